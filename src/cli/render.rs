//! `pathtracer SCENE WIDTH HEIGHT SAMPLES BOUNCES IMAGE`.

use super::arguments::Job;
use super::console::{digits, duration, say, with_prefix};
use super::event::{self, DiagnosticRecord, Event, JobRecord, Seconds, Summary, per_second};
use super::keeper::Keeper;
use super::progress::Reporter;
use super::saving::{self, Found};
use super::{describe, findings, interrupt};
use crate::error::{Diagnostic, Error, Result};
use crate::film::PictureError;
use crate::film::file::FilePlace;
use crate::output::{self, Aov, Provenance, Target, same_file};
use crate::picture::{Destination, Format};
use crate::render::{Ended, Estimate, Origin, Recipe, Rendered, View, in_pool, resume};
use crate::scene::{self, desc::CameraDesc};
use crate::study::rounds::timed;
use crate::world::World;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The exit code of a picture that is noisier than asked for because the time was up.
const NOISE_MISSED: u8 = 5;

/// Where the result goes.
enum Output {
    /// A picture, and the errors of its pixels.
    Picture(Box<Target>, Option<Destination>),
    /// A part of one.
    Part(FilePlace),
}

impl Output {
    /// Whatever can be known to fail fails here.
    fn new(job: &Job) -> Result<Output> {
        if saving::is_part(job) {
            return saving::part_place(job).map(Output::Part);
        }
        let target = Target::new(job.wanted())?;
        let error_bars = job.error_bars.as_deref().map(error_bars).transpose()?;
        if error_bars.as_ref().is_some_and(|bars| target.holds(bars.path())) {
            return Err(Error::Usage("--error-bars needs a file of its own, beside the picture's".into()));
        }
        Ok(Output::Picture(Box::new(target), error_bars))
    }

    /// Whether this file is to be replaced.
    fn replaces(&self, path: &Path) -> bool {
        match self {
            Output::Picture(target, bars) => {
                target.holds(path) || bars.as_ref().is_some_and(|bars| same_file(bars.path(), path))
            }
            Output::Part(place) => same_file(place.path(), path),
        }
    }

    /// Files that may be half written while the program runs.
    fn partial_paths(&self) -> Vec<PathBuf> {
        match self {
            Output::Picture(target, bars) => {
                let bars = bars.iter().map(|bars| bars.partial_path().to_path_buf());
                target.partial_paths().into_iter().chain(bars).collect()
            }
            Output::Part(place) => vec![place.partial_path().to_path_buf()],
        }
    }

    fn part(&self) -> Option<&FilePlace> {
        match self {
            Output::Part(place) => Some(place),
            Output::Picture(..) => None,
        }
    }

    /// See [`output::cut_components`]; none of a part, which keeps them.
    fn cut_components(&self, rendered: &Rendered) -> u64 {
        match self {
            Output::Part(_) => 0,
            Output::Picture(target, _) => output::cut_components(&rendered.film, target.picture().depth()),
        }
    }

    /// Writes what was rendered.
    fn write(&self, job: &Job, origin: &Origin, rendered: &Rendered) -> Result<()> {
        match self {
            Output::Part(place) => rendered.write_part(place, origin),
            Output::Picture(target, bars) => write_picture(target, bars.as_ref(), job, origin, rendered),
        }
    }
}

/// Renders; returns the exit code.
pub(super) fn run(job: &Job) -> anyhow::Result<u8> {
    // Whatever can be known to fail fails before the work.
    job.settings.check()?;
    let output = Output::new(job)?;
    if job.checkpoint.as_ref().is_some_and(|path| output.replaces(path)) {
        return Err(Error::Usage("--checkpoint needs a file of its own, beside the picture's".into()).into());
    }
    let checkpoints = saving::checkpoint_place(job, output.part())?;
    let mut partial = output.partial_paths();
    partial.extend(checkpoints.iter().map(|place| place.partial_path().to_path_buf()));
    interrupt::listen(partial)?;

    let Subject { world, camera, origin, warnings, seconds } = &Subject::read(job, &output)?;
    let found = saving::found(job, output.part(), origin)?;
    if let (Found::Begun(state), false) = (&found, job.quiet) {
        say(format_args!("going on after {} samples", state.samples()));
    }
    if job.json {
        let warnings = warnings.iter().map(DiagnosticRecord::new).collect();
        event::emit(&Event::Start { job: JobRecord::new(job), requires: &world.requires, warnings });
    }
    let state = match found {
        Found::Nothing => None,
        Found::Begun(state) => Some(*state),
        Found::Done(rendered) => {
            say(format_args!("{} is there already, and complete", job.image.display()));
            return Ok(end(job, world, &rendered, 0, *seconds));
        }
    };

    let reporter = Reporter::new(job);
    let keeper = Keeper::new(&reporter, checkpoints.as_ref(), origin, job.every);
    interrupt::ask_first();
    let rendered = resume(world, camera, &job.settings, &keeper, state);
    reporter.finish();
    let rendered = rendered?;
    if rendered.film.samples() == 0 {
        return Err(Error::Interrupted.into());
    }
    let build = seconds.build + rendered.build_seconds;
    let seconds = Seconds { build, render: rendered.render_seconds, ..*seconds };
    if rendered.ended == Ended::Cancelled && output.part().is_some() {
        unfinished(job, &keeper, &rendered)?;
        return Ok(end(job, world, &rendered, 0, seconds));
    }
    let (written, write) = timed(|| output.write(job, origin, &rendered));
    written.map_err(|error| saving::rescue(job, origin, &rendered, error))?;
    let seconds = Seconds { write, ..seconds };
    conclude(job, &rendered, seconds);
    Ok(end(job, world, &rendered, output.cut_components(&rendered), seconds))
}

/// What is rendered, ready for it.
struct Subject {
    world: World,
    camera: CameraDesc,
    origin: Origin,
    /// Of the scene and of what is rendered of it.
    warnings: Vec<Diagnostic>,
    /// What it took to get here.
    seconds: Seconds,
}

impl Subject {
    /// Reads and compiles the scene of a job, and says what is to be known about it.
    fn read(job: &Job, output: &Output) -> Result<Subject> {
        let (scene, load) = timed(|| in_pool(&job.settings, || scene::load(&job.scene)));
        let scene = scene?;
        if let Some(path) = scene.files.iter().chain([&job.scene]).find(|path| output.replaces(path)) {
            let path = path.display();
            return Err(Error::Usage(format!(
                "{path} belongs to the scene: choose another name for what is written"
            )));
        }
        if !job.quiet {
            scene.warnings.iter().for_each(say);
            say(describe::scene(&scene.desc));
        }
        Estimate::new(&scene.desc, &job.settings, job.denoise).check()?;
        let (world, build) = timed(|| in_pool(&job.settings, || World::compile(&scene.desc)));
        let world = world?;
        let guards = in_pool(&job.settings, || world.guards(&scene.desc, job.settings.width))?;
        if !job.quiet {
            guards.iter().for_each(say);
        }
        // The description ends here with its meshes: the world has all it needs of them.
        let (camera, digest, mut warnings) = (scene.desc.camera, scene.digest, scene.warnings);
        warnings.extend(guards);
        let recipe = Recipe::new(&job.scene, digest, &job.settings)?;
        let view = View::new(&world, &camera, job.settings.width, job.settings.height);
        let origin = Origin { recipe, view, brightest: world.brightest() };
        let seconds = Seconds { load, build, ..Seconds::default() };
        Ok(Subject { world, camera, origin, warnings, seconds })
    }
}

/// Tells programs how it ended; the exit code. `cut` components of pixels were too large for the picture.
fn end(job: &Job, world: &World, rendered: &Rendered, cut: u64, seconds: Seconds) -> u8 {
    if job.json {
        let summary = Summary::new(job, &world.requires, rendered, cut, seconds);
        let cancelled = rendered.ended == Ended::Cancelled;
        event::emit(&if cancelled { Event::Interrupted(summary) } else { Event::Done(summary) });
    }
    match rendered.ended {
        Ended::Cancelled => interrupt::exit_code().unwrap_or(0),
        Ended::OutOfTime if job.settings.noise.is_some() => NOISE_MISSED,
        _ => 0,
    }
}

/// Of a part that was interrupted only the checkpoint is left.
fn unfinished(job: &Job, keeper: &Keeper<'_>, rendered: &Rendered) -> Result<()> {
    if let Some(error) = keeper.failure() {
        return Err(error);
    }
    say(format_args!(
        "interrupted after {} of {} samples; the same command goes on with it",
        rendered.film.samples(),
        job.settings.samples_to_take()
    ));
    Ok(())
}

/// Writes a picture, and the errors of its pixels if they are wanted and known.
pub(super) fn write_picture(
    target: &Target,
    error_bars: Option<&Destination>,
    job: &Job,
    origin: &Origin,
    rendered: &Rendered,
) -> Result<()> {
    let provenance = Provenance {
        scene: &job.scene,
        digest: origin.recipe.digest,
        view: &origin.view,
        settings: &job.settings,
        samples: rendered.film.samples(),
        is_clamped: rendered.counters.clamped > 0,
        exposure: job.exposure,
    };
    target.write(&provenance, rendered)?;
    findings::report_cut(output::cut_components(&rendered.film, target.picture().depth()));
    if let Some(error_bars) = error_bars {
        output::write_error_bars(&rendered.film, error_bars)?;
    }
    Ok(())
}

/// Where the errors of the pixels go.
pub(super) fn error_bars(path: &Path) -> Result<Destination> {
    let destination = Destination::new(path)?;
    match destination.format() {
        Format::Exr => Ok(destination),
        _ => Err(Error::Usage(format!("error bars need an .exr, not {}", path.display()))),
    }
}

/// Says how it ended.
fn conclude(job: &Job, rendered: &Rendered, seconds: Seconds) {
    if let Some(what) = missing_errors(job, rendered) {
        say(format_args!("warning: {what}"));
    }
    findings::report(job, rendered);
    if job.quiet {
        return;
    }
    if let Some(note) = ending(job, rendered) {
        say(note);
    }
    let total = seconds.load + seconds.build + seconds.render + seconds.write;
    say(format_args!(
        "{} written in {} ({} of sampling, {}samples/s, {}rays/s){}{}",
        job.image.display(),
        duration(Duration::from_secs_f64(total)),
        duration(Duration::from_secs_f64(seconds.render)),
        with_prefix(per_second(rendered.samples(), seconds.render)),
        with_prefix(per_second(rendered.counters.rays as f64, seconds.render)),
        samples(job, rendered),
        rendered.error.as_ref().map_or(String::new(), error),
    ));
}

/// Why there are no errors of the pixels, if they were asked for.
pub(super) fn missing_errors(job: &Job, rendered: &Rendered) -> Option<&'static str> {
    let is_asked = job.error_bars.is_some() || job.aov.contains(&Aov::Error);
    (is_asked && Aov::Error.channels(rendered).is_empty()).then_some(
        "no errors of the pixels were written (--error-bars, --aov error): they need 16 samples, none of which may be \
         too large for f32; parts need --scramble-length 2",
    )
}

/// Why it ended before all that was asked for was done.
pub(super) fn ending(job: &Job, rendered: &Rendered) -> Option<String> {
    let (samples, asked) = (rendered.film.samples(), job.settings.samples);
    match (rendered.ended, job.settings.noise) {
        (Ended::Cancelled, _) if asked == 0 => Some(format!("interrupted after {samples} samples")),
        (Ended::Cancelled, _) => Some(format!("interrupted after {samples} of {asked} samples")),
        (Ended::OutOfTime, None) => {
            Some(format!("the time is up; SAMPLES = {samples} without --time makes the same picture"))
        }
        (Ended::OutOfTime, Some(noise)) => Some(format!(
            "warning: the time was up before the error was {noise} everywhere; SAMPLES = {samples} without --time makes the \
             same picture"
        )),
        (Ended::OutOfSamples, _) => {
            Some(format!("note: {samples} samples did not bring the error below the target everywhere"))
        }
        (Ended::Complete, _) => None,
    }
}

/// How many samples there were, where that was not known before.
fn samples(job: &Job, rendered: &Rendered) -> String {
    let film = &rendered.film;
    match (job.settings.noise, job.settings.time) {
        (None, None) => String::new(),
        (None, Some(_)) => format!("; {} samples a pixel", film.samples()),
        (Some(_), _) => {
            format!(
                "; {} samples a pixel, at most {}",
                digits(rendered.samples() / film.pixels() as f64, 4),
                film.samples()
            )
        }
    }
}

/// How far the picture is from the truth.
fn error(error: &PictureError) -> String {
    let PictureError { relative, mean, is_doubtful, .. } = error;
    let percent = |share: f64| digits(100.0 * share, 2);
    format!(
        "; estimated relative error {} % ({} to {} %), mean {} +- {}{}",
        percent(relative.value),
        percent(relative.low),
        percent(relative.high),
        digits(mean.value, 5),
        digits(mean.high - mean.value, 2),
        if *is_doubtful { ", doubtful: a few pixels carry most of it" } else { "" }
    )
}
