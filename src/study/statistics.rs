//! Estimates with intervals.

use super::random::Random;
use serde::Serialize;

/// How sure an interval is.
pub const CONFIDENCE: f64 = 0.95;

/// A number with its standard error and its interval of 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
    /// The standard deviation of the estimate.
    pub standard_error: f64,
}

impl Estimate {
    /// In another unit; the factor is > 0.
    pub fn scaled(&self, factor: f64) -> Estimate {
        Estimate {
            value: self.value * factor,
            low: self.low * factor,
            high: self.high * factor,
            standard_error: self.standard_error * factor,
        }
    }

    /// Half the width of the interval as a share of the value.
    pub fn relative(&self) -> f64 {
        if self.value == 0.0 { 0.0 } else { 0.5 * (self.high - self.low) / self.value.abs() }
    }
}

/// Resamples of `count` observations, drawn once: statistics of the same observations are resampled together, so that
/// their ratios have intervals too.
#[derive(Clone, Debug)]
pub struct Bootstrap {
    whole: Vec<usize>,
    resamples: Vec<Vec<usize>>,
    /// The probability beyond each end of an interval.
    tail: f64,
}

impl Bootstrap {
    /// `resamples` draws of `count` observations with replacement, from a fixed seed.
    ///
    /// Intervals are percentiles, the tails narrowed so that the mean of few normal observations is covered as often as
    /// by Student's interval: the plain ones would be too narrow by sqrt((n - 1) / n) and by the normal quantile in place of
    /// Student's (Hesterberg, "What Teachers Should Know About the Bootstrap", The American Statistician 69, 2015,
    /// section 5.3).
    pub fn new(count: usize, resamples: usize, seed: u64) -> Bootstrap {
        let mut random = Random::new(seed);
        let draw = |_| (0..count).map(|_| random.index(count.max(1))).collect();
        let tail = if count > 1 {
            let n = count as f64;
            normal_tail((n / (n - 1.0)).sqrt() * student_quantile(count - 1))
        } else {
            0.0
        };
        Bootstrap { whole: (0..count).collect(), resamples: (0..resamples).map(draw).collect(), tail }
    }

    /// A statistic of the observations with the given indices: of all, and its interval. Resamples for which it is not a
    /// number are left out.
    pub fn estimate(&self, statistic: impl Fn(&[usize]) -> f64) -> Estimate {
        let value = statistic(&self.whole);
        let mut values: Vec<f64> =
            self.resamples.iter().map(|indices| statistic(indices)).filter(|x| !x.is_nan()).collect();
        values.sort_by(f64::total_cmp);
        let (Some(low), Some(high)) = (percentile(&values, self.tail), percentile(&values, 1.0 - self.tail))
        else {
            return Estimate { value, low: value, high: value, standard_error: 0.0 };
        };
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let spread = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n;
        // A resample has the variance of the observations as they are, which is (n - 1) / n of the estimate.
        let count = self.whole.len() as f64;
        let standard_error = (spread * count / (count - 1.0).max(1.0)).sqrt();
        Estimate { value, low, high, standard_error }
    }

    /// The mean of observations.
    pub fn mean(&self, values: &[f64]) -> Estimate {
        self.estimate(|indices| mean_of(values, indices))
    }

    /// What comes of all observations, and then of every resample.
    pub fn map<T>(&self, of: impl Fn(&[usize]) -> T) -> Vec<T> {
        std::iter::once(&self.whole).chain(&self.resamples).map(|indices| of(indices)).collect()
    }
}

/// The mean of the values at indices.
pub fn mean_of(values: &[f64], indices: &[usize]) -> f64 {
    indices.iter().map(|&i| values[i]).sum::<f64>() / indices.len() as f64
}

/// The median of the values at indices; NaN of none.
pub fn median_of(values: &[f64], indices: &[usize]) -> f64 {
    let mut chosen: Vec<f64> = indices.iter().map(|&i| values[i]).collect();
    chosen.sort_by(f64::total_cmp);
    percentile(&chosen, 0.5).unwrap_or(f64::NAN)
}

/// The value below which a share of sorted values lies, between neighbours by proportion; `None` of none.
pub fn percentile(sorted: &[f64], share: f64) -> Option<f64> {
    let place = share.clamp(0.0, 1.0) * (sorted.len().checked_sub(1)?) as f64;
    let below = place.floor() as usize;
    let (a, b) = (sorted[below], sorted[(below + 1).min(sorted.len() - 1)]);
    // Infinities would make NaN of the proportion.
    Some(if a == b { a } else { a + (b - a) * (place - below as f64) })
}

/// The slope of the line through points that is best by least squares.
pub fn slope(points: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let n = points.clone().count() as f64;
    let (sum_x, sum_y) = points.clone().fold((0.0, 0.0), |(sx, sy), (x, y)| (sx + x, sy + y));
    let (mean_x, mean_y) = (sum_x / n, sum_y / n);
    let (xy, xx) = points.fold((0.0, 0.0), |(xy, xx), (x, y)| {
        (xy + (x - mean_x) * (y - mean_y), xx + (x - mean_x) * (x - mean_x))
    });
    xy / xx
}

/// Which of the points (cost, error) no other one beats in both: the Pareto front. Of equal points all are on it.
pub fn pareto_front(points: &[(f64, f64)]) -> Vec<bool> {
    let beats = |a: &(f64, f64), b: &(f64, f64)| a.0 <= b.0 && a.1 <= b.1 && (a.0 < b.0 || a.1 < b.1);
    points.iter().map(|point| !points.iter().any(|other| beats(other, point))).collect()
}

/// The interval of 95 % confidence for a probability of which `hits` of `trials` came true (Wilson 1927).
pub fn share_interval(hits: u64, trials: u64) -> (f64, f64) {
    /// The normal quantile of 97.5 %.
    const Z: f64 = 1.959_963_984_540_054;
    let (n, p) = (trials.max(1) as f64, hits as f64 / trials.max(1) as f64);
    let middle = (p + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
    let half = Z / (1.0 + Z * Z / n) * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    (if hits == 0 { 0.0 } else { middle - half }, middle + half)
}

/// The probability that a normal variable exceeds z.
fn normal_tail(z: f64) -> f64 {
    0.5 * libm::erfc(z * std::f64::consts::FRAC_1_SQRT_2)
}

/// Student's quantile of 97.5 %, by Newton's method on its tail.
pub fn student_quantile(degrees: usize) -> f64 {
    let wanted = 0.5 * (1.0 - CONFIDENCE);
    // The tail falls and is convex above 0, so steps from the left never overshoot.
    let mut t = 1.0;
    for _ in 0..60 {
        t += (student_tail(t, degrees) - wanted) / student_density(t, degrees);
    }
    t
}

fn student_density(t: f64, degrees: usize) -> f64 {
    let n = degrees as f64;
    let log = libm::lgamma(0.5 * (n + 1.0)) - libm::lgamma(0.5 * n) - 0.5 * (n * std::f64::consts::PI).ln();
    libm::exp(log - 0.5 * (n + 1.0) * libm::log1p(t * t / n))
}

/// The probability that Student's variable exceeds t, from the finite sums of Abramowitz and Stegun 26.7.3 and 26.7.4.
fn student_tail(t: f64, degrees: usize) -> f64 {
    let n = degrees as f64;
    let angle = libm::atan(t / n.sqrt());
    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
    let odd = degrees % 2 == 1;
    let mut term = if odd { cos } else { 1.0 };
    let mut sum = if degrees == 1 { 0.0 } else { term };
    let mut k = if odd { 3 } else { 2 };
    while k < degrees {
        let (above, below) = (f64::from(k as u32 - 1), f64::from(k as u32));
        term *= cos * cos * above / below;
        sum += term;
        k += 2;
    }
    let within = if odd { (angle + sin * sum) * std::f64::consts::FRAC_2_PI } else { sin * sum };
    0.5 * (1.0 - within)
}
