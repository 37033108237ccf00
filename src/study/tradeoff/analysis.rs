//! From numbers of seeds to estimates with intervals.

use super::errors::Errors;
use super::grid::{Grid, Variant};
use super::plan::{Curve, Plan};
use super::shots::{Configuration, Shot};
use crate::study::statistics::{Bootstrap, Estimate, mean_of, median_of, pareto_front, slope};

/// A configuration, measured.
#[derive(Clone, Debug)]
pub struct Row {
    /// Which one.
    pub configuration: Configuration,
    /// The median of the seconds of sampling, without load and build.
    pub seconds: Estimate,
    /// The median of the seconds to build the accelerator.
    pub build_seconds: Estimate,
    /// Millions of rays a second, the median.
    pub mrays: Estimate,
    /// Mean square error, in squares of radiance.
    pub mse: Estimate,
    /// Relative mean square error.
    pub rel_mse: Estimate,
    /// The same without the worst 0.1 % of the pixels.
    pub trimmed: Estimate,
    /// The mean of FLIP.
    pub flip: Estimate,
    /// Mean radiance of the picture.
    pub energy: Estimate,
    /// The mean of the picture beside the right one, less one: 0.01 is one percent too bright. `None` for the settings that
    /// are taken for right.
    pub bias: Option<Estimate>,
    /// 1 / (relMSE x seconds) beside that of the default.
    pub efficiency: Estimate,
    /// Whether no other configuration is both faster and better in relMSE.
    pub on_front: bool,
    /// The share of the resamples in which that is so.
    pub front_share: f64,
}

/// How the error of a variant falls with the samples.
#[derive(Clone, Debug)]
pub struct Convergence {
    /// Place of the variant in the list.
    pub variant: usize,
    /// The power of the samples with which the relMSE goes, without the part of the bias: -1 for independent samples.
    pub slope: Estimate,
}

/// The cheapest way to a wanted error.
#[derive(Clone, Debug)]
pub struct Recommendation {
    /// Place of the variant in the list.
    pub variant: usize,
    /// The samples that it takes.
    pub samples: u64,
    /// The seconds of sampling.
    pub seconds: Estimate,
    /// Whether more or fewer samples are needed than were measured.
    pub extrapolated: bool,
}

/// Resamples of an interval.
const RESAMPLES: usize = 2000;
/// Their seed.
const SEED: u64 = 1979;

/// All numbers.
pub(super) struct Analysis<'a> {
    pub(super) grid: &'a Grid,
    pub(super) variants: &'a [Variant],
    /// Variant by variant, with ascending samples.
    pub(super) configurations: &'a [Configuration],
    pub(super) shots: &'a [Vec<Shot>],
    pub(super) errors: &'a [Errors],
    /// Mean radiance of the reference, if there is one.
    pub(super) energy: Option<f64>,
    /// Place of the default among the numbers of samples.
    pub(super) baseline: usize,
    pub(super) seeds: usize,
}

impl Analysis<'_> {
    fn bootstrap(&self) -> Bootstrap {
        Bootstrap::new(self.seeds, RESAMPLES, SEED)
    }

    fn seconds(&self, i: usize) -> Vec<f64> {
        self.shots[i].iter().map(|shot| shot.seconds).collect()
    }

    pub(super) fn rows(&self) -> Vec<Row> {
        let bootstrap = self.bootstrap();
        let seconds: Vec<Vec<f64>> = (0..self.configurations.len()).map(|i| self.seconds(i)).collect();
        let cost = |i: usize, seeds: &[usize]| {
            (median_of(&seconds[i], seeds), mean_of(&self.errors[i].rel_mse, seeds))
        };
        let fronts = Fronts::of(&bootstrap, self.configurations.len(), &cost);
        let median = |values: &[f64]| bootstrap.estimate(|seeds| median_of(values, seeds));
        let row = |i: usize| {
            let errors = &self.errors[i];
            let of_shots = |of: fn(&Shot) -> f64| self.shots[i].iter().map(of).collect::<Vec<f64>>();
            Row {
                configuration: self.configurations[i],
                seconds: median(&seconds[i]),
                build_seconds: median(&of_shots(|shot| shot.build_seconds)),
                mrays: median(&of_shots(|shot| 1e-6 * shot.rays as f64 / shot.seconds.max(1e-9))),
                mse: bootstrap.mean(&errors.mse),
                rel_mse: bootstrap.mean(&errors.rel_mse),
                trimmed: bootstrap.mean(&errors.trimmed),
                flip: bootstrap.mean(&errors.flip),
                energy: bootstrap.mean(&errors.energy),
                bias: self.bias(&bootstrap, i),
                efficiency: bootstrap.estimate(|seeds| {
                    let product = |i: usize| {
                        let (seconds, error) = cost(i, seeds);
                        seconds * error
                    };
                    product(self.baseline) / product(i)
                }),
                on_front: fronts.whole[i],
                front_share: fronts.shares[i],
            }
        };
        (0..self.configurations.len()).map(row).collect()
    }

    /// Against the reference, else against the right variant with as many samples, seed by seed.
    fn bias(&self, bootstrap: &Bootstrap, i: usize) -> Option<Estimate> {
        let own = &self.errors[i].energy;
        if let Some(energy) = self.energy {
            return Some(bootstrap.estimate(|seeds| mean_of(own, seeds) / energy - 1.0));
        }
        let Configuration { variant, samples } = self.configurations[i];
        let right = self.grid.truth_of(&self.variants[variant]);
        let right = self
            .configurations
            .iter()
            .position(|other| other.samples == samples && self.variants[other.variant] == right);
        let right = &self.errors[right.filter(|&right| right != i)?].energy;
        Some(bootstrap.estimate(|seeds| mean_of(own, seeds) / mean_of(right, seeds) - 1.0))
    }

    pub(super) fn convergence(&self) -> Vec<Convergence> {
        if self.grid.samples.len() < 2 {
            return Vec::new();
        }
        let bootstrap = self.bootstrap();
        let of = |variant: usize| {
            let slope = bootstrap.estimate(|seeds| {
                let curve = self.curve(variant, seeds);
                slope(curve.samples.iter().zip(&curve.variances).map(|(&n, v)| ((n as f64).ln(), v.ln())))
            });
            Convergence { variant, slope }
        };
        (0..self.variants.len()).map(of).collect()
    }

    fn curve(&self, variant: usize, seeds: &[usize]) -> Curve<'_> {
        let counts = self.grid.samples.len();
        let places = variant * counts..(variant + 1) * counts;
        let errors = |i: usize| &self.errors[i];
        let variances: Vec<f64> = places.clone().map(|i| mean_of(&errors(i).rel_variance, seeds)).collect();
        let last = places.end - 1;
        let floor = mean_of(&errors(last).rel_mse, seeds) - variances[counts - 1];
        Curve {
            samples: &self.grid.samples,
            variances,
            seconds: places.map(|i| median_of(&self.seconds(i), seeds)).collect(),
            floor: floor.max(0.0),
        }
    }

    /// The variant that reaches a relMSE soonest.
    pub(super) fn recommend(&self, target: f64) -> Option<Recommendation> {
        let all: Vec<usize> = (0..self.seeds).collect();
        let plans = (0..self.variants.len()).filter_map(|i| Some((i, self.curve(i, &all).plan(target)?)));
        let (variant, Plan { samples, extrapolated, .. }) =
            plans.min_by(|(_, a), (_, b)| a.seconds.total_cmp(&b.seconds))?;
        let seconds = self.bootstrap().estimate(|seeds| {
            self.curve(variant, seeds).plan(target).map_or(f64::INFINITY, |plan| plan.seconds)
        });
        Some(Recommendation { variant, samples, seconds, extrapolated })
    }
}

/// Seconds and error of a configuration, over the seeds with the given indices.
type Cost<'c> = dyn Fn(usize, &[usize]) -> (f64, f64) + 'c;

/// Who is on the Pareto front, and in which share of the resamples.
struct Fronts {
    whole: Vec<bool>,
    shares: Vec<f64>,
}

impl Fronts {
    fn of(bootstrap: &Bootstrap, count: usize, cost: &Cost<'_>) -> Fronts {
        let front =
            |seeds: &[usize]| pareto_front(&(0..count).map(|i| cost(i, seeds)).collect::<Vec<(f64, f64)>>());
        let mut fronts = bootstrap.map(front);
        let whole = fronts.remove(0);
        let total = fronts.len().max(1) as f64;
        let share = |i: usize| fronts.iter().filter(|front| front[i]).count() as f64 / total;
        Fronts { whole, shares: (0..count).map(share).collect() }
    }
}
