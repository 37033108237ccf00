//! One pixel: from the sums of its scrambles to an interval.

use pathtracer::film::{ErrorBar, Film, Sums, quantile};
use pathtracer::math::Rgb;
use pathtracer::sampling::{SCRAMBLES, Scrambles};

#[test]
fn quantiles_agree_with_tables() {
    // NIST/SEMATECH e-Handbook of Statistical Methods 1.3.6.7.2, three decimals; the expansion is within 0.2 %.
    for (degrees, expected) in [(4.0, 2.776), (6.0, 2.447), (7.0, 2.365), (20.0, 2.086), (100.0, 1.984)] {
        let found = quantile(degrees);
        assert!((found / expected - 1.0).abs() < 0.002, "{degrees}: {found} instead of {expected}");
    }
    assert!((quantile(f64::INFINITY) - 1.96).abs() < 1e-4);
}

#[test]
fn equally_long_scrambles_give_the_textbooks_standard_error() {
    let means = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    let bar = ErrorBar::new(&means.map(|mean: f64| 16.0 * mean), &[16; SCRAMBLES]).expect("all have samples");
    assert_eq!(bar.mean, 4.5);
    // The variance of 1 to 8 is 6.
    assert!((bar.standard_error - (6.0_f64 / 8.0).sqrt()).abs() < 1e-15);
    assert!((bar.half_width() / bar.standard_error - 2.365).abs() < 0.002);
    assert!(!bar.is_doubtful);
}

#[test]
fn a_lone_bright_scramble_is_doubtful() {
    let mut sums = [1.0; SCRAMBLES];
    sums[3] = 50.0;
    assert!(ErrorBar::new(&sums, &[1; SCRAMBLES]).expect("all have samples").is_doubtful);
}

#[test]
fn equal_scrambles_have_no_error_and_no_doubt() {
    let bar = ErrorBar::new(&[3.0; SCRAMBLES], &[1; SCRAMBLES]).expect("all have samples");
    assert_eq!((bar.mean, bar.standard_error, bar.is_doubtful), (3.0, 0.0, false));
}

#[test]
fn fewer_scrambles_tell_nothing() {
    let mut counts = [16; SCRAMBLES];
    counts[7] = 0;
    assert_eq!(ErrorBar::new(&[1.0; SCRAMBLES], &counts), None);
}

#[test]
fn sums_beyond_the_range_of_numbers_tell_nothing() {
    assert_eq!(ErrorBar::new(&[f64::INFINITY; SCRAMBLES], &[1; SCRAMBLES]), None);
    let mut sums = [f64::MAX; SCRAMBLES];
    sums[0] = 0.0;
    assert_eq!(ErrorBar::new(&sums, &[1; SCRAMBLES]), None);
}

/// Chunks of four samples of one pixel, of scrambles of six: some chunks lie in one scramble, others in two.
#[test]
fn a_film_finds_the_sums_of_its_scrambles() {
    let scrambles = Scrambles::new(8);
    let value = |sample: u64| libm::sin(sample as f64) + 2.0;
    let mut film = Film::new(1, 1, 4);
    for chunk in 0..40 {
        let samples = 4 * chunk..4 * chunk + 4;
        let scramble = scrambles.only(samples.clone()).expect("4 divides 8");
        let sum = samples.map(value).sum::<f64>();
        film.add(chunk, Sums::of_scramble(scramble, 4, vec![Rgb::splat(sum)], Vec::new()))
            .expect("a new chunk");
    }
    let (mut sums, counts) = ([0.0; SCRAMBLES], scrambles.counts(160));
    (0..160).for_each(|sample| sums[scrambles.place(sample).scramble] += value(sample));
    assert_eq!(film.counts(), counts);
    let (found, expected) =
        (film.error_bar(0).expect("8 scrambles"), ErrorBar::new(&sums, &counts).expect("8"));
    // Sums of at most 160 numbers were kept in f32.
    assert!((found.mean / expected.mean - 1.0).abs() < 160.0 * f64::from(f32::EPSILON));
    assert!((found.standard_error / expected.standard_error - 1.0).abs() < 1e-3);
}
