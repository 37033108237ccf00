//! The sums of the chunk under way.

use super::{Settings, memory};
use crate::error::Result;
use crate::film::{Greys, Sums};
use crate::math::Rgb;
use crate::sampling::{SCRAMBLES, Scrambles};
use std::ops::Range;

/// One cell a pixel, row by row from the top left: the sum of its radiance, and where the chunk lies in several scrambles,
/// the sum of the means of the components in each.
pub(super) struct Cells {
    /// Samples per pixel so far.
    pub(super) samples: u64,
    pub(super) values: Vec<f64>,
    /// Numbers in a cell.
    pub(super) stride: usize,
    /// The scramble of all samples.
    scramble: Option<usize>,
    first: u64,
    scrambles: Scrambles,
}

/// Where the sums by scramble begin in a cell that has them.
pub(super) const GREYS: usize = 3;

impl Cells {
    /// Empty cells for these samples.
    pub(super) fn new(settings: &Settings, samples: Range<u64>) -> Result<Cells> {
        let scrambles = settings.scrambles();
        let first = samples.start;
        let scramble = scrambles.only(samples);
        let stride = if scramble.is_some() { GREYS } else { GREYS + SCRAMBLES };
        Ok(Cells { samples: 0, values: memory::zeros(settings, stride)?, stride, scramble, first, scrambles })
    }

    /// A copy, if there is memory for it.
    pub(super) fn try_clone(&self, settings: &Settings) -> Result<Cells> {
        let mut values = memory::zeros(settings, self.stride)?;
        values.copy_from_slice(&self.values);
        Ok(Cells { values, ..*self })
    }

    /// Copies what other cells of the same chunk hold.
    pub(super) fn copy_from(&mut self, other: &Cells) {
        self.samples = other.samples;
        self.values.copy_from_slice(&other.values);
    }

    /// What the film keeps.
    pub(super) fn into_sums(self) -> Sums {
        let cells = || self.values.chunks_exact(self.stride);
        let radiance = cells().map(|cell| Rgb::new(cell[0], cell[1], cell[2])).collect();
        if let Some(scramble) = self.scramble {
            return Sums::of_scramble(scramble, self.samples, radiance);
        }
        let greys = cells().map(|cell| std::array::from_fn(|i| cell[GREYS + i] as f32)).collect();
        let (before, after) =
            (self.scrambles.counts(self.first), self.scrambles.counts(self.first + self.samples));
        let counts = std::array::from_fn(|i| after[i] - before[i]);
        Sums { samples: self.samples, radiance, greys: Greys::All(greys), counts }
    }
}
