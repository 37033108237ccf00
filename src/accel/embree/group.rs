//! Groups triangles into blocks for the exact scene.

use crate::geometry::{Geometry, TriangleBlock};
use crate::math::Vec3;
use rayon::prelude::*;

/// Triangles of a block.
const LANES: usize = 8;

/// Bins per axis.
const BINS: usize = 16;

/// Slices longer than this are split on two threads.
const PARALLEL: usize = 4096;

/// All triangles in blocks of up to eight, by recursive splits of least surface area (Wald, "On fast Construction of
/// SAH-based Bounding Volume Hierarchies", 2007). The cost of a side is its area times the number of blocks it needs
/// at least, so that blocks are filled.
pub(super) fn group(geometry: &Geometry) -> Vec<TriangleBlock> {
    let indices = 0..geometry.triangles.len() as u32;
    let mut items: Vec<Item> = indices.into_par_iter().map(|index| Item::new(geometry, index)).collect();
    split(geometry, &mut items)
}

/// A triangle's box, and which it is.
#[derive(Clone, Copy)]
struct Item {
    index: u32,
    bounds: Box3,
}

impl Item {
    fn new(geometry: &Geometry, index: u32) -> Item {
        let corners = geometry.corners32(index).map(Vec3::from);
        Item { index, bounds: corners.into_iter().fold(Box3::EMPTY, Box3::with_point) }
    }

    fn center(&self) -> Vec3 {
        self.bounds.low + self.bounds.high
    }
}

/// A box in f32; a heuristic works on it, so its rounding does not matter.
#[derive(Clone, Copy)]
struct Box3 {
    low: Vec3,
    high: Vec3,
}

impl Box3 {
    const EMPTY: Box3 = Box3 { low: Vec3::INFINITY, high: Vec3::NEG_INFINITY };

    fn with_point(self, p: Vec3) -> Box3 {
        Box3 { low: self.low.min(p), high: self.high.max(p) }
    }

    fn union(self, other: Box3) -> Box3 {
        Box3 { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Half of the surface area, 0 if empty.
    fn half_area(self) -> f32 {
        let d = (self.high - self.low).max(Vec3::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }
}

fn split(geometry: &Geometry, items: &mut [Item]) -> Vec<TriangleBlock> {
    if items.len() > PARALLEL {
        let middle = partition(items);
        let (left, right) = items.split_at_mut(middle);
        let (mut blocks, rest) = rayon::join(|| split(geometry, left), || split(geometry, right));
        blocks.extend(rest);
        return blocks;
    }
    let mut blocks = Vec::with_capacity(items.len() / 4 + 1);
    split_into(geometry, items, &mut blocks);
    blocks
}

fn split_into(geometry: &Geometry, items: &mut [Item], blocks: &mut Vec<TriangleBlock>) {
    if items.len() <= LANES {
        items.sort_unstable_by_key(|item| item.index);
        blocks.push(TriangleBlock::new(items.iter().map(|i| (i.index, geometry.corners32(i.index)))));
        return;
    }
    let middle = partition(items);
    let (left, right) = items.split_at_mut(middle);
    split_into(geometry, left, blocks);
    split_into(geometry, right, blocks);
}

/// Puts the items of one side before those of the other; the length of the first side, neither side empty.
fn partition(items: &mut [Item]) -> usize {
    let centers = items.iter().fold(Box3::EMPTY, |b, item| b.with_point(item.center()));
    let best = (0..3).filter_map(|axis| best_split(items, &Binning::new(&centers, axis)?)).min_by(|a, b| {
        let order = a.cost.total_cmp(&b.cost);
        order.then(a.binning.axis.cmp(&b.binning.axis))
    });
    let Some(best) = best else {
        // All centres are one point (or not finite): any half will do.
        return items.len() / 2;
    };
    let mut middle = 0;
    for i in 0..items.len() {
        if best.binning.bin(&items[i]) <= best.last_left {
            items.swap(i, middle);
            middle += 1;
        }
    }
    middle
}

/// Equal slices of the centres' box along an axis.
#[derive(Clone, Copy)]
struct Binning {
    axis: usize,
    low: f32,
    per_length: f32,
}

impl Binning {
    fn new(centers: &Box3, axis: usize) -> Option<Binning> {
        let (low, high) = (centers.low[axis], centers.high[axis]);
        let per_length = BINS as f32 * (1.0 - f32::EPSILON) / (high - low);
        (high > low && per_length.is_finite()).then_some(Binning { axis, low, per_length })
    }

    fn bin(&self, item: &Item) -> usize {
        let position = (item.center()[self.axis] - self.low) * self.per_length;
        (position as usize).min(BINS - 1)
    }
}

struct Split {
    cost: f32,
    binning: Binning,
    /// The last bin of the first side.
    last_left: usize,
}

/// The cheapest split between two bins with items on both sides.
fn best_split(items: &[Item], binning: &Binning) -> Option<Split> {
    let mut bins = [(Box3::EMPTY, 0usize); BINS];
    for item in items {
        let (bounds, count) = &mut bins[binning.bin(item)];
        *bounds = bounds.union(item.bounds);
        *count += 1;
    }
    let cost = |bounds: Box3, count: usize| bounds.half_area() * count.div_ceil(LANES) as f32;
    let mut right = [(Box3::EMPTY, 0); BINS];
    let mut sum = (Box3::EMPTY, 0);
    for bin in (1..BINS).rev() {
        sum = (sum.0.union(bins[bin].0), sum.1 + bins[bin].1);
        right[bin - 1] = sum;
    }
    let mut left = (Box3::EMPTY, 0);
    let mut best: Option<Split> = None;
    for last_left in 0..BINS - 1 {
        left = (left.0.union(bins[last_left].0), left.1 + bins[last_left].1);
        let (right_bounds, right_count) = right[last_left];
        let cost = cost(left.0, left.1) + cost(right_bounds, right_count);
        if left.1 > 0 && right_count > 0 && best.as_ref().is_none_or(|b| cost < b.cost) {
            best = Some(Split { cost, binning: *binning, last_left });
        }
    }
    best
}
