//! A plane of sums cut into tiles that own their pixels.

use super::adaptive::Adaptive;
use super::cells::{Cells, Layout};
use super::{FIREFLY, FIREFLY_BEFORE};
use crate::film::{Frame, Halving, Run, grey};
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
    /// Whose halves are compared.
    pub(super) halving: Halving,
    /// Which blocks get them, if not all.
    pub(super) blocks: Option<&'a Adaptive>,
}

/// What a tile did.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub(super) struct Work {
    /// Samples of one pixel.
    pub(super) samples: u64,
    pub(super) counters: Counters,
}

/// The pixels of a plane of cells that lie in one square.
pub(super) struct Tile<'p> {
    layout: Layout,
    rows: Vec<Row<'p>>,
}

/// Cells side by side.
struct Row<'p> {
    x: u32,
    y: u32,
    cells: &'p mut [f64],
}

/// Cuts the plane of a frame into tiles of `side` x `side` pixels, row by row; where the frame has no pixels there are none.
pub(super) fn split<'c>(cells: &'c mut Cells, frame: &Frame, side: u32) -> Vec<Tile<'c>> {
    let layout = cells.layout;
    let mut rest = cells.values.as_mut_slice();
    let mut tiles: Vec<Tile<'c>> = Vec::new();
    // The tiles under way, by column.
    let mut band = 0;
    let mut open: Vec<Option<usize>> = vec![None; frame.width().div_ceil(side) as usize];
    for Run { x: Range { start: mut x, end }, y } in frame.runs() {
        if y / side != band {
            band = y / side;
            open.fill(None);
        }
        while x < end {
            let next = (x / side + 1).saturating_mul(side).min(end);
            let values = layout.stride() * (next - x) as usize;
            let (cells, after) = std::mem::take(&mut rest).split_at_mut(values);
            rest = after;
            let tile = *open[(x / side) as usize].get_or_insert_with(|| {
                tiles.push(Tile { layout, rows: Vec::new() });
                tiles.len() - 1
            });
            tiles[tile].rows.push(Row { x, y, cells });
            x = next;
        }
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
        let (layout, compared) = (self.layout, pass.compared());
        for Row { x, y, cells } in &mut self.rows {
            let y = *y;
            for (cell, x) in cells.chunks_exact_mut(layout.stride()).zip(*x..) {
                if !pass.blocks.is_none_or(|blocks| blocks.takes(x, y)) {
                    continue;
                }
                if cancelled() {
                    return None;
                }
                let mut sums = layout.radiance(cell);
                for index in pass.samples.clone() {
                    let place = pass.scrambles.place(index);
                    let firefly = pass.firefly(sums[0] + sums[1], index);
                    let radiance = pass.take(x, y, place, sample, firefly, &mut work.counters);
                    sums[layout.half(place.scramble)] += radiance;
                    if let Some(sum) = cell[layout.greys()].get_mut(place.scramble) {
                        *sum += grey(radiance);
                    }
                    if compared.contains(&(index + 1)) {
                        layout.compare(cell, grey(sums[0]));
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

    /// The numbers of a pixel's samples, reached in this pass, that are compared; 0 for none, and in chunks but the first.
    /// Passes at most double what there is, so there are at most two: a power of two, and the chunk itself.
    fn compared(&self) -> [u64; 2] {
        let last = self.halving.largest(self.samples.end);
        let is_first = self.samples.start == self.before;
        let reached = |count: u64| if is_first && count > self.samples.start { count } else { 0 };
        [self.halving.largest(last.saturating_sub(1)), last].map(reached)
    }

    /// Above which component a sample of a pixel is a firefly, given the sum of the pixel's samples before it in the chunk.
    #[inline]
    fn firefly(&self, sum: Rgb, index: u64) -> f64 {
        let before = self.before + (index - self.samples.start);
        let largest = sum.max_element();
        let is_known = before >= FIREFLY_BEFORE && largest > 0.0;
        if is_known { FIREFLY * (largest / before as f64) } else { f64::INFINITY }
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
