//! The error of one pixel from the means of its scrambles.

use super::Film;
use super::student::quantile;
use crate::sampling::SCRAMBLES;

/// How far a pixel is from the truth. All is about the mean of its components, as radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorBar {
    /// The estimate.
    pub mean: f64,
    /// Of the mean.
    pub standard_error: f64,
    /// Of the standard error: one less than there are scrambles.
    pub degrees: f64,
    /// Whether one scramble differs so much from the others that Student's interval is likely too narrow.
    pub is_doubtful: bool,
}

/// One scramble's share of the sum of squares above which it is an outlier: at 1 % of normal data (Grubbs 1950: the most
/// of 8 values is 2.274 standard deviations away, whose square is this share of the 7 in the sum).
const OUTLIER: f64 = 0.739;

impl ErrorBar {
    /// From the sums of all scrambles and how many samples each holds, which may differ by a factor of two; `None` where
    /// one has no samples or a sum is not finite.
    ///
    /// With weights w = n_r / n the mean is that of all samples, and the sum of w (m_r - m)^2 / 7 estimates its variance
    /// without bias if the variance of m_r goes as 1 / n_r; if it falls faster, it is a little too large.
    pub fn new(sums: &[f64; SCRAMBLES], counts: &[u64; SCRAMBLES]) -> Option<ErrorBar> {
        if counts.contains(&0) {
            return None;
        }
        let samples = counts.iter().sum::<u64>() as f64;
        let mean = sums.iter().sum::<f64>() / samples;
        let squares: [f64; SCRAMBLES] = std::array::from_fn(|r| {
            let apart = sums[r] / counts[r] as f64 - mean;
            counts[r] as f64 / samples * (apart * apart)
        });
        let total = squares.iter().sum::<f64>();
        let degrees = (SCRAMBLES - 1) as f64;
        let largest = squares.iter().fold(0.0, |a: f64, &b| a.max(b));
        let is_doubtful = largest > OUTLIER * total;
        let bar = ErrorBar { mean, standard_error: (total / degrees).sqrt(), degrees, is_doubtful };
        (bar.standard_error.is_finite() && mean.is_finite()).then_some(bar)
    }

    /// Half of the width of the 95 % interval around the mean.
    pub fn half_width(&self) -> f64 {
        quantile(self.degrees) * self.standard_error
    }
}

impl Film {
    /// The error of a pixel, counted row by row from the top left; `None` while fewer than 8 scrambles have samples.
    pub fn error_bar(&self, pixel: usize) -> Option<ErrorBar> {
        self.error_bar_of(pixel, &self.counts())
    }

    /// [`Film::error_bar`] with the film's counts, which are the same for all pixels.
    pub(super) fn error_bar_of(&self, pixel: usize, counts: &[u64; SCRAMBLES]) -> Option<ErrorBar> {
        let mut sums = [0.0; SCRAMBLES];
        self.nodes.iter().for_each(|node| node.sums.greys.add_to(&mut sums, pixel));
        ErrorBar::new(&sums, counts)
    }
}
