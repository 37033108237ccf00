//! A few pixels that tell the error of the picture before its own samples can.

use super::Settings;
use super::tile::Pass;
use crate::film::{Film, PictureError, PictureErrorSum, Pixels, Region, grey};
use crate::integrator::Counters;
use crate::math::Rgb;
use crate::sampling::{SCRAMBLES, stream};
use rayon::prelude::*;

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
    sums: [Rgb; SETS],
}

/// The sums of all sets of all pixels.
pub(super) type SetSums = Vec<[Rgb; SETS]>;

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
                sums: [Rgb::ZERO; SETS],
            }
        });
        let own = all.filter(|pixel| settings.region.contains(settings.width, pixel.x, pixel.y));
        ErrorPixels { all: own.collect(), pixels: pixels as f64 }
    }

    /// How many numbers [`ErrorPixels::numbers`] gives.
    pub(super) fn count(&self) -> u64 {
        (self.all.len() * SETS * 3) as u64
    }

    /// The sums of all sets of all pixels.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> + '_ {
        self.all.iter().flat_map(|pixel| pixel.sums).flat_map(|sum| sum.to_array())
    }

    /// Adds such numbers to the pixels of a region; false if they are not as many.
    pub(super) fn add(&mut self, numbers: &[f64], region: Region, width: u32) -> bool {
        let own = self.all.iter_mut().filter(|pixel| region.contains(width, pixel.x, pixel.y));
        let mut rest = numbers.chunks_exact(3);
        for sum in own.flat_map(|pixel| &mut pixel.sums) {
            let Some(rgb) = rest.next() else { return false };
            *sum += Rgb::new(rgb[0], rgb[1], rgb[2]);
        }
        rest.next().is_none()
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
                let mut sums = pixel.sums;
                for (sum, set) in sums.iter_mut().zip(1..) {
                    if cancelled() {
                        return None;
                    }
                    for index in pass.samples.clone() {
                        let place = pass.scrambles.place(index).in_set(set);
                        *sum += pass.take(
                            pixel.x,
                            pixel.y,
                            place,
                            sample,
                            f64::INFINITY,
                            &mut Counters::default(),
                        );
                    }
                }
                Some(sums)
            })
            .collect()
    }

    /// Keeps the sums of a pass.
    pub(super) fn keep(&mut self, sums: SetSums) {
        self.all.iter_mut().zip(sums).for_each(|(pixel, sums)| pixel.sums = sums);
    }

    /// The error of a picture of `samples` samples whose pixels have these sums.
    pub(super) fn estimate(&self, samples: u64, sum: impl Fn(usize) -> Rgb) -> PictureErrorSum {
        let mut total = PictureErrorSum::default();
        for pixel in &self.all {
            let mut values = [sum(pixel.number); SCRAMBLES];
            values[1..].copy_from_slice(&pixel.sums);
            let values = values.map(|sum| sum * (1.0 / samples as f64));
            let (relative, variance) = spread(&values);
            total.add(pixel.stands_for, relative, variance);
        }
        total
    }

    /// The error of the picture that a film holds.
    pub(super) fn error(&self, film: &Film) -> Option<PictureError> {
        let mut total = self.estimate(film.samples(), |pixel| film.sum(pixel));
        total.add_mean(film.total());
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

/// Of equally distributed values: their expected (x - truth)^2 / (truth^2 + 0.01), mean of the components, and the variance
/// of the mean of the components.
fn spread(values: &[Rgb; SCRAMBLES]) -> (f64, f64) {
    let variance_of = |component: &dyn Fn(&Rgb) -> f64| {
        let mean = values.iter().map(component).sum::<f64>() / SCRAMBLES as f64;
        let squares = values.iter().map(|value| (component(value) - mean) * (component(value) - mean));
        (squares.sum::<f64>() / (SCRAMBLES - 1) as f64, mean)
    };
    let relative = (0..3).map(|i| {
        let (variance, mean) = variance_of(&|value| value[i]);
        variance / (mean * mean + 0.01)
    });
    (relative.sum::<f64>() / 3.0, variance_of(&|&value| grey(value)).0)
}
