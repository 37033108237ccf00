//! Directions towards a rectangle, uniform in solid angle where that differs from uniform in area.

use crate::geometry::Rectangle;
use crate::math::DVec3;
use crate::math::elementary::{half_plane_angle, sin_cos_turns};
use std::f64::consts::TAU;

/// A rectangle in axes of its own, made once for all points that see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pane {
    center: DVec3,
    /// Unit vectors along the edges, and the normal.
    axes: [DVec3; 3],
    /// Half of the edges' lengths.
    half: [f64; 2],
}

impl Pane {
    /// The pane of a rectangle.
    pub(crate) fn new(rectangle: &Rectangle) -> Pane {
        let (width, height) = (rectangle.edge_u.length(), rectangle.edge_v.length());
        Pane {
            center: rectangle.center,
            axes: [rectangle.edge_u / width, rectangle.edge_v / height, rectangle.normal],
            half: [width * 0.5, height * 0.5],
        }
    }
}

/// A rectangle seen from a point (Ureña, Fajardo, King, "An Area-Preserving Parametrization for Spherical Rectangles",
/// EGSR 2013). The solid angle itself is computed by the form of Van Oosterom and Strackee, which does not cancel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SphericalRectangle {
    /// Ends of the rectangle along its two edges, and its distance, relative to the point (<= 0).
    x: [f64; 2],
    y: [f64; 2],
    z: f64,
    /// In steradians, where directions are uniform in it; none where points are uniform in area.
    uniform_in: Option<f64>,
}

/// Below this solid angle (sr) a rectangle is sampled by area; the angles that the parametrisation sums would cancel.
const SMALL: f64 = 1e-3;

/// Where the squares of the distances of a rectangle's points have at most this ratio, it is sampled by area, which
/// takes a tenth of the time. The density per solid angle, distance^3 / (area z), then varies by the ratio^1.5 at most,
/// and so smoothly that stratified samples hide it.
const FLAT: f64 = 2.0;

impl SphericalRectangle {
    /// The view from `p`.
    #[inline]
    pub(crate) fn new(pane: &Pane, p: DVec3) -> SphericalRectangle {
        let d = pane.center - p;
        let (x, y, z) = (d.dot(pane.axes[0]), d.dot(pane.axes[1]), d.dot(pane.axes[2]));
        let [width, height] = pane.half;
        let (x, y, z) = ([x - width, x + width], [y - height, y + height], -z.abs());
        let uniform_in =
            if is_flat(x, y, z) { None } else { Some(solid_angle(x, y, z)).filter(|&sr| sr >= SMALL) };
        SphericalRectangle { x, y, z, uniform_in }
    }

    /// In steradians; 0 in the rectangle's own plane.
    pub(crate) fn solid_angle(&self) -> f64 {
        self.uniform_in.unwrap_or_else(|| solid_angle(self.x, self.y, self.z))
    }

    /// Coordinates in [0, 1] on the rectangle, from `u` in [0, 1)^2.
    #[inline]
    pub(crate) fn sample(&self, u: [f64; 2]) -> (f64, f64) {
        let Some(solid_angle) = self.uniform_in else {
            return (u[0], u[1]);
        };
        let ([x0, x1], [y0, y1], z) = (self.x, self.y, self.z);
        // Cosines of the normals of three side planes of the pyramid with the rectangle's normal, and a sine.
        let inverse = 1.0 / length(z, y0);
        let (n0, m0) = (-y0 * inverse, -z * inverse);
        let (n2, n3) = (y1 / length(z, y1), -x0 / length(z, x0));
        // The paper's g2 and g3, and u0 solid angle + 2 pi - (g2 + g3), by their sines and cosines.
        let (c2, c3) = (-n2 * n3, -n3 * n0);
        let (s2, s3) = (((1.0 - c2) * (1.0 + c2)).sqrt(), ((1.0 - c3) * (1.0 + c3)).sqrt());
        let (sin_g, cos_g) = (s2 * c3 + c2 * s3, c2 * c3 - s2 * s3);
        let (sin_u, cos_u) = sin_cos_turns(u[0] * solid_angle / TAU);
        let (sin, cos) = (sin_u * cos_g - cos_u * sin_g, cos_u * cos_g + sin_u * sin_g);
        // The paper's f is numerator / sin, its cu is sign f / sqrt (f^2 + n0^2), and x = -z cu / sqrt (1 - cu^2).
        let numerator = cos * n0 - n2;
        let (a, b) = (numerator.abs(), m0 * sin.abs());
        let xu = -z * sin.copysign(sin * numerator) / ((a - b) * (a + b)).max(f64::MIN_POSITIVE).sqrt();
        let xu = xu.clamp(x0, x1);
        let distance2 = xu * xu + z * z;
        let (h0, h1) = (y0 / (distance2 + y0 * y0).sqrt(), y1 / (distance2 + y1 * y1).sqrt());
        let h = h0 + u[1] * (h1 - h0);
        let yv = h * (distance2 / ((1.0 - h) * (1.0 + h)).max(f64::MIN_POSITIVE)).sqrt();
        ((xu - x0) / (x1 - x0), (yv.clamp(y0, y1) - y0) / (y1 - y0))
    }

    /// Density per solid angle of [`SphericalRectangle::sample`] at the point with offset `to` (from the viewer).
    #[inline]
    pub(crate) fn pdf(&self, to: DVec3) -> f64 {
        if let Some(solid_angle) = self.uniform_in {
            return 1.0 / solid_angle;
        }
        let area = (self.x[1] - self.x[0]) * (self.y[1] - self.y[0]);
        let distance2 = to.length_squared();
        distance2 * distance2.sqrt() / (area * -self.z)
    }
}

/// Whether all points of a rectangle are nearly as far from the origin.
#[inline]
fn is_flat([x0, x1]: [f64; 2], [y0, y1]: [f64; 2], z: f64) -> bool {
    let (x, y) = (0f64.clamp(x0, x1), 0f64.clamp(y0, y1));
    let nearest = x * x + y * y + z * z;
    let farthest = (x0 * x0).max(x1 * x1) + (y0 * y0).max(y1 * y1) + z * z;
    farthest <= FLAT * nearest
}

/// Solid angle of a rectangle parallel to the xy plane seen from the origin: two triangles by Van Oosterom and
/// Strackee (IEEE Trans. Biomed. Eng. 30(2) 1983), the triple product from edges.
///
/// Half of each triangle's solid angle is the angle of a vector (below, triple); the angle of the complex product of
/// the two vectors is their sum, which is at most pi.
#[inline]
fn solid_angle([x0, x1]: [f64; 2], [y0, y1]: [f64; 2], z: f64) -> f64 {
    let z2 = z * z;
    let [x00, x01, x11, y00, y01, y11] = [x0 * x0, x0 * x1, x1 * x1, y0 * y0, y0 * y1, y1 * y1];
    // The corners a (x0, y0), b (x1, y0), c (x1, y1), d (x0, y1): their distances and scalar products.
    let distance = |xy: f64| (xy + z2).sqrt();
    let (a, b, c, d) = (distance(x00 + y00), distance(x11 + y00), distance(x11 + y11), distance(x00 + y11));
    let (ab, bc, cd, da) = (x01 + y00 + z2, x11 + y01 + z2, x01 + y11 + z2, x00 + y01 + z2);
    let ac = x01 + y01 + z2;
    let triple = -z * (x1 - x0) * (y1 - y0);
    let below_abc = a * b * c + ab * c + ac * b + bc * a;
    let below_acd = a * c * d + ac * d + da * c + cd * a;
    // Brought near 1 first: products of six lengths leave the range of numbers early.
    let size = below_abc.abs().max(below_acd.abs()).max(triple).max(f64::MIN_POSITIVE);
    let (p, q, t) = (below_abc / size, below_acd / size, triple / size);
    2.0 * half_plane_angle(p * q - t * t, (t * (p + q)).max(0.0))
}

fn length(a: f64, b: f64) -> f64 {
    (a * a + b * b).sqrt()
}
