//! Random numbers and warps.

mod independent;
mod scrambles;
mod sobol;
mod warp;

use crate::support::random::Sample4;
use pathtracer::sampling::{Independent, NumberSet, PixelSeed, Sampler, Sobol};

/// The p-value of pairs of numbers against the uniform distribution on the unit square, 32 x 32 cells.
fn pairs_uniform(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let mut counts = vec![0; 32 * 32];
    for (a, b) in pairs {
        counts[(a * 32.0) as usize * 32 + (b * 32.0) as usize] += 1;
    }
    crate::support::stats::chi_square_uniform(&counts)
}

/// The p-value of numbers against the uniform distribution, 1024 cells.
fn uniform(numbers: impl Iterator<Item = f64>) -> f64 {
    let mut counts = vec![0; 1024];
    for u in numbers {
        counts[(u * 1024.0) as usize] += 1;
    }
    crate::support::stats::chi_square_uniform(&counts)
}

/// Pixels of a square picture, row by row.
fn pixels<S: Sampler>(sampler: &S, width: u32) -> impl Iterator<Item = PixelSeed> {
    (0..width * width).map(move |i| sampler.pixel(i % width, i / width))
}

/// Every pair of numbers that differ in one argument (seed, x, y, sample, set, dimension), each a p-value.
fn p_values_of_neighbours<S: Sampler>() -> Vec<(&'static str, f64)> {
    let (one, other) = (S::new(1), S::new(2));
    let width = 1024;
    let at = |sampler: S, dx: u32, dy: u32, index: u64, set: u32, dimension: usize| {
        (0..width * width).map(move |i| {
            let pixel = sampler.pixel(i % width + dx, i / width + dy);
            sampler.sample4(pixel, index, set)[dimension]
        })
    };
    let base = || at(one, 0, 0, 5, 3, 1);
    vec![
        ("seed", pairs_uniform(base().zip(at(other, 0, 0, 5, 3, 1)))),
        ("x", pairs_uniform(base().zip(at(one, 1, 0, 5, 3, 1)))),
        ("y", pairs_uniform(base().zip(at(one, 0, 1, 5, 3, 1)))),
        ("diagonal", pairs_uniform(at(one, 1, 0, 5, 3, 1).zip(at(one, 0, 1, 5, 3, 1)))),
        ("set", pairs_uniform(base().zip(at(one, 0, 0, 5, 4, 1)))),
        ("distant set", pairs_uniform(base().zip(at(one, 0, 0, 5, 3 + 64, 1)))),
        ("set and dimension", pairs_uniform(base().zip(at(one, 0, 0, 5, 4, 0)))),
        ("dimension", pairs_uniform(base().zip(at(one, 0, 0, 5, 3, 2)))),
        ("dimensions 0, 3", pairs_uniform(at(one, 0, 0, 0, 0, 0).zip(at(one, 0, 0, 0, 0, 3)))),
        ("sample and set", pairs_uniform(base().zip(at(one, 0, 0, 9, 4, 1)))),
        ("block of 2^32 samples", pairs_uniform(base().zip(at(one, 0, 0, 5 + (1 << 32), 3, 1)))),
    ]
}

#[test]
fn one_number_is_the_first_of_a_pair() {
    fn check<S: Sampler>() {
        let sampler = S::new(3);
        for (index, pixel) in (0..).zip(pixels(&sampler, 8)) {
            let numbers = sampler.set(pixel, index, 5);
            for usage in 0..8 {
                assert_eq!(numbers.one(usage), numbers.pair(usage)[0]);
            }
        }
    }
    check::<Independent>();
    check::<Sobol>();
}
