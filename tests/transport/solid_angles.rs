//! Lights from 1e-9 to 6 sr over a floor, on both sides of the solid angles at which their sampling changes.

use super::direct::{TWO_SEGMENTS, lit_floor, polygon};
use crate::support::build::*;
use pathtracer::geometry::Rectangle;
use pathtracer::math::{DVec3, EPSILON};
use pathtracer::world::light::SphericalRectangle;
use std::f64::consts::PI;

const STERADIANS: [f64; 9] = [1e-9, 1e-7, 1e-5, 0.9e-3, 1.1e-3, 0.1, 1.0, 4.0, 6.0];

/// Half the side of a square at distance 1, seen from its axis under a solid angle: the inverse of
/// 4 asin(a^2 / (1 + a^2)).
fn half_side(steradians: f64) -> f64 {
    let sin = libm::sin(steradians / 4.0);
    (sin / (1.0 - sin)).sqrt()
}

#[test]
fn balls_from_a_speck_to_half_the_sky_light_a_floor() {
    for steradians in STERADIANS {
        // 2 pi (1 - cos) of the half angle.
        let rest = steradians / (2.0 * PI);
        let ratio = (rest * (2.0 - rest)).sqrt();
        for cosine in [1.0f64, 0.6] {
            // Wholly above the horizon.
            if ratio > cosine {
                continue;
            }
            let direction = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
            let desc = lit_floor(ball(direction, ratio), 3.0 / (ratio * ratio));
            let what = format!("a ball of {steradians} sr, cosine {cosine}");
            assert_mean(&what, &desc, &TWO_SEGMENTS, 3.0 * cosine, 1e-2);
        }
    }
}

#[test]
fn rectangles_from_a_speck_to_half_the_sky_light_a_floor() {
    for steradians in STERADIANS {
        let half = half_side(steradians);
        for aside in [0.0, 0.7] {
            let center = DVec3::new(aside, 0.5 * aside, 1.0);
            let expected = if half >= 1e-3 {
                let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
                polygon(&corners.map(|(x, y)| center + DVec3::new(x * half, y * half, 0.0))) / (half * half)
            } else {
                // So small that the integrand is constant to (half / distance)^2 < 1e-6.
                4.0 / (center.length_squared() * center.length_squared() * PI)
            };
            let desc = lit_floor(square(center, 2.0 * half), 1.0 / (half * half));
            let what = format!("a square of {steradians} sr, {aside} aside");
            assert_mean(&what, &desc, &TWO_SEGMENTS, expected, 1e-2);
        }
    }
}

#[test]
fn the_solid_angle_of_a_rectangle_does_not_cancel() {
    for steradians in STERADIANS {
        let half = half_side(steradians);
        let rectangle = Rectangle::new(DVec3::Z, DVec3::X * (2.0 * half), DVec3::Y * (2.0 * half));
        let found = SphericalRectangle::new(&rectangle, DVec3::ZERO).solid_angle();
        // 4 asin(a^2 / (1 + a^2)) as an arc tangent, which is good at both ends.
        let expected = 4.0 * libm::atan2(half * half, (1.0 + 2.0 * half * half).sqrt());
        // Numerator and denominator are sums of products without cancellation, of some ten roundings each; a few more
        // are in the lengths, the arc tangents and the expected value.
        let error = (found - expected).abs() / expected;
        assert!(error < 32.0 * EPSILON, "{steradians} sr: {found:e}, expected {expected:e}");
    }
}
