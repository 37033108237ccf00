use super::{p_values_of_neighbours, pairs_uniform, pixels, uniform};
use crate::support::random::Sample4;
use crate::support::stats::{Moments, SIGNIFICANCE, chi_square_uniform, sidak};
use pathtracer::sampling::{Sampler, Sobol};

/// First samples of blocks to look at, as multiples of the block's length: the beginning, somewhere, and the last
/// and first block beside the border of 2^32 samples.
fn first_samples(length: u64) -> [u64; 5] {
    [0, length, 37 * length, (1 << 32) - length, 1 << 32]
}

fn block(x: u32, set: u32, first: u64, length: u64) -> Vec<[f64; 4]> {
    let sampler = Sobol::new(5);
    let pixel = sampler.pixel(x, 7);
    (first..first + length).map(|i| sampler.sample4(pixel, i, set)).collect()
}

/// Whether every box of 2^-bits[d] along dimension d holds equally many of the points.
fn stratified(points: &[[f64; 4]], bits: [u32; 4]) -> bool {
    let boxes = 1 << bits.iter().sum::<u32>();
    let mut counts = vec![0; boxes];
    for point in points {
        let index =
            (0..4).fold(0, |index, d| index << bits[d] | (point[d] * f64::from(1 << bits[d])) as usize);
        counts[index] += 1;
    }
    counts.iter().all(|&count| count == points.len() / boxes)
}

#[test]
fn numbers_depend_on_nothing_but_the_arguments() {
    // Recorded values: pictures of a seed must stay the same on every machine and in every version.
    let sampler = Sobol::new(42);
    assert_eq!(
        sampler.sample4(sampler.pixel(3, 5), 7, 11),
        [0.05977492325473577, 0.5544877030188218, 0.851953612989746, 0.004602803732268512]
    );
    assert_eq!(
        sampler.sample4(sampler.pixel(1919, 1079), 1 << 40, 1000),
        [0.11388765287119895, 0.0010094557655975223, 0.5445135332411155, 0.6893887975020334]
    );
}

#[test]
fn every_block_is_stratified_in_each_dimension() {
    for k in 0..=10 {
        for first in first_samples(1 << k) {
            for x in 0..8 {
                let points = block(x, x, first, 1 << k);
                for d in 0..4 {
                    let mut bits = [0; 4];
                    bits[d] = k;
                    assert!(stratified(&points, bits), "2^{k} samples from {first}, dimension {d}");
                }
            }
        }
    }
}

#[test]
fn every_block_is_stratified_in_each_elementary_interval_of_a_use() {
    for k in 0..=10 {
        for first in first_samples(1 << k) {
            for x in 0..8 {
                let points = block(x, x, first, 1 << k);
                for i in 0..=k {
                    assert!(stratified(&points, [i, k - i, 0, 0]), "2^{k} samples from {first}, 2^-{i} wide");
                    assert!(stratified(&points, [0, 0, i, k - i]), "2^{k} samples from {first}, 2^-{i} wide");
                }
            }
        }
    }
}

#[test]
fn the_first_sample_is_uniform_over_pixels_in_leading_and_trailing_bits() {
    let sampler = Sobol::new(1);
    let significance = sidak(SIGNIFICANCE, 8);
    for d in 0..4 {
        let numbers = || pixels(&sampler, 512).map(|pixel| sampler.sample4(pixel, 0, 0)[d]);
        assert!(uniform(numbers()) > significance, "dimension {d}");
        let trailing = numbers().map(|u| (u * f64::from(1 << 20)).fract());
        assert!(uniform(trailing) > significance, "trailing bits of dimension {d}");
    }
}

#[test]
fn numbers_that_differ_in_one_argument_are_independent() {
    let p_values = p_values_of_neighbours::<Sobol>();
    let significance = sidak(SIGNIFICANCE, p_values.len());
    for (difference, p) in p_values {
        assert!(p > significance, "{difference}: p = {p}");
    }
}

/// In an Owen scramble two numbers that share k leading bits get k shared leading bits, a different next one, and
/// independent bits after it.
#[test]
fn bits_after_the_first_difference_are_independent() {
    let sampler = Sobol::new(8);
    let mut counts = vec![vec![0; 256]; 4 * 3];
    for pixel in pixels(&sampler, 256) {
        let (a, b) = (sampler.sample4(pixel, 10, 0), sampler.sample4(pixel, 21, 0));
        for d in 0..4 {
            let bits = |u: f64| (u * (1u64 << 32) as f64) as u32;
            let (a, b) = (bits(a[d]), bits(b[d]));
            let shared = (a ^ b).leading_zeros() as usize;
            if shared < 3 {
                let after = |x: u32| (x << (shared + 1) >> 28) as usize;
                counts[3 * d + shared][16 * after(a) + after(b)] += 1;
            }
        }
    }
    for (i, counts) in counts.iter().enumerate() {
        let p = chi_square_uniform(counts);
        assert!(p > sidak(SIGNIFICANCE, 4 * 3), "dimension {}, {} shared bits: p = {p}", i / 3, i % 3);
    }
}

#[test]
fn sets_of_a_pixel_are_uncorrelated_over_its_samples() {
    // The mean of a product of two independent stratified sequences, per pixel; its expectation over pixels is 0.
    let sampler = Sobol::new(4);
    let pairs = [(0, 1), (0, 2), (1, 2), (3, 7), (0, 255)];
    let significance = sidak(SIGNIFICANCE, pairs.len() * 16);
    for (set, other) in pairs {
        for d in 0..16 {
            let estimates = pixels(&sampler, 120).map(|pixel| {
                let product = |i| {
                    let (a, b) = (sampler.sample4(pixel, i, set), sampler.sample4(pixel, i, other));
                    (a[d / 4] - 0.5) * (b[d % 4] - 0.5)
                };
                (0..64).map(product).sum::<f64>() / 64.0
            });
            let moments = Moments::of(estimates);
            let p = moments.p_value(0.0);
            assert!(p > significance, "sets {set}, {other}, dimensions {} {}: p = {p}", d / 4, d % 4);
            // Two Owen-shuffled sequences pair up at least as well as random ones would (variance 1/144/64), up
            // to a factor of two for pairs of neighbours that move together.
            assert!(moments.variance() < 2.5 / 144.0 / 64.0, "sets {set}, {other}: {}", moments.variance());
        }
    }
}

#[test]
fn smooth_integrands_converge_faster_than_by_independent_samples() {
    // Owen 1997: the variance of a smooth integrand over scrambled nets falls as n^-3 (log n)^(d-1).
    let sampler = Sobol::new(6);
    let variance = |n: u64| {
        let estimates = pixels(&sampler, 32).map(|pixel| {
            let f = |i| sampler.sample4(pixel, i, 0)[..2].iter().map(|u| u * u).product::<f64>();
            (0..n).map(f).sum::<f64>() / n as f64
        });
        Moments::of(estimates).variance()
    };
    let octaves = 6.0;
    let slope = libm::log2(variance(1024) / variance(16)) / octaves;
    assert!(slope < -2.5, "variance falls as n^{slope}");
}

#[test]
fn pixels_do_not_share_their_points() {
    let sampler = Sobol::new(2);
    let significance = sidak(SIGNIFICANCE, 3);
    for (dx, dy) in [(1, 0), (0, 1), (1, 1)] {
        let pairs = (0..64 * 64).flat_map(|i| {
            let (a, b) = (sampler.pixel(i % 64, i / 64), sampler.pixel(i % 64 + dx, i / 64 + dy));
            // One sample of each pixel, so that the pairs are independent of each other.
            let index = u64::from(i % 16);
            (0..32).map(move |set| (sampler.sample4(a, index, set)[0], sampler.sample4(b, index, set)[0]))
        });
        let p = pairs_uniform(pairs);
        assert!(p > significance, "offset ({dx}, {dy}): p = {p}");
    }
}
