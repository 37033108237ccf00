//! Renders within a time. Nothing is asserted about how long they take.

use super::scenes::Subject;
use crate::support::watch::Unwatched;
use pathtracer::integrator::Counters;
use pathtracer::math::Rgb;
use pathtracer::render::{Ended, MIN_TIME, Settings, accumulate};
use pathtracer::sampling::SamplerKind;
use std::time::Duration;

/// A render without a limit of samples.
fn settings(width: u32, height: u32) -> Settings {
    Settings { time: Some(MIN_TIME), threads: Some(2), ..Settings::new(width, height, 0, 8) }
}

#[test]
fn as_many_samples_as_were_taken_make_the_same_picture() {
    let subject = Subject::new("sky");
    for sampler in SamplerKind::ALL {
        let timed = Settings { sampler, ..settings(48, 36) };
        let rendered = subject.render(&timed);
        assert_eq!(rendered.ended, Ended::OutOfTime);
        let fixed = Settings { time: None, samples: rendered.film.samples(), ..timed };
        assert!(subject.render(&fixed).film.means().eq(rendered.film.means()));
    }
}

#[test]
fn as_many_samples_as_were_taken_make_the_same_picture_with_blocks() {
    let subject = Subject::new("sky");
    let timed = Settings { noise: Some(1e-6), ..settings(48, 36) };
    let rendered = subject.render(&timed);
    assert_eq!(rendered.ended, Ended::OutOfTime);
    let fixed = Settings { time: None, samples: rendered.film.samples(), ..timed };
    assert!(subject.render(&fixed).film.means().eq(rendered.film.means()));
}

#[test]
fn one_sample_is_taken_however_long_it_takes() {
    // Some 200 ms of work a pass on two threads, twice the time that is allowed.
    let slow = |x: u32, _: u32, _: u64, _: &mut Counters| {
        Rgb::splat((0..50_000).fold(f64::from(x), |sum, i| sum + libm::sin(sum + f64::from(i))).abs())
    };
    let rendered = accumulate(&settings(20, 20), &Unwatched, slow).expect("a render without trouble");
    assert!(rendered.film.samples() >= 1);
    assert_eq!(rendered.ended, Ended::OutOfTime);
}

#[test]
fn samples_are_the_upper_limit() {
    let limited = Settings { samples: 3, time: Some(Duration::from_secs(3600)), ..settings(4, 3) };
    let rendered = Subject::new("sky").render(&limited);
    assert_eq!((rendered.film.samples(), rendered.ended), (3, Ended::Complete));
}

#[test]
fn times_that_are_too_short_are_refused() {
    let short = Settings { time: Some(MIN_TIME / 2), ..settings(4, 3) };
    assert!(short.check().is_err());
}
