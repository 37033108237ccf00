//! Estimates and intervals: known answers, and how often intervals hold the truth.

use crate::support::random::Random;
use pathtracer::study::statistics::{
    Bootstrap, mean_of, median_of, pareto_front, percentile, share_interval, slope, student_quantile,
};

#[test]
fn students_quantile_agrees_with_tables() {
    // NIST/SEMATECH e-Handbook of Statistical Methods 1.3.6.7.2, three decimals.
    for (degrees, quantile) in [(1, 12.706), (2, 4.303), (3, 3.182), (7, 2.365), (15, 2.131), (100, 1.984)] {
        assert!((student_quantile(degrees) - quantile).abs() < 5.1e-4, "{degrees}");
    }
}

#[test]
fn the_slope_of_a_power_law_is_its_power() {
    let points = [1.0f64, 4.0, 16.0, 64.0].map(|n| (n.ln(), (3.0 * n.powf(-1.25)).ln()));
    // Logarithms of a few units round to 1e-16.
    assert!((slope(points.into_iter()) + 1.25).abs() < 1e-14);
}

#[test]
fn percentiles_lie_between_neighbours() {
    let sorted = [1.0, 2.0, 4.0];
    assert_eq!(percentile(&sorted, 0.0), Some(1.0));
    assert_eq!(percentile(&sorted, 0.5), Some(2.0));
    assert_eq!(percentile(&sorted, 0.75), Some(3.0));
    assert_eq!(percentile(&sorted, 1.0), Some(4.0));
    assert_eq!(percentile(&[], 0.5), None);
}

#[test]
fn means_and_medians_are_of_the_chosen_values() {
    let values = [1.0, 10.0, 100.0, 7.0];
    assert_eq!(mean_of(&values, &[0, 0, 2]), 34.0);
    assert_eq!(median_of(&values, &[0, 2, 3]), 7.0);
    assert_eq!(median_of(&values, &[0, 0, 1, 1]), 5.5);
}

#[test]
fn the_front_is_what_nothing_beats() {
    let points = [(1.0, 9.0), (2.0, 5.0), (2.0, 6.0), (3.0, 5.0), (4.0, 1.0), (4.0, 1.0), (9.0, 2.0)];
    assert_eq!(pareto_front(&points), [true, true, false, false, true, true, false]);
}

#[test]
fn intervals_of_shares_are_wilsons() {
    // Newcombe, "Two-sided confidence intervals for the single proportion", Statistics in Medicine 17, 1998, table I,
    // method 3, four decimals.
    for (hits, trials, low, high) in
        [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611)]
    {
        let (a, b) = share_interval(hits, trials);
        assert!((a - low).abs() < 5.1e-5 && (b - high).abs() < 5.1e-5, "{hits} of {trials}: {a} {b}");
    }
}

#[test]
fn the_standard_error_of_a_mean_is_the_textbooks() {
    let mut random = Random::new(4);
    let values: Vec<f64> = (0..16).map(|_| random.unit()).collect();
    let mean = values.iter().sum::<f64>() / 16.0;
    let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / 15.0;
    let estimate = Bootstrap::new(16, 20_000, 1).mean(&values);
    assert_eq!(estimate.value, mean_of(&values, &(0..16).collect::<Vec<usize>>()));
    // The spread of 20,000 resamples has a relative standard deviation of 1 / sqrt(40,000) = 0.5 %; four of them.
    let ratio = estimate.standard_error / (variance / 16.0).sqrt();
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
    assert!(estimate.low < estimate.value && estimate.value < estimate.high);
}

#[test]
fn the_same_seed_gives_the_same_interval() {
    let values: Vec<f64> = (0..8).map(f64::from).collect();
    assert_eq!(Bootstrap::new(8, 300, 5).mean(&values), Bootstrap::new(8, 300, 5).mean(&values));
    assert_ne!(Bootstrap::new(8, 300, 5).mean(&values).low, Bootstrap::new(8, 300, 6).mean(&values).low);
}

#[test]
fn intervals_hold_the_mean_of_normal_values_nineteen_times_in_twenty() {
    const TRIALS: usize = 2000;
    const COUNT: usize = 16;
    let bootstrap = Bootstrap::new(COUNT, 1000, 3);
    let mut random = Random::new(9);
    // Box and Muller 1958.
    let mut normal = || {
        let radius = (-2.0 * (1.0 - random.unit()).ln()).sqrt();
        radius * (std::f64::consts::TAU * random.unit()).cos()
    };
    let mut held = 0;
    for _ in 0..TRIALS {
        let values: Vec<f64> = (0..COUNT).map(|_| 5.0 + normal()).collect();
        let estimate = bootstrap.mean(&values);
        held += usize::from(estimate.low <= 5.0 && 5.0 <= estimate.high);
    }
    let share = held as f64 / TRIALS as f64;
    // Four standard deviations of a binomial share are 4 sqrt(0.95 0.05 / 2000) = 0.0195. That all trials share 1000 resamples
    // moves an end, a percentile p = 1.4 %, by up to 4 sqrt(p / 1000) / (3.5 p) = 0.3 of its tail's probability: 0.008.
    assert!((share - 0.95).abs() < 0.0195 + 0.008, "{share}");
}
