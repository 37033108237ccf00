//! What to render, but for the scene, and whether it can be.

use super::{
    AccelKind, CHUNK, MAX_BOUNCES, MAX_PIXELS, MAX_SAMPLES, MAX_SIDE, MAX_THREADS, MIN_TIME, SCRAMBLE_LENGTH,
    SHORT_SCRAMBLE_LENGTH, memory, saved,
};
use crate::accel::{BvhQuality, Isa, Precision, check_isa};
use crate::error::{Error, Result};
use crate::film::{Frame, Region};
use crate::sampling::{SamplerKind, Scrambles};
use std::ops::Range;
use std::time::Duration;

/// What to render, but for the scene.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Pixels in a row, 1 to [`MAX_SIDE`].
    pub width: u32,
    /// Rows, 1 to [`MAX_SIDE`].
    pub height: u32,
    /// Samples per pixel, 1 to [`MAX_SAMPLES`]; with `noise` or `time` the most, and 0 for no limit.
    pub samples: u64,
    /// The longest path in ray segments, 1 to [`MAX_BOUNCES`].
    pub bounces: u32,
    /// What finds hits.
    pub accel: AccelKind,
    /// How hits of triangles are found.
    pub precision: Precision,
    /// The most instructions to use, or `None` for the machine's best.
    pub isa: Option<Isa>,
    /// How the accelerator's tree is built.
    pub bvh: BvhQuality,
    /// Threads, 1 to [`MAX_THREADS`], or `None` for one a core.
    pub threads: Option<usize>,
    /// Side of a tile in pixels, 1 to [`MAX_SIDE`], or `None` to choose one that keeps all threads busy.
    pub tile: Option<u32>,
    /// Samples per pixel in a chunk, at least 1.
    pub chunk: u32,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Where random numbers come from.
    pub sampler: SamplerKind,
    /// Whether lights are sampled; without, they are only found by chance.
    pub light_sampling: bool,
    /// The most that a component of a sample's radiance may be, > 0 and finite, or `None` for no limit. A limit makes
    /// the picture too dark, by [`Rendered::clamp_removed`](super::Rendered::clamp_removed).
    pub clamp: Option<f64>,
    /// Samples in the first round of each of a pixel's eight scrambles, at least 1, or `None` to choose: see [`Scrambles`].
    /// Part of what determines the picture.
    pub scramble_length: Option<u32>,
    /// Whether to estimate the error of the picture while the scrambles can't tell it: a few pixels then take seven more
    /// scrambles, whose samples do not enter the picture. They are about 1 pixel in 270, so at most 3 % more work, but 64
    /// where the picture has as many.
    pub error_estimate: bool,
    /// The relative error, > 0, at which blocks of 16 x 16 pixels stop, from [`NOISE_AFTER`](super::NOISE_AFTER) samples on: the root of the mean
    /// over a block's pixels and components of variance / (mean^2 + 0.01). Part of what determines the picture.
    pub noise: Option<f64>,
    /// How long sampling may take, at least [`MIN_TIME`]. One sample a pixel is taken in any case. The picture is that of a
    /// render whose `samples` are what this one took.
    pub time: Option<Duration>,
    /// Whether features are collected too: albedo, normals, depth, positions, objects. They do not change the light.
    pub features: bool,
    /// The pixels that take samples; the film holds no others.
    pub region: Region,
    /// The chunks of [`Settings::chunk`] samples that are taken, of those of all `samples`; `None` for all.
    pub chunks: Option<Range<u64>>,
}

impl Settings {
    /// A render of these sizes with everything else at its default.
    pub fn new(width: u32, height: u32, samples: u64, bounces: u32) -> Settings {
        Settings {
            width,
            height,
            samples,
            bounces,
            accel: AccelKind::default(),
            precision: Precision::default(),
            isa: None,
            bvh: BvhQuality::default(),
            threads: None,
            tile: None,
            chunk: CHUNK,
            seed: 0,
            sampler: SamplerKind::default(),
            light_sampling: true,
            clamp: None,
            scramble_length: None,
            error_estimate: false,
            noise: None,
            time: None,
            features: false,
            region: Region::All,
            chunks: None,
        }
    }

    /// The command line, without the program's name, that renders the scene in `scene` with these settings into the file
    /// `image`, but for the features; of machines and threads it says nothing.
    pub fn arguments(&self, scene: &str, image: &str) -> Vec<String> {
        let Settings { width, height, samples, bounces, .. } = self;
        let mut words = vec![scene.to_owned()];
        words.extend([width.to_string(), height.to_string(), samples.to_string(), bounces.to_string()]);
        words.push(image.to_owned());
        words.extend(self.region.option().into_iter().flatten());
        words.extend(
            self.chunks
                .iter()
                .flat_map(|chunks| ["--chunks".into(), format!("{}..{}", chunks.start, chunks.end)]),
        );
        words.extend(self.options());
        words
    }

    /// The options that differ from their defaults. Where accelerators differ, the accelerator is named in any case: the
    /// default is that of the build.
    fn options(&self) -> Vec<String> {
        let defaults = Settings::new(1, 1, 1, 1);
        let is_inexact = self.precision != defaults.precision;
        let accel = (is_inexact || self.accel != defaults.accel).then(|| self.accel.name().to_owned());
        let all: [(&str, Option<String>); 12] = [
            ("--seed", (self.seed != defaults.seed).then(|| self.seed.to_string())),
            ("--sampler", (self.sampler != defaults.sampler).then(|| self.sampler.to_string())),
            ("--light-sampling", (!self.light_sampling).then(|| "off".to_owned())),
            ("--clamp", self.clamp.map(|limit| limit.to_string())),
            ("--noise", self.noise.map(|target| target.to_string())),
            ("--time", self.time.map(|time| time.as_secs_f64().to_string())),
            ("--scramble-length", self.scramble_length.map(|length| length.to_string())),
            ("--error-estimate", (!self.error_estimate).then(|| "off".to_owned())),
            ("--precision", is_inexact.then(|| self.precision.name().to_owned())),
            ("--accel", accel),
            ("--isa", self.isa.map(|isa| isa.name().to_owned())),
            ("--bvh", (self.bvh != defaults.bvh).then(|| self.bvh.name().to_owned())),
        ];
        let given = all.into_iter().filter_map(|(option, value)| Some([option.to_owned(), value?]));
        given.flatten().collect()
    }

    /// How the samples of a pixel are spread over its scrambles.
    pub fn scrambles(&self) -> Scrambles {
        Scrambles::new(self.scramble_length.unwrap_or(self.chosen_scramble_length()).into())
    }

    /// The length of the scrambles where none is asked for.
    pub(crate) fn chosen_scramble_length(&self) -> u32 {
        match self.sampler {
            SamplerKind::Sobol if self.noise.is_none() => SCRAMBLE_LENGTH,
            _ => SHORT_SCRAMBLE_LENGTH,
        }
    }

    /// Where sampling ends at the latest.
    pub fn most_samples(&self) -> u64 {
        if self.samples == 0 { MAX_SAMPLES } else { self.samples }
    }

    /// Whether this can be rendered on this machine: ranges, memory for the film, features of the build. Nothing is
    /// allocated.
    ///
    /// # Errors
    /// The first thing that can't be, with what would be right.
    pub fn check(&self) -> Result<()> {
        self.check_ranges()?;
        self.check_part()?;
        self.accel.check()?;
        check_isa(self.isa)?;
        memory::check(self)
    }

    /// Whether all numbers are in range.
    pub(super) fn check_ranges(&self) -> Result<()> {
        let sides = 1..=MAX_SIDE;
        let pixels = u64::from(self.width) * u64::from(self.height);
        if !sides.contains(&self.width) || !sides.contains(&self.height) || pixels > MAX_PIXELS {
            return Err(Error::Usage(format!(
                "a picture of {} x {} pixels can't be rendered: each side is 1 to {MAX_SIDE} pixels, all \
                 together at most {MAX_PIXELS}",
                self.width, self.height
            )));
        }
        let samples = if self.has_other_end() { self.most_samples() } else { self.samples };
        let ranges = [
            ("samples", samples, MAX_SAMPLES),
            ("bounces", self.bounces.into(), MAX_BOUNCES.into()),
            ("tile", self.tile.map_or(1, u64::from), MAX_SIDE.into()),
            ("chunk", self.chunk.into(), u32::MAX.into()),
            ("threads", self.threads.map_or(1, |threads| threads as u64), MAX_THREADS as u64),
            ("scramble length", self.scramble_length.map_or(1, u64::from), u32::MAX.into()),
        ];
        if let Some((name, value, most)) = ranges.iter().find(|(_, value, most)| !(1..=*most).contains(value))
        {
            return Err(Error::Usage(format!("{name} must be from 1 to {most}, not {value}")));
        }
        if let Some(limit) = self.clamp.filter(|limit| !(limit.is_finite() && *limit > 0.0)) {
            return Err(Error::Usage(format!("clamp must be a finite number > 0, not {limit}")));
        }
        if let Some(target) = self.noise.filter(|target| !(target.is_finite() && *target > 0.0)) {
            return Err(Error::Usage(format!("noise must be a finite number > 0, not {target}")));
        }
        if let Some(time) = self.time.filter(|&time| time < MIN_TIME) {
            return Err(Error::Usage(format!("time must be at least {MIN_TIME:?}, not {time:?}")));
        }
        self.region.check(self.width, self.height, self.noise.is_some())
    }

    /// Whether it can be a part of a picture.
    fn check_part(&self) -> Result<()> {
        if !saved::is_whole(self) && self.time.is_some() {
            return Err(Error::Usage(
                "parts of a picture can't have a --time: they need the same samples".into(),
            ));
        }
        let Some(Range { start, end }) = self.chunks else { return Ok(()) };
        if self.noise.is_some() {
            let why =
                "--chunks can't be with --noise: where blocks stop depends on all chunks before; use --part";
            return Err(Error::Usage(why.into()));
        }
        let all = self.most_samples().div_ceil(self.chunk.into());
        if start < end && end <= all {
            return Ok(());
        }
        Err(Error::Usage(format!(
            "the chunks {start}..{end} can't be rendered: {} samples make {all} chunks of {}, numbered from 0",
            self.samples, self.chunk
        )))
    }

    /// The chunks that are taken, at most.
    pub fn chunk_range(&self) -> Range<u64> {
        self.chunks.clone().unwrap_or(0..self.most_samples().div_ceil(self.chunk.into()))
    }

    /// Samples per pixel that are taken, at most.
    pub fn samples_to_take(&self) -> u64 {
        let Range { start, end } = self.chunk_range();
        let chunk = u64::from(self.chunk);
        end.saturating_mul(chunk).min(self.most_samples()).saturating_sub(start.saturating_mul(chunk))
    }

    /// The pixels that take samples, as planes of them are numbered.
    pub fn frame(&self) -> Frame {
        Frame::new(self.width, self.height, self.region)
    }

    /// How many they are.
    pub fn area(&self) -> u64 {
        self.region.area(self.width, self.height)
    }

    /// Whether something else than the number of samples may end the render.
    fn has_other_end(&self) -> bool {
        self.noise.is_some() || self.time.is_some()
    }

    /// The threads that will be used.
    pub fn thread_count(&self) -> usize {
        self.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
    }

    /// The side of the tiles that will be used: as asked, else 32 pixels, or less in a small picture so that every
    /// thread gets several.
    pub fn tile_side(&self) -> u32 {
        self.tile_side_for(self.area())
    }

    /// The same where only so many pixels, close together, still take samples.
    pub(super) fn tile_side_for(&self, pixels: u64) -> u32 {
        let all = u64::from(self.width) * u64::from(self.height);
        let tiles = |side: u32| {
            let tiles = u64::from(self.width.div_ceil(side)) * u64::from(self.height.div_ceil(side));
            tiles * pixels / all
        };
        let wanted = 16 * self.thread_count() as u64;
        self.tile.unwrap_or_else(|| [32, 16, 8].into_iter().find(|&side| tiles(side) >= wanted).unwrap_or(4))
    }
}
