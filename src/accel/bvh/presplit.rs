//! Large triangles in pieces, each with a box of its own, before the tree is built: spatial splits with a bounded budget.
//!
//! After Karras and Aila, "Fast Parallel Construction of High-Quality Bounding Volume Hierarchies", HPG 2013, section 4:
//! triangles get pieces by how much of their box is empty, and are cut where coarse planes of one common grid go
//! through them, so that neighbours are cut alike. A piece only has a box; the leaf still holds the whole triangle, and the
//! decision about it is the same from every piece. Walls and beams that lie
//! slanting gain, whose boxes are mostly empty; scans and what stands along the axes do not.

use rayon::prelude::*;

use super::split::PrimRef;
use super::{triangle_bounds, triangle_padding};
use crate::geometry::MeshSpace;
use crate::math::{DVec3, round_down, round_up};

/// Pieces more than triangles, by the number of triangles.
const BUDGET: f64 = 0.3;

/// The most cuts through a triangle.
const MOST_CUTS: f64 = 64.0;

/// The boxes of all triangles, those of large ones in pieces; sorted by triangle.
pub(super) fn pieces(space: &MeshSpace) -> Vec<PrimRef> {
    let count = space.triangles.len() as u32;
    let weights: Vec<f64> = (0..count).into_par_iter().map(|index| weight(space.corners(index))).collect();
    let scale = scale_within_budget(&weights);
    (0..count)
        .into_par_iter()
        .flat_map_iter(|index| {
            let mut pieces = Vec::new();
            let (low, high) = triangle_bounds(space, index);
            let piece = Piece { space, index, padding: triangle_padding(space, low, high) };
            piece.cut(low, high, cuts(weights[index as usize], scale), &mut pieces);
            pieces
        })
        .collect()
}

/// How much a triangle asks for pieces: the cube root of the surface by which its box is larger than the triangle seen
/// along the three axes.
fn weight([a, b, c]: [DVec3; 3]) -> f64 {
    let size = a.max(b).max(c) - a.min(b).min(c);
    let seen = (b - a).cross(c - a).abs() * 0.5;
    let half_area = size.x * size.y + size.y * size.z + size.z * size.x;
    libm::cbrt((half_area - (seen.x + seen.y + seen.z)).max(0.0))
}

fn cuts(weight: f64, scale: f64) -> u32 {
    (weight * scale).min(MOST_CUTS) as u32
}

/// The largest scale with which all cuts together stay within the budget, found by halving.
fn scale_within_budget(weights: &[f64]) -> f64 {
    let budget = (BUDGET * weights.len() as f64) as u64;
    let total = |scale: f64| weights.par_iter().map(|&weight| u64::from(cuts(weight, scale))).sum::<u64>();
    let heaviest = weights.par_iter().copied().reduce(|| 0.0, f64::max);
    let (mut low, mut high) = (0.0, MOST_CUTS / heaviest);
    if !high.is_finite() {
        return 0.0;
    }
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        if total(middle) <= budget { low = middle } else { high = middle }
    }
    low
}

/// A triangle that is cut.
struct Piece<'g> {
    space: &'g MeshSpace,
    index: u32,
    padding: f64,
}

impl Piece<'_> {
    /// Cuts what is in a box `cuts` times.
    fn cut(&self, low: [f64; 3], high: [f64; 3], cuts: u32, out: &mut Vec<PrimRef>) {
        let size = [0, 1, 2].map(|axis| high[axis] - low[axis]);
        let axis = (1..3).fold(0, |longest, axis| if size[axis] > size[longest] { axis } else { longest });
        let plane = grid_plane(low[axis], high[axis]);
        if cuts == 0 || !(low[axis] < plane && plane < high[axis]) {
            let (low, high) =
                (low.map(|x| round_down(x - self.padding)), high.map(|x| round_up(x + self.padding)));
            out.push(PrimRef::new(self.index, low, high));
            return;
        }
        let sides = [self.clip(axis, plane, false, low, high), self.clip(axis, plane, true, low, high)];
        let area = |(low, high): &([f64; 3], [f64; 3])| {
            let size = [0, 1, 2].map(|axis| (high[axis] - low[axis]).max(0.0));
            size[0] * size[1] + size[1] * size[2] + size[2] * size[0]
        };
        let share = area(&sides[0]) / (area(&sides[0]) + area(&sides[1]));
        let left = (f64::from(cuts - 1) * share + 0.5) as u32;
        for ((low, high), cuts) in sides.into_iter().zip([left, (cuts - 1).saturating_sub(left)]) {
            // An empty side has nothing that could be hit.
            if (0..3).all(|axis| low[axis] <= high[axis]) {
                self.cut(low, high, cuts, out);
            }
        }
    }

    /// The box around the part of the triangle on one side of a plane, within a box.
    fn clip(
        &self,
        axis: usize,
        plane: f64,
        upper: bool,
        low: [f64; 3],
        high: [f64; 3],
    ) -> ([f64; 3], [f64; 3]) {
        let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut add = |p: DVec3| (least, most) = (least.min(p), most.max(p));
        let corners = self.space.corners(self.index);
        for i in 0..3 {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            if (a[axis] >= plane) == upper || a[axis] == plane {
                add(a);
            }
            if (a[axis] < plane) != (b[axis] < plane) {
                let mut p = a.lerp(b, (plane - a[axis]) / (b[axis] - a[axis]));
                p[axis] = plane;
                add(p);
            }
        }
        let (least, most) = (least.to_array(), most.to_array());
        ([0, 1, 2].map(|i| least[i].max(low[i])), [0, 1, 2].map(|i| most[i].min(high[i])))
    }
}

/// The coarsest multiple of a power of two between two numbers, if it is not too near to one of them; else their middle.
fn grid_plane(low: f64, high: f64) -> f64 {
    let size = high - low;
    if !(size > 0.0 && size.is_finite()) {
        return low;
    }
    let mut step = libm::ldexp(1.0, libm::ilogb(size) + 1);
    for _ in 0..3 {
        let plane = (high / step).floor() * step;
        if plane > low + 0.2 * size && plane < high - 0.2 * size {
            return plane;
        }
        step *= 0.5;
    }
    low + 0.5 * size
}
