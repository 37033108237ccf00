//! From a world to a film. The only place where the choices of a run become types; below it everything is generic.
//!
//! Chunks of samples are the outer loop, tiles of pixels the inner one, spread over a pool of threads. After every
//! chunk all pixels have the same number of samples, and a tile writes only its own pixels: neither the tiles nor the
//! threads can be seen in the sums.

mod adaptive;
mod cells;
mod chunks;
mod coverage;
mod error_pixels;
mod estimate;
mod features;
mod memory;
mod merge;
mod meter;
mod outlook;
mod pace;
mod prepared;
mod recipe;
mod report;
mod saved;
mod settings;
mod so_far;
mod tile;
mod view;

pub(crate) use crate::memory::available_bytes;
#[doc(hidden)]
pub use crate::memory::available_bytes_below;
pub use adaptive::NOISE_AFTER;
pub use estimate::Estimate;
pub use features::{FAR, FeatureKind, FeaturePlanes};
pub use memory::film_bytes;
pub use merge::{Merged, merge};
pub use outlook::Outlook;
pub use prepared::Prepared;
pub(crate) use recipe::OF_A_TASK;
pub use recipe::Recipe;
pub use saved::{FileKind, FilmFile, Origin, Snapshot, State};
pub use settings::Settings;
pub use so_far::SoFar;
pub use view::View;

use crate::error::{Error, Result};
use crate::film::{Film, PictureError};
use crate::integrator::Counters;
use crate::math::Rgb;
use crate::scene::desc::CameraDesc;
use crate::world::World;
use chunks::take_samples;
use serde::{Deserialize, Serialize};
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AccelKind {
    /// Embree, of builds with the feature `embree`.
    Embree,
    /// The BVH of this program.
    Native,
}

impl AccelKind {
    /// In the order in which they are listed to users.
    pub const ALL: [AccelKind; 2] = [AccelKind::Embree, AccelKind::Native];

    /// Those of this build, the default first.
    pub const BUILT: &[AccelKind] =
        if cfg!(feature = "embree") { &AccelKind::ALL } else { &[AccelKind::Native] };

    /// Whether this build has it.
    ///
    /// # Errors
    /// It has not; what to do about it.
    pub fn check(self) -> Result<()> {
        if AccelKind::BUILT.contains(&self) { Ok(()) } else { Err(self.missing()) }
    }

    /// The answer to who asks for it in a build without it.
    pub(crate) fn missing(self) -> Error {
        let name = self.name();
        Error::Usage(format!(
            "this build has no accelerator `{name}`, only `native`: install Debian's lib{name}-dev and build with \
             `--features {name}`"
        ))
    }

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
        AccelKind::BUILT[0]
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

    /// How long [`Watch::progress`] has held the render so far. It counts to a limit of time, but not to how fast samples are
    /// taken.
    fn paused(&self) -> Duration {
        Duration::ZERO
    }

    /// Called after every pass, by the thread that waits for the render, with the picture so far: it has the bytes of a
    /// render of as many samples. Where blocks stop, after every chunk.
    fn pass(&self, _so_far: &SoFar<'_>) {}

    /// Called by the same thread wherever the render could go on later, with all that it needs for that.
    fn keep(&self, _snapshot: &Snapshot<'_>) {}
}

/// Nobody: sees nothing and stops nothing.
#[derive(Clone, Copy, Debug)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn progress(&self, _: &Progress) {}

    fn cancelled(&self) -> bool {
        false
    }
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
    /// The brightest light, the unit of [`Counters::last_light`].
    pub brightest: f64,
    /// How far the picture is from the truth, estimated from the film if its eight scrambles have their first round,
    /// else as [`Settings::error_estimate`] says; `None` without either.
    pub error: Option<PictureError>,
    /// The sums by which the error is estimated where the film can't tell it.
    pub(crate) error_sums: Vec<f64>,
    /// Why it has ended.
    pub ended: Ended,
    /// Seconds to build the accelerator.
    pub build_seconds: f64,
    /// Seconds from the first ray to the last, but for pauses.
    pub render_seconds: f64,
}

/// Renders what `camera` sees of `world`.
///
/// A render that is cancelled is no error: it holds the complete passes, maybe none.
///
/// # Errors
/// Settings that can't be, an accelerator that can't be built, a bug met on the way.
pub fn render(
    world: &World,
    camera: &CameraDesc,
    settings: &Settings,
    watch: &dyn Watch,
) -> Result<Rendered> {
    resume(world, camera, settings, watch, None)
}

/// Renders on from where a checkpoint was; see [`render`].
///
/// # Errors
/// As [`render`].
pub fn resume(
    world: &World,
    camera: &CameraDesc,
    settings: &Settings,
    watch: &dyn Watch,
    state: Option<State>,
) -> Result<Rendered> {
    settings.check()?;
    in_pool(settings, || {
        let prepared = Prepared::build_here(&world.geometry, settings)?;
        prepared.render_here(world, camera, settings, watch, state)
    })
}

/// Sums `sample(x, y, index, counters)` over all pixels and samples of `settings`; [`render`] without a scene.
///
/// # Errors
/// Settings that can't be, a bug met on the way.
pub fn accumulate<F>(settings: &Settings, watch: &dyn Watch, sample: F) -> Result<Rendered>
where
    F: Fn(u32, u32, u64, &mut Counters) -> Rgb + Sync,
{
    settings.check()?;
    in_pool(settings, || take_samples(settings, watch, &sample, None))
}

/// Runs `work` in a pool of its own, of as many threads as `settings` say. A panic in any of them becomes an error.
pub(crate) fn in_pool<T: Send>(settings: &Settings, work: impl FnOnce() -> Result<T> + Send) -> Result<T> {
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
