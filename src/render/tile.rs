//! A plane of sums cut into tiles that own their pixels.

use crate::integrator::Counters;
use crate::math::Rgb;
use std::ops::Range;

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

    /// Adds the samples with these indices to every pixel, in this order; `None` if `cancelled`, which is asked before
    /// every row.
    pub(super) fn sum<F>(
        &mut self,
        samples: Range<u64>,
        sample: &F,
        cancelled: impl Fn() -> bool,
    ) -> Option<Counters>
    where
        F: Fn(u32, u32, u64, &mut Counters) -> Rgb,
    {
        let mut counters = Counters::default();
        for (row, y) in self.rows.iter_mut().zip(self.y..) {
            if cancelled() {
                return None;
            }
            for (pixel, x) in row.iter_mut().zip(self.x..) {
                for index in samples.clone() {
                    let radiance = sample(x, y, index, &mut counters);
                    if radiance.is_finite() && radiance.min_element() >= 0.0 {
                        *pixel += radiance;
                    } else {
                        counters.dropped += 1;
                    }
                }
            }
        }
        Some(counters)
    }
}
