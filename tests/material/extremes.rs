//! Grazing angles, corners of the unit cube and other odd arguments.

use super::{SPECULARITIES, clear_coat, diffuse, normal, reflective, refractive};
use pathtracer::material::{Material, Pdf};
use pathtracer::math::{DVec3, Frame};

fn materials() -> Vec<Material> {
    let mut materials = vec![diffuse()];
    for s in SPECULARITIES.into_iter().chain([1e-9, 0.5f64.next_up(), 0.5f64.next_down(), 0.995, 1.0]) {
        materials.extend([reflective(s), clear_coat(0.5, s)]);
    }
    materials
}

/// Directions whose height above the surface goes down to the least number that is not zero.
fn grazing(n: DVec3) -> Vec<DVec3> {
    let frame = Frame::around(n);
    [1e-3, 1e-8, 1e-16, 1e-17, 1e-100, 1e-300, f64::from_bits(1)]
        .into_iter()
        .flat_map(|height| [DVec3::new(1.0, 0.0, height), DVec3::new(-0.6, 0.8, height)])
        .map(|local| frame.to_world(local.normalize()))
        .filter(|wo| wo.dot(n) > 0.0)
        .collect()
}

fn odd_cube() -> impl Iterator<Item = [f64; 3]> {
    const VALUES: [f64; 5] = [0.0, 1.1102230246251565e-16, 0.25, 0.5, 0.9999999999999999];
    (0..125).map(|i| [VALUES[i / 25], VALUES[i / 5 % 5], VALUES[i % 5]])
}

#[test]
fn reflected_directions_are_unit_and_above_the_surface() {
    for n in [DVec3::Z, -DVec3::Z, DVec3::X, normal()] {
        for wo in grazing(n) {
            for (material, u) in materials().iter().flat_map(|m| odd_cube().map(move |u| (m, u))) {
                let scatter = material.sample(wo, n, true, u).expect("wo is above the surface");
                let w = scatter.direction;
                // Lifting a direction over the surface changes its length by up to 4 units of 2^-52.
                assert!((w.length() - 1.0).abs() < 8.0 * f64::EPSILON, "{material:?} {wo} {u:?}: {w}");
                assert!(w.dot(n) > 0.0, "{material:?} {wo} {u:?}: {w}");
                assert!(scatter.weight.is_finite(), "{material:?} {wo} {u:?}: {scatter:?}");
                let regular = matches!(scatter.pdf, Pdf::SolidAngle(pdf) if pdf > 0.0 && pdf.is_finite());
                assert!(regular || scatter.pdf == Pdf::Delta, "{material:?} {wo} {u:?}: {scatter:?}");
            }
        }
    }
}

#[test]
fn eval_is_a_number_for_grazing_pairs() {
    let n = DVec3::Z;
    let directions = grazing(n);
    for material in materials() {
        for (&wo, &wi) in directions.iter().flat_map(|wo| directions.iter().map(move |wi| (wo, wi))) {
            let (value, pdf) = material.eval(wo, n, wi);
            assert!(
                value.is_finite() && pdf.is_finite() && pdf >= 0.0,
                "{material:?} {wo} {wi}: {value} {pdf}"
            );
        }
    }
}

#[test]
fn a_lerp_that_vanishes_gives_a_direction() {
    // d = -x and r = x along the surface, half of each: nothing is left.
    let n = DVec3::Z;
    let wo = DVec3::new(-1.0, 0.0, 1e-300);
    let scatter = reflective(0.5).sample(wo, n, true, [0.0, 0.0, 0.5]).expect("wo is above the surface");
    assert!(scatter.direction.is_normalized() && scatter.direction.z > 0.0, "{scatter:?}");
}

#[test]
fn refraction_at_any_ratio_and_angle_gives_unit_directions() {
    let ratios = [1e-320, 1e-300, 1e-9, 0.42, 1.0 - 1e-7, 1.0, 1.0f64.next_up(), 1.0 + 1e-7, 1.5, 1e9, 1e300];
    for n in [DVec3::Z, normal()] {
        let mut directions = grazing(n);
        directions.extend([n, (n + 1e-9 * n.any_orthonormal_vector()).normalize()]);
        for wo in directions {
            for (ratio, entering) in ratios.iter().flat_map(|&ratio| [(ratio, true), (ratio, false)]) {
                for u in odd_cube() {
                    let scatter =
                        refractive(ratio).sample(wo, n, entering, u).expect("wo is above the surface");
                    let w = scatter.direction;
                    assert!((w.length() - 1.0).abs() < 8.0 * f64::EPSILON, "{ratio} {entering} {wo}: {w}");
                    assert!(w.dot(n) != 0.0, "{ratio} {entering} {wo}: {w}");
                }
            }
        }
    }
}
