//! A plane of sums cut into tiles that own their pixels.

use super::{FIREFLY, FIREFLY_BEFORE};
use crate::integrator::Counters;
use crate::math::Rgb;
use std::ops::Range;

/// Samples that every pixel gets.
pub(super) struct Pass {
    /// Their indices.
    pub(super) samples: Range<u64>,
    /// How many of the same chunk every pixel has already.
    pub(super) before: u64,
    /// The most that a component of a sample may be.
    pub(super) clamp: Option<f64>,
}

/// A rectangle of a plane.
pub(super) struct Tile<'p> {
    x: u32,
    y: u32,
    rows: Vec<&'p mut [Rgb]>,
}

/// Cuts a plane with rows of `width` pixels into tiles of `side` x `side` pixels, fewer at the right and lower edges.
pub(super) fn split(plane: &mut [Rgb], width: u32, side: u32) -> Vec<Tile<'_>> {
    let band_pixels = width as usize * side as usize;
    let bands = plane.chunks_mut(band_pixels).zip((0..).step_by(side as usize));
    bands.flat_map(|(band, y)| split_band(band, width, side, y)).collect()
}

fn split_band(band: &mut [Rgb], width: u32, side: u32, y: u32) -> Vec<Tile<'_>> {
    let mut tiles: Vec<Tile<'_>> =
        (0..width).step_by(side as usize).map(|x| Tile { x, y, rows: Vec::new() }).collect();
    for row in band.chunks_mut(width as usize) {
        let parts = row.chunks_mut(side as usize);
        tiles.iter_mut().zip(parts).for_each(|(tile, part)| tile.rows.push(part));
    }
    tiles
}

impl Tile<'_> {
    /// The number of pixels.
    pub(super) fn pixels(&self) -> u64 {
        self.rows.iter().map(|row| row.len() as u64).sum()
    }

    /// Adds the samples of a pass to every pixel, in the order of their indices; `None` if `cancelled`, which is asked
    /// before every pixel: in a bright closed scene one may take a second.
    pub(super) fn sum<F>(&mut self, pass: &Pass, sample: &F, cancelled: impl Fn() -> bool) -> Option<Counters>
    where
        F: Fn(u32, u32, u64, &mut Counters) -> Rgb,
    {
        let mut counters = Counters::default();
        for (row, y) in self.rows.iter_mut().zip(self.y..) {
            for (pixel, x) in row.iter_mut().zip(self.x..) {
                if cancelled() {
                    return None;
                }
                let firefly = pass.firefly(*pixel);
                for index in pass.samples.clone() {
                    let radiance = sample(x, y, index, &mut counters);
                    *pixel += pass.judge(radiance, firefly, &mut counters);
                }
            }
        }
        Some(counters)
    }
}

impl Pass {
    /// Above which component a sample of a pixel is a firefly, given the sum of the pixel's samples in the chunk.
    fn firefly(&self, sum: Rgb) -> f64 {
        let largest = sum.max_element();
        let is_known = self.before >= FIREFLY_BEFORE && largest > 0.0;
        if is_known { FIREFLY * (largest / self.before as f64) } else { f64::INFINITY }
    }

    /// Counts what is odd about a sample; returns what is added to its pixel.
    #[inline]
    fn judge(&self, radiance: Rgb, firefly: f64, counters: &mut Counters) -> Rgb {
        if !(radiance.is_finite() && radiance.min_element() >= 0.0) {
            counters.dropped += 1;
            return Rgb::ZERO;
        }
        let added = match self.clamp {
            Some(limit) if radiance.max_element() > limit => clamp(radiance, limit, counters),
            _ => radiance,
        };
        counters.fireflies += u64::from(added.max_element() > firefly);
        added
    }
}

/// Limits the components of a sample.
fn clamp(radiance: Rgb, limit: f64, counters: &mut Counters) -> Rgb {
    let limited = radiance.min(Rgb::splat(limit));
    counters.clamped += 1;
    // Divided first: the sum of the components may exceed the range of numbers.
    counters.clamp_removed.add(((radiance - limited) / limit).element_sum() / 3.0);
    limited
}
