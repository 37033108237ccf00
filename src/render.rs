//! From a world to a film. The only place where the choices of a run become types; below it everything is generic.
//!
//! Chunks of samples are the outer loop, tiles of pixels the inner one, spread over a pool of threads. After every
//! chunk all pixels have the same number of samples, and a tile writes only its own pixels: neither the tiles nor the
//! threads can be seen in the sums.

mod features;
mod memory;
mod report;
mod tile;

pub use features::{FAR, FeatureKind, FeaturePlanes};
pub(crate) use memory::available_bytes;
pub use memory::film_bytes;

use crate::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use crate::accel::embree::Embree;
use crate::accel::{Accelerator, BuildOptions, BvhQuality, Isa, Precision, check_isa};
use crate::error::{Error, Result};
use crate::film::Film;
use crate::integrator::{Counters, FeatureTracer, PathTracer};
use crate::math::Rgb;
use crate::sampling::{Independent, Sampler, SamplerKind, Sobol};
use crate::scene::desc::CameraDesc;
use crate::world::World;
use rayon::prelude::*;
use std::any::Any;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;
use tile::{Pass, Tile};

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

/// The implementations of [`Accelerator`].
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
    /// Samples per pixel, 1 to [`MAX_SAMPLES`].
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
            features: false,
        }
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
        let ranges = [
            ("samples", self.samples, MAX_SAMPLES),
            ("bounces", self.bounces.into(), MAX_BOUNCES.into()),
            ("tile", self.tile.map_or(1, u64::from), MAX_SIDE.into()),
            ("chunk", self.chunk.into(), u32::MAX.into()),
            ("threads", self.threads.map_or(1, |threads| threads as u64), MAX_THREADS as u64),
        ];
        if let Some((name, value, most)) = ranges.iter().find(|(_, value, most)| !(1..=*most).contains(value))
        {
            return Err(Error::Usage(format!("{name} must be from 1 to {most}, not {value}")));
        }
        if let Some(limit) = self.clamp.filter(|limit| !(limit.is_finite() && *limit > 0.0)) {
            return Err(Error::Usage(format!("clamp must be a finite number > 0, not {limit}")));
        }
        if self.accel == AccelKind::Embree && !cfg!(feature = "embree") {
            return Err(no_embree());
        }
        check_isa(self.isa)?;
        memory::check(self)
    }

    /// The threads that will be used.
    pub fn thread_count(&self) -> usize {
        self.threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
    }

    /// The side of the tiles that will be used: as asked, else 32 pixels, or less in a small picture so that every
    /// thread gets several.
    pub fn tile_side(&self) -> u32 {
        let tiles = |side: u32| u64::from(self.width.div_ceil(side)) * u64::from(self.height.div_ceil(side));
        let wanted = 16 * self.thread_count() as u64;
        self.tile.unwrap_or_else(|| [32, 16, 8].into_iter().find(|&side| tiles(side) >= wanted).unwrap_or(4))
    }
}

/// How far a render is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Samples taken, of all pixels.
    pub samples: u64,
    /// Samples to be taken.
    pub total: u64,
    /// Rays traced.
    pub rays: u64,
}

/// Somebody who follows a render. Called from all threads.
pub trait Watch: Sync {
    /// Called after every tile.
    fn progress(&self, progress: &Progress);

    /// Whether to stop. Asked for every pixel; the pass that is under way is given up.
    fn cancelled(&self) -> bool;
}

/// What a render made.
#[derive(Debug)]
pub struct Rendered {
    /// The sums of all samples.
    pub film: Film,
    /// What was counted for the samples that the film holds. Dropped samples, which were not finite or negative, count
    /// as black, so that all pixels have the same number of samples; there should be none.
    pub counters: Counters,
    /// What is seen, if it was asked for.
    pub features: Option<FeaturePlanes>,
    /// The limit of the samples' components.
    pub clamp: Option<f64>,
    /// Whether it was stopped before all samples were taken.
    pub cancelled: bool,
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
    let run = Run { world, camera, settings, watch };
    in_pool(settings, || match settings.accel {
        #[cfg(feature = "embree")]
        AccelKind::Embree => run.with_accel(|options| Embree::build(&world.geometry, options)),
        #[cfg(not(feature = "embree"))]
        AccelKind::Embree => Err(no_embree()),
        AccelKind::Native => run.with_accel(|options| Bvh::build(&world.geometry, options)),
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

/// A render on its way to its types.
struct Run<'r> {
    world: &'r World,
    camera: &'r CameraDesc,
    settings: &'r Settings,
    watch: &'r dyn Watch,
}

impl Run<'_> {
    fn with_accel<A: Accelerator>(&self, build: impl Fn(&BuildOptions) -> Result<A>) -> Result<Rendered> {
        let start = Instant::now();
        let Settings { precision, isa, bvh: quality, .. } = *self.settings;
        let accel = build(&BuildOptions { precision, isa, quality, ..BuildOptions::default() })?;
        let build_seconds = start.elapsed().as_secs_f64();
        let rendered = match self.settings.sampler {
            SamplerKind::Sobol => self.with_sampler(&accel, Sobol::new(self.settings.seed)),
            SamplerKind::Independent => self.with_sampler(&accel, Independent::new(self.settings.seed)),
        }?;
        Ok(Rendered { build_seconds, ..rendered })
    }

    fn with_sampler<A: Accelerator, S: Sampler>(&self, accel: &A, sampler: S) -> Result<Rendered> {
        let Settings { width, height, bounces, light_sampling, .. } = *self.settings;
        let camera = self.world.camera(self.camera, width, height);
        let tracer = PathTracer::new(self.world, &camera, accel, bounces, light_sampling);
        let rendered = take_samples(self.settings, self.watch, |x, y, index, counters| {
            tracer.sample(&sampler, x, y, index, counters)
        })?;
        if !self.settings.features {
            return Ok(rendered);
        }
        let tracer = FeatureTracer { world: self.world, camera: &camera, accelerator: accel };
        let features = features::collect(self.settings, rendered.film.samples(), |x, y, index| {
            tracer.sample(&sampler, x, y, index)
        });
        Ok(Rendered { features: Some(features?), ..rendered })
    }
}

/// The chunk loop. A chunk is taken in passes, so that a render which is stopped early has something to show.
fn take_samples<F>(settings: &Settings, watch: &dyn Watch, sample: F) -> Result<Rendered>
where
    F: Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync,
{
    let start = Instant::now();
    let chunk = u64::from(settings.chunk);
    let mut film = Film::new(settings.width, settings.height, chunk);
    let passes = Passes { settings, watch, meter: Meter::new(settings), sample };
    let mut counters = Counters::default();
    let mut cancelled = false;
    for index in 0..settings.samples.div_ceil(chunk) {
        let samples = index * chunk..settings.samples.min((index + 1) * chunk);
        let wanted = samples.end - samples.start;
        let (taken, sums) = passes.chunk(samples, &mut counters)?;
        if taken > 0 {
            film.add(index, taken, sums)?;
        }
        if taken < wanted {
            cancelled = true;
            break;
        }
    }
    let render_seconds = start.elapsed().as_secs_f64();
    let clamp = settings.clamp;
    Ok(Rendered { film, counters, features: None, clamp, cancelled, build_seconds: 0.0, render_seconds })
}

/// What the passes of a render share.
struct Passes<'s, F> {
    settings: &'s Settings,
    watch: &'s dyn Watch,
    meter: Meter,
    sample: F,
}

impl<F> Passes<'_, F>
where
    F: Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync,
{
    /// The sums of a chunk, and how many samples of a pixel they hold: fewer than wanted if cancelled. Passes double
    /// what there is: 1, 1, 2, 4 ... samples, added in the same order as in one go.
    fn chunk(&self, samples: Range<u64>, counters: &mut Counters) -> Result<(u64, Vec<Rgb>)> {
        let mut sums = memory::plane(self.settings)?;
        let mut complete = memory::plane(self.settings)?;
        let mut next = samples.start;
        while next < samples.end {
            let taken = next - samples.start;
            let end = samples.end.min(next + taken.max(1));
            let pass = Pass { samples: next..end, before: taken, clamp: self.settings.clamp };
            let Some(counted) = self.pass(&pass, &mut sums) else {
                return Ok((taken, complete));
            };
            *counters += counted;
            next = end;
            if next < samples.end {
                complete.copy_from_slice(&sums);
            }
        }
        Ok((samples.end - samples.start, sums))
    }

    /// Adds samples to all pixels; `None` if cancelled, which leaves the sums unusable.
    fn pass(&self, pass: &Pass, sums: &mut [Rgb]) -> Option<Counters> {
        let count = pass.samples.end - pass.samples.start;
        tile::split(sums, self.settings.width, self.settings.tile_side())
            .into_par_iter()
            .with_max_len(1)
            .map(|mut tile: Tile<'_>| {
                let counters = tile.sum(pass, &self.sample, || self.watch.cancelled())?;
                self.watch.progress(&self.meter.add(tile.pixels() * count, counters.rays));
                Some(counters)
            })
            .try_reduce(Counters::default, |mut a, b| {
                a += b;
                Some(a)
            })
    }
}

/// Adds up the work of all threads for [`Watch::progress`].
struct Meter {
    total: u64,
    samples: AtomicU64,
    rays: AtomicU64,
}

impl Meter {
    fn new(settings: &Settings) -> Meter {
        let pixels = u64::from(settings.width) * u64::from(settings.height);
        let total = pixels.saturating_mul(settings.samples);
        Meter { total, samples: AtomicU64::new(0), rays: AtomicU64::new(0) }
    }

    fn add(&self, samples: u64, rays: u64) -> Progress {
        Progress {
            samples: self.samples.fetch_add(samples, Ordering::Relaxed) + samples,
            total: self.total,
            rays: self.rays.fetch_add(rays, Ordering::Relaxed) + rays,
        }
    }
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
