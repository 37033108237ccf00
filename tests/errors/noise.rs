//! Blocks that stop when their error is small enough.

#[cfg(feature = "embree")]
use super::scenes::Subject;
use crate::support::stats::{Moments, SIGNIFICANCE, two_sided_tail};
use crate::support::watch::Unwatched;
use pathtracer::integrator::Counters;
use pathtracer::math::Rgb;
#[cfg(feature = "embree")]
use pathtracer::render::AccelKind;
use pathtracer::render::{Ended, NOISE_AFTER, Rendered, Settings, accumulate};
use pathtracer::sampling::{Independent, NumberSet, Sampler, SamplerKind};

const WIDTH: u32 = 40;
const HEIGHT: u32 = 24;

/// A number in (0, 1) for each sample.
fn number(seed: u64) -> impl Fn(u32, u32, u64) -> f64 + Sync {
    let sampler = Independent::new(seed);
    move |x, y, index| sampler.set(sampler.pixel(x, y), index, 0).one(0)
}

/// Radiance 1 on average: the left blocks have little noise, the right ones more.
fn uneven(seed: u64) -> impl Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync {
    let number = number(seed);
    move |x, y, index, _| {
        let strength = if x < 16 { 0.1 } else { 1.0 };
        Rgb::splat(1.0 + strength * (2.0 * number(x, y, index) - 1.0))
    }
}

/// Radiance 1 on average: half of it from one sample in 100.
fn fireflies(seed: u64) -> impl Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync {
    let number = number(seed);
    move |x, y, index, _| Rgb::splat(if number(x, y, index) < 0.01 { 50.5 } else { 0.5 })
}

fn settings(noise: f64, samples: u64) -> Settings {
    Settings { noise: Some(noise), threads: Some(2), ..Settings::new(WIDTH, HEIGHT, samples, 1) }
}

fn render<F>(settings: &Settings, sample: F) -> Rendered
where
    F: Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync,
{
    accumulate(settings, &Unwatched, sample).expect("a render without trouble")
}

fn bits(rendered: &Rendered) -> Vec<[u64; 3]> {
    rendered.film.means().map(|mean| mean.to_array().map(f64::to_bits)).collect()
}

fn mean(rendered: &Rendered) -> f64 {
    let means = rendered.film.means().map(|mean| mean.element_sum() / 3.0);
    means.sum::<f64>() / f64::from(WIDTH * HEIGHT)
}

#[test]
fn tiles_and_threads_do_not_change_where_blocks_stop() {
    let settings = settings(0.06, 0);
    let expected = render(&settings, uneven(1));
    for (threads, tile) in [(1, Some(64)), (2, Some(7)), (8, Some(1)), (8, None)] {
        let rendered = render(&Settings { threads: Some(threads), tile, ..settings.clone() }, uneven(1));
        assert_eq!(rendered.film, expected.film);
        assert_eq!((rendered.samples, rendered.counters), (expected.samples, expected.counters));
    }
}

#[cfg(feature = "embree")]
#[test]
fn accelerators_do_not_change_where_blocks_stop() {
    let subject = Subject::new("cornellBox");
    let settings = Settings { noise: Some(0.5), ..Settings::new(32, 24, 256, 8) };
    let [embree, native] = [AccelKind::Embree, AccelKind::Native]
        .map(|accel| subject.render(&Settings { accel, ..settings.clone() }).film);
    assert_eq!(embree, native);
}

#[test]
fn noisy_blocks_get_more_samples() {
    // At noise 0.02 the left third needs (0.1 / sqrt 3 / 0.02)^2 = 8 samples, so it stops as soon as a block may; the
    // others need 833.
    let rendered = render(&settings(0.02, 0), uneven(1));
    assert_eq!(rendered.ended, Ended::Complete);
    assert!((700..1300).contains(&rendered.film.samples()), "{}", rendered.film.samples());
    let per_pixel = rendered.samples as f64 / f64::from(WIDTH * HEIGHT);
    let expected = (16.0 * NOISE_AFTER as f64 + 24.0 * 833.0) / 40.0;
    // The two halves of a block stop at different times, and both go on until the later one.
    assert!((0.8..1.4).contains(&(per_pixel / expected)), "{per_pixel} instead of {expected}");
}

#[test]
fn a_picture_without_noise_stops_as_soon_as_it_may() {
    let rendered = render(&settings(0.01, 0), |_, _, _, _| Rgb::ONE);
    assert_eq!((rendered.film.samples(), rendered.ended), (NOISE_AFTER, Ended::Complete));
    assert!(rendered.film.means().all(|mean| mean == Rgb::ONE));
}

#[test]
fn samples_are_the_upper_limit() {
    let rendered = render(&settings(1e-6, 100), uneven(1));
    assert_eq!((rendered.film.samples(), rendered.ended), (100, Ended::OutOfSamples));
}

#[test]
fn as_many_samples_as_were_taken_make_the_same_picture() {
    let free = render(&settings(0.05, 0), uneven(1));
    let limited = render(&settings(0.05, free.film.samples()), uneven(1));
    assert_eq!(bits(&free), bits(&limited));
}

/// The mean over pictures of both ways against each other (Welch's test) and against the truth, which is 1.
fn assert_unbiased<F, S>(noise: f64, sample: F)
where
    F: Fn(u64) -> S,
    S: Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync,
{
    let (mut adaptive, mut fixed) = (Moments::default(), Moments::default());
    for seed in 0..60 {
        let rendered = render(&settings(noise, 0), sample(seed));
        assert!(rendered.film.samples() > NOISE_AFTER, "no block went on");
        adaptive.add(mean(&rendered));
        fixed.add(mean(&render(&Settings::new(WIDTH, HEIGHT, 128, 1), sample(1000 + seed))));
    }
    let error = adaptive.standard_error().hypot(fixed.standard_error());
    assert!(two_sided_tail((adaptive.mean() - fixed.mean()) / error) > SIGNIFICANCE);
    assert!(adaptive.p_value(1.0) > SIGNIFICANCE, "{} +- {}", adaptive.mean(), adaptive.standard_error());
}

#[test]
fn stopping_does_not_bias_a_plain_picture() {
    assert_unbiased(0.06, uneven);
}

#[test]
fn stopping_does_not_bias_a_picture_of_fireflies() {
    // Some 600 samples a pixel, of which six are fireflies.
    assert_unbiased(0.2, fireflies);
}

#[test]
fn the_error_that_is_reached_is_that_asked_for() {
    let settings = settings(0.03, 0);
    let relative = |mean: Rgb| (mean.x - 1.0) * (mean.x - 1.0) / 1.01;
    let mut squares = Moments::default();
    for seed in 0..8 {
        let film = render(&settings, uneven(seed)).film;
        // The right blocks, which alone stop by their error.
        let right = film.means().enumerate().filter(|(pixel, _)| pixel % WIDTH as usize >= 16);
        right.for_each(|(_, mean)| squares.add(relative(mean)));
    }
    let ratio = squares.mean().sqrt() / 0.03;
    // A block of 256 pixels is judged by 3 degrees of freedom each: to 5 % of its square, and stops when it first seems good.
    assert!((0.9..1.1).contains(&ratio), "{ratio}");
}

#[test]
fn uneven_noise_is_lower_than_with_as_many_samples_everywhere() {
    let relative =
        |rendered: &Rendered| rendered.film.means().map(|mean| (mean.x - 1.0) * (mean.x - 1.0)).sum::<f64>();
    let (mut adaptive, mut fixed) = (0.0, 0.0);
    for seed in 0..8 {
        let rendered = render(&settings(0.02, 0), uneven(seed));
        let samples = rendered.samples / u64::from(WIDTH * HEIGHT);
        adaptive += relative(&rendered);
        fixed += relative(&render(&Settings::new(WIDTH, HEIGHT, samples, 1), uneven(seed + 100)));
    }
    assert!(adaptive < fixed, "{adaptive} against {fixed}");
}

#[test]
fn settings_of_noise_that_cannot_be_are_refused() {
    for noise in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(settings(noise, 10).check().is_err());
    }
    assert!(Settings::new(WIDTH, HEIGHT, 0, 1).check().is_err());
    assert!(settings(0.1, 0).check().is_ok());
}

#[test]
fn both_samplers_stop() {
    for sampler in SamplerKind::ALL {
        let rendered = render(&Settings { sampler, ..settings(0.05, 0) }, uneven(3));
        assert_eq!(rendered.ended, Ended::Complete);
        assert!(rendered.error.is_some());
    }
}
