//! The sums of the chunk under way.

use super::{Settings, memory};
use crate::error::Result;
use crate::film::file::Reader;
use crate::film::{Greys, HALVES, Halving, Pair, Sums};
use crate::math::Rgb;
use crate::sampling::{SCRAMBLES, Scrambles};
use rayon::prelude::*;
use std::ops::Range;

/// One cell a pixel, in the order of the render's [`Frame`](crate::film::Frame).
pub(super) struct Cells {
    /// Samples per pixel so far.
    pub(super) samples: u64,
    pub(super) values: Vec<f64>,
    pub(super) layout: Layout,
    first: u64,
    scrambles: Scrambles,
    halving: Halving,
}

/// What a cell holds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Layout {
    /// The sum of the radiance of samples that all lie in this scramble; of the first chunk also the means of the components,
    /// summed over the samples that are compared (see [`Halving`]), and before over their first half.
    Plain(usize),
    /// Also, by scramble, the sums of the means of the components.
    Scrambled,
    /// The radiance of the even scrambles, that of the odd ones, and the sums by scramble.
    Halved,
}

/// Numbers in a sum of radiance.
const RADIANCE: usize = 3;

impl Layout {
    /// What the chunk that begins with a sample needs. It is that of a whole chunk, even where fewer samples are wanted: then
    /// more can follow later.
    pub(super) fn new(settings: &Settings, first: u64) -> Layout {
        match settings.scrambles().only(first..first + u64::from(settings.chunk)) {
            _ if settings.noise.is_some() => Layout::Halved,
            Some(scramble) => Layout::Plain(scramble),
            None => Layout::Scrambled,
        }
    }

    /// Numbers in a cell.
    pub(super) fn stride(self) -> usize {
        self.compared().map_or(self.greys().end, |compared| compared.end)
    }

    /// Where in a cell the sums are that are compared.
    #[inline]
    pub(super) fn compared(self) -> Option<Range<usize>> {
        matches!(self, Layout::Plain(_)).then_some(RADIANCE..RADIANCE + 2)
    }

    /// Where in a cell the sums by scramble are.
    pub(super) fn greys(self) -> Range<usize> {
        match self {
            Layout::Plain(_) => RADIANCE..RADIANCE,
            Layout::Scrambled => RADIANCE..RADIANCE + SCRAMBLES,
            Layout::Halved => HALVES * RADIANCE..HALVES * RADIANCE + SCRAMBLES,
        }
    }

    /// The sums of the radiance in a cell, by half where it has halves.
    #[inline]
    pub(super) fn radiance(self, cell: &[f64]) -> [Rgb; HALVES] {
        let at = |i: usize| Rgb::new(cell[i], cell[i + 1], cell[i + 2]);
        [at(0), if self == Layout::Halved { at(RADIANCE) } else { Rgb::ZERO }]
    }

    /// Writes them back.
    #[inline]
    pub(super) fn set_radiance(self, cell: &mut [f64], sums: [Rgb; HALVES]) {
        cell[..RADIANCE].copy_from_slice(&sums[0].to_array());
        if self == Layout::Halved {
            cell[RADIANCE..2 * RADIANCE].copy_from_slice(&sums[1].to_array());
        }
    }

    /// Keeps the sum of the samples that are compared from now on.
    #[inline]
    pub(super) fn compare(self, cell: &mut [f64], sum: f64) {
        if let Some([before, all]) = self.compared().map(|compared| &mut cell[compared]) {
            *before = std::mem::replace(all, sum);
        }
    }

    /// The half of the sums that a scramble belongs to.
    #[inline]
    pub(super) fn half(self, scramble: usize) -> usize {
        if self == Layout::Halved { scramble % HALVES } else { 0 }
    }

    /// Takes a half out of a cell that has halves.
    pub(super) fn clear_half(cell: &mut [f64], half: usize) {
        cell[half * RADIANCE..(half + 1) * RADIANCE].fill(0.0);
        let greys = &mut cell[Layout::Halved.greys()];
        greys.iter_mut().skip(half).step_by(HALVES).for_each(|grey| *grey = 0.0);
    }
}

impl Cells {
    /// Empty cells for the chunk that begins with a sample.
    pub(super) fn new(settings: &Settings, first: u64) -> Result<Cells> {
        let (layout, scrambles) = (Layout::new(settings, first), settings.scrambles());
        let values = memory::zeros(settings, layout.stride())?;
        let halving = Halving::new(settings.chunk.into());
        Ok(Cells { samples: 0, values, layout, first, scrambles, halving })
    }

    /// Reads the `samples` samples of the chunk that begins with a sample.
    pub(super) fn read(settings: &Settings, first: u64, samples: u64, reader: &mut Reader) -> Result<Cells> {
        if !(1..u64::from(settings.chunk)).contains(&samples) {
            return Err(reader.refuse("holds more of a chunk than there can be"));
        }
        let mut cells = Cells::new(settings, first)?;
        let stride = cells.layout.stride();
        cells.values = reader.light(settings.area() * stride as u64)?;
        cells.samples = samples;
        Ok(cells)
    }

    /// A copy, if there is memory for it.
    pub(super) fn try_clone(&self, settings: &Settings) -> Result<Cells> {
        let mut values = memory::zeros(settings, self.layout.stride())?;
        values.copy_from_slice(&self.values);
        Ok(Cells { values, ..*self })
    }

    /// Copies what other cells of the same chunk hold.
    pub(super) fn copy_from(&mut self, other: &Cells) {
        self.samples = other.samples;
        self.values.copy_from_slice(&other.values);
    }

    /// That of a pixel.
    pub(super) fn cell(&self, pixel: usize) -> &[f64] {
        let stride = self.layout.stride();
        &self.values[pixel * stride..][..stride]
    }

    /// That of a pixel.
    pub(super) fn cell_mut(&mut self, pixel: usize) -> &mut [f64] {
        let stride = self.layout.stride();
        &mut self.values[pixel * stride..][..stride]
    }

    /// The sum of a pixel's radiance.
    pub(super) fn sum(&self, pixel: usize) -> Rgb {
        let [a, b] = self.layout.radiance(self.cell(pixel));
        a + b
    }

    /// How far the halves of a pixel's samples differ, of the first chunk, where it is known.
    pub(super) fn deviation(&self, pixel: usize) -> Option<f64> {
        let sums = &self.cell(pixel)[self.layout.compared()?];
        let compared = self.halving.largest(self.samples);
        let before = self.halving.largest(compared.saturating_sub(1));
        let pair = Pair { sums: [sums[0], sums[1] - sums[0]], counts: [before, compared - before] };
        Some(pair.deviation())
    }

    /// What the film keeps.
    pub(super) fn into_sums(self) -> Sums {
        let Cells { samples, layout, first, scrambles, .. } = self;
        let cells = || self.values.par_chunks_exact(layout.stride());
        let half = |half: usize| cells().map(|cell| layout.radiance(cell)[half]).collect();
        if let Layout::Plain(scramble) = layout {
            let pixels = if first == 0 { 0..self.values.len() / layout.stride() } else { 0..0 };
            let deviations =
                pixels.into_par_iter().map(|pixel| self.deviation(pixel).unwrap_or(0.0) as f32).collect();
            return Sums::of_scramble(scramble, samples, half(0), deviations);
        }
        let odd = if layout == Layout::Halved { half(1) } else { Vec::new() };
        let start = layout.greys().start;
        let greys = cells().map(|cell| std::array::from_fn(|i| cell[start + i] as f32)).collect();
        let (before, after) = (scrambles.counts(first), scrambles.counts(first + samples));
        let counts = std::array::from_fn(|i| after[i] - before[i]);
        let deviations = Vec::new();
        Sums { samples, radiance: half(0), odd, greys: Greys::All(greys), deviations, counts }
    }
}
