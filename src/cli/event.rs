//! `--json`: one JSON object a line on stdout.

use super::arguments::Job;
use crate::accel::Isa;
use crate::error::{Diagnostic, Error, Severity};
use crate::film::PictureError;
use crate::render::{Ended, Progress, Rendered};
use crate::world::Requires;
use serde::Serialize;
use std::io::{self, Write};
use std::time::Duration;

/// A line of output.
#[derive(Debug, Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
pub(super) enum Event<'e> {
    /// Rendering begins.
    Start {
        #[serde(flatten)]
        job: JobRecord,
        requires: &'e Requires,
        /// Of the scene.
        warnings: Vec<DiagnosticRecord>,
    },
    /// Rendering goes on.
    Progress {
        samples: u64,
        /// Null where there is no limit.
        total: Option<u64>,
        rays: u64,
        seconds: f64,
        eta_seconds: f64,
        samples_per_second: f64,
        /// The relative error so far and at the end; null where not known.
        error: Option<f64>,
        error_at_end: Option<f64>,
    },
    /// The picture is written.
    Done(Summary<'e>),
    /// The picture is written, or of a part the checkpoint, with fewer samples than asked for.
    Interrupted(Summary<'e>),
    /// The program ends without a picture.
    Error { code: u8, message: String, diagnostics: Vec<DiagnosticRecord> },
}

/// The settings of a render. `isa` is null for the machine's best, `clamp`, `noise` and `time_seconds` for no limit.
#[derive(Debug, Serialize)]
pub(super) struct JobRecord {
    version: &'static str,
    scene: String,
    image: String,
    width: u32,
    height: u32,
    samples: u64,
    bounces: u32,
    accel: &'static str,
    precision: &'static str,
    isa: Option<&'static str>,
    bvh: &'static str,
    threads: usize,
    tile: u32,
    chunk: u32,
    seed: u64,
    sampler: &'static str,
    scramble_length: u64,
    light_sampling: bool,
    clamp: Option<f64>,
    noise: Option<f64>,
    time_seconds: Option<f64>,
    exposure: f64,
}

/// What a render was, took and made.
#[derive(Debug, Serialize)]
pub(super) struct Summary<'e> {
    #[serde(flatten)]
    job: JobRecord,
    requires: &'e Requires,
    /// Samples per pixel in the picture; with `noise` the most. A render with so many makes the same picture.
    samples_taken: u64,
    /// Samples of all pixels; with `noise` also those that only decided where blocks stopped.
    all_samples: u64,
    /// Whether there is more noise than asked for.
    noise_missed: bool,
    error: Option<ErrorRecord>,
    #[serde(flatten)]
    counts: Counts,
    /// Components of pixels that were written as the largest number that the picture can say.
    cut_components: u64,
    rays: u64,
    #[serde(flatten)]
    seconds: Seconds,
    samples_per_second: f64,
    rays_per_second: f64,
}

/// How far the picture is from the truth, with 95 % intervals; null where that is not known.
#[derive(Debug, Serialize)]
struct ErrorRecord {
    /// The root of the expected relMSE.
    relative: f64,
    relative_interval: [f64; 2],
    /// Over pixels and components, as radiance.
    mean: f64,
    mean_interval: [f64; 2],
    mean_standard_error: f64,
    /// Whether a few pixels carry most of the error.
    doubtful: bool,
}

/// What was odd about the samples of a picture.
#[derive(Debug, Serialize)]
struct Counts {
    dropped_samples: u64,
    refused_rays: u64,
    self_hits: u64,
    cut_paths: u64,
    /// Share of the samples' throughput that arrived with the last segment, 0 to 1.
    cut_throughput: f64,
    /// Estimated share of the light that these paths would have brought, 0 to 1; null without light.
    cut_light: Option<f64>,
    fireflies: u64,
    clamped_samples: u64,
    /// Off the picture's mean, in units of radiance; null without a limit.
    clamp_removed: Option<f64>,
    /// Share of the unclamped picture's light, 0 to 1; null without a limit.
    clamp_bias: Option<f64>,
}

/// What the parts of a run took.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Seconds {
    /// To read the scene and its meshes.
    #[serde(rename = "load_seconds")]
    pub(super) load: f64,
    /// To compile the world and build the accelerator.
    #[serde(rename = "build_seconds")]
    pub(super) build: f64,
    /// From the first ray to the last.
    #[serde(rename = "render_seconds")]
    pub(super) render: f64,
    /// To write the picture.
    #[serde(rename = "write_seconds")]
    pub(super) write: f64,
}

/// A mistake in an input file.
#[derive(Debug, Serialize)]
pub(super) struct DiagnosticRecord {
    severity: &'static str,
    message: String,
    file: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
    help: Option<String>,
}

impl JobRecord {
    pub(super) fn new(job: &Job) -> JobRecord {
        let settings = &job.settings;
        JobRecord {
            version: env!("CARGO_PKG_VERSION"),
            scene: job.scene.to_string_lossy().into_owned(),
            image: job.image.to_string_lossy().into_owned(),
            width: settings.width,
            height: settings.height,
            samples: settings.samples,
            bounces: settings.bounces,
            accel: settings.accel.name(),
            precision: settings.precision.name(),
            isa: settings.isa.map(Isa::name),
            bvh: settings.bvh.name(),
            threads: settings.thread_count(),
            tile: settings.tile_side(),
            chunk: settings.chunk,
            seed: settings.seed,
            sampler: settings.sampler.name(),
            scramble_length: settings.scrambles().length(),
            light_sampling: settings.light_sampling,
            clamp: settings.clamp,
            noise: settings.noise,
            time_seconds: settings.time.map(|time| time.as_secs_f64()),
            exposure: job.exposure,
        }
    }
}

impl<'e> Summary<'e> {
    pub(super) fn new(
        job: &Job,
        requires: &'e Requires,
        rendered: &Rendered,
        cut_components: u64,
        seconds: Seconds,
    ) -> Summary<'e> {
        let Rendered { film, counters, .. } = rendered;
        Summary {
            job: JobRecord::new(job),
            requires,
            samples_taken: film.samples(),
            all_samples: rendered.samples,
            noise_missed: job.settings.noise.is_some() && rendered.ended != Ended::Complete,
            error: rendered.error.as_ref().map(ErrorRecord::new),
            counts: Counts::new(rendered),
            cut_components,
            rays: counters.rays,
            seconds,
            samples_per_second: per_second(rendered.samples(), seconds.render),
            rays_per_second: per_second(counters.rays as f64, seconds.render),
        }
    }
}

impl ErrorRecord {
    fn new(error: &PictureError) -> ErrorRecord {
        let PictureError { relative, mean, standard_error, is_doubtful } = *error;
        ErrorRecord {
            relative: relative.value,
            relative_interval: [relative.low, relative.high],
            mean: mean.value,
            mean_interval: [mean.low, mean.high],
            mean_standard_error: standard_error,
            doubtful: is_doubtful,
        }
    }
}

impl Counts {
    fn new(rendered: &Rendered) -> Counts {
        let counters = &rendered.counters;
        Counts {
            dropped_samples: counters.dropped,
            refused_rays: counters.refused,
            self_hits: counters.self_hits,
            cut_paths: counters.cut_paths,
            cut_throughput: rendered.cut_share(),
            cut_light: rendered.cut_light(),
            fireflies: counters.fireflies,
            clamped_samples: counters.clamped,
            clamp_removed: rendered.clamp_removed(),
            clamp_bias: rendered.clamp_bias(),
        }
    }
}

impl Event<'_> {
    /// `limited`: whether the number of samples is.
    pub(super) fn progress(progress: &Progress, elapsed: Duration, limited: bool) -> Event<'static> {
        let seconds = elapsed.as_secs_f64();
        Event::Progress {
            samples: progress.samples,
            total: Some(progress.total).filter(|_| limited),
            rays: progress.rays,
            seconds,
            eta_seconds: eta(progress, elapsed).as_secs_f64(),
            samples_per_second: per_second(progress.samples as f64, seconds),
            error: progress.outlook.error,
            error_at_end: progress.outlook.error_at_end,
        }
    }

    pub(super) fn error(code: u8, error: &anyhow::Error) -> Event<'static> {
        match error.downcast_ref::<Error>() {
            Some(Error::Scene(all)) => {
                let diagnostics = all.iter().map(DiagnosticRecord::new).collect();
                Event::Error { code, message: "the scene has mistakes".into(), diagnostics }
            }
            _ => {
                let text = error.to_string();
                let message = text.strip_prefix("error: ").unwrap_or(&text).trim_end().to_owned();
                Event::Error { code, message, diagnostics: Vec::new() }
            }
        }
    }
}

impl DiagnosticRecord {
    pub(super) fn new(diagnostic: &Diagnostic) -> DiagnosticRecord {
        let location = diagnostic.location.as_ref();
        DiagnosticRecord {
            severity: match diagnostic.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
            },
            message: diagnostic.message.clone(),
            file: location.map(|location| location.file.to_string_lossy().into_owned()),
            line: location.map(|location| location.line),
            column: location.map(|location| location.column),
            help: diagnostic.help.clone(),
        }
    }
}

/// Prints an event. A reader that has gone away does not stop the render.
pub(super) fn emit(event: &impl Serialize) {
    if let Ok(line) = serde_json::to_string(event) {
        let mut stdout = io::stdout().lock();
        let _ = writeln!(stdout, "{line}").and_then(|()| stdout.flush());
    }
}

/// The time that is left if it goes on as it did so far.
pub(super) fn eta(progress: &Progress, elapsed: Duration) -> Duration {
    if let Some(seconds) = progress.outlook.seconds_left {
        return Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
    }
    let left = progress.total.saturating_sub(progress.samples) as f64;
    let factor = left / progress.samples.max(1) as f64;
    Duration::try_from_secs_f64(elapsed.as_secs_f64() * factor).unwrap_or(Duration::MAX)
}

/// A rate; zero where no time has passed.
pub(super) fn per_second(count: f64, seconds: f64) -> f64 {
    if seconds > 0.0 { count / seconds } else { 0.0 }
}
