//! What the counts of a render mean for its picture.

use super::Rendered;
use crate::math::Rgb;

/// The rate at which throughput is left over is at least so far below 1: 2^-20.
const RATE_STEP: f64 = 1.0 / 1_048_576.0;

impl Rendered {
    /// Samples taken, of all pixels.
    pub fn samples(&self) -> f64 {
        self.samples as f64
    }

    /// The share, 0 to 1, of the samples' starting throughput that arrived at a surface with the last segment of a path
    /// and was not followed any further. It bounds what the limit of bounces costs: where the light beyond has the
    /// radiance L on average, the picture lacks at most this share of L.
    pub fn cut_share(&self) -> f64 {
        self.counters.cut_throughput.value() / self.samples().max(1.0)
    }

    /// What the paths that were cut would have brought, as a share, 0 to 1, of all light that would then be in the picture:
    /// an estimate from the light that the last segments brought, which longer ones would bring in proportion to the
    /// throughput they have left, shrinking at the same rate from each to the next. `None` without light, and where paths
    /// of one segment don't tell a rate.
    ///
    /// In a closed room with walls of one albedo and emission this is exact.
    pub fn cut_light(&self) -> Option<f64> {
        let counters = &self.counters;
        let last = self.brightest * counters.last_light.value();
        let (before, after) = (counters.last_throughput.value(), counters.cut_throughput.value());
        if after > 0.0 && before == 0.0 {
            return None;
        }
        // Where all throughput is left after a step, no sum of steps ends.
        let rate = (after / before).min(1.0 - RATE_STEP);
        let cut = if after > 0.0 { last * rate / (1.0 - rate) } else { 0.0 };
        let found = self.mean_radiance() * self.samples();
        (cut + found > 0.0).then(|| cut / (cut + found))
    }

    /// The mean over pixels and components; of a part, over its own pixels.
    fn mean_radiance(&self) -> f64 {
        self.film.means().sum::<Rgb>().element_sum() / (3.0 * self.film.pixels() as f64)
    }

    /// How much darker the mean of the picture (over pixels and components) is for [`Rendered::clamp`], in units of
    /// radiance; `None` without a limit. Each clamped sample was rounded to 2^-32 of the limit.
    pub fn clamp_removed(&self) -> Option<f64> {
        let limit = self.clamp?;
        Some(limit * (self.counters.clamp_removed.value() / self.samples().max(1.0)))
    }

    /// The share, 0 to 1, of the light of the unclamped picture that [`Rendered::clamp`] took away; `None` without a
    /// limit.
    pub fn clamp_bias(&self) -> Option<f64> {
        let removed = self.clamp_removed()?;
        if removed == 0.0 {
            return Some(0.0);
        }
        Some(removed / (self.mean_radiance() + removed))
    }
}
