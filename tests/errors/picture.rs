//! The whole picture: what is expected of its relMSE, and of its mean.

use crate::support::stats::Moments;
use crate::support::watch::Unwatched;
use pathtracer::film::PictureError;
use pathtracer::integrator::Counters;
use pathtracer::math::Rgb;
use pathtracer::render::{Rendered, Settings, accumulate};
use pathtracer::sampling::{Independent, NumberSet, Sampler, SamplerKind};

/// The radiance of a pixel's truth.
fn truth(x: u32, y: u32) -> Rgb {
    Rgb::new(0.2 + 0.01 * f64::from(x), 0.5, 0.1 + 0.02 * f64::from(y))
}

/// Noise of one colour, uniform between 0 and twice the truth: of the variance truth^2 / 3.
fn noisy(seed: u64) -> impl Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync {
    let sampler = Independent::new(seed);
    move |x, y, index, _| 2.0 * sampler.set(sampler.pixel(x, y), index, 0).one(0) * truth(x, y)
}

fn settings(samples: u64, scramble_length: u32) -> Settings {
    let settings = Settings::new(40, 30, samples, 1);
    Settings { scramble_length: Some(scramble_length), error_estimate: true, ..settings }
}

fn render(settings: &Settings, seed: u64) -> Rendered {
    accumulate(settings, &Unwatched, noisy(seed)).expect("a render without trouble")
}

fn error(rendered: &Rendered) -> PictureError {
    rendered.error.expect("an estimate")
}

/// The root of the relMSE that is expected at so many samples.
fn expected_relative(samples: u64) -> f64 {
    let square = |t: f64| t * t / 3.0 / (t * t + 0.01);
    let pixels = (0..30).flat_map(|y| (0..40).map(move |x| truth(x, y)));
    let total: f64 = pixels.map(|t| t.to_array().into_iter().map(square).sum::<f64>() / 3.0).sum();
    (total / 1200.0 / samples as f64).sqrt()
}

/// How often the interval of the mean holds the truth, and how the estimates of the relative error spread.
fn trials(settings: &Settings) -> (u32, Moments) {
    let mean =
        (0..30).flat_map(|y| (0..40).map(move |x| truth(x, y).element_sum() / 3.0)).sum::<f64>() / 1200.0;
    let (mut held, mut relative) = (0, Moments::default());
    for seed in 0..200 {
        let error = error(&render(&Settings { seed, ..settings.clone() }, seed));
        held += u32::from(error.mean.low <= mean && mean <= error.mean.high);
        relative.add(error.relative.value);
        assert!(!error.is_doubtful);
    }
    (held, relative)
}

/// 200 intervals of 95 % hold the truth 190 +- 3.1 times; at 4 deviations of the binomial distribution 178 to 200 times.
fn assert_honest(settings: &Settings) {
    let (held, relative) = trials(settings);
    assert!((178..=200).contains(&held), "{held} of 200");
    // The root of an unbiased estimate is too small by an eighth of its relative variance, well below 1 %. The truth in the
    // denominator is a pixel's mean, whose relative variance is 1 / (3 samples); its reciprocal square is too large by three
    // times that, and its root by half of it.
    let ratio = relative.mean() / expected_relative(settings.samples);
    assert!((0.99..1.01 + 0.5 / settings.samples as f64).contains(&ratio), "{ratio}");
}

#[test]
fn eight_scrambles_of_the_film_tell_the_error() {
    assert_honest(&settings(16, 2));
}

#[test]
fn a_few_pixels_tell_the_error_of_one_scramble() {
    assert_honest(&settings(16, 128));
}

/// Noise in 12 of the 1200 pixels: of the 64 that are chosen about every second picture has none of them.
#[test]
fn noise_in_pixels_that_the_chosen_ones_miss_is_counted() {
    let noisy = |seed: u64| {
        let sampler = Independent::new(seed);
        move |x: u32, y: u32, index: u64, _: &mut Counters| match (x, y) {
            (8..12, 20..23) => 200.0 * sampler.set(sampler.pixel(x, y), index, 0).one(0) * Rgb::ONE,
            _ => Rgb::ONE,
        }
    };
    let truth = (12.0 * 100.0 + 1188.0) / 1200.0;
    let held = (0..200).filter(|&seed| {
        let settings = Settings { seed, ..settings(16, 128) };
        let rendered = accumulate(&settings, &Unwatched, noisy(seed)).expect("a render without trouble");
        let mean = error(&rendered).mean;
        mean.low <= truth && truth <= mean.high
    });
    // At 4 deviations of the binomial distribution, as above.
    let held = held.count();
    assert!((178..=200).contains(&held), "{held} of 200");
}

#[test]
fn unequally_long_scrambles_tell_the_error() {
    assert_honest(&settings(21, 2));
}

#[test]
fn the_estimate_does_not_change_the_picture() {
    for samples in [1, 5, 40] {
        let with = settings(samples, 128);
        let without = Settings { error_estimate: false, ..with.clone() };
        let (with, without) = (render(&with, 1), render(&without, 1));
        assert_eq!(with.film, without.film);
        assert_eq!(with.counters, without.counters);
        assert_eq!(without.error, None);
    }
}

#[test]
fn threads_and_tiles_do_not_change_the_estimate() {
    for base in [settings(20, 128), settings(20, 2)] {
        let expected = error(&render(&base, 1));
        for (threads, tile) in [(1, 64), (2, 8), (8, 5)] {
            let rendered = render(&Settings { threads: Some(threads), tile: Some(tile), ..base.clone() }, 1);
            assert_eq!(error(&rendered), expected);
        }
    }
}

#[test]
fn the_smallest_picture_has_an_error() {
    let one = Settings { error_estimate: true, ..Settings::new(1, 1, 1, 1) };
    let error = error(&render(&one, 1));
    assert!(error.relative.value > 0.0 && error.standard_error > 0.0);
}

#[test]
fn long_and_narrow_pictures_have_an_error() {
    for (width, height) in [(1, 500), (500, 1), (3, 7), (7000, 2)] {
        let narrow = Settings { error_estimate: true, ..Settings::new(width, height, 2, 1) };
        assert!(render(&narrow, 1).error.is_some());
    }
}

#[test]
fn independent_samples_lie_in_short_scrambles() {
    let independent = Settings { sampler: SamplerKind::Independent, ..Settings::new(4, 3, 16, 1) };
    assert!(render(&independent, 1).error.is_some());
}
