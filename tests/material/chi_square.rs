//! Samples of every lobe against its density.

use super::lobe_grid::{Verdict, compare};
use super::{ANGLES, SPECULARITIES, clear_coat, cube, diffuse, direction_at, normal, reflective};
use crate::support::stats::{SIGNIFICANCE, sidak};
use pathtracer::material::Material;
use pathtracer::math::DVec3;

/// About 20 a cell.
const SAMPLES: u64 = 250_000;

/// Of the tests that take longer.
const MANY_SAMPLES: u64 = 1_000_000;

/// The integral of a density may be off by this much: the quadrature's error where the horizon cuts cells.
const INTEGRAL_TOLERANCE: f64 = 1e-4;

fn accepts(verdict: &Verdict, tests: usize) -> bool {
    verdict.p_value > sidak(SIGNIFICANCE, tests)
        && (verdict.integral - 1.0).abs() < INTEGRAL_TOLERANCE
        && verdict.outside == 0
}

/// The samples of `material` at an angle against `pdf`, in cells made for `specularity`.
fn verdict(
    material: &Material,
    degrees: f64,
    specularity: f64,
    count: u64,
    pdf: impl Fn(DVec3, DVec3, DVec3) -> f64,
) -> Verdict {
    let n = normal();
    let wo = direction_at(n, degrees);
    let mirror = 2.0 * n.dot(wo) * n - wo;
    let seed = (degrees * 100.0 + specularity * 1e6) as u64;
    let samples = cube(seed, count).filter_map(|u| material.sample(wo, n, true, u)).map(|s| s.direction);
    compare(samples, |w| pdf(wo, n, w), mirror, specularity)
}

fn check(material: &Material, specularity: f64, count: u64, tests: usize) {
    for degrees in ANGLES {
        let verdict = verdict(material, degrees, specularity, count, |wo, n, w| material.eval(wo, n, w).1);
        assert!(accepts(&verdict, tests), "{material:?} at {degrees} degrees: {verdict:?}");
    }
}

fn check_lerp_lobes(specularities: impl Iterator<Item = f64>, count: u64) {
    for s in specularities {
        check(&reflective(s), s, count, SPECULARITIES.len() * ANGLES.len());
    }
}

fn check_clear_coats(count: u64) {
    let cases = [(0.0, 0.6), (0.3, 0.25), (0.3, 0.6), (0.3, 0.9), (1.0, 0.25), (1.0, 0.9)];
    for (probability, s) in cases {
        check(&clear_coat(probability, s), s, count, cases.len() * ANGLES.len());
    }
}

#[test]
fn the_lambertian_lobe_has_its_density() {
    check(&diffuse(), 0.0, SAMPLES, ANGLES.len());
}

#[test]
fn broad_lobes_have_their_density() {
    check_lerp_lobes(SPECULARITIES.into_iter().filter(|&s| s < 0.5), SAMPLES);
}

#[test]
fn lobes_with_a_rim_have_their_density() {
    check_lerp_lobes(SPECULARITIES.into_iter().filter(|&s| s >= 0.5), SAMPLES);
}

#[test]
fn clear_coats_have_their_density() {
    check_clear_coats(SAMPLES);
}

#[test]
#[ignore = "20 seconds: the same with more samples"]
fn lobes_have_their_density_in_more_samples() {
    check(&diffuse(), 0.0, MANY_SAMPLES, ANGLES.len());
    check_lerp_lobes(SPECULARITIES.into_iter(), MANY_SAMPLES);
    check_clear_coats(MANY_SAMPLES);
}

/// The density with mistakes that have been made elsewhere, which the same comparison must refuse.
#[test]
fn a_wrong_density_is_refused() {
    let material = reflective(0.6);
    let scaled = verdict(&material, 45.0, 0.6, SAMPLES, |wo, n, w| 1.01 * material.eval(wo, n, w).1);
    assert!(!accepts(&scaled, 1), "a factor of 1.01: {scaled:?}");

    let other = reflective(0.601);
    let shifted = verdict(&material, 45.0, 0.6, SAMPLES, |wo, n, w| other.eval(wo, n, w).1);
    assert!(!accepts(&shifted, 1), "another specularity: {shifted:?}");

    let narrow = reflective(0.9);
    let one_branch = verdict(&narrow, 80.0, 0.9, SAMPLES, |wo, n, w| larger_root_alone(0.9, wo, n, w));
    assert!(!accepts(&one_branch, 1), "the smaller root forgotten: {one_branch:?}");

    let broad = reflective(0.3);
    let lambertian = verdict(&broad, 45.0, 0.3, SAMPLES, |wo, n, w| diffuse().eval(wo, n, w).1);
    assert!(!accepts(&lambertian, 1), "another lobe: {lambertian:?}");
}

/// The density of the lerp lobe for specularities above 1/2 without its second branch.
fn larger_root_alone(s: f64, wo: DVec3, n: DVec3, w: DVec3) -> f64 {
    let r = 2.0 * n.dot(wo) * n - wo;
    let a = 1.0 - s;
    let q = (a * a - s * s * w.cross(r).length_squared()).sqrt();
    let rho = s * w.dot(r) + q;
    if q > 0.0 && rho > 0.0 {
        rho * rho * (rho * n.dot(w) - s * n.dot(r)).max(0.0) / (std::f64::consts::PI * a * a * q)
    } else {
        0.0
    }
}

/// Without the second branch, but divided by what is left, so that only the shape is wrong.
#[test]
fn a_wrong_shape_with_the_right_integral_is_refused() {
    let material = reflective(0.9);
    let density = |wo: DVec3, n: DVec3, w: DVec3| larger_root_alone(0.9, wo, n, w);
    let lacking = verdict(&material, 80.0, 0.9, SAMPLES, density).integral;
    let normalised = verdict(&material, 80.0, 0.9, SAMPLES, |wo, n, w| density(wo, n, w) / lacking);
    assert!((normalised.integral - 1.0).abs() < INTEGRAL_TOLERANCE, "{normalised:?}");
    assert!(normalised.p_value < 1e-6, "{normalised:?}");
}
