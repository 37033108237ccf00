//! What the counts of a render mean for its picture.

use super::Rendered;
use crate::math::Rgb;

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
        let pixels = f64::from(self.film.width()) * f64::from(self.film.height());
        let mean = self.film.means().sum::<Rgb>().element_sum() / (3.0 * pixels);
        Some(removed / (mean + removed))
    }
}
