//! The sphere, in f64.

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
    ///
    /// Haines, Günther, Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems ch. 7:
    /// the discriminant from the perpendicular, the roots without cancellation.
    pub fn roots(&self, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let f = origin - self.center;
        let b = -f.dot(direction);
        let perpendicular = (f + direction * b).length();
        if perpendicular > self.radius {
            return None;
        }
        let root = ((self.radius - perpendicular) * (self.radius + perpendicular)).sqrt();
        let distance = f.length();
        let c = (distance - self.radius) * (distance + self.radius);
        let q = if b > 0.0 { b + root } else { b - root };
        let other = if q == 0.0 { 0.0 } else { c / q };
        Some(if b > 0.0 { (other, q) } else { (q, other) })
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
