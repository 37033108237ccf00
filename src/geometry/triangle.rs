//! The triangle of a mesh, and the leaf that all accelerators share: a conservative f32 test of eight triangles at
//! once, then the decision in f64 for the few that are left.
//!
//! Only + - * / in f64: the same bits on every machine and in every instruction set.

use super::frame::LocalRay;
use super::lanes::{Lanes, Portable};
use super::shear::ShearedRay;
use crate::math::DVec3;

/// Up to eight triangles, structure of arrays, in the f32 coordinates of their [`super::LocalFrame`].
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct TriangleBlock {
    /// Corner, axis, lane; infinite in unused lanes, where that makes every result NaN.
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
    let ray = ShearedRay::new(ray);
    let crossing = crossing(&ray, corners.map(|corner| ray.rotate(corner)))?;
    let (u, v) = crossing.coordinates();
    Some((crossing.t, u, v))
}

/// Where a line goes through a triangle.
#[derive(Clone, Copy)]
struct Crossing {
    t: f64,
    /// The weights of the corners times something; none is 0 in sum.
    weights: [f64; 3],
}

impl Crossing {
    /// The weights of the second and third corner.
    #[inline(always)]
    fn coordinates(&self) -> (f64, f64) {
        let [a, b, c] = self.weights;
        let sum = a + b + c;
        (b / sum, c / sum)
    }
}

/// The decision about a triangle, whose components are ordered as those of the sheared ray are.
#[inline(always)]
fn crossing(ray: &ShearedRay, corners: [[f64; 3]; 3]) -> Option<Crossing> {
    let weights = ray.edges(corners);
    let [a, b, c] = weights;
    let negative = (a < 0.0) | (b < 0.0) | (c < 0.0);
    let positive = (a > 0.0) | (b > 0.0) | (c > 0.0);
    if negative & positive {
        return None;
    }
    let t = plane_distance(ray, corners)?;
    (a + b + c != 0.0).then_some(Crossing { t, weights })
}

/// Where the line meets the plane of a triangle that another kernel says it hits: (t, u, v), all pulled to those of the
/// triangle; where [`intersect_triangle`] finds a hit, the same bits. `None` for triangles without area and for
/// rays in the triangle's plane.
pub fn plane_hit(ray: &LocalRay, corners: [DVec3; 3]) -> Option<(f64, f64, f64)> {
    sheared_plane_hit(&ShearedRay::new(ray), corners)
}

/// [`plane_hit`] of a ray with its shear.
#[inline(always)]
pub(crate) fn sheared_plane_hit(sheared: &ShearedRay, corners: [DVec3; 3]) -> Option<(f64, f64, f64)> {
    let ray = sheared.ray;
    let rotated = corners.map(|corner| sheared.rotate(corner));
    let edges = sheared.edges(rotated);
    let sum = edges[0] + edges[1] + edges[2];
    let t = plane_distance(sheared, rotated)?;
    if sum == 0.0 {
        return None;
    }
    let weights = edges.map(|w| w / sum);
    if weights.iter().all(|&w| w >= 0.0) {
        return Some((t, weights[1], weights[2]));
    }
    let inside = weights.map(|w| w.clamp(0.0, 1.0));
    let total = inside[0] + inside[1] + inside[2];
    // Beside a triangle that is seen edge-on its plane may be met anywhere.
    let depths = corners.map(|corner| (corner - ray.origin64()).dot(ray.direction64()));
    let t = t.max(depths[0].min(depths[1]).min(depths[2])).min(depths[0].max(depths[1]).max(depths[2]));
    Some((t, inside[1] / total, inside[2] / total))
}

/// Distance to the plane of the corners.
#[inline(always)]
fn plane_distance(ray: &ShearedRay, [a, b, c]: [[f64; 3]; 3]) -> Option<f64> {
    let vector = DVec3::from_array;
    let (a, b, c) = (vector(a), vector(b), vector(c));
    let normal = (b - a).cross(c - a);
    let cosine = normal.dot(vector(ray.direction));
    (cosine != 0.0).then(|| (a - vector(ray.origin)).dot(normal) / cosine)
}

impl TriangleBlock {
    /// The most triangles in a block.
    pub const LANES: usize = 8;

    /// Packs one to eight triangles, given as (index, corners). More than eight, or none, are a fault of the caller:
    /// the rest is left out.
    pub fn new(triangles: impl IntoIterator<Item = (u32, [[f32; 3]; 3])>) -> TriangleBlock {
        let mut block = TriangleBlock { corners: [[[f32::INFINITY; 8]; 3]; 3], indices: [u32::MAX; 8] };
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

    /// The index of the triangle in a lane below 8.
    #[inline(always)]
    pub(crate) fn lane_index(&self, lane: usize) -> u32 {
        self.indices[lane]
    }

    /// The block without the triangle in a lane.
    pub(crate) fn without(&self, lane: usize) -> TriangleBlock {
        let kept = self.indices().enumerate().filter(|&(other, _)| other != lane);
        TriangleBlock::new(kept.map(|(other, index)| {
            let corners = self.corners_of(other).map(|corner| corner.as_vec3().to_array());
            (index, corners)
        }))
    }

    /// The corners of the triangle in a lane below 8, exactly.
    #[inline(always)]
    pub(crate) fn corners_of(&self, lane: usize) -> [DVec3; 3] {
        // By reference: all lanes would be copied else.
        let [a, b, c] = &self.corners;
        let corner = |c: &[[f32; 8]; 3]| DVec3::new(c[0][lane].into(), c[1][lane].into(), c[2][lane].into());
        [corner(a), corner(b), corner(c)]
    }

    /// The corners of the triangle in a lane below 8 as the components of `ray` are ordered.
    #[inline(always)]
    fn rotated_corners_of(&self, lane: usize, ray: &ShearedRay) -> [[f64; 3]; 3] {
        let [a, b, c] = &self.corners;
        let order = ray.order();
        [rotated_corner(a, lane, order), rotated_corner(b, lane, order), rotated_corner(c, lane, order)]
    }

    /// All triangles as they are seen along the ray, in f32.
    #[inline(always)]
    pub(crate) fn seen<L: Lanes>(&self, ray: &ShearedRay, lanes: L) -> Seen<L> {
        // No closures here: only functions that are inlined always become part of one with these instructions.
        let [a, b, c] = &self.corners;
        let (a, b, c) = (see(a, ray, lanes), see(b, ray, lanes), see(c, ray, lanes));
        let areas = [signed_areas(b, c, lanes), signed_areas(c, a, lanes), signed_areas(a, b, lanes)];
        Seen { corners: [a, b, c], areas }
    }

    /// A bit for every lane, from the lowest on, whose triangle the ray may hit: a superset of the hits, in f32.
    ///
    /// Let u = 2^-24, o and c the components of the ray's start and of a corner relative to it, and D and M bounds for
    /// |c| and for the coordinates X, Y that the corners are seen at. The start is within 2 u |o|, the slopes, at most 1,
    /// within u; counting roundings, X and Y are wrong by at most E = u (4 |o| + 6 D), and an area, x1 y2 - x2 y1, by at
    /// most 4 E M + 2 E^2 + 4 u M^2. As M <= 2 D, the last term is less than 4/3 E M, and all of it less than
    /// 5.4 E (M + E). D is at most M and the largest depth. `bound` has 6 instead of 5.4, and 8 u for the 4 u and
    /// 6 u in E, for its own roundings and for the (far smaller) ones of the decision in f64. The smallest normal number
    /// covers products that underflow. In local coordinates nothing overflows: only unused lanes give NaN, which are
    /// never candidates.
    #[inline(always)]
    fn candidates<L: Lanes>(&self, ray: &ShearedRay, lanes: L) -> u32 {
        let Seen { corners: [a, b, c], areas: [u, v, w] } = self.seen(ray, lanes);
        let depth = lanes.max(larger(a[2], b[2], lanes), lanes.abs(c[2]));
        let width = lanes.max(larger(a[0], a[1], lanes), larger(b[0], b[1], lanes));
        let width = lanes.max(width, larger(c[0], c[1], lanes));
        let [x, y, z] = ray.origin32;
        let far = x.abs().max(y.abs()).max(z.abs());
        let reach = lanes.add(lanes.splat(far), lanes.add(width, depth));
        let error = lanes.mul(lanes.splat(4.0 * f32::EPSILON), reach);
        let scaled = lanes.mul(lanes.splat(6.0), error);
        let product = lanes.mul(scaled, lanes.add(width, error));
        let bound = lanes.add(product, lanes.splat(f32::MIN_POSITIVE));
        let below = lanes.sub(lanes.splat(0.0), bound);
        let (least, most) = (lanes.min(lanes.min(u, v), w), lanes.max(lanes.max(u, v), w));
        lanes.at_most(below, least) | lanes.at_most(most, bound)
    }
}

#[inline(always)]
fn rotated_corner(corners: &[[f32; 8]; 3], lane: usize, [x, y, z]: [usize; 3]) -> [f64; 3] {
    let lane = lane & 7;
    [corners[x][lane].into(), corners[y][lane].into(), corners[z][lane].into()]
}

/// Where eight corners are seen.
#[inline(always)]
fn see<L: Lanes>(corners: &[[f32; 8]; 3], ray: &ShearedRay, lanes: L) -> [L::Floats; 3] {
    let ([x, y, z], [ox, oy, oz]) = (ray.order(), ray.origin32);
    let depth = lanes.sub(lanes.load(&corners[z]), lanes.splat(oz));
    let x = lanes.sub(lanes.load(&corners[x]), lanes.splat(ox));
    let y = lanes.sub(lanes.load(&corners[y]), lanes.splat(oy));
    let [slope_x, slope_y] = ray.slopes32;
    let x = lanes.sub(x, lanes.mul(lanes.splat(slope_x), depth));
    let y = lanes.sub(y, lanes.mul(lanes.splat(slope_y), depth));
    [x, y, depth]
}

/// Twice the signed areas of the triangles (0, p, q).
#[inline(always)]
fn signed_areas<L: Lanes>(p: [L::Floats; 3], q: [L::Floats; 3], lanes: L) -> L::Floats {
    lanes.sub(lanes.mul(p[0], q[1]), lanes.mul(p[1], q[0]))
}

/// The larger one of two sizes.
#[inline(always)]
fn larger<L: Lanes>(p: L::Floats, q: L::Floats, lanes: L) -> L::Floats {
    lanes.max(lanes.abs(p), lanes.abs(q))
}

/// Triangles of a block as they are seen along a ray.
pub(crate) struct Seen<L: Lanes> {
    /// By corner: two coordinates across the axis that is the direction's largest, and the distance along it.
    pub(crate) corners: [[L::Floats; 3]; 3],
    /// Twice the signed areas of the triangles that the ray makes with the edges opposite to the corners.
    pub(crate) areas: [L::Floats; 3],
}

/// Makes `best` the hit with the smallest key (t, index) of it and the block's triangles, t in (0, `ray.t_max`].
/// Whether that is another hit than before.
pub fn closest_in_block(block: &TriangleBlock, ray: &LocalRay, best: &mut Option<TriangleHit>) -> bool {
    closest_in_lanes(block, &ShearedRay::new(ray), best, Portable)
}

/// [`closest_in_block`] in the instructions of `lanes`.
#[inline(always)]
pub(crate) fn closest_in_lanes<L: Lanes>(
    block: &TriangleBlock,
    ray: &ShearedRay,
    best: &mut Option<TriangleHit>,
    lanes: L,
) -> bool {
    let mut found = false;
    let mut mask = block.candidates(ray, lanes);
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize & 7;
        mask &= mask - 1;
        let index = block.indices[lane];
        if let Some(crossing) = crossing(ray, block.rotated_corners_of(lane, ray)) {
            let t = crossing.t;
            let closer = match best {
                Some(old) => (t, index) < (old.t, old.index),
                None => t <= ray.ray.t_max,
            };
            if t > 0.0 && closer && !ray.ray.excludes(index) {
                let (u, v) = crossing.coordinates();
                *best = Some(TriangleHit { t, index, u, v });
                found = true;
            }
        }
    }
    found
}

/// Whether a triangle of the block is hit with t in (0, `ray.t_max`).
pub fn any_in_block(block: &TriangleBlock, ray: &LocalRay) -> bool {
    any_in_lanes(block, &ShearedRay::new(ray), Portable)
}

/// [`any_in_block`] in the instructions of `lanes`.
#[inline(always)]
pub(crate) fn any_in_lanes<L: Lanes>(block: &TriangleBlock, ray: &ShearedRay, lanes: L) -> bool {
    let mut mask = block.candidates(ray, lanes);
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize & 7;
        mask &= mask - 1;
        if let Some(Crossing { t, .. }) = crossing(ray, block.rotated_corners_of(lane, ray))
            && t > 0.0
            && t < ray.ray.t_max
            && !ray.ray.excludes(block.indices[lane])
        {
            return true;
        }
    }
    false
}
