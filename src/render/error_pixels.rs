//! A few pixels that tell the error of the picture before its own samples alone can.

use super::Settings;
use super::cells::Cells;
use super::tile::Pass;
use crate::film::{
    Chosen, Film, Halving, Measures, Pair, PictureError, PictureErrorSum, Pixels, Region, Whole, grey,
};
use crate::integrator::Counters;
use crate::math::Rgb;
use crate::sampling::{SCRAMBLES, stream};
use rayon::prelude::*;
use std::ops::Range;

/// Sets of scrambles beside that of the picture: with it there are as many values of a pixel as there are scrambles.
const SETS: usize = SCRAMBLES - 1;
/// One pixel of so many is chosen: 7 / 270 is 2.6 % more work.
const PIXELS_PER_CHOICE: u64 = 270;
/// The fewest chosen, where the picture has as many.
const FEWEST: u64 = 64;

/// Pixels chosen at random, one in each cell of a grid over the picture, each with the sums of its samples in other sets
/// of scrambles: as many samples, at the same places of the sequences.
///
/// The values of a pixel in all sets are independent and equally distributed, so their variance is that of the picture's
/// pixel.
pub(super) struct ErrorPixels {
    all: Vec<ErrorPixel>,
    /// Of the picture.
    pixels: f64,
}

#[derive(Clone, Copy)]
struct ErrorPixel {
    x: u32,
    y: u32,
    /// Row by row.
    number: usize,
    /// The pixels of its cell.
    stands_for: f64,
    sets: [SetSum; SETS],
}

/// The samples of a pixel in one set of scrambles.
#[derive(Clone, Copy, Default)]
pub(super) struct SetSum {
    radiance: Rgb,
    /// The means of the components, summed by [`Halving::level`].
    levels: [f64; LEVELS],
}

/// As many as 2048 samples in chunks of 16 have; of more the halves are not compared.
const LEVELS: usize = 12;
/// Numbers in a [`SetSum`].
const NUMBERS: usize = 3 + LEVELS;

/// All sets of all pixels.
pub(super) type SetSums = Vec<[SetSum; SETS]>;

impl ErrorPixels {
    /// Those of a render that estimates its error by them; blocks know theirs.
    pub(super) fn wanted(settings: &Settings) -> Option<ErrorPixels> {
        (settings.error_estimate && settings.noise.is_none()).then(|| ErrorPixels::new(settings))
    }

    pub(super) fn new(settings: &Settings) -> ErrorPixels {
        let (width, height) = (u64::from(settings.width), u64::from(settings.height));
        let pixels = width * height;
        let wanted = (pixels / PIXELS_PER_CHOICE).max(FEWEST.min(pixels));
        let across = (wanted as f64 * width as f64 / height as f64).sqrt() as u64;
        let rows = (wanted / across.clamp(1, width)).clamp(1, height);
        let columns = (wanted / rows).clamp(1, width);
        let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
        let all = cells.map(|(row, column)| {
            let cut = |side: u64, i: u64, parts: u64| side * i / parts;
            let (left, right) = (cut(width, column, columns), cut(width, column + 1, columns));
            let (top, bottom) = (cut(height, row, rows), cut(height, row + 1, rows));
            let area = (right - left) * (bottom - top);
            // The high half of the product is uniform below `area`.
            let hash = stream(settings.seed, row * columns + column) as u128;
            let chosen = ((hash * u128::from(area)) >> 64) as u64;
            let (x, y) = (left + chosen % (right - left), top + chosen / (right - left));
            ErrorPixel {
                x: x as u32,
                y: y as u32,
                number: (y * width + x) as usize,
                stands_for: area as f64,
                sets: [SetSum::default(); SETS],
            }
        });
        let own = all.filter(|pixel| settings.region.contains(settings.width, pixel.x, pixel.y));
        ErrorPixels { all: own.collect(), pixels: pixels as f64 }
    }

    /// How many numbers [`ErrorPixels::numbers`] gives.
    pub(super) fn count(&self) -> u64 {
        (self.all.len() * SETS * NUMBERS) as u64
    }

    /// The sums of all sets of all pixels.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        self.all.iter().flat_map(|pixel| pixel.sets).flat_map(|sum| sum.numbers())
    }

    /// Adds such numbers to the pixels of a region; false if they are not as many.
    pub(super) fn add(&mut self, numbers: &[f64], region: Region, width: u32) -> bool {
        let own = self.all.iter_mut().filter(|pixel| region.contains(width, pixel.x, pixel.y));
        let (numbers, rest) = numbers.as_chunks();
        let mut numbers = numbers.iter();
        for sum in own.flat_map(|pixel| &mut pixel.sets) {
            let Some(numbers) = numbers.next() else { return false };
            sum.add(numbers);
        }
        numbers.next().is_none() && rest.is_empty()
    }

    /// The sums after a pass; `None` if `cancelled`.
    pub(super) fn pass<F>(
        &self,
        pass: &Pass,
        sample: &F,
        cancelled: impl Fn() -> bool + Sync,
    ) -> Option<SetSums>
    where
        F: Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync,
    {
        self.all
            .par_iter()
            .map(|pixel| {
                let mut sets = pixel.sets;
                for (sum, set) in sets.iter_mut().zip(1..) {
                    if cancelled() {
                        return None;
                    }
                    sum.take(pass.samples.clone(), pass.halving, |index| {
                        let (place, counters) =
                            (pass.scrambles.place(index).in_set(set), &mut Counters::default());
                        pass.take(pixel.x, pixel.y, place, sample, f64::INFINITY, counters)
                    });
                }
                Some(sets)
            })
            .collect()
    }

    /// Keeps the sums of a pass.
    pub(super) fn keep(&mut self, sets: SetSums) {
        self.all.iter_mut().zip(sets).for_each(|(pixel, sets)| pixel.sets = sets);
    }

    /// The error of the picture that a film holds: what its halves say, scaled by what these pixels know; where the halves are
    /// not known, from these pixels alone. With the cells of a chunk that is still to be added.
    pub(super) fn error(&self, film: &Film, cells: Option<&Cells>) -> Option<PictureError> {
        let samples = film.samples() + cells.map_or(0, |cells| cells.samples);
        let weight = 1.0 / samples as f64;
        let mean = |pixel| film.sum_after(cells.map(|cells| cells.sum(pixel)), pixel) * weight;
        // The first chunk's are in the cells while it is under way.
        let in_cells = cells.filter(|_| film.samples() == 0);
        let own_deviation = |pixel| match in_cells {
            Some(cells) => cells.deviation(pixel),
            None => film.deviation(pixel),
        };
        let halving = Halving::new(film.chunk());
        let compared = halving.largest(samples);
        // From the variance of the sum of those that are compared to that of the mean of all.
        let share = weight / compared as f64;
        let of = |deviation: f64| share * (deviation * deviation);
        let whole = Whole { film, pixel: |pixel| Some((mean(pixel), of(own_deviation(pixel)?))) };
        let chosen: Option<Vec<Chosen>> = self
            .all
            .iter()
            .map(|pixel| {
                let mut values = [(mean(pixel.number), own_deviation(pixel.number)?); SCRAMBLES];
                for (value, set) in values[1..].iter_mut().zip(&pixel.sets) {
                    *value = (set.radiance * weight, set.deviation(halving, compared)?);
                }
                let deviations = values.map(|(mean, deviation)| Measures::new(of(deviation), mean));
                let variance = spread(&values.map(|(mean, _)| mean));
                Some(Chosen { stands_for: pixel.stands_for, variance, deviations })
            })
            .collect();
        chosen.and_then(|chosen| whole.error(&chosen)).or_else(|| self.error_of_chosen(samples, &mean))
    }

    /// The same from the chosen pixels alone.
    fn error_of_chosen(&self, samples: u64, mean: &(impl Fn(usize) -> Rgb + Sync)) -> Option<PictureError> {
        let mut total = PictureErrorSum::default();
        for pixel in &self.all {
            let mut values = [mean(pixel.number); SCRAMBLES];
            for (value, set) in values[1..].iter_mut().zip(&pixel.sets) {
                *value = set.radiance * (1.0 / samples as f64);
            }
            let Measures { variance, relative } = spread(&values);
            total.add(pixel.stands_for, relative, variance);
        }
        let means: Vec<f64> =
            (0..self.pixels as usize).into_par_iter().map(|pixel| grey(mean(pixel))).collect();
        total.add_mean(means.iter().sum());
        total.finish(self.kind())
    }

    /// What they stand for.
    pub(super) fn kind(&self) -> Pixels {
        Pixels::Some { of: self.pixels, degrees: SETS as f64 }
    }

    /// The chosen pixels, and how many each stands for.
    pub(super) fn chosen(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.all.iter().map(|pixel| (pixel.number, pixel.stands_for))
    }
}

impl SetSum {
    fn numbers(&self) -> [f64; NUMBERS] {
        let mut numbers = [0.0; NUMBERS];
        numbers[..3].copy_from_slice(&self.radiance.to_array());
        numbers[3..].copy_from_slice(&self.levels);
        numbers
    }

    /// Adds such numbers.
    fn add(&mut self, numbers: &[f64; NUMBERS]) {
        self.radiance += Rgb::new(numbers[0], numbers[1], numbers[2]);
        self.levels.iter_mut().zip(&numbers[3..]).for_each(|(sum, number)| *sum += number);
    }

    /// Adds samples.
    fn take(&mut self, samples: Range<u64>, halving: Halving, mut sample: impl FnMut(u64) -> Rgb) {
        for index in samples {
            let radiance = sample(index);
            self.radiance += radiance;
            if let Some(sum) = self.levels.get_mut(halving.level(index)) {
                *sum += grey(radiance);
            }
        }
    }

    /// The deviation of the first `samples`, which are compared; `None` where their sums are not kept.
    fn deviation(&self, halving: Halving, samples: u64) -> Option<f64> {
        let last = halving.level(samples.saturating_sub(1));
        let before = halving.largest(samples.saturating_sub(1));
        let sums = [self.levels.get(..last)?.iter().sum(), *self.levels.get(last)?];
        Some(Pair { sums, counts: [before, samples - before] }.deviation())
    }
}

/// Of equally distributed values: the variance of the mean of the components, and their expected (x - truth)^2 /
/// (truth^2 + 0.01), mean of the components.
fn spread(values: &[Rgb; SCRAMBLES]) -> Measures {
    let variance_of = |component: &dyn Fn(&Rgb) -> f64| {
        let mean = values.iter().map(component).sum::<f64>() / SCRAMBLES as f64;
        let squares = values.iter().map(|value| (component(value) - mean) * (component(value) - mean));
        (squares.sum::<f64>() / (SCRAMBLES - 1) as f64, mean)
    };
    let relative = (0..3).map(|i| {
        let (variance, mean) = variance_of(&|value| value[i]);
        variance / (mean * mean + 0.01)
    });
    Measures { variance: variance_of(&|&value| grey(value)).0, relative: relative.sum::<f64>() / 3.0 }
}
