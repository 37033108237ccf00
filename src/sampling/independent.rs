//! Independent uniform numbers by a counter-based hash.

use super::{GOLDEN, NumberSet, PixelSeed, Sampler, mix, stream};

/// Plain Monte Carlo: every number is the hash of its place, unrelated to all others.
#[derive(Clone, Copy, Debug)]
pub struct Independent {
    mixed_seed: u64,
}

/// A place in the stream of a sample.
#[derive(Clone, Copy, Debug)]
pub struct IndependentSet {
    state: u64,
    first: u64,
}

impl Sampler for Independent {
    type Set = IndependentSet;

    fn new(seed: u64) -> Self {
        Independent { mixed_seed: mix(seed.wrapping_add(GOLDEN)) }
    }

    fn pixel(&self, x: u32, y: u32) -> PixelSeed {
        PixelSeed::new(self.mixed_seed, x, y)
    }

    #[inline]
    fn set(&self, pixel: PixelSeed, index: u64, set: u32) -> IndependentSet {
        // Each sample has its own stream, in which the sets follow each other.
        IndependentSet { state: stream(pixel.0, index), first: u64::from(set) << 32 | 1 }
    }
}

impl NumberSet for IndependentSet {
    #[inline]
    fn pair(&self, usage: u32) -> [f64; 2] {
        let first = self.first + 2 * u64::from(usage);
        [unit(stream(self.state, first)), unit(stream(self.state, first + 1))]
    }

    #[inline]
    fn one(&self, usage: u32) -> f64 {
        unit(stream(self.state, self.first + 2 * u64::from(usage)))
    }
}

/// The middle of one of 2^52 equal cells of (0, 1): exact in f64, never 0, never 1.
#[inline]
fn unit(bits: u64) -> f64 {
    ((bits >> 12) as f64 + 0.5) * (1.0 / (1u64 << 52) as f64)
}
