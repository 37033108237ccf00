//! The sphere, in f64.

use super::doubles::{Doubles, One};
use crate::math::{Bounds, DVec3};

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Centre.
    pub center: DVec3,
    /// Radius > 0.
    pub radius: f64,
}

impl Ball {
    /// The two distances, nearer first, at which the line meets the sphere; one or both may be negative.
    pub fn roots(&self, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let (center, origin) = (self.center.to_array(), origin.to_array());
        let (meets, near, far) = roots(One, center, self.radius, origin, direction.to_array());
        meets.then_some((near, far))
    }

    /// The distance > 0 at which a ray leaves the sphere that starts on its surface, or within rounding of it, and goes
    /// inward: there always is one, however little the ray enters.
    pub fn exit(&self, origin: DVec3, direction: DVec3) -> f64 {
        self.roots(origin, direction).map_or(0.0, |(_, far)| far).max(f64::MIN_POSITIVE)
    }

    /// The unit normal, away from the centre, where a ray from `origin` arrives after `t`.
    pub fn normal_at(&self, origin: DVec3, direction: DVec3, t: f64) -> DVec3 {
        ((origin - self.center) + direction * t).normalize()
    }

    /// The box around it.
    pub fn bounds(&self) -> Bounds {
        Bounds { min: self.center - self.radius, max: self.center + self.radius }
    }
}

/// Whether the line meets the sphere, and the two distances, nearer first.
///
/// Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems ch. 7: the
/// discriminant from the perpendicular, the roots without cancellation.
#[inline(always)]
pub(super) fn roots<L: Doubles>(
    lanes: L,
    center: [L::Double; 3],
    radius: L::Double,
    origin: [L::Double; 3],
    direction: [L::Double; 3],
) -> (L::Mask, L::Double, L::Double) {
    let zero = lanes.same(0.0);
    let f = lanes.difference(origin, center);
    let b = lanes.minus(zero, lanes.dot(f, direction));
    let nearest = lanes.along(f, direction, b);
    let perpendicular = lanes.root(lanes.dot(nearest, nearest));
    let meets = lanes.is_at_most(perpendicular, radius);
    let inside = lanes.times(lanes.minus(radius, perpendicular), lanes.plus(radius, perpendicular));
    let root = lanes.root(inside);
    let distance = lanes.root(lanes.dot(f, f));
    let c = lanes.times(lanes.minus(distance, radius), lanes.plus(distance, radius));
    let ahead = lanes.is_less(zero, b);
    let q = lanes.choose(ahead, lanes.plus(b, root), lanes.minus(b, root));
    let other = lanes.choose(lanes.differs(q, zero), lanes.over(c, q), zero);
    (meets, lanes.choose(ahead, other, q), lanes.choose(ahead, q, other))
}
