//! Where to cut a set of primitives: the surface area heuristic over bins (Wald, "On fast Construction of SAH-based
//! Bounding Volume Hierarchies", 2007), its costs rounded up to whole leaves.

use glam::Vec4;
use rayon::prelude::*;

use super::build::{Part, Rules};

/// A box in f32; the fourth component means nothing.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aabb {
    pub(super) low: Vec4,
    pub(super) high: Vec4,
}

impl Aabb {
    const EMPTY: Aabb = Aabb { low: Vec4::INFINITY, high: Vec4::NEG_INFINITY };

    fn union(self, other: Aabb) -> Aabb {
        Aabb { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    fn with_point(self, p: Vec4) -> Aabb {
        Aabb { low: self.low.min(p), high: self.high.max(p) }
    }

    /// Half of the surface; 0 for an empty box.
    pub(super) fn half_area(self) -> f32 {
        let size = (self.high - self.low).max(Vec4::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}

/// A primitive's box and index.
///
/// The index is in the fourth components, 16 bits each as a whole number: two vectors a primitive are moved instead of
/// three, and no lane ever holds a subnormal number, which some processors compute slowly.
#[derive(Clone, Copy, Debug)]
pub(super) struct PrimRef {
    low: Vec4,
    high: Vec4,
}

impl PrimRef {
    pub(super) fn new(index: u32, low: [f32; 3], high: [f32; 3]) -> PrimRef {
        let extend = |[x, y, z]: [f32; 3], w: u32| Vec4::new(x, y, z, w as f32);
        PrimRef { low: extend(low, index & 0xffff), high: extend(high, index >> 16) }
    }

    pub(super) fn index(&self) -> u32 {
        self.low.w as u32 | (self.high.w as u32) << 16
    }

    /// Twice the centre.
    fn centroid(&self) -> Vec4 {
        self.low + self.high
    }

    fn bounds(&self) -> Aabb {
        Aabb { low: self.low, high: self.high }
    }
}

/// Primitives that one thread takes at once; the pieces are the same for any number of threads.
const CHUNK: usize = 1 << 15;

/// The boxes around primitives and around their (doubled) centres.
pub(super) fn bounds_of(prims: &[PrimRef]) -> (Aabb, Aabb) {
    let empty = (Aabb::EMPTY, Aabb::EMPTY);
    let add = |(bounds, centroids): (Aabb, Aabb), prim: &PrimRef| {
        (bounds.union(prim.bounds()), centroids.with_point(prim.centroid()))
    };
    let chunks: Vec<_> = prims.par_chunks(CHUNK).map(|chunk| chunk.iter().fold(empty, add)).collect();
    chunks.into_iter().fold(empty, |a, b| (a.0.union(b.0), a.1.union(b.1)))
}

/// Cuts a part in two, neither empty: where the surface area heuristic says, if it is `shaped` and the centres differ,
/// else in the middle.
pub(super) fn split<'p>(part: Part<'p>, rules: &Rules, shaped: bool) -> (Part<'p>, Part<'p>) {
    let plane = if shaped { best_plane(&part, rules) } else { None };
    let Part { prims, start, centroids, .. } = part;
    let (middle, [left, right]) = match plane {
        Some(plane) => partition(prims, |prim| plane.is_left(prim)),
        None => halve(prims, centroids, rules.block),
    };
    let (left_prims, right_prims) = prims.split_at_mut(middle);
    (
        Part { prims: left_prims, start, bounds: left.0, centroids: left.1 },
        Part { prims: right_prims, start: start + middle, bounds: right.0, centroids: right.1 },
    )
}

/// Most bins along an axis.
const MAX_BINS: usize = 32;

#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    count: u32,
}

type Bins = [[Bin; MAX_BINS]; 3];

const EMPTY_BIN: Bin = Bin { bounds: Aabb::EMPTY, count: 0 };

/// From centres to bins.
#[derive(Clone, Copy)]
struct Binning {
    origin: Vec4,
    /// Bins per length; 0 on axes along which all centres agree.
    scale: Vec4,
    bins: usize,
}

impl Binning {
    fn new(centroids: Aabb, count: usize, hasty: bool) -> Binning {
        let bins = (8 + count / 8).min(MAX_BINS);
        // A little less than the number of bins, so that the last centre falls into the last bin.
        let reach = bins as f32 * (1.0 - 4.0 * f32::EPSILON);
        let size = centroids.high - centroids.low;
        let mut scale = size.to_array().map(|size| {
            let scale = reach / size;
            if scale.is_finite() { scale } else { 0.0 }
        });
        if hasty {
            let longest = longest_axis(size);
            (0..3).filter(|&axis| axis != longest).for_each(|axis| scale[axis] = 0.0);
        }
        Binning { origin: centroids.low, scale: Vec4::new(scale[0], scale[1], scale[2], 0.0), bins }
    }

    fn bins_of(&self, prim: &PrimRef) -> [usize; 3] {
        let place = (prim.centroid() - self.origin) * self.scale;
        // Written out: without link-time optimisation a `map` is not inlined.
        let bin = |place: f32| (place as i32 as usize).min(self.bins - 1);
        [bin(place.x), bin(place.y), bin(place.z)]
    }

    fn fill(&self, prims: &[PrimRef]) -> Bins {
        let mut bins = [[EMPTY_BIN; MAX_BINS]; 3];
        for prim in prims {
            let places = self.bins_of(prim);
            for axis in (0..3).filter(|&axis| self.scale[axis] != 0.0) {
                let bin = &mut bins[axis][places[axis]];
                bin.bounds = bin.bounds.union(prim.bounds());
                bin.count += 1;
            }
        }
        bins
    }
}

/// Where to cut: the bins before `position` along `axis` go left.
struct Plane {
    binning: Binning,
    axis: usize,
    position: usize,
}

impl Plane {
    fn is_left(&self, prim: &PrimRef) -> bool {
        self.binning.bins_of(prim)[self.axis] < self.position
    }
}

/// The cheapest cut, `None` if all centres agree.
fn best_plane(part: &Part, rules: &Rules) -> Option<Plane> {
    let binning = Binning::new(part.centroids, part.prims.len(), rules.hasty);
    let bins = if part.prims.len() <= CHUNK {
        binning.fill(part.prims)
    } else {
        let chunks: Vec<Bins> = part.prims.par_chunks(CHUNK).map(|chunk| binning.fill(chunk)).collect();
        chunks.iter().fold([[EMPTY_BIN; MAX_BINS]; 3], join)
    };
    let mut best = None;
    let mut least = f32::INFINITY;
    for (axis, bins) in bins.iter().enumerate() {
        if binning.scale[axis] == 0.0 {
            continue;
        }
        let (cost, position) = sweep(&bins[..binning.bins], rules.block);
        if cost < least {
            least = cost;
            best = Some(Plane { binning, axis, position });
        }
    }
    best
}

fn join(mut sum: Bins, other: &Bins) -> Bins {
    for (sum, other) in sum.iter_mut().flatten().zip(other.iter().flatten()) {
        sum.bounds = sum.bounds.union(other.bounds);
        sum.count += other.count;
    }
    sum
}

/// The least cost of a cut before one of the bins, and that bin. The first and the last bin are not empty.
fn sweep(bins: &[Bin], block: usize) -> (f32, usize) {
    let cost = |bounds: Aabb, count: u32| bounds.half_area() * count.div_ceil(block as u32) as f32;
    let mut right = [0f32; MAX_BINS];
    let (mut bounds, mut count) = (Aabb::EMPTY, 0);
    for position in (1..bins.len()).rev() {
        bounds = bounds.union(bins[position].bounds);
        count += bins[position].count;
        right[position] = cost(bounds, count);
    }
    let (mut bounds, mut count) = (Aabb::EMPTY, 0);
    let mut best = (f32::INFINITY, 1);
    for position in 1..bins.len() {
        bounds = bounds.union(bins[position - 1].bounds);
        count += bins[position - 1].count;
        let total = cost(bounds, count) + right[position];
        if total < best.0 {
            best = (total, position);
        }
    }
    best
}

fn longest_axis(size: Vec4) -> usize {
    (1..3).fold(0, |longest, axis| if size[axis] > size[longest] { axis } else { longest })
}

/// Boxes around primitives and centres, left and right of a cut.
type Sides = [(Aabb, Aabb); 2];

/// Moves what is left to the front; returns how many those are, and the boxes of both sides.
///
/// Large arrays in pieces, the same for any number of threads: each brings its own left to the front, and then what is
/// left behind the common middle is exchanged for what is right before it.
fn partition(prims: &mut [PrimRef], is_left: impl Fn(&PrimRef) -> bool + Sync) -> (usize, Sides) {
    if prims.len() <= CHUNK {
        return partition_chunk(prims, is_left);
    }
    let chunks: Vec<_> = prims.par_chunks_mut(CHUNK).map(|chunk| partition_chunk(chunk, &is_left)).collect();
    let middle = chunks.iter().map(|(left, _)| left).sum();
    let sides = chunks.iter().fold([(Aabb::EMPTY, Aabb::EMPTY); 2], |sum, (_, sides)| {
        [0, 1].map(|side| (sum[side].0.union(sides[side].0), sum[side].1.union(sides[side].1)))
    });
    let (front, back) = prims.split_at_mut(middle);
    let starts = (0..chunks.len()).map(|chunk| chunk * CHUNK);
    let borders: Vec<_> = starts.zip(&chunks).map(|(start, (left, _))| (start, start + left)).collect();
    // Parts of the front that belong to the right, and of the back that belong to the left, as long together.
    let mut misplaced = borders.iter().flat_map(|&(start, border)| {
        let (begin, end) = (border.min(middle), (start + CHUNK).min(middle));
        (begin < end).then_some(begin..end)
    });
    let mut hole = misplaced.next().unwrap_or(0..0);
    for &(start, border) in borders.iter().filter(|(_, border)| *border > middle) {
        let mut rest = &mut back[start.max(middle) - middle..border - middle];
        while !rest.is_empty() {
            if hole.is_empty() {
                hole = misplaced.next().unwrap_or(0..0);
            }
            let count = rest.len().min(hole.len());
            let (now, later) = rest.split_at_mut(count);
            front[hole.start..hole.start + count].swap_with_slice(now);
            (hole.start, rest) = (hole.start + count, later);
        }
    }
    (middle, sides)
}

/// [`partition`] on one thread.
fn partition_chunk(prims: &mut [PrimRef], is_left: impl Fn(&PrimRef) -> bool) -> (usize, Sides) {
    let mut sides = [(Aabb::EMPTY, Aabb::EMPTY); 2];
    let (mut front, mut back) = (0, prims.len());
    let mut add = |side: usize, prim: &PrimRef| {
        sides[side].0 = sides[side].0.union(prim.bounds());
        sides[side].1 = sides[side].1.with_point(prim.centroid());
    };
    while front < back {
        if is_left(&prims[front]) {
            add(0, &prims[front]);
            front += 1;
        } else {
            back -= 1;
            add(1, &prims[front]);
            prims.swap(front, back);
        }
    }
    (front, sides)
}

/// Cuts in the middle of the order along the longest axis, at a whole number of leaves.
fn halve(prims: &mut [PrimRef], centroids: Aabb, block: usize) -> (usize, Sides) {
    let axis = longest_axis(centroids.high - centroids.low);
    let middle = (prims.len() / 2).div_ceil(block) * block;
    prims.select_nth_unstable_by(middle, |a, b| {
        a.centroid()[axis].total_cmp(&b.centroid()[axis]).then(a.index().cmp(&b.index()))
    });
    (middle, [bounds_of(&prims[..middle]), bounds_of(&prims[middle..])])
}
