//! The sums of a run of chunks, and how two of them become one.

use super::Pair;
use crate::math::Rgb;
use crate::sampling::SCRAMBLES;
use rayon::prelude::*;

/// The sums of every pixel's samples in some chunks.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    /// Samples per pixel.
    pub samples: u64,
    /// Radiance, one sum a pixel, row by row from the top left; where blocks may stop, of the even scrambles.
    pub radiance: Vec<Rgb>,
    /// The same of the odd scrambles, where blocks may stop; else empty.
    pub odd: Vec<Rgb>,
    /// The same by scramble.
    pub greys: Greys,
    /// One a pixel: how far the halves of its first samples differ (see [`Pair`]), as many as [`Halving`](super::Halving) says.
    /// Kept with the first chunk's; else, and where that is not known, empty.
    pub deviations: Vec<f32>,
    /// Samples per pixel in each scramble.
    pub counts: [u64; SCRAMBLES],
}

/// The means of the components, summed by scramble. In f32: they tell the error, of which three digits are plenty.
#[derive(Clone, Debug, PartialEq)]
pub enum Greys {
    /// Not kept.
    Unknown,
    /// All samples lie in this scramble.
    One(usize, Vec<f32>),
    /// In several.
    All(Vec<[f32; SCRAMBLES]>),
}

impl Sums {
    /// Sums that can't tell their error.
    pub fn plain(samples: u64, radiance: Vec<Rgb>) -> Sums {
        let (odd, deviations) = (Vec::new(), Vec::new());
        Sums { samples, radiance, odd, greys: Greys::Unknown, deviations, counts: [0; SCRAMBLES] }
    }

    /// Sums of samples that all lie in one scramble, and their deviations if they are known.
    pub fn of_scramble(scramble: usize, samples: u64, radiance: Vec<Rgb>, deviations: Vec<f32>) -> Sums {
        let greys = radiance.par_iter().map(|&sum| grey(sum) as f32).collect();
        let mut counts = [0; SCRAMBLES];
        counts[scramble] = samples;
        Sums { samples, radiance, odd: Vec::new(), greys: Greys::One(scramble, greys), deviations, counts }
    }

    /// The radiance of a half of the scrambles.
    pub(super) fn half(&self, odd: bool) -> &[Rgb] {
        if odd { &self.odd } else { &self.radiance }
    }

    /// The sums of both.
    pub(super) fn join(self, other: Sums) -> Sums {
        let Sums { samples, mut radiance, mut odd, greys, mut deviations, counts } = self;
        let counts_of_both = [samples, other.samples];
        let halves = radiance.iter().zip(&other.radiance).map(|(&left, &right)| [grey(left), grey(right)]);
        deviations.iter_mut().zip(halves).for_each(|(deviation, sums)| {
            *deviation = Pair { sums, counts: counts_of_both }.deviation() as f32
        });
        radiance.iter_mut().zip(&other.radiance).for_each(|(sum, &other)| *sum += other);
        odd.iter_mut().zip(&other.odd).for_each(|(sum, &other)| *sum += other);
        Sums {
            samples: samples + other.samples,
            radiance,
            odd,
            greys: greys.join(other.greys),
            deviations,
            counts: std::array::from_fn(|i| counts[i] + other.counts[i]),
        }
    }
}

impl Greys {
    /// Adds those of a pixel to `sums`.
    pub(super) fn add_to(&self, sums: &mut [f64; SCRAMBLES], pixel: usize) {
        match self {
            Greys::Unknown => {}
            Greys::One(scramble, greys) => sums[*scramble] += f64::from(greys[pixel]),
            Greys::All(greys) => {
                sums.iter_mut().zip(greys[pixel]).for_each(|(sum, grey)| *sum += f64::from(grey));
            }
        }
    }

    fn join(self, other: Greys) -> Greys {
        match (self, other) {
            (Greys::Unknown, _) | (_, Greys::Unknown) => Greys::Unknown,
            (Greys::One(a, mut sums), Greys::One(b, others)) if a == b => {
                sums.iter_mut().zip(others).for_each(|(sum, other)| *sum += other);
                Greys::One(a, sums)
            }
            (a, b) => {
                let mut all = a.spread();
                all.iter_mut().enumerate().for_each(|(pixel, sums)| b.add_narrow(sums, pixel));
                Greys::All(all)
            }
        }
    }

    fn add_narrow(&self, sums: &mut [f32; SCRAMBLES], pixel: usize) {
        match self {
            Greys::Unknown => {}
            Greys::One(scramble, greys) => sums[*scramble] += greys[pixel],
            Greys::All(greys) => sums.iter_mut().zip(greys[pixel]).for_each(|(sum, grey)| *sum += grey),
        }
    }

    fn spread(self) -> Vec<[f32; SCRAMBLES]> {
        match self {
            Greys::Unknown => Vec::new(),
            Greys::One(scramble, greys) => greys.into_iter().map(|grey| at(scramble, grey)).collect(),
            Greys::All(greys) => greys,
        }
    }
}

fn at(scramble: usize, grey: f32) -> [f32; SCRAMBLES] {
    let mut sums = [0.0; SCRAMBLES];
    sums[scramble] = grey;
    sums
}

/// The mean of the components, each divided first: their sum may exceed the range of numbers.
pub(crate) fn grey(radiance: Rgb) -> f64 {
    (radiance * (1.0 / 3.0)).element_sum()
}
