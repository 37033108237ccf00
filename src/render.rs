//! From a world to a film. The only place where the choices of a run become types; below it everything is generic.
//!
//! Chunks of samples are the outer loop, tiles of pixels the inner one, spread over a pool of threads. After every
//! chunk all pixels have the same number of samples, and a tile writes only its own pixels: neither the tiles nor the
//! threads can be seen in the sums.

mod adaptive;
mod cells;
mod chunks;
mod error_pixels;
mod features;
mod memory;
mod meter;
mod outlook;
mod pace;
mod prepared;
mod report;
mod so_far;
mod tile;

pub use adaptive::NOISE_AFTER;
pub use features::{FAR, FeatureKind, FeaturePlanes};
pub(crate) use memory::available_bytes;
pub use memory::film_bytes;
pub use outlook::Outlook;
pub use prepared::Prepared;
pub use so_far::SoFar;

use crate::accel::{BvhQuality, Isa, Precision, check_isa};
use crate::error::{Error, Result};
use crate::film::{Film, PictureError};
use crate::integrator::Counters;
use crate::math::Rgb;
use crate::sampling::{SamplerKind, Scrambles};
use crate::scene::desc::CameraDesc;
use crate::world::World;
use chunks::take_samples;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Duration;

/// The widest and highest picture, in pixels.
pub const MAX_SIDE: u32 = 65_536;
/// The largest picture, in pixels.
pub const MAX_PIXELS: u64 = 1 << 30;
/// The most samples per pixel.
pub const MAX_SAMPLES: u64 = 1 << 32;
/// The longest path, in segments. A closed white scene keeps paths for ever, and a stop is asked for between pixels.
pub const MAX_BOUNCES: u32 = 65_536;
/// The most threads that can be asked for.
pub const MAX_THREADS: usize = 1024;
/// Samples a pixel in a chunk, unless set otherwise: few enough that stopping loses little, enough that waiting for
/// the last tile of a chunk costs little.
pub const CHUNK: u32 = 16;
/// The shortest time that can be asked for.
pub const MIN_TIME: Duration = Duration::from_millis(100);
/// A sample is a firefly if its largest component is more than so many times that of the mean of the samples before it
/// in its pixel and chunk.
///
/// That mean is taken where a chunk's passes begin (at 8, 16, 32 ... samples of a chunk), and only from
/// [`FIREFLY_BEFORE`] samples on that are not all black; so of a chunk of 16 samples the second half is judged. It is a
/// ratio: the scale of the lights does not matter. Fireflies stay in the picture;
/// with a limit, samples are judged as they are limited.
pub const FIREFLY: f64 = 100.0;
/// The fewest samples of a pixel and chunk by which others are judged to be fireflies.
pub const FIREFLY_BEFORE: u64 = 8;

/// Samples in the first round of every scramble, unless set otherwise: so many are worth keeping together, and the eight
/// scrambles that error bars need are complete at eight times as many. Splitting 64 samples into 8 scrambles was measured
/// to cost 1.5 to 1.6 times the relMSE on smooth scenes.
pub const SCRAMBLE_LENGTH: u32 = 128;
/// The same where splitting costs nothing, or where error bars are wanted after few samples.
pub const SHORT_SCRAMBLE_LENGTH: u32 = 2;

/// The implementations of [`Accelerator`](crate::accel::Accelerator).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AccelKind {
    /// Embree, of builds with the feature `embree`.
    Embree,
    /// The BVH of this program.
    Native,
}

impl AccelKind {
    /// The name on the command line and in pictures.
    pub const fn name(self) -> &'static str {
        match self {
            AccelKind::Embree => "embree",
            AccelKind::Native => "native",
        }
    }
}

impl Default for AccelKind {
    /// Embree where it is compiled in.
    fn default() -> AccelKind {
        if cfg!(feature = "embree") { AccelKind::Embree } else { AccelKind::Native }
    }
}

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
    /// the picture too dark, by [`Rendered::clamp_removed`].
    pub clamp: Option<f64>,
    /// Samples in the first round of each of a pixel's eight scrambles, at least 1, or `None` to choose: see [`Scrambles`].
    /// Part of what determines the picture.
    pub scramble_length: Option<u32>,
    /// Whether to estimate the error of the picture while the scrambles can't tell it: a few pixels then take seven more
    /// scrambles, whose samples do not enter the picture. They are about 1 pixel in 270, so at most 3 % more work, but 64
    /// where the picture has as many.
    pub error_estimate: bool,
    /// The relative error, > 0, at which blocks of 16 x 16 pixels stop, from [`NOISE_AFTER`] samples on: the root of the mean
    /// over a block's pixels and components of variance / (mean^2 + 0.01). Part of what determines the picture.
    pub noise: Option<f64>,
    /// How long sampling may take, at least [`MIN_TIME`]. One sample a pixel is taken in any case. The picture is that of a
    /// render whose `samples` are what this one took.
    pub time: Option<Duration>,
    /// Whether features are collected too: albedo, normals, depth, positions, objects. They do not change the light.
    pub features: bool,
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
        }
    }

    /// How the samples of a pixel are spread over its scrambles.
    pub fn scrambles(&self) -> Scrambles {
        let chosen = match self.sampler {
            SamplerKind::Sobol if self.noise.is_none() => SCRAMBLE_LENGTH,
            _ => SHORT_SCRAMBLE_LENGTH,
        };
        Scrambles::new(self.scramble_length.unwrap_or(chosen).into())
    }

    /// Where sampling ends at the latest.
    pub fn most_samples(&self) -> u64 {
        if self.samples == 0 { MAX_SAMPLES } else { self.samples }
    }

    /// Whether this can be rendered on this machine: ranges, memory for the film, features of the build. Nothing is
    /// allocated.
    pub fn check(&self) -> Result<()> {
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
        if self.accel == AccelKind::Embree && !cfg!(feature = "embree") {
            return Err(no_embree());
        }
        check_isa(self.isa)?;
        memory::check(self)
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
        self.tile_side_for(u64::from(self.width) * u64::from(self.height))
    }

    /// The same where only so many pixels, close together, still take samples.
    fn tile_side_for(&self, pixels: u64) -> u32 {
        let all = u64::from(self.width) * u64::from(self.height);
        let tiles = |side: u32| {
            let tiles = u64::from(self.width.div_ceil(side)) * u64::from(self.height.div_ceil(side));
            tiles * pixels / all
        };
        let wanted = 16 * self.thread_count() as u64;
        self.tile.unwrap_or_else(|| [32, 16, 8].into_iter().find(|&side| tiles(side) >= wanted).unwrap_or(4))
    }
}

/// How far a render is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Samples taken, of all pixels.
    pub samples: u64,
    /// Samples to be taken, at most.
    pub total: u64,
    /// Rays traced.
    pub rays: u64,
    /// What is known about the error, after the last pass.
    pub outlook: Outlook,
}

/// Why a render has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// All samples are taken, or the noise is low enough.
    Complete,
    /// The noise is not low enough after the most samples.
    OutOfSamples,
    /// The time was up first.
    OutOfTime,
    /// It was cancelled.
    Cancelled,
}

/// Somebody who follows a render. Called from all threads.
pub trait Watch: Sync {
    /// Called after every tile.
    fn progress(&self, progress: &Progress);

    /// Whether to stop. Asked for every pixel; the pass that is under way is given up.
    fn cancelled(&self) -> bool;

    /// Called after every pass, by the thread that waits for the render, with the picture so far: it has the bytes of a
    /// render of as many samples. Where blocks stop, after every chunk.
    fn pass(&self, _so_far: &SoFar<'_>) {}
}

/// What a render made.
#[derive(Debug)]
pub struct Rendered {
    /// The sums of all samples.
    pub film: Film,
    /// Samples taken, of all pixels; with [`Settings::noise`] also those which only decided where blocks stopped.
    pub samples: u64,
    /// What was counted for these samples. Dropped samples, which were not finite or negative, count
    /// as black, so that all pixels have the same number of samples; there should be none.
    pub counters: Counters,
    /// What is seen, if it was asked for.
    pub features: Option<FeaturePlanes>,
    /// The limit of the samples' components.
    pub clamp: Option<f64>,
    /// How far the picture is from the truth, estimated from the film if its eight scrambles have their first round,
    /// else as [`Settings::error_estimate`] says; `None` without either.
    pub error: Option<PictureError>,
    /// Why it has ended.
    pub ended: Ended,
    /// Seconds to build the accelerator.
    pub build_seconds: f64,
    /// Seconds from the first ray to the last.
    pub render_seconds: f64,
}

/// Renders what `camera` sees of `world`.
///
/// A render that is cancelled is no error: it holds the complete passes, maybe none. Errors: settings that can't be, an
/// accelerator that can't be built, a bug met on the way.
pub fn render(
    world: &World,
    camera: &CameraDesc,
    settings: &Settings,
    watch: &dyn Watch,
) -> Result<Rendered> {
    settings.check()?;
    in_pool(settings, || {
        let prepared = Prepared::build_here(&world.geometry, settings)?;
        prepared.render_here(world, camera, settings, watch)
    })
}

/// Sums `sample(x, y, index, counters)` over all pixels and samples of `settings`; [`render`] without a scene.
pub fn accumulate<F>(settings: &Settings, watch: &dyn Watch, sample: F) -> Result<Rendered>
where
    F: Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync,
{
    settings.check()?;
    in_pool(settings, || take_samples(settings, watch, &sample))
}

/// Runs `work` in a pool of its own, of as many threads as `settings` say. A panic in any of them becomes an error.
pub fn in_pool<T: Send>(settings: &Settings, work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
    let threads = settings.thread_count();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Error::Unavailable(format!("cannot start {threads} threads: {error}")))?;
    catch_unwind(AssertUnwindSafe(|| pool.install(work)))
        .unwrap_or_else(|payload| Err(Error::Internal(panic_message(payload.as_ref()).to_owned())))
}

fn panic_message(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<&str>().copied();
    text.or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("a panic without a message")
}

fn no_embree() -> Error {
    Error::Usage(
        "this build has no Embree: install Debian's libembree-dev and build with `--features embree`, or use \
         `--accel native`"
            .into(),
    )
}
