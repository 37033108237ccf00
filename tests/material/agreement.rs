//! `sample` and `eval` agree, and weights are the colours.

use super::{
    ANGLES, COAT_COLOR, COLOR, SPECULARITIES, clear_coat, cube, diffuse, direction_at, normal, reflective,
    refractive,
};
use crate::support::stats::{Moments, SIGNIFICANCE, sidak};
use pathtracer::material::{ClearCoat, Diffuse, Material, Pdf, Reflective, Scatter};
use pathtracer::math::{DVec3, Rgb};

const SAMPLES: u64 = 20_000;

fn samples(material: Material, wo: DVec3, n: DVec3, count: u64) -> impl Iterator<Item = Scatter> {
    cube(1, count).map(move |u| material.sample(wo, n, true, u).expect("wo is above the surface"))
}

/// Every material at every angle.
fn each_case(mut check: impl FnMut(Material, DVec3, DVec3)) {
    let mut materials = vec![diffuse(), refractive(0.67)];
    for s in SPECULARITIES.into_iter().chain([0.995, 1.0]) {
        materials.push(reflective(s));
        materials.extend([0.0, 0.3, 1.0].map(|probability| clear_coat(probability, s)));
    }
    let n = normal();
    for material in materials {
        ANGLES.into_iter().for_each(|degrees| check(material, direction_at(n, degrees), n));
    }
}

#[test]
fn the_density_of_a_sample_is_that_of_eval() {
    each_case(|material, wo, n| {
        for scatter in samples(material, wo, n, SAMPLES) {
            if let Pdf::SolidAngle(pdf) = scatter.pdf {
                assert_eq!(pdf, material.eval(wo, n, scatter.direction).1, "{material:?} {scatter:?}");
            }
        }
    });
}

#[test]
fn weight_times_density_is_what_eval_says() {
    each_case(|material, wo, n| {
        for scatter in samples(material, wo, n, SAMPLES) {
            if let Pdf::SolidAngle(pdf) = scatter.pdf {
                assert_eq!(scatter.weight * pdf, material.eval(wo, n, scatter.direction).0, "{material:?}");
            }
        }
    });
}

#[test]
fn densities_of_samples_are_positive_and_finite() {
    each_case(|material, wo, n| {
        for scatter in samples(material, wo, n, SAMPLES) {
            if let Pdf::SolidAngle(pdf) = scatter.pdf {
                assert!(pdf > 0.0 && pdf.is_finite(), "{material:?} {scatter:?}");
            }
        }
    });
}

#[test]
fn the_weight_of_a_single_lobe_is_exactly_its_color() {
    each_case(|material, wo, n| {
        let expected = match material {
            Material::ClearCoat(coat) if coat.probability == 0.0 => COLOR,
            Material::ClearCoat(coat) if coat.probability == 1.0 => COAT_COLOR,
            Material::ClearCoat(_) => return,
            _ => COLOR,
        };
        assert!(samples(material, wo, n, SAMPLES).all(|scatter| scatter.weight == expected), "{material:?}");
    });
}

#[test]
fn white_weighs_exactly_one() {
    let n = normal();
    for s in SPECULARITIES.into_iter().chain([1.0]) {
        let coat = Reflective { color: Rgb::ONE, specularity: s };
        let base = Diffuse { color: Rgb::ONE };
        let material = Material::ClearCoat(ClearCoat { base, coat, probability: 0.37 });
        let wo = direction_at(n, 60.0);
        assert!(samples(material, wo, n, SAMPLES).all(|scatter| scatter.weight == Rgb::ONE), "{s}");
    }
}

#[test]
fn a_clear_coat_reflects_the_mean_of_its_colors() {
    let n = normal();
    let cases: Vec<(f64, f64)> =
        SPECULARITIES.into_iter().flat_map(|s| ANGLES.map(|angle| (s, angle))).collect();
    for &(s, degrees) in &cases {
        let material = clear_coat(0.3, s);
        let weights: Vec<Rgb> =
            samples(material, direction_at(n, degrees), n, SAMPLES).map(|scatter| scatter.weight).collect();
        let expected = 0.3 * COAT_COLOR + 0.7 * COLOR;
        for channel in 0..3 {
            let moments = Moments::of(weights.iter().map(|weight| weight[channel]));
            let p = moments.p_value(expected[channel]);
            let mean = moments.mean();
            assert!(
                p > sidak(SIGNIFICANCE, 3 * cases.len()),
                "{material:?} at {degrees} degrees: {mean}, p = {p}"
            );
        }
    }
}

#[test]
fn a_coat_of_probability_zero_is_the_base_bit_by_bit() {
    let n = normal();
    for s in SPECULARITIES.into_iter().chain([0.995, 1.0]) {
        for degrees in ANGLES {
            let wo = direction_at(n, degrees);
            let (coated, bare) = (samples(clear_coat(0.0, s), wo, n, 1000), samples(diffuse(), wo, n, 1000));
            for (coated, bare) in coated.zip(bare) {
                assert_eq!(coated, bare);
                let eval = |material: Material| material.eval(wo, n, bare.direction);
                assert_eq!(eval(clear_coat(0.0, s)), eval(diffuse()));
            }
        }
    }
}

#[test]
fn a_delta_coat_does_not_compete_with_its_base() {
    let (n, material) = (normal(), clear_coat(0.3, 1.0));
    let wo = direction_at(n, 30.0);
    let mirror = 2.0 * n.dot(wo) * n - wo;
    let mut coats = 0;
    for scatter in samples(material, wo, n, SAMPLES) {
        match scatter.pdf {
            Pdf::Delta => {
                assert_eq!((scatter.weight, scatter.direction), (COAT_COLOR, mirror));
                coats += 1;
            }
            Pdf::SolidAngle(pdf) => {
                let lambertian = diffuse().eval(wo, n, scatter.direction).1;
                assert_eq!((scatter.weight, pdf), (COLOR, (1.0 - 0.3) * lambertian));
            }
        }
    }
    // A binomial share of 0.3: four standard deviations.
    let share = f64::from(coats) / SAMPLES as f64;
    assert!((share - 0.3).abs() < 4.0 * (0.3 * 0.7 / SAMPLES as f64).sqrt(), "{share}");
}

#[test]
fn specularity_one_is_a_mirror() {
    let n = normal();
    for degrees in ANGLES {
        let wo = direction_at(n, degrees);
        for scatter in samples(reflective(1.0), wo, n, 100) {
            assert_eq!(scatter.pdf, Pdf::Delta);
            // The half vector is the normal; unit vectors and a sum of two leave a few roundings.
            let half = wo + scatter.direction;
            assert!((half - half.dot(n) * n).length() < 8.0 * f64::EPSILON, "{degrees} degrees");
        }
    }
}

#[test]
fn a_lobe_too_narrow_for_light_samples_keeps_its_shape() {
    let (n, s) = (normal(), 0.995);
    let wo = direction_at(n, 45.0);
    let mirror = 2.0 * n.dot(wo) * n - wo;
    let rim = (1.0 - s) / s;
    let mut widest: f64 = 0.0;
    for scatter in samples(reflective(s), wo, n, SAMPLES) {
        assert_eq!(scatter.pdf, Pdf::Delta);
        assert_eq!(reflective(s).eval(wo, n, scatter.direction), (Rgb::ZERO, 0.0));
        widest = widest.max(scatter.direction.cross(mirror).length());
    }
    assert!(widest <= rim * (1.0 + 1e-12) && widest > 0.99 * rim, "{widest} {rim}");
}

#[test]
fn delta_materials_say_so() {
    let deltas = [reflective(1.0), reflective(0.991), refractive(0.67), clear_coat(1.0, 1.0)];
    let others = [diffuse(), reflective(0.99), clear_coat(0.99, 1.0), clear_coat(1.0, 0.5)];
    assert!(deltas.iter().all(Material::is_delta));
    assert!(!others.iter().any(Material::is_delta));
}

#[test]
fn nothing_is_scattered_to_or_from_below() {
    each_case(|material, wo, n| {
        assert_eq!(material.eval(wo, n, -wo), (Rgb::ZERO, 0.0));
        assert_eq!(material.eval(-wo, n, wo), (Rgb::ZERO, 0.0));
        assert_eq!(material.sample(-wo, n, true, [0.5; 3]), None);
    });
}
