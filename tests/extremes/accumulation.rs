//! Sums of very many samples.

use crate::support::double_double::DoubleDouble;
use crate::support::random::Random;
use pathtracer::film::{Film, Sums};
use pathtracer::math::Rgb;
use pathtracer::render::{Settings, Unwatched, accumulate};

/// A long run of samples of one pixel: the mean that the film gives, and the exact one.
fn assert_mean_of(what: &str, chunks: u64, chunk: u64, mut sample: impl FnMut() -> f64) {
    let mut film = Film::new(1, 1, chunk);
    let mut exact = DoubleDouble::from(0.0);
    for index in 0..chunks {
        let mut sum = 0.0;
        for _ in 0..chunk {
            let value = sample();
            sum += value;
            exact = exact + DoubleDouble::from(value);
        }
        film.add(index, Sums::plain(chunk, vec![Rgb::splat(sum)])).expect("a new chunk");
    }
    let count = chunks * chunk;
    let expected = (exact / DoubleDouble::from(count as f64)).to_f64();
    let mean = film.means().next().expect("one pixel").x;
    assert_eq!(film.samples(), count);
    // A chunk's sum is wrong by at most `chunk` roundings, the tree by one a level: 2^-53 * (4096 + 14) is 5e-13.
    assert!((mean / expected - 1.0).abs() < 1e-9, "{what}: {mean} instead of {expected}");
}

fn exponential(random: &mut Random) -> f64 {
    -libm::log(1.0 - random.unit())
}

#[test]
fn a_million_samples_are_summed_to_1e_9() {
    let mut random = Random::new(151);
    assert_mean_of("constant", 62_500, 16, || 0.1);
    assert_mean_of("exponential", 62_500, 16, || exponential(&mut random));
}

#[test]
fn two_to_the_26_samples_are_summed_to_1e_9() {
    let mut random = Random::new(152);
    assert_mean_of("constant", 1 << 14, 1 << 12, || 0.1);
    assert_mean_of("exponential", 1 << 14, 1 << 12, || exponential(&mut random));
}

#[test]
fn a_firefly_among_a_million_samples_is_kept() {
    let mut random = Random::new(153);
    let mut left = 500_000;
    let sample = || {
        left -= 1;
        if left == 0 { 1e30 } else { exponential(&mut random) }
    };
    assert_mean_of("firefly", 62_500, 16, sample);
}

/// Through the render loop: samples that are no light are left out and counted, fireflies are kept and counted.
#[test]
fn samples_that_are_not_finite_are_counted_and_fireflies_kept() {
    let settings = Settings { threads: Some(2), ..Settings::new(8, 8, 2000, 1) };
    let sample = |_, _, index, _: &mut _| match index % 1008 {
        1 => Rgb::new(f64::NAN, 1.0, 1.0),
        2 => Rgb::splat(f64::INFINITY),
        3 => Rgb::new(1.0, -1e-3, 1.0),
        // In the second half of a chunk, where samples are judged by the first.
        12 => Rgb::splat(1e30),
        _ => Rgb::ONE,
    };
    let rendered = accumulate(&settings, &Unwatched, sample).expect("a render");
    assert_eq!(rendered.counters.dropped, 3 * 2 * 64);
    assert_eq!(rendered.counters.fireflies, 2 * 64);
    // Of 2000 samples two are fireflies; the dropped ones count as black.
    let expected = (2e30 + 1992.0) / 2000.0;
    for mean in rendered.film.means() {
        assert!((mean / expected - 1.0).abs().max_element() < 1e-9, "{mean}");
    }
}
