//! A plane of sums cut into tiles that own their pixels.

use super::cells::{Cells, GREYS};
use super::{FIREFLY, FIREFLY_BEFORE};
use crate::film::grey;
use crate::integrator::Counters;
use crate::math::Rgb;
use crate::sampling::{Place, Scrambles};
use std::ops::Range;

/// Samples that every pixel gets.
pub(super) struct Pass {
    /// Their indices.
    pub(super) samples: Range<u64>,
    /// How many of the same chunk every pixel has already.
    pub(super) before: u64,
    /// The most that a component of a sample may be.
    pub(super) clamp: Option<f64>,
    /// Where they lie.
    pub(super) scrambles: Scrambles,
}

/// A rectangle of a plane of cells.
pub(super) struct Tile<'p> {
    x: u32,
    y: u32,
    stride: usize,
    rows: Vec<&'p mut [f64]>,
}

/// Cuts a plane with rows of `width` pixels into tiles of `side` x `side` pixels, fewer at the right and lower edges.
pub(super) fn split(cells: &mut Cells, width: u32, side: u32) -> Vec<Tile<'_>> {
    let Cells { values, stride, .. } = cells;
    let band_values = width as usize * side as usize * *stride;
    let bands = values.chunks_mut(band_values).zip((0..).step_by(side as usize));
    bands.flat_map(|(band, y)| split_band(band, *stride, width, side, y)).collect()
}

fn split_band(band: &mut [f64], stride: usize, width: u32, side: u32, y: u32) -> Vec<Tile<'_>> {
    let mut tiles: Vec<Tile<'_>> =
        (0..width).step_by(side as usize).map(|x| Tile { x, y, stride, rows: Vec::new() }).collect();
    for row in band.chunks_mut(width as usize * stride) {
        let parts = row.chunks_mut(side as usize * stride);
        tiles.iter_mut().zip(parts).for_each(|(tile, part)| tile.rows.push(part));
    }
    tiles
}

impl Tile<'_> {
    /// The number of pixels.
    pub(super) fn pixels(&self) -> u64 {
        self.rows.iter().map(|row| (row.len() / self.stride) as u64).sum()
    }

    /// Adds the samples of a pass to every pixel, in the order of their indices; `None` if `cancelled`, which is asked
    /// before every pixel: in a bright closed scene one may take a second.
    pub(super) fn sum<F>(&mut self, pass: &Pass, sample: &F, cancelled: impl Fn() -> bool) -> Option<Counters>
    where
        F: Fn(u32, u32, u64, &mut Counters) -> Rgb,
    {
        let mut counters = Counters::default();
        for (row, y) in self.rows.iter_mut().zip(self.y..) {
            for (cell, x) in row.chunks_exact_mut(self.stride).zip(self.x..) {
                if cancelled() {
                    return None;
                }
                let mut sum = Rgb::new(cell[0], cell[1], cell[2]);
                let firefly = pass.firefly(sum);
                for index in pass.samples.clone() {
                    let place = pass.scrambles.place(index);
                    let radiance = pass.take(x, y, place, sample, firefly, &mut counters);
                    sum += radiance;
                    if let Some(greys) = cell.get_mut(GREYS..).filter(|greys| !greys.is_empty()) {
                        greys[place.scramble] += grey(radiance);
                    }
                }
                cell[..GREYS].copy_from_slice(&sum.to_array());
            }
        }
        Some(counters)
    }
}

impl Pass {
    /// What the sample at a place adds to its pixel.
    #[inline]
    pub(super) fn take<F>(
        &self,
        x: u32,
        y: u32,
        place: Place,
        sample: &F,
        firefly: f64,
        counters: &mut Counters,
    ) -> Rgb
    where
        F: Fn(u32, u32, u64, &mut Counters) -> Rgb,
    {
        let radiance = sample(x, y, place.sample_index(), counters);
        self.judge(radiance, firefly, counters)
    }

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
