//! The loop over chunks. A chunk is taken in passes, so that a render which is stopped early has something to show.

use super::cells::Cells;
use super::error_pixels::ErrorPixels;
use super::meter::Meter;
use super::tile::{self, Pass, Tile};
use super::{Rendered, Settings, Watch};
use crate::error::Result;
use crate::film::Film;
use crate::integrator::Counters;
use crate::math::Rgb;
use rayon::prelude::*;
use std::ops::Range;
use std::time::Instant;

/// Takes all samples.
pub(super) fn take_samples<F>(settings: &Settings, watch: &dyn Watch, sample: F) -> Result<Rendered>
where
    F: Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync,
{
    let start = Instant::now();
    let chunk = u64::from(settings.chunk);
    let mut film = Film::new(settings.width, settings.height, chunk);
    let error_pixels = settings.error_estimate.then(|| ErrorPixels::new(settings));
    let meter = Meter::new(settings);
    let mut passes = Passes { settings, watch, meter, sample, error_pixels, counters: Counters::default() };
    let mut cancelled = false;
    for index in 0..settings.samples.div_ceil(chunk) {
        let samples = index * chunk..settings.samples.min((index + 1) * chunk);
        let wanted = samples.end - samples.start;
        let cells = passes.chunk(samples)?;
        let taken = cells.samples;
        if taken > 0 {
            film.add(index, cells.into_sums())?;
        }
        if taken < wanted {
            cancelled = true;
            break;
        }
    }
    let render_seconds = start.elapsed().as_secs_f64();
    let has_scrambles = film.samples() >= settings.scrambles().first_round();
    let error = match &passes.error_pixels {
        Some(pixels) if film.samples() > 0 => pixels.error(&film, has_scrambles),
        _ => film.picture_error().filter(|_| has_scrambles),
    };
    let (clamp, counters) = (settings.clamp, passes.counters);
    Ok(Rendered { film, counters, clamp, error, cancelled, build_seconds: 0.0, render_seconds })
}

/// What the passes of a render share.
struct Passes<'s, F> {
    settings: &'s Settings,
    watch: &'s dyn Watch,
    meter: Meter,
    sample: F,
    error_pixels: Option<ErrorPixels>,
    /// Of the complete passes.
    counters: Counters,
}

impl<F> Passes<'_, F>
where
    F: Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync,
{
    /// The sums of a chunk: of fewer samples than wanted if cancelled. Passes double what there is: 1, 1, 2, 4 ... samples,
    /// added in the same order as in one go.
    fn chunk(&mut self, samples: Range<u64>) -> Result<Cells> {
        let mut cells = Cells::new(self.settings, samples.clone())?;
        let mut complete = cells.try_clone(self.settings)?;
        while cells.samples < samples.end - samples.start {
            let next = samples.start + cells.samples;
            let end = samples.end.min(next + cells.samples.max(1));
            if !self.pass(next..end, &mut cells) {
                return Ok(complete);
            }
            if end < samples.end {
                complete.copy_from(&cells);
            }
        }
        Ok(cells)
    }

    /// Adds samples to all pixels; false if cancelled, which leaves the sums unusable.
    fn pass(&mut self, samples: Range<u64>, cells: &mut Cells) -> bool {
        let scrambles = self.settings.scrambles();
        let count = samples.end - samples.start;
        // Later the picture's own scrambles tell its error.
        let error_pixels = self.error_pixels.as_ref().filter(|_| samples.start < scrambles.first_round());
        let pass = Pass { samples, before: cells.samples, clamp: self.settings.clamp, scrambles };
        let cancelled = || self.watch.cancelled();
        let (counters, sets) = rayon::join(
            || {
                tile::split(cells, self.settings.width, self.settings.tile_side())
                    .into_par_iter()
                    .with_max_len(1)
                    .map(|mut tile: Tile<'_>| {
                        let counters = tile.sum(&pass, &self.sample, cancelled)?;
                        self.watch.progress(&self.meter.add(tile.pixels() * count, counters.rays));
                        Some(counters)
                    })
                    .try_reduce(Counters::default, |mut a, b| {
                        a += b;
                        Some(a)
                    })
            },
            || {
                error_pixels
                    .map_or(Some(None), |pixels| pixels.pass(&pass, &self.sample, cancelled).map(Some))
            },
        );
        let (Some(counters), Some(sets)) = (counters, sets) else { return false };
        if let (Some(pixels), Some(sets)) = (&mut self.error_pixels, sets) {
            pixels.keep(sets);
        }
        self.counters += counters;
        cells.samples += count;
        true
    }
}
