//! The rectangle: two triangles with f64 corners that share a diagonal.

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
    /// Lower left, lower right, upper right, upper left.
    corners: [DVec3; 4],
    /// Sum of the edges' lengths.
    pub(super) reach: f64,
}

/// Distance, triangle (0 or 1) and coordinates in [0, 1].
type RectangleHit = (f64, u32, f64, f64);

impl Rectangle {
    /// The rectangle with these half edges; `half_u` and `half_v` are at right angles, `half_u` to the right seen
    /// from the front.
    pub fn new(center: DVec3, half_u: DVec3, half_v: DVec3) -> Rectangle {
        let corners = [
            center - half_u - half_v,
            center + half_u - half_v,
            center + half_u + half_v,
            center - half_u + half_v,
        ];
        // Normalised first: the lengths may be as small as the square root of the smallest number.
        let normal = half_u.normalize().cross(half_v.normalize()).normalize();
        let (edge_u, edge_v) = (half_u * 2.0, half_v * 2.0);
        Rectangle { center, edge_u, edge_v, normal, corners, reach: edge_u.length() + edge_v.length() }
    }

    /// Where the line meets the rectangle, up to `t_max`. It is decided as for the triangles of meshes, by exact signs of
    /// corners that are seen along the ray: rectangles that share two corners let no ray through between them.
    pub fn intersect(&self, origin: DVec3, direction: DVec3, t_max: f64) -> Option<RectangleHit> {
        let cosine = self.normal.dot(direction);
        if cosine == 0.0 {
            return None;
        }
        let t = self.normal.dot(self.center - origin) / cosine;
        if !(t > 0.0 && t <= t_max) {
            return None;
        }
        let shear = Shear::onto_largest_axis(direction);
        let seen = |corner: usize| shear.project(self.corners[corner] - origin);
        let (a, b, c, d) = (seen(0), seen(1), seen(2), seen(3));
        let (ab, bc, cd, da) = (signed_area(a, b), signed_area(b, c), signed_area(c, d), signed_area(d, a));
        let ca = signed_area(c, a);
        let part = if same_sign(ab, bc, ca) {
            0
        } else if same_sign(cd, da, -ca) {
            1
        } else {
            return None;
        };
        let p = (origin - self.center) + direction * t;
        let along = |e: DVec3| (p.dot(e) / e.dot(e) + 0.5).clamp(0.0, 1.0);
        Some((t, part, along(self.edge_u), along(self.edge_v)))
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
        self.corners.iter().fold(Bounds::EMPTY, |bounds, &corner| bounds.with_point(corner))
    }
}

/// Whether no two of these have opposite signs; not if all are zero, which is how a triangle without area is seen.
fn same_sign(a: f64, b: f64, c: f64) -> bool {
    (a.min(b).min(c) >= 0.0 || a.max(b).max(c) <= 0.0) && a + b + c != 0.0
}
