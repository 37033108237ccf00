//! The Fresnel equations against closed forms and against an oracle of twice the digits.

use crate::support::double_double::DoubleDouble;
use pathtracer::material::{Fresnel, Interface};

/// The equations as textbooks have them, in about 106 bits: reflectance and cosine beyond, none where total.
fn oracle(ratio: f64, entering: bool, cos: f64) -> Option<(f64, f64)> {
    let [one, ratio, cos] = [1.0, ratio, cos].map(DoubleDouble::from);
    // Indices on this side and beyond.
    let (n_i, n_t) = if entering { (ratio, one) } else { (one, ratio) };
    let m = n_i / n_t;
    let squared = one - m * m * (one - cos * cos);
    if squared.to_f64() <= 0.0 {
        return None;
    }
    let cos_t = squared.sqrt();
    let r_s = (n_i * cos - n_t * cos_t) / (n_i * cos + n_t * cos_t);
    let r_p = (n_t * cos - n_i * cos_t) / (n_t * cos + n_i * cos_t);
    Some((((r_s * r_s + r_p * r_p) / DoubleDouble::from(2.0)).to_f64(), cos_t.to_f64()))
}

/// Cosines from 1 down to 2^-40.
fn cosines() -> impl Iterator<Item = f64> {
    (0..400).map(|i| libm::exp2(-0.1 * f64::from(i))).chain((1..100).map(|i| f64::from(i) / 100.0))
}

/// The relative error that a few roundings make of a reflectance: `squared` of the cosine beyond is a sum whose
/// terms may cancel, and half of its relative error goes into each amplitude.
fn tolerance(ratio: f64, entering: bool, cos: f64, cos_t: f64) -> f64 {
    let m = if entering { ratio } else { 1.0 / ratio };
    32.0 * f64::EPSILON * (1.0 + (m * cos / cos_t) * (m * cos / cos_t))
}

#[test]
fn equal_to_the_oracle_at_all_angles_and_ratios() {
    for ratio in [1e-3, 0.1, 0.42, 0.67, 0.75, 0.9, 0.999, 1.001, 1.1, 1.5, 2.4, 10.0, 1e3] {
        compare_with_oracle(ratio);
    }
}

#[test]
fn equal_to_the_oracle_where_the_indices_are_nearly_equal() {
    for exponent in [4, 5, 6, 7, 8, 9, 12, 15] {
        let difference = libm::pow(10.0, -f64::from(exponent));
        compare_with_oracle(1.0 + difference);
        compare_with_oracle(1.0 - difference);
    }
    compare_with_oracle(1f64.next_up());
    compare_with_oracle(1f64.next_down());
}

fn compare_with_oracle(ratio: f64) {
    for (entering, cos) in [true, false].into_iter().flat_map(|side| cosines().map(move |cos| (side, cos))) {
        let found = Interface::new(ratio, entering).at(cos);
        let Some((reflectance, cos_t)) = oracle(ratio, entering, cos) else {
            assert_eq!(
                found,
                Fresnel { reflectance: 1.0, cos_transmitted: None },
                "{ratio} {entering} {cos}"
            );
            continue;
        };
        let bound = tolerance(ratio, entering, cos, cos_t);
        if bound > 1.0 {
            // So near the critical angle that a rounding of the cosine decides whether reflection is total.
            continue;
        }
        let error = (found.reflectance / reflectance - 1.0).abs();
        assert!(error < bound, "{ratio} {entering} {cos}: {found:?}, not {reflectance}: {error} > {bound}");
        let error = (found.cos_transmitted.expect("not total") / cos_t - 1.0).abs();
        assert!(error < bound, "{ratio} {entering} {cos}: {found:?}, not {cos_t}");
    }
}

#[test]
fn reflected_and_transmitted_energy_sum_to_one() {
    for ratio in [0.42, 0.67, 0.999, 1.1, 1.5] {
        for (entering, cos) in
            [true, false].into_iter().flat_map(|side| cosines().map(move |cos| (side, cos)))
        {
            let interface = Interface::new(ratio, entering);
            let Fresnel { reflectance, cos_transmitted: Some(t) } = interface.at(cos) else { continue };
            // Transmitted amplitudes have formulas of their own (Born and Wolf, section 1.5.2).
            let m = interface.ratio();
            let (t_s, t_p) = (2.0 * m * cos / (m * cos + t), 2.0 * m * cos / (cos + m * t));
            let transmittance = t / (m * cos) * 0.5 * (t_s * t_s + t_p * t_p);
            let bound = tolerance(ratio, entering, cos, t);
            assert!((reflectance + transmittance - 1.0).abs() < bound, "{ratio} {entering} {cos}");
        }
    }
}

#[test]
fn known_values() {
    let at = |ratio: f64, cos: f64| Interface::new(ratio, true).at(cos).reflectance;
    let near = |a: f64, b: f64| (a - b).abs() < 8.0 * f64::EPSILON;
    // Normal incidence: ((n - 1) / (n + 1))^2.
    assert!(near(at(1.0 / 1.5, 1.0), 0.04));
    assert!(near(at(1.0 / 3.0, 1.0), 0.25));
    // Brewster's angle, tan = n: no p component, and r_s = (n^2 - 1) / (n^2 + 1).
    let brewster = 1.0 / (1.0f64 + 1.5 * 1.5).sqrt();
    assert!(near(at(1.0 / 1.5, brewster), 0.5 * (1.25f64 / 3.25).powi(2)));
}

#[test]
fn grazing_light_is_reflected() {
    for ratio in [0.42, 0.67, 0.999] {
        assert!((Interface::new(ratio, true).at(1e-17).reflectance - 1.0).abs() < 1e-14, "{ratio}");
    }
}

#[test]
fn equal_indices_reflect_nothing_at_any_angle() {
    for entering in [true, false] {
        for cos in cosines().chain([0.0, f64::MIN_POSITIVE]) {
            let expected = Fresnel { reflectance: 0.0, cos_transmitted: Some(cos) };
            assert_eq!(Interface::new(1.0, entering).at(cos), expected);
        }
    }
}

#[test]
fn total_reflection_begins_at_the_critical_angle() {
    // sin = 3/5 beyond, n = 5/3: the cosine of the critical angle is 4/5.
    let leaving = Interface::new(3.0 / 5.0, false);
    let margin = 4.0 * f64::EPSILON;
    let below = leaving.at(0.8 - margin);
    assert_eq!(below, Fresnel { reflectance: 1.0, cos_transmitted: None });
    assert!(leaving.at(0.8 + margin).cos_transmitted.is_some());
    // Just above, the reflectance is 1 less about 4 (m + 1/m) / 2 times the cosine beyond over that inside.
    let beyond = leaving.at(0.8 + 1e-12);
    let cos_t = beyond.cos_transmitted.expect("not total");
    let slope = 2.0 * (5.0 / 3.0 + 3.0 / 5.0) / 0.8;
    assert!((1.0 - beyond.reflectance) / (slope * cos_t) - 1.0 < 1e-3, "{beyond:?}");
}
