//! Maps from the unit square to shapes, each with its density. All but the triangle's go through the concentric
//! disk, so that neighbours in the square stay neighbours and strata stay compact; none is singular.

use crate::math::elementary::sin_cos;
use crate::math::{DVec3, INV_PI};
use std::f64::consts::FRAC_PI_4;

/// A point of the unit disk, with what rounding would lose if it were computed from x and y.
struct Disk {
    x: f64,
    y: f64,
    /// Distance from the centre, exact, in [0, 1].
    radius: f64,
}

/// The concentric map of Shirley and Chiu ("A Low Distortion Map Between Disk and Square", JGT 2(3) 1997).
#[inline(always)]
fn concentric(u: [f64; 2]) -> Disk {
    let (a, b) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    if a == 0.0 && b == 0.0 {
        return Disk { x: 0.0, y: 0.0, radius: 0.0 };
    }
    let steep = b.abs() > a.abs();
    let (major, minor) = if steep { (b, a) } else { (a, b) };
    let (sin, cos) = sin_cos(FRAC_PI_4 * (minor / major));
    let (along, across) = (major * cos, major * sin);
    let (x, y) = if steep { (across, along) } else { (along, across) };
    Disk { x, y, radius: major.abs() }
}

/// A point (x, y) uniform in the unit disk (density 1 / pi per area), from `u` in [0, 1)^2.
pub fn square_to_disk(u: [f64; 2]) -> [f64; 2] {
    let Disk { x, y, .. } = concentric(u);
    [x, y]
}

/// A unit vector with z >= 0, distributed as the cosine with +z, from `u` in [0, 1)^2.
#[inline]
pub fn square_to_cosine_hemisphere(u: [f64; 2]) -> DVec3 {
    let Disk { x, y, radius } = concentric(u);
    DVec3::new(x, y, ((1.0 - radius) * (1.0 + radius)).sqrt())
}

/// Density of [`square_to_cosine_hemisphere`] per solid angle at the cosine `cos` with +z.
#[inline]
pub fn cosine_hemisphere_pdf(cos: f64) -> f64 {
    cos.max(0.0) * INV_PI
}

/// A unit vector uniform in the cone about +z whose half angle has 1 - cosine = `one_minus_cos_max` in (0, 2],
/// from `u` in [0, 1)^2. Taking one minus the cosine keeps cones of any width accurate.
pub fn square_to_cone(u: [f64; 2], one_minus_cos_max: f64) -> DVec3 {
    let Disk { x, y, radius } = concentric(u);
    let one_minus_cos = radius * radius * one_minus_cos_max;
    // The sine is sqrt(one_minus_cos (2 - one_minus_cos)); the disk brings its factor `radius` along.
    let scale = (one_minus_cos_max * (2.0 - one_minus_cos)).sqrt();
    DVec3::new(x * scale, y * scale, 1.0 - one_minus_cos)
}

/// Density of [`square_to_cone`] per solid angle.
pub fn cone_pdf(one_minus_cos_max: f64) -> f64 {
    0.5 * INV_PI / one_minus_cos_max
}

/// The barycentric coordinates of the second and third vertex for a point uniform in a triangle (density 1 / its area per
/// area), from `u` in [0, 1)^2 (Heitz, "A Low-Distortion Map Between Triangle and Square", 2019).
pub fn square_to_triangle(u: [f64; 2]) -> [f64; 2] {
    let [a, b] = u;
    if b > a { [0.5 * a, b - 0.5 * a] } else { [a - 0.5 * b, 0.5 * b] }
}
