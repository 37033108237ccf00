//! The rectangle: two triangles with f64 corners that share a diagonal.

use super::doubles::{Doubles, One};
use super::shear::{Shear, signed_area};
use crate::math::{Bounds, DVec3};

/// A rectangle. Seen from its front, `edge_u` runs to the right and `edge_v` up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Centre.
    pub center: DVec3,
    /// The whole lower edge, from left to right.
    pub edge_u: DVec3,
    /// The whole left edge, upwards.
    pub edge_v: DVec3,
    /// Unit normal of the front.
    pub normal: DVec3,
    /// Sum of the edges' lengths.
    pub(super) reach: f64,
    /// The edges over the squares of their lengths.
    along_u: DVec3,
    along_v: DVec3,
    slack: [f64; 2],
}

/// Distance, triangle (0 or 1) and coordinates in [0, 1].
type RectangleHit = (f64, u32, f64, f64);

/// A rectangle, or several, as coordinates in f64 see it.
pub(super) struct Pane<N> {
    pub(super) center: [N; 3],
    pub(super) normal: [N; 3],
    /// The edges over the squares of their lengths.
    pub(super) along_u: [N; 3],
    pub(super) along_v: [N; 3],
    /// See [`SLACK`]: the part that the rectangle knows, and the factor on the size of the ray's origin.
    pub(super) slack: [N; 2],
}

/// What coordinates say for certain.
pub(super) struct Clearance<N> {
    /// Below 0 if the rectangle is missed.
    pub(super) misses: N,
    /// Above 0 if it is hit, on the side of the diagonal that the coordinates tell.
    pub(super) hits: N,
}

/// Below what part of R over the shorter edge, divided by the cosine of the angle to the normal, coordinates are not
/// trusted: 2^-28. R is the sum of the sizes of the ray's origin, the centre and the edges.
///
/// With e = 2^-53 the distance t to the plane is wrong by at most (8 e R + 8 e |t|) / cosine, and the point there by
/// 4 e (R + |t|) more. Of points within 4 R that is less than 80 e R / cosine; of farther ones it is either less than their
/// own distance from the rectangle, or the cosine is below 50 e and the slack above all coordinates. The exact signs are
/// those of corners moved by up to 16 e R across the ray, which is at most 32 e R / cosine in the plane. Together less than
/// 2^-46 R / cosine, and sqrt(2) of it beside the diagonal.
///
/// It is 2^18 times that, so that t is right to 2^-18 of the shorter edge too wherever coordinates decide: accelerators
/// leave out boxes that begin beyond t, and these are widened by more ([`super::LocalFrame::padding`]).
const SLACK: f64 = 1.0 / 268_435_456.0;

/// By what part of R the box around the rectangle is widened where it tells a ray in the plane how far the rectangle is:
/// 2^-46, which is 128 e R. Corners and the distances to the faces are wrong by less, and it is little beside what
/// accelerators widen boxes by.
const BOX_SLACK: f64 = 1.0 / 70_368_744_177_664.0;

/// Larger numbers and the reciprocals of smaller ones than this are left to exact signs.
const COMMON: f64 = 1e100;

impl<N: Copy> Pane<N> {
    /// The distance to the plane, and the cosine of the angle to its normal.
    #[inline(always)]
    pub(super) fn distance<L: Doubles<Double = N>>(
        &self,
        lanes: L,
        origin: [N; 3],
        direction: [N; 3],
    ) -> (N, N) {
        let cosine = lanes.dot(self.normal, direction);
        (lanes.over(lanes.dot(self.normal, lanes.difference(self.center, origin)), cosine), cosine)
    }

    /// The coordinates of the point at `t`, in [-0.5, 0.5] within the rectangle.
    #[inline(always)]
    fn coordinates<L: Doubles<Double = N>>(
        &self,
        lanes: L,
        origin: [N; 3],
        direction: [N; 3],
        t: N,
    ) -> [N; 2] {
        let p = lanes.along(lanes.difference(origin, self.center), direction, t);
        [lanes.dot(p, self.along_u), lanes.dot(p, self.along_v)]
    }

    /// The coordinates of the point at `t`, and what they say for certain. `size` is the sum of the sizes of the
    /// components of `origin`.
    #[inline(always)]
    pub(super) fn look<L: Doubles<Double = N>>(
        &self,
        lanes: L,
        origin: [N; 3],
        direction: [N; 3],
        t: N,
        cosine: N,
        size: N,
    ) -> ([N; 2], Clearance<N>) {
        let [u, v] = self.coordinates(lanes, origin, direction, t);
        let slack = lanes.plus(self.slack[0], lanes.times(self.slack[1], size));
        let cosine = lanes.size(cosine);
        let within = lanes.minus(lanes.same(0.5), lanes.greater(lanes.size(u), lanes.size(v)));
        let off_diagonal = lanes.size(lanes.minus(u, v));
        let clearance = Clearance {
            misses: lanes.plus(lanes.times(within, cosine), slack),
            hits: lanes.minus(lanes.times(lanes.lesser(within, off_diagonal), cosine), slack),
        };
        ([u, v], clearance)
    }
}

impl Rectangle {
    /// The rectangle with these half edges; `half_u` and `half_v` are at right angles, `half_u` to the right seen
    /// from the front.
    pub fn new(center: DVec3, half_u: DVec3, half_v: DVec3) -> Rectangle {
        // Normalised first: the lengths may be as small as the square root of the smallest number.
        let normal = half_u.normalize().cross(half_v.normalize()).normalize();
        let (edge_u, edge_v) = (half_u * 2.0, half_v * 2.0);
        let reach = edge_u.length() + edge_v.length();
        let shorter = edge_u.length().min(edge_v.length());
        // Infinite where squares might leave the range of numbers: then exact signs always decide.
        let is_common = shorter > 1.0 / COMMON && center.abs().element_sum() + reach < COMMON;
        let relative = if is_common { SLACK / shorter } else { f64::INFINITY };
        Rectangle {
            center,
            edge_u,
            edge_v,
            normal,
            reach,
            along_u: edge_u / edge_u.length_squared(),
            along_v: edge_v / edge_v.length_squared(),
            slack: [relative * (center.abs().element_sum() + reach), relative],
        }
    }

    /// Where the line meets the rectangle, up to `t_max`. It is decided as for the triangles of meshes, by exact signs of
    /// corners that are seen along the ray: rectangles that share two corners let no ray through between them. Away from
    /// edges and from the diagonal the coordinates say the same.
    pub fn intersect(&self, origin: DVec3, direction: DVec3, t_max: f64) -> Option<RectangleHit> {
        let (pane, o, d) = (self.pane(), origin.to_array(), direction.to_array());
        let (t, cosine) = pane.distance(One, o, d);
        if cosine == 0.0 || t.is_nan() {
            return None;
        }
        let (uv, clearance) = pane.look(One, o, d, t, cosine, origin.abs().element_sum());
        if clearance.misses < 0.0 {
            return None;
        }
        let (t, part, uv) = if clearance.hits > 0.0 {
            (t, Self::part_at(uv), uv)
        } else {
            let part = self.part_hit(origin, direction)?;
            let (enter, leave) = self.range(origin, direction);
            let t = t.max(enter).min(leave);
            (t, part, pane.coordinates(One, o, d, t))
        };
        (t > 0.0 && t <= t_max).then(|| (t, part, edge_coordinate(uv[0]), edge_coordinate(uv[1])))
    }

    /// Where the line is in the box around the rectangle, a little widened. The distance to the plane is rounding alone for
    /// a ray that lies in it, but such a ray meets the rectangle in this box.
    fn range(&self, origin: DVec3, direction: DVec3) -> (f64, f64) {
        let around = origin.abs().element_sum() + self.center.abs().element_sum() + self.reach;
        let (bounds, slack) = (self.bounds(), DVec3::splat(BOX_SLACK * around));
        let (low, high) = (bounds.min - slack - origin, bounds.max + slack - origin);
        let whole = (f64::NEG_INFINITY, f64::INFINITY);
        (0..3).filter(|&axis| direction[axis] != 0.0).fold(whole, |(enter, leave), axis| {
            let (a, b) = (low[axis] / direction[axis], high[axis] / direction[axis]);
            (enter.max(a.min(b)), leave.min(a.max(b)))
        })
    }

    /// The part and the coordinates of a hit at `t` away from edges and diagonal.
    #[inline(always)]
    pub(super) fn clear_hit(&self, origin: DVec3, direction: DVec3, t: f64) -> (u32, f64, f64) {
        let uv = self.pane().coordinates(One, origin.to_array(), direction.to_array(), t);
        (Self::part_at(uv), edge_coordinate(uv[0]), edge_coordinate(uv[1]))
    }

    fn part_at([u, v]: [f64; 2]) -> u32 {
        u32::from(u < v)
    }

    /// What a ray is tried against first.
    #[inline(always)]
    pub(super) fn pane(&self) -> Pane<f64> {
        Pane {
            center: self.center.to_array(),
            normal: self.normal.to_array(),
            along_u: self.along_u.to_array(),
            along_v: self.along_v.to_array(),
            slack: self.slack,
        }
    }

    /// Lower left, lower right, upper right, upper left.
    pub(crate) fn corners(&self) -> [DVec3; 4] {
        let (half_u, half_v) = (self.edge_u * 0.5, self.edge_v * 0.5);
        [
            self.center - half_u - half_v,
            self.center + half_u - half_v,
            self.center + half_u + half_v,
            self.center - half_u + half_v,
        ]
    }

    /// The part that is hit, by exact signs, of a ray that meets the plane.
    fn part_hit(&self, origin: DVec3, direction: DVec3) -> Option<u32> {
        let shear = Shear::onto_largest_axis(direction);
        let [a, b, c, d] = self.corners().map(|corner| shear.project(corner - origin));
        let (ab, bc, cd, da) = (signed_area(a, b), signed_area(b, c), signed_area(c, d), signed_area(d, a));
        let ca = signed_area(c, a);
        if same_sign(ab, bc, ca) {
            Some(0)
        } else if same_sign(cd, da, -ca) {
            Some(1)
        } else {
            None
        }
    }

    /// Area in square units.
    pub fn area(&self) -> f64 {
        self.edge_u.length() * self.edge_v.length()
    }

    /// The point with these coordinates in [0, 1], relative to the centre.
    pub fn offset_at(&self, u: f64, v: f64) -> DVec3 {
        self.edge_u * (u - 0.5) + self.edge_v * (v - 0.5)
    }

    /// The box around it.
    pub fn bounds(&self) -> Bounds {
        self.corners().into_iter().fold(Bounds::EMPTY, Bounds::with_point)
    }
}

/// Whether no two of these have opposite signs; not if all are zero, which is how a triangle without area is seen.
fn same_sign(a: f64, b: f64, c: f64) -> bool {
    (a.min(b).min(c) >= 0.0 || a.max(b).max(c) <= 0.0) && a + b + c != 0.0
}

/// From [-0.5, 0.5] to [0, 1], without what rounding adds.
fn edge_coordinate(x: f64) -> f64 {
    (x + 0.5).clamp(0.0, 1.0)
}
