//! `pathtracer SCENE WIDTH HEIGHT SAMPLES BOUNCES IMAGE`.

use super::arguments::Job;
use super::console::{duration, say, with_prefix};
use super::event::{self, Event, JobRecord, Seconds, Summary, per_second};
use super::progress::Reporter;
use super::target::Target;
use super::{describe, findings, interrupt};
use crate::error::Error;
use crate::output::Provenance;
use crate::render::{Rendered, in_pool, render};
use crate::scene;
use crate::world::World;
use std::time::{Duration, Instant};

/// Renders; returns the exit code.
pub(super) fn run(job: &Job) -> anyhow::Result<u8> {
    // Whatever can be known to fail fails before the work.
    job.settings.check()?;
    let target = Target::new(job)?;
    let destination = &target.picture;
    interrupt::listen(destination.partial_path().to_path_buf())?;

    let (scene, load) = timed(|| in_pool(&job.settings, || scene::load(&job.scene)));
    let scene = scene?;
    if !job.quiet {
        scene.warnings.iter().for_each(say);
        say(describe::scene(&scene.desc));
    }
    let (world, compile) = timed(|| in_pool(&job.settings, || World::compile(&scene.desc)));
    let world = world?;
    let guards = in_pool(&job.settings, || world.guards(&scene.desc, job.settings.width))?;
    if !job.quiet {
        guards.iter().for_each(say);
    }
    if job.json {
        event::emit(&Event::Start { job: JobRecord::new(job), requires: &world.requires });
    }

    // The world has all it needs of the meshes.
    let (camera, digest) = (scene.desc.camera.clone(), scene.digest);
    drop(scene);
    let reporter = Reporter::new(job);
    let rendered = render(&world, &camera, &job.settings, &reporter);
    reporter.finish();
    let rendered = rendered?;
    if rendered.film.samples() == 0 {
        return Err(Error::Interrupted.into());
    }
    let provenance = Provenance {
        scene: &job.scene,
        digest,
        camera: &camera,
        world: &world,
        settings: &job.settings,
        samples: rendered.film.samples(),
        is_clamped: rendered.counters.clamped > 0,
        exposure: job.exposure,
    };
    let (written, write) = timed(|| target.write(job, &provenance, &rendered));
    written?;

    let build = compile + rendered.build_seconds;
    let seconds = Seconds { load, build, render: rendered.render_seconds, write };
    conclude(job, &rendered, seconds);
    if job.json {
        let summary = Summary::new(job, &world.requires, &rendered, seconds);
        event::emit(&if rendered.cancelled { Event::Interrupted(summary) } else { Event::Done(summary) });
    }
    let code = if rendered.cancelled { interrupt::exit_code() } else { None };
    Ok(code.unwrap_or(0))
}

/// Says how it ended.
fn conclude(job: &Job, rendered: &Rendered, seconds: Seconds) {
    findings::report(job, rendered);
    if job.quiet {
        return;
    }
    let film = &rendered.film;
    if rendered.cancelled {
        say(format_args!("interrupted after {} of {} samples", film.samples(), job.settings.samples));
    }
    let total = seconds.load + seconds.build + seconds.render + seconds.write;
    say(format_args!(
        "{} written in {} ({} of sampling, {}samples/s, {}rays/s)",
        job.image.display(),
        duration(Duration::from_secs_f64(total)),
        duration(Duration::from_secs_f64(seconds.render)),
        with_prefix(per_second(rendered.samples(), seconds.render)),
        with_prefix(per_second(rendered.counters.rays as f64, seconds.render)),
    ));
}

/// A result and the seconds that it took.
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    (result, start.elapsed().as_secs_f64())
}
