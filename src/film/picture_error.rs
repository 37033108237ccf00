//! The error of a whole picture, estimated without knowing the truth.

use super::Film;
use super::student::quantile;
use crate::math::Rgb;
use rayon::prelude::*;
use std::ops::Range;

/// How far a picture is from the truth: what is expected of a render like it, estimated from how much its scrambles differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureError {
    /// The root of the relMSE, that is of the mean over pixels and components of (x - truth)^2 / (truth^2 + 0.01).
    pub relative: Estimate,
    /// The mean over pixels and components, as radiance; its interval is that of the truth.
    pub mean: Estimate,
    /// The standard error of `mean`.
    pub standard_error: f64,
    /// Whether a few pixels carry most of the error, so that the intervals are likely too narrow.
    pub is_doubtful: bool,
}

/// A number and its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The estimate.
    pub value: f64,
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

/// Fewer pixels than this, were their errors equal, would know the error as badly.
const FEW_DEGREES: f64 = 20.0;

/// Where the error is estimated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pixels {
    /// At every pixel; the errors are known with so many degrees of freedom.
    All {
        /// Scrambles less one.
        degrees: f64,
    },
    /// At a few that stand for all of this many.
    Some {
        /// Pixels of the picture.
        of: f64,
        /// Values of a pixel less one.
        degrees: f64,
    },
}

/// Adds up pixels.
#[derive(Clone, Copy, Debug, Default)]
pub struct PictureErrorSum {
    count: f64,
    mean: f64,
    relative: Weighted,
    variance: Weighted,
}

/// Sums of a number x and its weights w.
#[derive(Clone, Copy, Debug, Default)]
struct Weighted {
    w: f64,
    w_x: f64,
    w2: f64,
    w2_x: f64,
    w2_x2: f64,
}

impl PictureErrorSum {
    /// Adds a pixel that stands for `weight` pixels: its expected (x - truth)^2 / (truth^2 + 0.01), mean of the components,
    /// and the variance of the mean of its components.
    pub fn add(&mut self, weight: f64, relative_square: f64, variance: f64) {
        self.count += 1.0;
        self.relative.add(weight, relative_square);
        self.variance.add(weight, variance);
    }

    /// Adds the mean of a pixel's components to that of the picture.
    pub fn add_mean(&mut self, mean: f64) {
        self.mean += mean;
    }

    /// The error of the picture; `None` without pixels or where a number is not finite.
    pub fn finish(&self, pixels: Pixels) -> Option<PictureError> {
        let all = match pixels {
            Pixels::All { .. } => self.count,
            Pixels::Some { of, .. } => of,
        };
        let relative = self.relative.mean(pixels, self.count)?;
        let variance = self.variance.mean(pixels, self.count)?;
        PictureError::new(self.mean / all, all, relative, variance)
    }

    fn with(mut self, other: &PictureErrorSum) -> PictureErrorSum {
        self.count += other.count;
        self.mean += other.mean;
        self.relative.join(&other.relative);
        self.variance.join(&other.variance);
        self
    }
}

impl PictureError {
    /// From the mean of so many pixels, the means over them of the squares of the relative error and of the variance, each with
    /// its degrees of freedom; `None` where a number is not finite.
    pub(super) fn new(
        mean: f64,
        pixels: f64,
        (relative, relative_degrees): (f64, f64),
        (variance, variance_degrees): (f64, f64),
    ) -> Option<PictureError> {
        let standard_error = (variance / pixels).sqrt();
        let half_width = quantile(variance_degrees) * standard_error;
        // A mean of squares is about a chi-square variable: its logarithm has the variance 2 / degrees, that of its root a
        // quarter of that.
        let root = relative.sqrt();
        let factor = libm::exp(quantile(relative_degrees) * (0.5 / relative_degrees).sqrt());
        let error = PictureError {
            relative: Estimate { value: root, low: root / factor, high: root * factor },
            mean: Estimate { value: mean, low: mean - half_width, high: mean + half_width },
            standard_error,
            is_doubtful: variance_degrees.min(relative_degrees) < FEW_DEGREES,
        };
        (root.is_finite() && mean.is_finite() && half_width.is_finite()).then_some(error)
    }
}

impl Weighted {
    fn add(&mut self, weight: f64, x: f64) {
        self.join(&Weighted {
            w: weight,
            w_x: weight * x,
            w2: weight * weight,
            w2_x: weight * weight * x,
            w2_x2: weight * weight * x * x,
        });
    }

    fn join(&mut self, other: &Weighted) {
        self.w += other.w;
        self.w_x += other.w_x;
        self.w2 += other.w2;
        self.w2_x += other.w2_x;
        self.w2_x2 += other.w2_x2;
    }

    /// The weighted mean, and the degrees of freedom of the chi-square variable that is as uncertain (Satterthwaite 1946).
    fn mean(&self, pixels: Pixels, count: f64) -> Option<(f64, f64)> {
        if self.w == 0.0 {
            return None;
        }
        let mean = self.w_x / self.w;
        // An estimated variance s^2 of k degrees has the variance 2 s^4 / (k + 2), as estimated from itself.
        let of_pixels = |degrees: f64| self.w2_x2 * 2.0 / (degrees + 2.0);
        let spread = match pixels {
            Pixels::All { degrees } => of_pixels(degrees),
            Pixels::Some { degrees, .. } => {
                let apart = self.w2_x2 - 2.0 * mean * self.w2_x + mean * mean * self.w2;
                (apart * count / (count - 1.0).max(1.0)).max(of_pixels(degrees))
            }
        };
        let spread = spread / (self.w * self.w);
        let degrees = if spread > 0.0 { 2.0 * mean * mean / spread } else { f64::INFINITY };
        Some((mean, degrees.max(1.0)))
    }
}

impl Film {
    /// The error of the picture from that of all its pixels; `None` while fewer than 8 scrambles have samples.
    ///
    /// What is known of a pixel is the error of the mean of its components; that of each is taken to be proportional to the
    /// component. Rows are worked on side by side and added in order.
    pub fn picture_error(&self) -> Option<PictureError> {
        let row = |pixels: Range<usize>| self.error_sum(pixels.map(|pixel| (pixel, 1.0)));
        let rows: Vec<PictureErrorSum> = self.rows().into_par_iter().map(row).collect::<Option<_>>()?;
        let sum = rows.iter().fold(PictureErrorSum::default(), PictureErrorSum::with);
        sum.finish(Pixels::All { degrees: self.error_bar(0)?.degrees })
    }

    /// The errors of some pixels, each of which stands for so many.
    pub(crate) fn error_sum(&self, pixels: impl Iterator<Item = (usize, f64)>) -> Option<PictureErrorSum> {
        let counts = self.counts();
        let weight = 1.0 / self.samples().max(1) as f64;
        let mut sum = PictureErrorSum::default();
        for (pixel, stands_for) in pixels {
            let bar = self.error_bar_of(pixel, &counts)?;
            let variance = bar.standard_error * bar.standard_error;
            let relative = variance * relative_weight(self.mean(pixel, weight), bar.mean);
            sum.add(stands_for, relative, variance);
            sum.add_mean(stands_for * bar.mean);
        }
        Some(sum)
    }

    /// The deviation of the first samples of a pixel, where it is known.
    pub(crate) fn deviation(&self, pixel: usize) -> Option<f64> {
        let first = self.nodes.first().filter(|node| node.first == 0)?;
        first.sums.deviations.get(pixel).map(|&deviation| deviation.into())
    }

    /// The pixels in runs as long as the picture's rows.
    pub(super) fn rows(&self) -> Vec<Range<usize>> {
        let (width, pixels) = (self.width() as usize, self.pixels());
        (0..pixels).step_by(width).map(|start| start..pixels.min(start + width)).collect()
    }
}

/// What makes a variance of the mean of a pixel's components the expectation of (x - truth)^2 / (truth^2 + 0.01), mean of
/// the components, where the error of each is proportional to it.
pub(crate) fn relative_weight(mean: Rgb, grey: f64) -> f64 {
    if grey == 0.0 {
        return 0.0;
    }
    let share = |component: f64| (component / grey) * (component / grey) / (component * component + 0.01);
    mean.to_array().into_iter().map(share).sum::<f64>() / 3.0
}
