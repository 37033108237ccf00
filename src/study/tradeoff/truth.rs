//! What the pictures should be: a reference, or the mean of all renders that are right on average.

use super::shots::Shot;
use crate::study::metrics::flip::Prepared;
use crate::study::metrics::relative_weight;
use rayon::prelude::*;

/// The right picture.
pub(super) struct Truth {
    /// As well as it is known: linear R G B.
    pub(super) pixels: Vec<f32>,
    /// Of every value: what a squared error is multiplied with to become a relative one.
    pub(super) weights: Vec<f64>,
    /// For the shots of each seed, what FLIP compares them with; one for all, or one a seed.
    prepared: Vec<Prepared>,
}

impl Truth {
    /// A reference.
    pub(super) fn given(pixels: Vec<f32>, width: usize) -> Truth {
        let prepared = vec![Prepared::new(&pixels, width)];
        Truth { weights: weights(&pixels), pixels, prepared }
    }

    /// The mean of shots, those of a configuration weighted by its inverse variance. A shot is compared with the mean of
    /// those of the other seeds, with which it has no sample in common.
    pub(super) fn mean(right: &[&[Shot]], width: usize) -> Truth {
        let factors: Vec<f64> =
            right.iter().map(|shots| 1.0 / variance(shots).max(f64::MIN_POSITIVE)).collect();
        let largest = factors.iter().fold(0.0f64, |a, &b| a.max(b));
        let factors: Vec<f64> = factors.iter().map(|factor| factor / largest).collect();
        let (seeds, values) = (right[0].len(), right[0][0].pixels.len());
        let sum_of_seed = |seed: usize| {
            let mut sum = vec![0.0; values];
            for (shots, factor) in right.iter().zip(&factors) {
                let pairs = sum.iter_mut().zip(&shots[seed].pixels);
                pairs.for_each(|(sum, &value)| *sum += factor * f64::from(value));
            }
            sum
        };
        let sums: Vec<Vec<f64>> = (0..seeds).into_par_iter().map(sum_of_seed).collect();
        let total = factors.iter().sum::<f64>();
        let mean_of = |chosen: &dyn Fn(usize) -> bool| -> Vec<f32> {
            let count = (0..seeds).filter(|&seed| chosen(seed)).count() as f64;
            let value = |i: usize| {
                let chosen = sums.iter().enumerate().filter(|&(seed, _)| chosen(seed));
                (chosen.map(|(_, sum)| sum[i]).sum::<f64>() / (count * total)) as f32
            };
            (0..values).map(value).collect()
        };
        let pixels = mean_of(&|_| true);
        let others = |seed: usize| Prepared::new(&mean_of(&|other| other != seed), width);
        let prepared = (0..seeds).into_par_iter().map(others).collect();
        Truth { weights: weights(&pixels), pixels, prepared }
    }

    /// What FLIP compares a shot of a seed with.
    pub(super) fn prepared(&self, seed: usize) -> &Prepared {
        &self.prepared[seed.min(self.prepared.len() - 1)]
    }

    /// The mean of all values, in units of radiance.
    pub(super) fn energy(&self) -> f64 {
        energy(&self.pixels)
    }
}

/// The mean of all values of a picture.
pub(super) fn energy(pixels: &[f32]) -> f64 {
    pixels.iter().map(|&value| f64::from(value)).sum::<f64>() / pixels.len().max(1) as f64
}

fn weights(pixels: &[f32]) -> Vec<f64> {
    pixels.iter().map(|&value| relative_weight(value.into())).collect()
}

/// The mean over all values of the variance across shots, without bias.
fn variance(shots: &[Shot]) -> f64 {
    let values = shots[0].pixels.len();
    let of_value = |i: usize| {
        let n = shots.len() as f64;
        let mean = shots.iter().map(|shot| f64::from(shot.pixels[i])).sum::<f64>() / n;
        shots.iter().map(|shot| (f64::from(shot.pixels[i]) - mean).powi(2)).sum::<f64>() / (n - 1.0)
    };
    (0..values).map(of_value).sum::<f64>() / values as f64
}
