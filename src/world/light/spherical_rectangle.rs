//! Directions towards a rectangle, uniform in solid angle.

use crate::geometry::Rectangle;
use crate::math::DVec3;

/// A rectangle seen from a point (Ureña, Fajardo, King, "An Area-Preserving Parametrization for Spherical Rectangles",
/// EGSR 2013). The solid angle itself is computed by the form of Van Oosterom and Strackee, which does not cancel.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    /// Ends of the rectangle along its two edges, and its distance, relative to the point (<= 0).
    x: [f64; 2],
    y: [f64; 2],
    z: f64,
    /// In steradians.
    solid_angle: f64,
}

/// Below this solid angle (sr) a rectangle is nearly flat to the eye and is sampled by area; the angles that the
/// parametrisation sums would cancel.
const SMALL: f64 = 1e-3;

impl SphericalRectangle {
    /// The view from `p`.
    pub fn new(rectangle: &Rectangle, p: DVec3) -> SphericalRectangle {
        let (width, height) = (rectangle.edge_u.length(), rectangle.edge_v.length());
        let d = rectangle.center - p;
        let x = d.dot(rectangle.edge_u / width);
        let y = d.dot(rectangle.edge_v / height);
        let (x, y) = ([x - width * 0.5, x + width * 0.5], [y - height * 0.5, y + height * 0.5]);
        let z = -d.dot(rectangle.normal).abs();
        SphericalRectangle { x, y, z, solid_angle: solid_angle(x, y, z) }
    }

    /// In steradians; 0 in the rectangle's own plane.
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// Coordinates in [0, 1] on the rectangle, from `u` in [0, 1)^2.
    pub fn sample(&self, u: [f64; 2]) -> (f64, f64) {
        if self.solid_angle < SMALL {
            return (u[0], u[1]);
        }
        let ([x0, x1], [y0, y1], z) = (self.x, self.y, self.z);
        // Cosines of the normals of the four side planes of the pyramid with the rectangle's normal.
        let cosine = |c: f64| c / length(z, c);
        let (n0, n2, n3) = (-cosine(y0), cosine(y1), -cosine(x0));
        let g2 = libm::acos(-n2 * n3);
        let g3 = libm::acos(-n3 * n0);
        let angle = u[0] * self.solid_angle + std::f64::consts::TAU - g2 - g3;
        let sin = libm::sin(angle);
        let f = (libm::cos(angle) * n0 - n2) / sin;
        let cu = (f.signum() / (f * f + n0 * n0).sqrt()).clamp(-1.0, 1.0);
        let xu = (-(cu * z) / ((1.0 - cu) * (1.0 + cu)).max(f64::MIN_POSITIVE).sqrt()).clamp(x0, x1);
        let distance = length(xu, z);
        let (h0, h1) = (y0 / length(distance, y0), y1 / length(distance, y1));
        let h = h0 + u[1] * (h1 - h0);
        let yv = (h * distance / ((1.0 - h) * (1.0 + h)).max(f64::MIN_POSITIVE).sqrt()).clamp(y0, y1);
        ((xu - x0) / (x1 - x0), (yv - y0) / (y1 - y0))
    }

    /// Density per solid angle of [`SphericalRectangle::sample`] at the point with offset `to` (from the viewer).
    pub fn pdf(&self, to: DVec3) -> f64 {
        if self.solid_angle >= SMALL {
            return 1.0 / self.solid_angle;
        }
        let area = (self.x[1] - self.x[0]) * (self.y[1] - self.y[0]);
        let distance2 = to.length_squared();
        distance2 * distance2.sqrt() / (area * -self.z)
    }
}

/// Solid angle of a rectangle parallel to the xy plane seen from the origin: two triangles by Van Oosterom and
/// Strackee (IEEE Trans. Biomed. Eng. 30(2) 1983), the triple products from edges.
fn solid_angle(x: [f64; 2], y: [f64; 2], z: f64) -> f64 {
    let corner = |i: usize, j: usize| DVec3::new(x[i], y[j], z);
    let (a, b, c, d) = (corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
    triangle_solid_angle(a, b, c) + triangle_solid_angle(a, c, d)
}

fn triangle_solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let triple = a.dot((b - a).cross(c - a)).abs();
    let below = la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la;
    2.0 * libm::atan2(triple, below)
}

fn length(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}
