use pathtracer::error::Error;
use pathtracer::film::Region;
use pathtracer::integrator::{Counters, FixedSum};
use pathtracer::math::{EPSILON, Rgb};
use pathtracer::render::{Ended, FIREFLY, Progress, Rendered, Settings, Watch, accumulate};
use std::sync::atomic::{AtomicU64, Ordering};

/// Stops a render once so many samples are taken.
struct StopAt(u64, AtomicU64);

impl Watch for StopAt {
    fn progress(&self, progress: &Progress) {
        self.1.fetch_max(progress.samples, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.1.load(Ordering::Relaxed) >= self.0
    }
}

const PIXELS: u64 = 37 * 23;
const LIMIT: f64 = 1000.0;

fn small(samples: u64) -> Settings {
    Settings { threads: Some(2), tile: Some(8), ..Settings::new(37, 23, samples, 1) }
}

fn clamped(samples: u64) -> Settings {
    Settings { clamp: Some(LIMIT), ..small(samples) }
}

fn run(settings: &Settings, sample: impl Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync) -> Rendered {
    accumulate(settings, &StopAt(u64::MAX, AtomicU64::new(0)), sample).expect("a render without trouble")
}

/// Numbers from e^-20 to e^20.
fn spread(x: u32, y: u32, index: u64, _: &mut Counters) -> Rgb {
    let value = |i: u64| {
        libm::exp(libm::sin((u64::from(x) * 37 + u64::from(y) * 101 + index * 13 + i) as f64) * 20.0)
    };
    Rgb::new(value(0), value(1), value(2))
}

/// The mean of a picture over pixels and components.
fn mean(rendered: &Rendered) -> f64 {
    rendered.film.means().map(Rgb::element_sum).sum::<f64>() / (3 * PIXELS) as f64
}

#[test]
fn a_firefly_is_counted_and_kept() {
    for index in [8, 15, 16 + 8] {
        let rendered = run(&small(32), |x, _, i, _| match (x, i) {
            (0, i) if i == index => Rgb::new(0.0, 1e30, 0.0),
            _ => Rgb::ONE,
        });
        assert_eq!(rendered.counters.fireflies, 23, "sample {index}");
        assert_eq!(rendered.film.means().next().map(|mean| mean.y), Some(1e30 / 32.0));
    }
}

#[test]
fn a_firefly_is_brighter_than_the_named_multiple_of_the_mean_before_it() {
    let last_is = |value: f64| {
        run(&small(16), move |_, _, i, _| {
            Rgb::splat(if i == 15 { value } else { 0.75 * f64::from(i % 3 == 0) })
        })
    };
    assert_eq!(last_is(0.25 * FIREFLY).counters.fireflies, 0);
    assert_eq!(last_is((0.25 * FIREFLY).next_up()).counters.fireflies, PIXELS);
}

#[test]
fn where_all_before_is_black_or_missing_nothing_is_a_firefly() {
    assert_eq!(run(&small(16), |_, _, i, _| Rgb::splat((i / 15) as f64)).counters.fireflies, 0);
    assert_eq!(
        run(&small(16), |_, _, i, _| Rgb::splat(if i == 7 { 1e30 } else { 1.0 })).counters.fireflies,
        0
    );
}

#[test]
fn the_scale_of_the_lights_does_not_change_what_is_a_firefly() {
    let fireflies = |exponent: i32| {
        let factor = 2f64.powi(exponent);
        run(&small(40), |x, y, i, counters| factor * spread(x, y, i, counters)).counters.fireflies
    };
    let expected = fireflies(0);
    assert!(expected > 0);
    assert_eq!([-300, -9, 9, 300].map(fireflies), [expected; 4]);
}

#[test]
fn what_the_limit_made_of_a_sample_is_judged() {
    // A thousand times the limit, but for two of them; the limited ones are all equal.
    let rendered = run(&clamped(16), |_, _, i, _| Rgb::splat(if i % 8 == 0 { 1.0 } else { 1000.0 * LIMIT }));
    assert_eq!((rendered.counters.clamped, rendered.counters.fireflies), (14 * PIXELS, 0));
}

#[test]
fn tiles_and_threads_do_not_change_what_is_counted() {
    let (free, limited) = (run(&small(40), spread), run(&clamped(40), spread));
    assert!(free.counters.fireflies > 0 && limited.counters.clamped > 0);
    for threads in [1, 2, 8] {
        for tile in [None, Some(1), Some(8), Some(64)] {
            for (settings, expected) in [(small(40), &free), (clamped(40), &limited)] {
                let rendered = run(&Settings { threads: Some(threads), tile, ..settings }, spread);
                assert_eq!(rendered.counters, expected.counters);
                assert_eq!(rendered.clamp_bias(), expected.clamp_bias());
                assert_eq!(rendered.film, expected.film);
            }
        }
    }
}

#[test]
fn the_limit_takes_what_it_says() {
    let (free, limited) = (run(&small(40), spread), run(&clamped(40), spread));
    let difference = mean(&free) - mean(&limited);
    // Half a step of 2^-32 limits a sample; in each mean one rounding for each of 40 samples, 851 pixels and some 10
    // other operations.
    let allowed = LIMIT * 2f64.powi(-33) + 2.0 * (40 + PIXELS + 10) as f64 * EPSILON * mean(&free);
    let removed = limited.clamp_removed().expect("a limit");
    assert!((removed - difference).abs() <= allowed, "{removed} instead of {difference}");
    let bias = limited.clamp_bias().expect("a limit");
    assert!((bias - difference / mean(&free)).abs() <= 2.0 * allowed / mean(&free), "{bias}");
    let above = |x, y, i| spread(x, y, i, &mut Counters::default()).max_element() > LIMIT;
    let places = (0..37).flat_map(|x| (0..23).map(move |y| (x, y)));
    let expected =
        places.flat_map(|(x, y)| (0..40).map(move |i| (x, y, i))).filter(|&(x, y, i)| above(x, y, i));
    assert_eq!(limited.counters.clamped, expected.count() as u64);
}

#[test]
fn known_samples_lose_known_parts() {
    let rendered = run(&clamped(16), |_, _, i, _| match i {
        3 => Rgb::new(4.0 * LIMIT, LIMIT, 0.0),
        _ => Rgb::splat(LIMIT),
    });
    assert_eq!(rendered.counters.clamped, PIXELS);
    assert_eq!(rendered.counters.clamp_removed.value(), PIXELS as f64);
    assert_eq!(rendered.clamp_removed(), Some(LIMIT / 16.0));
    // The unclamped mean is (15 + 5 / 3) / 16 limits; at most ten roundings.
    let bias = rendered.clamp_bias().expect("a limit");
    assert!((bias - 1.0 / (15.0 + 5.0 / 3.0)).abs() < (PIXELS + 10) as f64 * EPSILON * bias, "{bias}");
}

/// What is a share of the light is that of the pixels which the render took, not of the whole picture.
#[test]
fn shares_of_the_light_of_a_part_are_those_of_its_own_pixels() {
    let regions = [
        Region::All,
        Region::Crop { left: 3, top: 2, right: 20, bottom: 7 },
        Region::Part { index: 1, count: 4 },
    ];
    for region in regions {
        let rendered = run(&Settings { region, ..clamped(16) }, |_, _, _, counters| {
            counters.last_throughput.add(1.0);
            counters.cut_throughput.add(0.5);
            counters.last_light.add(LIMIT);
            Rgb::splat(4.0 * LIMIT)
        });
        // All numbers are powers of two and small multiples of them, but for the limit and the means: some roundings.
        let near = |share: Option<f64>, expected: f64| {
            assert!(
                share.is_some_and(|share| (share - expected).abs() < 20.0 * EPSILON),
                "{region}: {share:?}"
            );
        };
        near(rendered.clamp_bias(), 0.75);
        // As much as the last segments brought is lost beyond them: a limit beside the limit that was found.
        near(rendered.cut_light(), 0.5);
    }
}

#[test]
fn a_limit_above_all_samples_changes_no_bit() {
    let rendered = run(&Settings { clamp: Some(1e9), ..small(40) }, spread);
    assert_eq!(rendered.film, run(&small(40), spread).film);
    assert_eq!((rendered.counters.clamped, rendered.clamp_bias()), (0, Some(0.0)));
}

#[test]
fn samples_that_are_no_light_are_dropped_and_not_clamped() {
    let rendered = run(&clamped(16), |_, _, _, _| Rgb::new(f64::INFINITY, 1.0, 1.0));
    assert_eq!((rendered.counters.dropped, rendered.counters.clamped), (16 * PIXELS, 0));
    assert_eq!((mean(&rendered), rendered.clamp_bias()), (0.0, Some(0.0)));
}

#[test]
fn a_cancelled_render_counts_what_its_film_holds() {
    let watch = StopAt(PIXELS * 36, AtomicU64::new(0));
    let rendered = accumulate(&clamped(64), &watch, spread).expect("no error");
    assert_eq!(rendered.ended, Ended::Cancelled);
    let expected = run(&clamped(36), spread);
    assert_eq!((rendered.counters, rendered.clamp_bias()), (expected.counters, expected.clamp_bias()));
}

#[test]
fn a_limit_that_is_no_positive_number_is_refused() {
    for limit in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let settings = Settings { clamp: Some(limit), ..small(1) };
        assert!(matches!(settings.check(), Err(Error::Usage(_))), "{limit}");
    }
}

#[test]
fn a_fixed_sum_is_the_same_in_every_order_and_stays_in_range() {
    let values: Vec<f64> = (0..1000).map(|i| spread(i, 0, 0, &mut Counters::default()).x).collect();
    let sum = |values: &mut dyn Iterator<Item = &f64>| {
        let mut sum = FixedSum::default();
        values.for_each(|&value| sum.add(value));
        sum
    };
    let total = sum(&mut values.iter());
    assert_eq!(total, sum(&mut values.iter().rev()));
    // Half a step a number, and a rounding for each of the other sum.
    let plain: f64 = values.iter().sum();
    assert!((total.value() - plain).abs() <= 1000.0 * (2f64.powi(-33) + EPSILON * plain));
    assert_eq!(sum(&mut [0.25, f64::NAN, -1.0, 0.5].iter()).value(), 0.75);
    assert_eq!(sum(&mut [1.0, f64::INFINITY, 1.0].iter()).value(), 2f64.powi(96));
}
