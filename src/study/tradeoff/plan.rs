//! How many samples an error takes, and how long they last.

use crate::render::MAX_SAMPLES;
use crate::study::statistics::slope;

/// What was measured of a variant, in the order of its numbers of samples, which ascend.
#[derive(Clone, Debug)]
pub struct Curve<'c> {
    /// Samples a pixel.
    pub samples: &'c [u64],
    /// The part of the relMSE that falls with the samples.
    pub variances: Vec<f64>,
    /// Seconds of a render.
    pub seconds: Vec<f64>,
    /// The part that does not: the square of the bias.
    pub floor: f64,
}

/// The samples for an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Samples a pixel, rounded up.
    pub samples: u64,
    /// Seconds of sampling.
    pub seconds: f64,
    /// Whether more or fewer samples are needed than were measured.
    pub extrapolated: bool,
}

impl Curve<'_> {
    /// The fewest samples with which the error is at most `target`: between measured numbers along a power law, beyond
    /// them along the fitted one. `None` if the bias alone is more, or the samples are too many.
    pub fn plan(&self, target: f64) -> Option<Plan> {
        let goal = target - self.floor;
        let (&first, &last) = (self.samples.first()?, self.samples.last()?);
        if goal.is_nan() || goal <= 0.0 || self.variances.iter().any(|variance| !variance.is_finite()) {
            return None;
        }
        let exact = self.samples_for(goal);
        // Not one more for the rounding of a logarithm.
        let samples = (exact * (1.0 - 1e-9)).ceil().max(1.0);
        (samples <= MAX_SAMPLES as f64).then(|| Plan {
            samples: samples as u64,
            seconds: self.seconds_for(samples),
            extrapolated: samples > last as f64 || samples < first as f64,
        })
    }

    fn samples_for(&self, goal: f64) -> f64 {
        let n = |i: usize| self.samples[i] as f64;
        let inside = (1..self.samples.len())
            .find(|&i| self.variances[i - 1] >= goal && goal >= self.variances[i] && self.variances[i] > 0.0);
        if let Some(i) = inside {
            return power_between((self.variances[i - 1], n(i - 1)), (self.variances[i], n(i)), goal);
        }
        let from = if goal > self.variances[0] { 0 } else { self.samples.len() - 1 };
        if self.variances[from] <= 0.0 {
            return n(from);
        }
        n(from) * (goal / self.variances[from]).powf(1.0 / self.rate())
    }

    /// The power of the samples with which the variance goes: -1 for independent samples and where nothing is known, never
    /// so flat or steep that noise would rule.
    fn rate(&self) -> f64 {
        let points = self.samples.iter().zip(&self.variances).filter(|(_, variance)| **variance > 0.0);
        let rate = slope(points.map(|(&n, variance)| ((n as f64).ln(), variance.ln())));
        if rate.is_finite() { rate.clamp(-2.0, -0.5) } else { -1.0 }
    }

    fn seconds_for(&self, samples: f64) -> f64 {
        let n = |i: usize| self.samples[i] as f64;
        let last = self.samples.len() - 1;
        match (1..=last).find(|&i| n(i - 1) <= samples && samples <= n(i)) {
            Some(i) => power_between((n(i - 1), self.seconds[i - 1]), (n(i), self.seconds[i]), samples),
            None if samples < n(0) => self.seconds[0] * samples / n(0),
            None => self.seconds[last] * samples / n(last),
        }
    }
}

/// y at x on the power law through two points.
fn power_between((x0, y0): (f64, f64), (x1, y1): (f64, f64), x: f64) -> f64 {
    if x0 == x1 {
        return y0;
    }
    y0 * (y1 / y0).powf((x / x0).ln() / (x1 / x0).ln())
}
