//! The halves of the samples of a pixel.

use crate::support::stats::Moments;
use pathtracer::film::{Halving, Pair};
use pathtracer::sampling::{Independent, NumberSet, Sampler};

#[test]
fn every_compared_number_of_samples_has_the_later_half_in_a_level_of_its_own() {
    for chunk in [1, 2, 10, 16, 100] {
        let halving = Halving::new(chunk);
        let mut before = 0;
        for samples in (1..3000).filter(|&samples| halving.largest(samples) == samples) {
            let level = halving.level(samples - 1);
            assert!((before..samples).all(|sample| halving.level(sample) == level), "{chunk}: {samples}");
            assert_eq!(halving.level(samples), level + 1, "{chunk}: {samples}");
            assert_eq!(halving.largest(samples - 1), before, "{chunk}: {samples}");
            before = samples;
        }
    }
}

#[test]
fn the_nodes_of_a_film_are_compared() {
    let halving = Halving::new(16);
    let compared: Vec<u64> = (0..200).filter(|&samples| halving.largest(samples) == samples).collect();
    assert_eq!(compared, [0, 1, 2, 4, 8, 16, 32, 64, 128]);
}

#[test]
fn the_difference_of_halves_tells_the_variance_of_independent_samples() {
    let sampler = Independent::new(5);
    for counts in [[8, 8], [8, 2], [1, 1]] {
        let mut squares = Moments::default();
        for pixel in 0..20_000 {
            let mut next = (0..).map(|index| sampler.set(sampler.pixel(pixel, 0), index, 0).one(0));
            let sums = counts.map(|count| next.by_ref().take(count as usize).sum());
            let deviation = Pair { sums, counts }.deviation();
            squares.add(deviation * deviation);
        }
        // Numbers that are uniform from 0 to 1 have the variance 1/12; 4 standard errors.
        let expected = (counts[0] + counts[1]) as f64 / 12.0;
        assert!((squares.mean() - expected).abs() < 4.0 * squares.standard_error(), "{counts:?}");
    }
}
