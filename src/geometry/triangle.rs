//! The triangle of a mesh, and the leaf that all accelerators share: a conservative f32 test of eight triangles at
//! once, then the decision in f64 for the few that are left.
//!
//! Only + - * / in f64: the same bits on every machine and in every instruction set.

use super::frame::LocalRay;
use crate::math::DVec3;

/// Up to eight triangles, structure of arrays, in the f32 coordinates of their [`super::LocalFrame`].
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(32))]
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

/// Twice the signed volume spanned by the edge pq and the direction d, seen from the ray's origin.
///
/// Exchanging p and q negates the result exactly, so two triangles that share an edge agree on its side and no gap is
/// between them (Platis & Theoharis 2003; Embree's robust mode uses the same form in f32).
#[inline(always)]
pub(super) fn edge(p: DVec3, q: DVec3, d: DVec3) -> f64 {
    (p - q).cross(p + q).dot(d)
}

/// Where the line from `origin` along `direction` meets the triangle, as (t, u, v); t may be negative.
/// `None` also for triangles without area and for rays in the triangle's plane.
#[inline(always)]
pub fn intersect_triangle(origin: DVec3, direction: DVec3, corners: [DVec3; 3]) -> Option<(f64, f64, f64)> {
    let [a, b, c] = corners.map(|corner| corner - origin);
    let (wa, wb, wc) = (edge(b, c, direction), edge(c, a, direction), edge(a, b, direction));
    let (least, most) = (wa.min(wb).min(wc), wa.max(wb).max(wc));
    if least < 0.0 && most > 0.0 {
        return None;
    }
    let sum = wa + wb + wc;
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let cosine = normal.dot(direction);
    if sum == 0.0 || cosine == 0.0 {
        return None;
    }
    Some((a.dot(normal) / cosine, wb / sum, wc / sum))
}

/// Where the line meets the plane of a triangle that another kernel says it hits: (t, u, v), the weights pulled into
/// the triangle; where [`intersect_triangle`] finds a hit, the same bits. `None` for triangles without area and for
/// rays in the triangle's plane.
pub fn plane_hit(origin: DVec3, direction: DVec3, corners: [DVec3; 3]) -> Option<(f64, f64, f64)> {
    let [a, b, c] = corners.map(|corner| corner - origin);
    let (wa, wb, wc) = (edge(b, c, direction), edge(c, a, direction), edge(a, b, direction));
    let sum = wa + wb + wc;
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let cosine = normal.dot(direction);
    if sum == 0.0 || cosine == 0.0 {
        return None;
    }
    let weights = [wa / sum, wb / sum, wc / sum];
    if weights.iter().all(|&w| w >= 0.0) {
        return Some((a.dot(normal) / cosine, weights[1], weights[2]));
    }
    let inside = weights.map(|w| w.clamp(0.0, 1.0));
    let total = inside[0] + inside[1] + inside[2];
    Some((a.dot(normal) / cosine, inside[1] / total, inside[2] / total))
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

    fn corners_of(&self, lane: usize) -> [DVec3; 3] {
        self.corners.map(|c| DVec3::new(c[0][lane].into(), c[1][lane].into(), c[2][lane].into()))
    }

    /// A bit for every lane whose triangle may be hit: a superset of the hits, in f32.
    ///
    /// The corners of a triangle that is hit lie within its longest edge of the ray, so the error of an edge function
    /// is below 12 * 2^-24 * max|edge| * max|corner - origin|; the bound here is four times that. Values that are not
    /// finite keep the lane.
    #[allow(clippy::needless_range_loop)] // plain loops over lanes become vector instructions
    #[inline(always)]
    fn candidates(&self, ray: &LocalRay) -> u32 {
        let o = ray.origin.to_array();
        let d = ray.direction.to_array();
        let mut v = [[[0f32; 8]; 3]; 3];
        for corner in 0..3 {
            for axis in 0..3 {
                for lane in 0..8 {
                    v[corner][axis][lane] = self.corners[corner][axis][lane] - o[axis];
                }
            }
        }
        let mut keep = [0u32; 8];
        for lane in 0..8 {
            let at = |corner: usize| [v[corner][0][lane], v[corner][1][lane], v[corner][2][lane]];
            let (a, b, c) = (at(0), at(1), at(2));
            let (wa, la) = edge_f32(b, c, d);
            let (wb, lb) = edge_f32(c, a, d);
            let (wc, lc) = edge_f32(a, b, d);
            let reach = norm1(a).max(norm1(b)).max(norm1(c));
            let bound = 3e-6 * la.max(lb).max(lc) * reach;
            let (least, most) = (wa.min(wb).min(wc), wa.max(wb).max(wc));
            // Written so that a NaN keeps the lane.
            keep[lane] = u32::from(!((least < -bound) & (most > bound)));
        }
        let mut mask = 0;
        for lane in 0..8 {
            mask |= keep[lane] << lane;
        }
        mask
    }
}

/// The edge function in f32 and the 1-norm of the edge.
#[inline(always)]
fn edge_f32(p: [f32; 3], q: [f32; 3], d: [f32; 3]) -> (f32, f32) {
    let e = [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let s = [p[0] + q[0], p[1] + q[1], p[2] + q[2]];
    let cross = [e[1] * s[2] - e[2] * s[1], e[2] * s[0] - e[0] * s[2], e[0] * s[1] - e[1] * s[0]];
    (cross[0] * d[0] + cross[1] * d[1] + cross[2] * d[2], norm1(e))
}

#[inline(always)]
fn norm1(v: [f32; 3]) -> f32 {
    v[0].abs() + v[1].abs() + v[2].abs()
}

/// Makes `best` the hit with the smallest key (t, index) of it and the block's triangles, t in (0, `ray.t_max`].
#[inline(always)]
pub fn closest_in_block(block: &TriangleBlock, ray: &LocalRay, best: &mut Option<TriangleHit>) {
    let mut mask = block.candidates(ray);
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask - 1;
        let index = block.indices[lane];
        if index == u32::MAX || ray.excludes(index) {
            continue;
        }
        if let Some((t, u, v)) = intersect_triangle(ray.origin64(), ray.direction64(), block.corners_of(lane))
        {
            let closer = match best {
                Some(old) => (t, index) < (old.t, old.index),
                None => t <= ray.t_max,
            };
            if t > 0.0 && closer {
                *best = Some(TriangleHit { t, index, u, v });
            }
        }
    }
}

/// Whether a triangle of the block is hit with t in (0, `ray.t_max`).
#[inline(always)]
pub fn any_in_block(block: &TriangleBlock, ray: &LocalRay) -> bool {
    let mut mask = block.candidates(ray);
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask - 1;
        let index = block.indices[lane];
        if index == u32::MAX || ray.excludes(index) {
            continue;
        }
        if let Some((t, ..)) = intersect_triangle(ray.origin64(), ray.direction64(), block.corners_of(lane))
            && t > 0.0
            && t < ray.t_max
        {
            return true;
        }
    }
    false
}
