//! Measurements that are repeated in turn, so that whatever else the machine does hits all alike.

use serde::Serialize;
use std::time::Instant;

/// The middle and the range of repeated measurements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// The median.
    pub median: f64,
    /// The smallest.
    pub min: f64,
    /// The largest.
    pub max: f64,
}

impl Spread {
    /// Of at least one number; all zero of none.
    pub fn of(values: &[f64]) -> Spread {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (Some(&min), Some(&max)) = (sorted.first(), sorted.last()) else { return Spread::default() };
        let middle = sorted.len() / 2;
        let median = if sorted.len().is_multiple_of(2) {
            (sorted[middle - 1] + sorted[middle]) / 2.0
        } else {
            sorted[middle]
        };
        Spread { median, min, max }
    }

    /// In another unit.
    pub fn scaled(&self, factor: f64) -> Spread {
        Spread { median: self.median * factor, min: self.min * factor, max: self.max * factor }
    }

    /// Half of the range as a share of the median.
    pub fn relative(&self) -> f64 {
        if self.median > 0.0 { 0.5 * (self.max - self.min) / self.median } else { 0.0 }
    }
}

/// Measures every one of `subjects` in each of `rounds`; the values of a subject in the order of the rounds.
pub fn interleaved<T>(
    rounds: usize,
    subjects: &mut [T],
    mut measure: impl FnMut(&mut T) -> f64,
) -> Vec<Vec<f64>> {
    let mut values = vec![Vec::with_capacity(rounds); subjects.len()];
    for _ in 0..rounds {
        for (subject, values) in subjects.iter_mut().zip(&mut values) {
            values.push(measure(subject));
        }
    }
    values
}

/// A result and the seconds that it took.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}

/// The geometric mean of numbers > 0; zero of none.
pub fn geometric_mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value.ln(), count + 1));
    if count > 0 { (sum / f64::from(count)).exp() } else { 0.0 }
}
