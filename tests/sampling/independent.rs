use super::{p_values_of_neighbours, pairs_uniform, pixels, uniform};
use crate::support::random::Sample4;
use crate::support::stats::{SIGNIFICANCE, sidak};
use pathtracer::sampling::{Independent, Sampler};

#[test]
fn numbers_depend_on_nothing_but_the_arguments() {
    // Recorded values: pictures of a seed must stay the same on every machine and in every version.
    let sampler = Independent::new(42);
    assert_eq!(
        sampler.sample4(sampler.pixel(3, 5), 7, 11),
        [0.5246008152339693, 0.7278972863154948, 0.30916852928111005, 0.0038572950094178937]
    );
    assert_eq!(
        sampler.sample4(sampler.pixel(1919, 1079), 1 << 40, 1000),
        [0.8788628456480286, 0.48124086230244567, 0.8114016782155725, 0.9750545974142092]
    );
}

#[test]
fn numbers_are_uniform_over_samples_in_leading_and_trailing_bits() {
    let sampler = Independent::new(0);
    let pixel = sampler.pixel(0, 0);
    let significance = sidak(SIGNIFICANCE, 8);
    for dimension in 0..4 {
        let numbers = || (0..1 << 18).map(|i| sampler.sample4(pixel, i, 0)[dimension]);
        assert!(uniform(numbers()) > significance, "dimension {dimension}");
        let trailing = numbers().map(|u| (u * (1u64 << 42) as f64).fract());
        assert!(uniform(trailing) > significance, "trailing bits of dimension {dimension}");
    }
}

#[test]
fn numbers_lie_strictly_between_0_and_1() {
    let sampler = Independent::new(9);
    let all = pixels(&sampler, 300).flat_map(|pixel| sampler.sample4(pixel, 0, 0));
    assert!(all.into_iter().all(|u| u > 0.0 && u < 1.0));
}

#[test]
fn numbers_that_differ_in_one_argument_are_independent() {
    let p_values = p_values_of_neighbours::<Independent>();
    let significance = sidak(SIGNIFICANCE, p_values.len());
    for (difference, p) in p_values {
        assert!(p > significance, "{difference}: p = {p}");
    }
}

#[test]
fn successive_samples_are_independent() {
    let sampler = Independent::new(3);
    let pixel = sampler.pixel(10, 20);
    let significance = sidak(SIGNIFICANCE, 4);
    for lag in [1, 2, 16, 1 << 20] {
        let at = |i| sampler.sample4(pixel, i, 2)[0];
        let p = pairs_uniform((0..1 << 18).map(|i| (at(i), at(i + lag))));
        assert!(p > significance, "lag {lag}: p = {p}");
    }
}

#[test]
fn no_two_places_share_a_number() {
    // 10^5 numbers of 52 bits: two equal ones are expected once in a million such tests.
    let sampler = Independent::new(1);
    let mut numbers: Vec<u64> = pixels(&sampler, 50)
        .flat_map(|pixel| (0..10).flat_map(move |i| sampler.sample4(pixel, i, i as u32)))
        .map(f64::to_bits)
        .collect();
    let count = numbers.len();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), count);
}
