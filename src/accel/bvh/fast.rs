//! The f32 leaf of [`crate::accel::Precision::Fast`]: eight triangles at once, no second look in f64.

use super::traverse::Leaf;
use crate::geometry::{LocalRay, TriangleBlock, TriangleHit, plane_hit};
use crate::math::{cross32, dot32, subtract32};

/// Blocks decided in f32. Rays may slip through edges; neighbours do not agree on them.
pub(super) struct FastTriangles<'t> {
    pub(super) blocks: &'t [TriangleBlock],
    pub(super) ray: &'t LocalRay,
    /// Distance of the best hit, or the end of the ray.
    t: f32,
    best: Option<Winner>,
}

/// Where the best hit is: fetching its corners by index would touch memory that the traversal has not.
#[derive(Clone, Copy)]
struct Winner {
    index: u32,
    leaf: u32,
    lane: usize,
}

impl<'t> FastTriangles<'t> {
    pub(super) fn new(blocks: &'t [TriangleBlock], ray: &'t LocalRay) -> FastTriangles<'t> {
        FastTriangles { blocks, ray, t: ray.t_max32(), best: None }
    }

    /// The best hit, its t, u and v computed in f64.
    pub(super) fn hit(&self) -> Option<TriangleHit> {
        let Winner { index, leaf, lane } = self.best?;
        let corners = self.blocks[leaf as usize].corners_of(lane);
        let (t, u, v) = plane_hit(self.ray, corners)?;
        Some(TriangleHit { t, index, u, v })
    }
}

impl Leaf for FastTriangles<'_> {
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.t
    }

    #[inline(always)]
    fn closest(&mut self, leaf: u32) {
        let block = &self.blocks[leaf as usize];
        let (mut mask, distances) = hits(block, self.ray, self.t);
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize / 8;
            mask &= mask - 1;
            let (t, index) = (distances[lane], block.lane_index(lane));
            let tie = t == self.t && self.best.is_none_or(|best| index < best.index);
            if (t < self.t || tie) && !self.ray.excludes(index) {
                (self.t, self.best) = (t, Some(Winner { index, leaf, lane }));
            }
        }
    }

    #[inline(always)]
    fn address(&self, leaf: u32) -> *const u8 {
        self.blocks.as_ptr().wrapping_add(leaf as usize).cast()
    }

    #[inline(always)]
    fn any(&self, leaf: u32) -> bool {
        let block = &self.blocks[leaf as usize];
        let (mut mask, distances) = hits(block, self.ray, self.t);
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize / 8;
            mask &= mask - 1;
            if distances[lane] < self.t && !self.ray.excludes(block.lane_index(lane)) {
                return true;
            }
        }
        false
    }
}

/// The lowest bit of byte i tells whether lane i is hit at a distance in (0, `limit`]; and the distances.
///
/// Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997, without its epsilon: the weights are
/// compared with the determinant, and the division is left to last.
#[inline(always)]
fn hits(block: &TriangleBlock, ray: &LocalRay, limit: f32) -> (u64, [f32; 8]) {
    let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
    let [p0, p1, p2] = block.corner_lanes();
    let mut distances = [0f32; 8];
    let mut hit = [false; 8];
    for lane in 0..8 {
        let corner = |p: &[[f32; 8]; 3]| [p[0][lane], p[1][lane], p[2][lane]];
        let a = corner(p0);
        let (e1, e2) = (subtract32(corner(p1), a), subtract32(corner(p2), a));
        let to_origin = subtract32(o, a);
        let (p, q) = (cross32(d, e2), cross32(to_origin, e1));
        let determinant = dot32(e1, p);
        let sign = if determinant < 0.0 { -1.0 } else { 1.0 };
        let size = determinant * sign;
        let (u, v, t) = (dot32(to_origin, p) * sign, dot32(d, q) * sign, dot32(e2, q) * sign);
        distances[lane] = t / size;
        hit[lane] = (u >= 0.0) & (v >= 0.0) & (u + v <= size) & (t > 0.0) & (distances[lane] <= limit);
    }
    (u64::from_le_bytes(hit.map(u8::from)), distances)
}
