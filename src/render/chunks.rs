//! The loop over chunks. A chunk is taken in passes, so that a render which is stopped early has something to show.

use super::adaptive::Adaptive;
use super::cells::Cells;
use super::error_pixels::ErrorPixels;
use super::meter::Meter;
use super::outlook::{History, Outlook};
use super::pace::Pace;
use super::saved::{Snapshot, State, is_whole};
use super::so_far::SoFar;
use super::tile::{self, Pass, Tile, Work};
use super::{Ended, Rendered, Settings, Watch};
use crate::error::Result;
use crate::film::{Film, Halving, PictureError};
use crate::integrator::Counters;
use crate::math::Rgb;
use rayon::prelude::*;
use std::ops::Range;

/// Takes all samples.
pub(super) fn take_samples<F>(
    settings: &Settings,
    watch: &dyn Watch,
    sample: F,
    state: Option<State>,
) -> Result<Rendered>
where
    F: Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync,
{
    let mut chunks = Chunks::new(settings, watch, sample, state)?;
    let ended = chunks.take_all()?;
    let render_seconds = chunks.elapsed();
    let error = chunks.error();
    let error_sums = chunks.error_pixels.iter().flat_map(ErrorPixels::numbers).collect();
    let Chunks { film, work, .. } = chunks;
    let Work { samples, counters } = work;
    let clamp = settings.clamp;
    Ok(Rendered {
        film,
        samples,
        counters,
        clamp,
        error,
        error_sums,
        ended,
        features: None,
        brightest: 1.0,
        build_seconds: 0.0,
        render_seconds,
    })
}

/// A render under way.
struct Chunks<'s, F> {
    settings: &'s Settings,
    watch: &'s dyn Watch,
    sample: F,
    film: Film,
    /// Of the complete passes.
    work: Work,
    pace: Pace,
    meter: Meter,
    history: History,
    error_pixels: Option<ErrorPixels>,
    blocks: Option<Adaptive>,
    /// Of the chunk with which a resumed render begins.
    cells: Option<Cells>,
}

impl<'s, F> Chunks<'s, F>
where
    F: Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync,
{
    fn new(
        settings: &'s Settings,
        watch: &'s dyn Watch,
        sample: F,
        state: Option<State>,
    ) -> Result<Chunks<'s, F>> {
        let mut chunks = Chunks {
            settings,
            watch,
            sample,
            film: Film::of(settings.frame(), settings.chunk.into()),
            work: Work::default(),
            pace: Pace::new(settings.time),
            meter: Meter::new(settings),
            history: History::default(),
            error_pixels: ErrorPixels::wanted(settings),
            blocks: None,
            cells: None,
        };
        match state {
            Some(state) => chunks.resume(state),
            None => {
                chunks.blocks = settings.noise.map(|target| Adaptive::new(settings, target)).transpose()?;
            }
        }
        Ok(chunks)
    }

    /// Takes over what was done before.
    fn resume(&mut self, state: State) {
        let State { film, cells, work, error_sums, blocks, passed: [seconds, samples] } = state;
        if let Some(pixels) = &mut self.error_pixels {
            pixels.add(&error_sums, self.settings.region, self.settings.width);
        }
        self.pace.resume(seconds, samples);
        self.meter.resume(&work);
        (self.film, self.cells, self.work, self.blocks) = (film, cells, work, blocks);
    }

    fn take_all(&mut self) -> Result<Ended> {
        let (chunk, most) = (u64::from(self.settings.chunk), self.settings.most_samples());
        let Range { start, end } = self.settings.chunk_range();
        for index in start + self.film.samples() / chunk..end {
            if self.blocks.as_ref().is_some_and(Adaptive::is_done) {
                return Ok(Ended::Complete);
            }
            let (cells, ended) = self.chunk(index * chunk..most.min((index + 1) * chunk))?;
            let is_full = cells.samples == chunk;
            if !is_full {
                self.save(Some(&cells), true);
            }
            if cells.samples > 0 {
                self.keep(index, cells)?;
                self.watch.pass(&SoFar::new(&self.film, None));
            }
            if is_full {
                let is_done = self.blocks.as_ref().is_some_and(Adaptive::is_done);
                self.save(None, is_done || index + 1 == end);
            }
            if let Some(ended) = ended {
                return Ok(ended);
            }
        }
        let missed = self.blocks.as_ref().is_some_and(|blocks| !blocks.is_done());
        Ok(if missed { Ended::OutOfSamples } else { Ended::Complete })
    }

    /// Hands out what it takes to go on from here.
    fn save(&self, cells: Option<&Cells>, is_last: bool) {
        self.watch.keep(&Snapshot {
            film: &self.film,
            cells: cells.filter(|cells| cells.samples > 0),
            work: self.work,
            error_pixels: self.error_pixels.as_ref(),
            blocks: self.blocks.as_ref(),
            passed: self.pace.passed(),
            is_last,
        });
    }

    /// Adds a chunk to the film.
    fn keep(&mut self, index: u64, mut cells: Cells) -> Result<()> {
        let Some(blocks) = &mut self.blocks else { return self.film.add(index, cells.into_sums()) };
        let is_complete = cells.samples == u64::from(self.settings.chunk);
        blocks.take(&mut cells, is_complete);
        self.film.add(index, cells.into_sums())?;
        self.film.set_stops(blocks.stops()?);
        Ok(())
    }

    /// The sums of a chunk, and why they hold fewer samples than wanted. Passes double what there is: 1, 1, 2, 4 ...
    /// samples, or fewer where the time is short or a pass takes long, added in the same order as in one go. Where blocks
    /// stop, few pixels may be left, so all after the first chunk is one pass, unless that takes long.
    fn chunk(&mut self, samples: Range<u64>) -> Result<(Cells, Option<Ended>)> {
        let mut cells = match self.cells.take() {
            Some(cells) => cells,
            None => Cells::new(self.settings, samples.start)?,
        };
        let mut complete = cells.try_clone(self.settings)?;
        let is_one_pass = self.blocks.is_some() && samples.start > 0;
        loop {
            let next = samples.start + cells.samples;
            let doubled = if is_one_pass { u64::MAX } else { cells.samples.max(1) };
            let wanted = doubled.min(samples.end.saturating_sub(next));
            if wanted == 0 {
                return Ok((cells, None));
            }
            let fitting = self.pace.fitting(wanted, self.open_pixels());
            if fitting == 0 {
                return Ok((cells, Some(Ended::OutOfTime)));
            }
            let fitting = self.pace.bearable(fitting, self.open_pixels());
            if !self.pass(next..next + fitting, &mut cells) {
                let ended = if self.watch.cancelled() { Ended::Cancelled } else { Ended::OutOfTime };
                return Ok((complete, Some(ended)));
            }
            self.look_ahead(&cells);
            if cells.samples < samples.end - samples.start {
                complete.copy_from(&cells);
                self.save(Some(&cells), false);
                if self.blocks.is_none() {
                    self.watch.pass(&SoFar::new(&self.film, Some(&cells)));
                }
            }
        }
    }

    /// Adds samples to all pixels; false if cancelled or if the time is up, which leaves the sums unusable.
    fn pass(&mut self, samples: Range<u64>, cells: &mut Cells) -> bool {
        let scrambles = self.settings.scrambles();
        let (count, start) = (samples.end - samples.start, self.elapsed());
        // Later the picture's own scrambles tell its error.
        let error_pixels = self.error_pixels.as_ref().filter(|_| samples.start < scrambles.first_round());
        let (clamp, blocks) = (self.settings.clamp, self.blocks.as_ref());
        let side = self.settings.tile_side_for(self.open_pixels());
        let halving = Halving::new(self.settings.chunk.into());
        let pass = Pass { samples, before: cells.samples, clamp, scrambles, halving, blocks };
        let cancelled = || self.watch.cancelled() || self.pace.is_over();
        let (work, sets) = rayon::join(
            || {
                tile::split(cells, self.film.frame(), side)
                    .into_par_iter()
                    .with_max_len(1)
                    .map(|mut tile: Tile<'_>| {
                        let work = tile.sum(&pass, &self.sample, cancelled)?;
                        self.watch.progress(&self.meter.add(&work));
                        Some(work)
                    })
                    .try_reduce(Work::default, |mut a, b| {
                        a += b;
                        Some(a)
                    })
            },
            || {
                error_pixels
                    .map_or(Some(None), |pixels| pixels.pass(&pass, &self.sample, cancelled).map(Some))
            },
        );
        let (Some(work), Some(sets)) = (work, sets) else { return false };
        if let (Some(pixels), Some(sets)) = (&mut self.error_pixels, sets) {
            pixels.keep(sets);
        }
        self.pace.learn(work.samples, self.elapsed() - start);
        self.work += work;
        cells.samples += count;
        true
    }

    /// Seconds since the start, but for pauses.
    fn elapsed(&self) -> f64 {
        (self.pace.elapsed() - self.watch.paused().as_secs_f64()).max(0.0)
    }

    /// The pixels that take samples.
    fn open_pixels(&self) -> u64 {
        self.blocks.as_ref().map_or_else(|| self.settings.area(), Adaptive::open_pixels)
    }

    /// The error of the picture.
    fn error(&self) -> Option<PictureError> {
        if !is_whole(self.settings) {
            return None;
        }
        let has_scrambles = self.film.samples() >= self.settings.scrambles().first_round();
        match &self.error_pixels {
            _ if has_scrambles => self.film.picture_error(),
            Some(pixels) if self.film.samples() > 0 => pixels.error(&self.film, None),
            _ => None,
        }
    }

    /// Tells the followers the error after a pass, and where it leads.
    fn look_ahead(&mut self, cells: &Cells) {
        let samples = self.film.samples() + cells.samples;
        let error = match (&self.blocks, &self.error_pixels) {
            (Some(blocks), _) => blocks.error(),
            (None, Some(pixels)) if is_whole(self.settings) => self.error_so_far(pixels, cells),
            _ => None,
        };
        if let Some(error) = error {
            self.history.add(samples, error);
        }
        let seconds_left = self.seconds_left(samples);
        let per_sample = self.pace.seconds_per_sample().map(|seconds| seconds * self.open_pixels() as f64);
        let most = self.settings.samples_to_take() as f64;
        let at_end = match (self.pace.left(), per_sample) {
            (Some(left), Some(seconds)) => (samples as f64 + left / seconds).min(most),
            _ => most,
        };
        let error_at_end =
            self.history.error_at(at_end).map(|error| error.max(self.settings.noise.unwrap_or(0.0)));
        self.meter.tell(Outlook {
            error,
            error_at_end: error_at_end.filter(|_| error.is_some()),
            seconds_left,
        });
    }

    /// Seconds until the target, the time or the last sample is reached, whichever comes first.
    fn seconds_left(&self, samples: u64) -> Option<f64> {
        let seconds = self.pace.seconds_per_sample()?;
        let all = self.settings.samples_to_take().saturating_sub(samples) as f64 * self.open_pixels() as f64;
        let target = self.blocks.as_ref().and_then(|blocks| blocks.samples_left(self.history.slope()));
        let sampling = seconds * target.unwrap_or(all).min(all);
        Some(self.pace.left().unwrap_or(f64::INFINITY).min(sampling))
    }

    /// The relative error of the film and the cells; once the scrambles tell it, at the chosen pixels alone.
    fn error_so_far(&self, pixels: &ErrorPixels, cells: &Cells) -> Option<f64> {
        let has_scrambles = self.film.samples() >= self.settings.scrambles().first_round();
        let error = if has_scrambles {
            self.film.error_sum(pixels.chosen())?.finish(pixels.kind())
        } else {
            pixels.error(&self.film, Some(cells))
        };
        error.map(|error| error.relative.value)
    }
}
