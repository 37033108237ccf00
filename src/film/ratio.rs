//! The error of a picture from the differences within the samples of all its pixels, scaled by what a few pixels tell.
//!
//! Most of a picture's error often lies in few pixels, which a few that are chosen miss. The deviations of all pixels
//! ([`Pair`](super::Pair)) know where the error is but not how large: they don't see how much better the points are spread
//! together than by halves. The chosen pixels, whose variance is known, tell that ratio (Cochran 1977, Sampling Techniques,
//! chapter 6). A deviation beyond all that they have seen is counted in full: that is rare light, which is met by chance.

use super::{Film, PictureError, relative_weight};
use crate::math::Rgb;
use crate::sampling::SCRAMBLES;
use rayon::prelude::*;
use std::ops::{Add, Range};

/// A square of the error of a pixel.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Measures {
    /// Of the mean of the components.
    pub(crate) variance: f64,
    /// Over truth^2 + 0.01, mean of the components.
    pub(crate) relative: f64,
}

/// A pixel whose variance is known.
pub(crate) struct Chosen {
    /// For how many pixels it stands.
    pub(crate) stands_for: f64,
    /// The variance of its values in sets of scrambles.
    pub(crate) variance: Measures,
    /// What the deviation in each set says of it.
    pub(crate) deviations: [Measures; SCRAMBLES],
}

/// All pixels of a picture.
pub(crate) struct Whole<'f, F> {
    pub(crate) film: &'f Film,
    /// The mean of a pixel, and what its deviation says of the variance of the mean of its components.
    pub(crate) pixel: F,
}

/// The ratio of variances to deviations; both as sums over the chosen pixels.
struct Ratio {
    variance: f64,
    deviation: f64,
    /// The pixels that the chosen ones stand for.
    weight: f64,
    /// The weighted variance and deviation of each.
    terms: Vec<[f64; 2]>,
    /// The largest deviation of any set.
    limit: f64,
}

/// Deviations of all pixels: their parts up to a limit, what is beyond, and the sums of the squares of both.
#[derive(Clone, Copy, Default)]
struct Tally {
    low: f64,
    low_squares: f64,
    high: f64,
    high_squares: f64,
}

/// So many pixels with the picture's mean deviation and a ratio of 1 are added to the chosen ones: what is known before. It
/// matters where the chosen ones have hardly any deviation.
const BEFOREHAND: f64 = 2.0;
/// A ratio above is noise: halves of the samples are not spread better than the whole.
const LARGEST_RATIO: f64 = 1.5;

impl Measures {
    /// Of a pixel with this mean whose components' mean has a variance.
    pub(crate) fn new(variance: f64, mean: Rgb) -> Measures {
        Measures { variance, relative: variance * relative_weight(mean, super::grey(mean)) }
    }
}

impl<F> Whole<'_, F>
where
    F: Fn(usize) -> Option<(Rgb, f64)> + Sync,
{
    /// The error of the picture; `None` where deviations are not known or all zero.
    ///
    /// Rows are worked on side by side and added in order.
    pub(crate) fn error(&self, chosen: &[Chosen]) -> Option<PictureError> {
        let variance = Ratio::new(chosen, |measures| measures.variance);
        let relative = Ratio::new(chosen, |measures| measures.relative);
        let row = |pixels: Range<usize>| -> Option<(f64, Tally, Tally)> {
            let mut sums = (0.0, Tally::default(), Tally::default());
            for pixel in pixels {
                let (mean, deviation) = (self.pixel)(pixel)?;
                let measures = Measures::new(deviation, mean);
                sums.0 += super::grey(mean);
                sums.1.count(measures.variance, variance.limit);
                sums.2.count(measures.relative, relative.limit);
            }
            Some(sums)
        };
        let rows: Vec<_> = self.film.rows().into_par_iter().map(row).collect::<Option<_>>()?;
        let (mean, variances, relatives) = rows
            .into_iter()
            .reduce(|a, b| (a.0 + b.0, a.1 + b.1, a.2 + b.2))
            .filter(|sums| sums.1.low + sums.1.high > 0.0)?;
        let pixels = self.film.pixels() as f64;
        let mean_square = |ratio: Ratio, tally: Tally| ratio.mean_square(&tally, pixels);
        let (variance, relative) = (mean_square(variance, variances), mean_square(relative, relatives));
        PictureError::new(mean / pixels, pixels, relative, variance)
    }
}

impl Ratio {
    fn new(chosen: &[Chosen], measure: impl Fn(&Measures) -> f64) -> Ratio {
        let mut ratio = Ratio { variance: 0.0, deviation: 0.0, weight: 0.0, terms: Vec::new(), limit: 0.0 };
        for pixel in chosen {
            let weight = pixel.stands_for;
            let deviations = pixel.deviations.iter().map(&measure);
            let largest = deviations.clone().fold(0.0, f64::max);
            let term =
                [weight * measure(&pixel.variance), weight * deviations.sum::<f64>() / SCRAMBLES as f64];
            ratio.variance += term[0];
            ratio.deviation += term[1];
            ratio.weight += weight;
            ratio.terms.push(term);
            ratio.limit = ratio.limit.max(largest);
        }
        ratio
    }

    /// The mean over the pixels, and its degrees of freedom: those of the chi-square variable that is as uncertain.
    fn mean_square(&self, all: &Tally, pixels: f64) -> (f64, f64) {
        let count = self.terms.len() as f64;
        let beforehand = BEFOREHAND * self.weight / count * (all.low / pixels);
        let deviation = self.deviation + beforehand;
        let known = if deviation > 0.0 { (self.variance + beforehand) / deviation } else { 1.0 };
        let ratio = known.min(LARGEST_RATIO);
        let total = ratio * all.low + all.high;
        // The terms are as many independent numbers of mean zero.
        let apart: f64 = self.terms.iter().map(|[v, d]| (v - known * d) * (v - known * d)).sum();
        let of_ratio = apart * count / (count - 1.0).max(1.0) / (deviation * deviation);
        let of_ratio = if known > 0.0 && deviation > 0.0 {
            of_ratio.min(known * known) * (ratio / known).powi(2)
        } else {
            0.0
        };
        // Deviations are taken as rare light: the sum of their squares is the variance of their sum. That is twice as much as
        // of normally distributed samples or more, and nothing where many pixels are alike.
        let squares =
            ratio * ratio * all.low_squares + 2.0 * ratio * self.limit * all.high + all.high_squares;
        let spread = all.low * all.low * of_ratio + squares;
        let degrees = if spread > 0.0 { 2.0 * total * total / spread } else { f64::INFINITY };
        (total / pixels, degrees.max(1.0))
    }
}

impl Tally {
    fn count(&mut self, deviation: f64, limit: f64) {
        let low = deviation.min(limit);
        let high = deviation - low;
        self.low += low;
        self.low_squares += low * low;
        self.high += high;
        self.high_squares += high * high;
    }
}

impl Add for Tally {
    type Output = Tally;

    fn add(self, other: Tally) -> Tally {
        Tally {
            low: self.low + other.low,
            low_squares: self.low_squares + other.low_squares,
            high: self.high + other.high,
            high_squares: self.high_squares + other.high_squares,
        }
    }
}
