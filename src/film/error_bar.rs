//! The error of one pixel from the means of its scrambles.

use super::student::quantile;
use super::{Film, HALVES};
use crate::sampling::SCRAMBLES;

/// How far a pixel is from the truth. All is about the mean of its components, as radiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorBar {
    /// The estimate.
    pub mean: f64,
    /// Of the mean.
    pub standard_error: f64,
    /// Of the standard error: the scrambles less one for each mean that was taken.
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
        ErrorBar::of_groups(sums, counts, 1)
    }

    /// The same of the mean of the means of both halves of the scrambles: see [`BLOCK`](super::BLOCK).
    pub fn of_halves(sums: &[f64; SCRAMBLES], counts: &[u64; SCRAMBLES]) -> Option<ErrorBar> {
        ErrorBar::of_groups(sums, counts, HALVES)
    }

    /// Of the mean of the means of so many groups, to which the scrambles belong in turn.
    fn of_groups(sums: &[f64; SCRAMBLES], counts: &[u64; SCRAMBLES], groups: usize) -> Option<ErrorBar> {
        if counts.contains(&0) {
            return None;
        }
        let (mut mean, mut squares) = (0.0, [0.0; SCRAMBLES]);
        let each = 1.0 / groups as f64;
        for group in 0..groups {
            let members = || (group..SCRAMBLES).step_by(groups);
            let samples = members().map(|r| counts[r]).sum::<u64>() as f64;
            let of_group = members().map(|r| sums[r]).sum::<f64>() / samples;
            mean += each * of_group;
            for r in members() {
                let apart = each * (sums[r] / counts[r] as f64 - of_group);
                squares[r] = counts[r] as f64 / samples * (apart * apart);
            }
        }
        let total = squares.iter().sum::<f64>();
        let degrees_each = (SCRAMBLES / groups - 1) as f64;
        let largest = squares.iter().fold(0.0, |a: f64, &b| a.max(b));
        let bar = ErrorBar {
            mean,
            standard_error: (total / degrees_each).sqrt(),
            degrees: degrees_each * groups as f64,
            is_doubtful: largest > OUTLIER * total,
        };
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

    /// [`Film::error_bar`] with the film's counts, which are the same for all pixels where no block has stopped.
    pub(super) fn error_bar_of(&self, pixel: usize, counts: &[u64; SCRAMBLES]) -> Option<ErrorBar> {
        let mut sums = [0.0; SCRAMBLES];
        self.nodes.iter().for_each(|node| node.sums.greys.add_to(&mut sums, pixel));
        match self.stopped_counts(pixel) {
            Some(counts) => ErrorBar::of_halves(&sums, &counts),
            None => ErrorBar::new(&sums, counts),
        }
    }
}
