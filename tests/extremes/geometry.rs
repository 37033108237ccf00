//! The geometry routines on any numbers, against double-double arithmetic.
//!
//! Seeds are fixed, unless `PATHTRACER_SEED` is another one: then ten times as many cases are tried. Cases that failed once
//! stand in the `.regressions` files beside the tests and are tried first.

mod frame;
mod instance;
mod solids;
mod triangle;

use pathtracer::math::{DMat3, DVec3};
use proptest::prelude::*;
use proptest::test_runner::{Config, FileFailurePersistence, RngSeed};

/// The same cases on every run without a seed.
fn config(cases: u32) -> Config {
    let regressions = FileFailurePersistence::WithSource("regressions");
    let seed = std::env::var("PATHTRACER_SEED").ok().map(|seed| seed.parse().expect("a seed is a number"));
    let cases = if seed.is_some() { 10 * cases } else { cases };
    Config {
        cases,
        max_global_rejects: 100 * cases,
        rng_seed: RngSeed::Fixed(seed.unwrap_or(17)),
        failure_persistence: Some(Box::new(regressions)),
        ..Config::default()
    }
}

/// A number of either sign and a size of 2^-30 to 2^30, or 0.
fn number() -> impl Strategy<Value = f64> {
    let any = (-30.0..30.0f64, any::<bool>())
        .prop_map(|(exponent, negative)| libm::exp2(exponent) * if negative { -1.0 } else { 1.0 });
    prop_oneof![9 => any, 1 => Just(0.0)]
}

/// A size of 2^-30 to 2^30.
fn size() -> impl Strategy<Value = f64> {
    (-30.0..30.0f64).prop_map(libm::exp2)
}

fn point() -> impl Strategy<Value = DVec3> {
    (number(), number(), number()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// A unit vector; often along an axis or nearly so.
fn direction() -> impl Strategy<Value = DVec3> {
    let component =
        || prop_oneof![4 => -1.0..1.0f64, 1 => Just(0.0), 1 => (-30.0..0.0f64).prop_map(libm::exp2)];
    (component(), component(), component())
        .prop_map(|(x, y, z)| DVec3::new(x, y, z))
        .prop_filter("has a direction", |d| d.length() > 1e-6)
        .prop_map(DVec3::normalize)
}

/// A turn about any axis.
fn turn() -> impl Strategy<Value = DMat3> {
    (direction(), direction())
        .prop_filter("has two directions", |(x, around)| x.cross(*around).length() > 1e-3)
        .prop_map(|(x, around)| {
            let y = x.cross(around).normalize();
            DMat3::from_cols(x, y, x.cross(y))
        })
}
