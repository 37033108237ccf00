//! The errors of the shots of a configuration, one number a seed.
//!
//! Without a reference the error is that of theory, the variance plus the square of the bias, both estimated without a
//! bias of their own and split among the seeds such that the mean over the seeds is the estimate:
//!
//! - The variance: R / (R - 1) times the squared distance to the mean of the R shots, which is the squared distance to
//!   the mean of the others less what that mean's own noise adds.
//! - The square of the bias, of a variant that is not right on average: from the differences d of its shots to those of the
//!   variant that is, at equal seeds. The mean product of two different ones estimates the square, where the square of
//!   their mean would add its variance. The share of a seed is that of the first order, 2 u - U, where u is the mean
//!   product with the others and U the estimate.

use super::shots::Shot;
use super::truth::{Truth, energy};
use crate::study::metrics::flip::Prepared;
use crate::study::metrics::trimmed_mean;
use rayon::prelude::*;

/// What is known about the shots of a configuration, one number a seed each.
#[derive(Clone, Debug)]
pub(super) struct Errors {
    pub(super) mse: Vec<f64>,
    pub(super) rel_mse: Vec<f64>,
    /// The part of `rel_mse` that falls with more samples.
    pub(super) rel_variance: Vec<f64>,
    pub(super) trimmed: Vec<f64>,
    pub(super) flip: Vec<f64>,
    /// Mean radiance.
    pub(super) energy: Vec<f64>,
}

/// The square of the bias of a variant.
pub(super) struct SquaredBias {
    /// Of every value; of most too noisy to be read, but without bias.
    values: Vec<f64>,
    /// The mean over the values, and that of the relative one, one share a seed.
    plain: Vec<f64>,
    relative: Vec<f64>,
}

impl SquaredBias {
    /// From shots of a variant and of the right one, at equal seeds.
    pub(super) fn of(shots: &[Shot], right: &[Shot], truth: &Truth) -> SquaredBias {
        let n = shots.len() as f64;
        let difference =
            |seed: usize, i: usize| f64::from(shots[seed].pixels[i]) - f64::from(right[seed].pixels[i]);
        let count = truth.weights.len();
        let sum: Vec<f64> =
            (0..count).map(|i| (0..shots.len()).map(|seed| difference(seed, i)).sum()).collect();
        let products = |seed: usize, weight: &dyn Fn(usize) -> f64| {
            let of_value = |i: usize| {
                let d = difference(seed, i);
                d * (sum[i] - d) * weight(i)
            };
            (0..count).map(of_value).sum::<f64>() / (count as f64 * (n - 1.0))
        };
        let shares = |weight: &dyn Fn(usize) -> f64| {
            let u: Vec<f64> = (0..shots.len()).map(|seed| products(seed, weight)).collect();
            let mean = u.iter().sum::<f64>() / n;
            u.iter().map(|u| 2.0 * u - mean).collect()
        };
        let square = |i: usize| {
            let own: f64 = (0..shots.len()).map(|seed| difference(seed, i).powi(2)).sum();
            (sum[i] * sum[i] - own) / (n * (n - 1.0))
        };
        SquaredBias {
            values: (0..count).map(square).collect(),
            plain: shares(&|_| 1.0),
            relative: shares(&|i| truth.weights[i]),
        }
    }
}

impl Errors {
    /// Against the shots' own mean, with the square of the bias of a variant that has one.
    pub(super) fn across_seeds(
        shots: &[Shot],
        truth: &Truth,
        bias: Option<&SquaredBias>,
        width: usize,
    ) -> Errors {
        let n = shots.len() as f64;
        let mean: Vec<f64> = (0..truth.weights.len())
            .map(|i| shots.iter().map(|shot| f64::from(shot.pixels[i])).sum::<f64>() / n)
            .collect();
        let variance = |seed: usize, i: usize| {
            let d = f64::from(shots[seed].pixels[i]) - mean[i];
            n / (n - 1.0) * d * d
        };
        let mut errors = Errors::of(shots, truth, &variance, width);
        if let Some(bias) = bias {
            let add = |to: &mut Vec<f64>, shares: &[f64]| {
                to.iter_mut().zip(shares).for_each(|(value, share)| *value += share);
            };
            add(&mut errors.mse, &bias.plain);
            add(&mut errors.rel_mse, &bias.relative);
            let whole = |seed: usize, i: usize| variance(seed, i) + bias.values[i];
            errors.trimmed = (0..shots.len()).map(|seed| trimmed(truth, &|i| whole(seed, i))).collect();
        }
        errors
    }

    /// Against a reference.
    pub(super) fn against(shots: &[Shot], truth: &Truth, width: usize) -> Errors {
        let square =
            |seed: usize, i: usize| (f64::from(shots[seed].pixels[i]) - f64::from(truth.pixels[i])).powi(2);
        let across = Errors::across_seeds(shots, truth, None, width);
        Errors { rel_variance: across.rel_variance, ..Errors::of(shots, truth, &square, width) }
    }

    fn of(
        shots: &[Shot],
        truth: &Truth,
        square: &(dyn Fn(usize, usize) -> f64 + Sync),
        width: usize,
    ) -> Errors {
        let values = truth.weights.len();
        let seeds = 0..shots.len();
        let relative = |seed: usize, i: usize| square(seed, i) * truth.weights[i];
        let mean = |of: &dyn Fn(usize) -> f64| (0..values).map(of).sum::<f64>() / values as f64;
        let rel_mse: Vec<f64> = seeds.clone().map(|seed| mean(&|i| relative(seed, i))).collect();
        let flip = |seed: usize| {
            let map = Prepared::new(&shots[seed].pixels, width).difference(truth.prepared(seed));
            map.iter().map(|&value| f64::from(value)).sum::<f64>() / map.len() as f64
        };
        Errors {
            mse: seeds.clone().map(|seed| mean(&|i| square(seed, i))).collect(),
            rel_variance: rel_mse.clone(),
            rel_mse,
            trimmed: seeds.clone().map(|seed| trimmed(truth, &|i| square(seed, i))).collect(),
            flip: seeds.into_par_iter().map(flip).collect(),
            energy: shots.iter().map(|shot| energy(&shot.pixels)).collect(),
        }
    }
}

/// The relative error of a shot without the worst pixels.
fn trimmed(truth: &Truth, square: &dyn Fn(usize) -> f64) -> f64 {
    let pixel = |p: usize| (3 * p..3 * p + 3).map(|i| square(i) * truth.weights[i]).sum::<f64>() / 3.0;
    trimmed_mean((0..truth.weights.len() / 3).map(pixel).collect())
}
