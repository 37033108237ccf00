//! The elementary functions of inner loops, against those of `libm`.

use crate::support::random::Random;
use pathtracer::math::elementary::{half_plane_angle, inverse_fifth_root, sin_cos, sin_cos_turns};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// A few roundings.
const FEW: f64 = 4.0 * f64::EPSILON;

fn assert_near(found: f64, expected: f64, error: f64, what: impl std::fmt::Display) {
    assert!((found - expected).abs() <= error, "{what}: {found}, not {expected}");
}

#[test]
fn sine_and_cosine_of_small_angles_are_good_to_a_few_roundings() {
    let mut random = Random::new(1);
    let angles = (0..100_000).map(|_| random.between(-FRAC_PI_4, FRAC_PI_4));
    for angle in angles.chain([0.0, -0.0, 1e-300, FRAC_PI_4, -FRAC_PI_4]) {
        let (sin, cos) = sin_cos(angle);
        assert_near(sin, libm::sin(angle), FEW * angle.abs(), angle);
        assert_near(cos, libm::cos(angle), FEW, angle);
    }
}

#[test]
fn sine_and_cosine_of_a_turn_are_good_to_a_few_roundings() {
    let mut random = Random::new(2);
    let turns = (0..100_000).map(|_| random.unit());
    for turns in turns.chain((0..=8).map(|i| f64::from(i) / 8.0)) {
        let (sin, cos) = sin_cos_turns(turns);
        // The angle that the other functions get is rounded twice, to within 2^-52 of 2 pi.
        let error = FEW + TAU * f64::EPSILON;
        assert_near(sin, libm::sin(TAU * turns), error, turns);
        assert_near(cos, libm::cos(TAU * turns), error, turns);
    }
}

#[test]
fn angles_of_the_upper_half_plane_are_good_to_a_few_roundings() {
    let mut random = Random::new(3);
    for _ in 0..100_000 {
        let (x, y) = (random.between(-1.0, 1.0), random.unit() * libm::exp2(-60.0 * random.unit()));
        let expected = libm::atan2(y, x);
        assert_near(half_plane_angle(x, y), expected, FEW * expected, format_args!("({x}, {y})"));
    }
}

#[test]
fn angles_of_the_axes_and_diagonals_are_right() {
    let cases = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, FRAC_PI_4), (0.0, 1.0, FRAC_PI_2)];
    for (x, y, angle) in cases.into_iter().chain([(-1.0, 1.0, 3.0 * FRAC_PI_4), (-1.0, 0.0, PI)]) {
        assert_near(half_plane_angle(x, y), angle, FEW * angle, format_args!("({x}, {y})"));
    }
}

#[test]
fn inverse_fifth_roots_are_good_to_a_few_roundings_of_all_normal_numbers() {
    let mut random = Random::new(4);
    let numbers = (0..100_000).map(|_| libm::exp2(random.between(-1022.0, 1023.9)));
    for x in numbers.chain([f64::MIN_POSITIVE, 1.0, 32.0, f64::MAX]) {
        let root = inverse_fifth_root(x);
        // The exponent of `pow` is rounded: by 2^-55, times up to 710, the logarithm of the largest number.
        let expected = libm::pow(x, -0.2);
        assert_near(root, expected, (FEW + 710.0 * 2f64.powi(-55)) * expected, x);
    }
}
