//! Which numbers of the sampler decide what.

use crate::sampling::{NumberSet, PixelSeed, Sampler};

/// The random numbers of one sample, each made only when it is asked for.
///
/// Decisions share a set if their results are added: the light that is aimed at, and all that comes from where the path
/// goes on. Where results are multiplied the sets differ, since the uses of a set are functions of each other.
#[derive(Clone, Copy)]
pub(super) struct Numbers<'s, S> {
    sampler: &'s S,
    pixel: PixelSeed,
    index: u64,
}

/// The numbers of one segment.
pub(super) struct SegmentNumbers<'s, S: Sampler> {
    sample: Numbers<'s, S>,
    first_set: u32,
    shared: S::Set,
}

/// Sets of the camera, and of every segment.
const CAMERA_SETS: u32 = 2;
const SEGMENT_SETS: u32 = 3;

impl<'s, S: Sampler> Numbers<'s, S> {
    pub(super) fn new(sampler: &'s S, x: u32, y: u32, index: u64) -> Numbers<'s, S> {
        Numbers { sampler, pixel: sampler.pixel(x, y), index }
    }

    /// Those of one of several paths that go on from the same start. A scramble, which the upper half of an index names,
    /// stays the same.
    #[inline]
    pub(super) fn branch(&self, branch: u32, branches: u32) -> Numbers<'s, S> {
        let scramble = self.index & !u64::from(u32::MAX);
        let point = self.index & u64::from(u32::MAX);
        Numbers { index: scramble | (point * u64::from(branches) + u64::from(branch)), ..*self }
    }

    /// A point of the pixel.
    #[inline]
    pub(super) fn pixel(&self) -> [f64; 2] {
        self.set(0).pair(0)
    }

    /// A point of the lens.
    #[inline]
    pub(super) fn lens(&self) -> [f64; 2] {
        self.set(1).pair(0)
    }

    /// Those of a segment, counted from 1.
    #[inline]
    pub(super) fn segment(&self, segment: u32) -> SegmentNumbers<'s, S> {
        let first_set = CAMERA_SETS + SEGMENT_SETS * (segment - 1);
        SegmentNumbers { sample: *self, first_set, shared: self.set(first_set) }
    }

    #[inline]
    fn set(&self, set: u32) -> S::Set {
        self.sampler.set(self.pixel, self.index, set)
    }
}

impl<S: Sampler> SegmentNumbers<'_, S> {
    /// The point of a light.
    #[inline]
    pub(super) fn light(&self) -> [f64; 2] {
        self.shared.pair(0)
    }

    /// The direction in which the path goes on.
    #[inline]
    pub(super) fn direction(&self) -> [f64; 2] {
        self.shared.pair(1)
    }

    /// Which light.
    #[inline]
    pub(super) fn light_choice(&self) -> f64 {
        self.sample.set(self.first_set + 1).one(0)
    }

    /// Which part of the material.
    #[inline]
    pub(super) fn lobe(&self) -> f64 {
        self.sample.set(self.first_set + 1).one(1)
    }

    /// The point of a light that is sought by way of a ball.
    #[inline]
    pub(super) fn caustic_light(&self) -> [f64; 2] {
        self.shared.pair(2)
    }

    /// Which ball, and which light.
    #[inline]
    pub(super) fn caustic_choice(&self) -> [f64; 2] {
        self.sample.set(self.first_set + 1).pair(2)
    }

    /// Whether the path goes on.
    #[inline]
    pub(super) fn roulette(&self) -> f64 {
        self.sample.set(self.first_set + 2).one(0)
    }
}
