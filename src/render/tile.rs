//! A plane of sums cut into tiles that own their pixels.

use super::adaptive::Adaptive;
use super::cells::{Cells, Layout};
use super::{FIREFLY, FIREFLY_BEFORE};
use crate::film::{Region, grey};
use crate::integrator::Counters;
use crate::math::Rgb;
use crate::sampling::{Place, Scrambles};
use serde::{Deserialize, Serialize};
use std::ops::{AddAssign, Range};

/// Samples that every pixel gets.
pub(super) struct Pass<'a> {
    /// Their indices.
    pub(super) samples: Range<u64>,
    /// How many of the same chunk every pixel has already.
    pub(super) before: u64,
    /// The most that a component of a sample may be.
    pub(super) clamp: Option<f64>,
    /// Where they lie.
    pub(super) scrambles: Scrambles,
    /// Which blocks get them, if not all.
    pub(super) blocks: Option<&'a Adaptive>,
    /// Which pixels of the picture get them.
    pub(super) region: Region,
    /// Of the picture.
    pub(super) width: u32,
}

/// What a tile did.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Work {
    /// Samples of one pixel.
    pub(super) samples: u64,
    pub(super) counters: Counters,
}

/// A rectangle of a plane of cells.
pub(super) struct Tile<'p> {
    x: u32,
    y: u32,
    layout: Layout,
    rows: Vec<&'p mut [f64]>,
}

/// Cuts a plane with rows of `width` pixels into tiles of `side` x `side` pixels, fewer at the right and lower edges.
pub(super) fn split(cells: &mut Cells, width: u32, side: u32) -> Vec<Tile<'_>> {
    let Cells { values, layout, .. } = cells;
    let layout = *layout;
    let band_values = width as usize * side as usize * layout.stride();
    let bands = values.chunks_mut(band_values).zip((0..).step_by(side as usize));
    bands.flat_map(|(band, y)| split_band(band, layout, width, side, y)).collect()
}

fn split_band(band: &mut [f64], layout: Layout, width: u32, side: u32, y: u32) -> Vec<Tile<'_>> {
    let mut tiles: Vec<Tile<'_>> =
        (0..width).step_by(side as usize).map(|x| Tile { x, y, layout, rows: Vec::new() }).collect();
    for row in band.chunks_mut(width as usize * layout.stride()) {
        let parts = row.chunks_mut(side as usize * layout.stride());
        tiles.iter_mut().zip(parts).for_each(|(tile, part)| tile.rows.push(part));
    }
    tiles
}

impl Tile<'_> {
    /// Adds the samples of a pass to every pixel, in the order of their indices; `None` if `cancelled`, which is asked
    /// before every pixel: in a bright closed scene one may take a second.
    pub(super) fn sum<F>(&mut self, pass: &Pass, sample: &F, cancelled: impl Fn() -> bool) -> Option<Work>
    where
        F: Fn(u32, u32, u64, &mut Counters) -> Rgb,
    {
        let mut work = Work::default();
        let layout = self.layout;
        for (row, y) in self.rows.iter_mut().zip(self.y..) {
            for (cell, x) in row.chunks_exact_mut(layout.stride()).zip(self.x..) {
                if !pass.takes(x, y) {
                    continue;
                }
                if cancelled() {
                    return None;
                }
                let mut sums = layout.radiance(cell);
                let firefly = pass.firefly(sums[0] + sums[1]);
                for index in pass.samples.clone() {
                    let place = pass.scrambles.place(index);
                    let radiance = pass.take(x, y, place, sample, firefly, &mut work.counters);
                    sums[layout.half(place.scramble)] += radiance;
                    if let Some(sum) = cell[layout.greys()].get_mut(place.scramble) {
                        *sum += grey(radiance);
                    }
                }
                layout.set_radiance(cell, sums);
                work.samples += pass.samples.end - pass.samples.start;
            }
        }
        Some(work)
    }
}

impl AddAssign for Work {
    fn add_assign(&mut self, other: Work) {
        self.samples += other.samples;
        self.counters += other.counters;
    }
}

impl Pass<'_> {
    /// Whether a pixel takes samples.
    #[inline]
    fn takes(&self, x: u32, y: u32) -> bool {
        match self.blocks {
            Some(blocks) => blocks.takes(x, y),
            None => self.region.contains(self.width, x, y),
        }
    }

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
