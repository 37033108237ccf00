//! The triangle of a mesh, and the leaf that all accelerators share: a conservative f32 test of eight triangles at
//! once, then the decision in f64 for the few that are left.
//!
//! Only + - * / in f64: the same bits on every machine and in every instruction set.

use super::frame::LocalRay;
use crate::math::{DVec3, cross32, dot32, subtract32};

/// Up to eight triangles, structure of arrays, in the f32 coordinates of their [`super::LocalFrame`].
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct TriangleBlock {
    /// Corner, axis, lane.
    corners: [[[f32; 8]; 3]; 3],
    /// Indices of the triangles; `u32::MAX` in unused lanes, which come last.
    indices: [u32; 8],
}

/// A hit of a triangle in local space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// In units of the local ray's direction.
    pub t: f64,
    /// Index of the triangle.
    pub index: u32,
    /// Weight of the second corner.
    pub u: f64,
    /// Weight of the third corner.
    pub v: f64,
}

/// Where the line of `ray` meets the triangle, as (t, u, v); t may be negative. `None` also for triangles without area
/// and for rays in the triangle's plane.
#[inline(always)]
pub fn intersect_triangle(ray: &LocalRay, corners: [DVec3; 3]) -> Option<(f64, f64, f64)> {
    let weights = ray.edges(corners);
    let negative = weights.iter().any(|&w| w < 0.0);
    let positive = weights.iter().any(|&w| w > 0.0);
    if negative & positive {
        return None;
    }
    let sum = weights[0] + weights[1] + weights[2];
    let t = plane_distance(ray, corners)?;
    (sum != 0.0).then(|| (t, weights[1] / sum, weights[2] / sum))
}

/// Where the line meets the plane of a triangle that another kernel says it hits: (t, u, v), the weights pulled into
/// the triangle; where [`intersect_triangle`] finds a hit, the same bits. `None` for triangles without area and for
/// rays in the triangle's plane.
pub fn plane_hit(ray: &LocalRay, corners: [DVec3; 3]) -> Option<(f64, f64, f64)> {
    let edges = ray.edges(corners);
    let sum = edges[0] + edges[1] + edges[2];
    let t = plane_distance(ray, corners)?;
    if sum == 0.0 {
        return None;
    }
    let weights = edges.map(|w| w / sum);
    if weights.iter().all(|&w| w >= 0.0) {
        return Some((t, weights[1], weights[2]));
    }
    let inside = weights.map(|w| w.clamp(0.0, 1.0));
    let total = inside[0] + inside[1] + inside[2];
    Some((t, inside[1] / total, inside[2] / total))
}

/// Distance to the plane of the corners.
#[inline(always)]
fn plane_distance(ray: &LocalRay, corners: [DVec3; 3]) -> Option<f64> {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let cosine = normal.dot(ray.direction64());
    (cosine != 0.0).then(|| (corners[0] - ray.origin64()).dot(normal) / cosine)
}

impl TriangleBlock {
    /// The most triangles in a block.
    pub const LANES: usize = 8;

    /// Packs one to eight triangles, given as (index, corners). More than eight, or none, are a fault of the caller:
    /// the rest is left out.
    pub fn new(triangles: impl IntoIterator<Item = (u32, [[f32; 3]; 3])>) -> TriangleBlock {
        let mut block = TriangleBlock { corners: [[[0.0; 8]; 3]; 3], indices: [u32::MAX; 8] };
        for (lane, (index, corners)) in triangles.into_iter().take(8).enumerate() {
            block.indices[lane] = index;
            for (corner, position) in corners.iter().enumerate() {
                for (axis, &value) in position.iter().enumerate() {
                    block.corners[corner][axis][lane] = value;
                }
            }
        }
        block
    }

    /// The indices of its triangles.
    pub fn indices(&self) -> impl Iterator<Item = u32> + '_ {
        self.indices.iter().copied().take_while(|&index| index != u32::MAX)
    }

    /// Lower and upper corner of the box around its triangles.
    pub fn bounds(&self) -> ([f32; 3], [f32; 3]) {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for lane in 0..self.indices().count() {
            for corner in &self.corners {
                for axis in 0..3 {
                    low[axis] = low[axis].min(corner[axis][lane]);
                    high[axis] = high[axis].max(corner[axis][lane]);
                }
            }
        }
        (low, high)
    }

    /// The coordinates, by corner, axis and lane; 0 in unused lanes.
    #[inline(always)]
    pub(crate) fn corner_lanes(&self) -> &[[[f32; 8]; 3]; 3] {
        &self.corners
    }

    /// The index of the triangle in a lane below 8.
    #[inline(always)]
    pub(crate) fn lane_index(&self, lane: usize) -> u32 {
        self.indices[lane]
    }

    /// The corners of the triangle in a lane below 8, exactly.
    #[inline(always)]
    pub(crate) fn corners_of(&self, lane: usize) -> [DVec3; 3] {
        self.corners.map(|c| DVec3::new(c[0][lane].into(), c[1][lane].into(), c[2][lane].into()))
    }

    /// The lowest bit of byte i tells whether the ray may hit the triangle of lane i and does not exclude it: a
    /// superset of the hits, in f32.
    ///
    /// With C = corner 0 - origin, e1 and e2 the edges from corner 0, and den = (e1 x e2).d, half of the edge functions
    /// are U = (C x d).e2, V = -(C x d).e1 and W = den - U - V (Möller & Trumbore 1997 written as Plücker products).
    /// Counting roundings, each of U, V and den is wrong by at most 7 * 2^-24 and W by at most 9 * 2^-24 times
    /// max|d| (|C| (|e1| + |e2|) + |e1| |e2|), 1-norms all; `bound` is 16.7 * 2^-24 of it, which leaves room for its
    /// own roundings and for those of the f64 decision, which sees the ray before it was rounded to f32: the direction
    /// within 2^-24 max|d|, one more unit in each of the two terms, and the origin within 2^-23 |o|, which is
    /// 2 * 2^-24 max|d| |o| (|e1| + |e2|), of which `bound` has twice that. The smallest normal number covers products
    /// that underflow. A NaN counts for neither side.
    #[allow(clippy::needless_range_loop)] // a plain loop over lanes becomes vector instructions
    #[inline(always)]
    fn candidates(&self, ray: &LocalRay) -> u64 {
        let o = ray.origin.to_array();
        let d = ray.direction.to_array();
        let scale = 1e-6 * d[0].abs().max(d[1].abs()).max(d[2].abs());
        let [p0, p1, p2] = &self.corners;
        let [left, target] = ray.excluded_indices();
        let moved = 0.25 * norm1(o);
        let mut keep = [false; 8];
        for lane in 0..8 {
            let a = [p0[0][lane], p0[1][lane], p0[2][lane]];
            let e1 = subtract32([p1[0][lane], p1[1][lane], p1[2][lane]], a);
            let e2 = subtract32([p2[0][lane], p2[1][lane], p2[2][lane]], a);
            let c = subtract32(a, o);
            let moment = cross32(c, d);
            let (u, v) = (dot32(moment, e2), -dot32(moment, e1));
            let w = dot32(cross32(e1, e2), d) - u - v;
            let (l1, l2) = (norm1(e1), norm1(e2));
            let bound = scale * ((norm1(c) + moved) * (l1 + l2) + l1 * l2) + f32::MIN_POSITIVE;
            let (below, above) = (-bound, bound);
            let negative = (u < below) | (v < below) | (w < below);
            let positive = (u > above) | (v > above) | (w > above);
            let index = self.indices[lane];
            let allowed = (index != left) & (index != target) & (index != u32::MAX);
            keep[lane] = !(negative & positive) & allowed;
        }
        u64::from_le_bytes(keep.map(u8::from))
    }
}

#[inline(always)]
fn norm1(v: [f32; 3]) -> f32 {
    v[0].abs() + v[1].abs() + v[2].abs()
}

/// Makes `best` the hit with the smallest key (t, index) of it and the block's triangles, t in (0, `ray.t_max`].
/// Whether that is another hit than before.
#[inline(always)]
pub fn closest_in_block(block: &TriangleBlock, ray: &LocalRay, best: &mut Option<TriangleHit>) -> bool {
    let mut found = false;
    let mut mask = block.candidates(ray);
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize / 8;
        mask &= mask - 1;
        let index = block.indices[lane];
        if let Some((t, u, v)) = intersect_triangle(ray, block.corners_of(lane)) {
            let closer = match best {
                Some(old) => (t, index) < (old.t, old.index),
                None => t <= ray.t_max,
            };
            if t > 0.0 && closer {
                *best = Some(TriangleHit { t, index, u, v });
                found = true;
            }
        }
    }
    found
}

/// Whether a triangle of the block is hit with t in (0, `ray.t_max`).
#[inline(always)]
pub fn any_in_block(block: &TriangleBlock, ray: &LocalRay) -> bool {
    let mut mask = block.candidates(ray);
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize / 8;
        mask &= mask - 1;
        if let Some((t, ..)) = intersect_triangle(ray, block.corners_of(lane))
            && t > 0.0
            && t < ray.t_max
        {
            return true;
        }
    }
    false
}
