//! `pathtracer tradeoff SCENE`: what every setting costs in time and gains in accuracy.

use super::arguments::TradeoffJob;
use super::console::{duration, say};
use super::event::emit;
use super::plot_file::PlotFile;
use super::studied;
use crate::error::{Error, Result};
use crate::output::TextFile;
use crate::study::machine::Machine;
use crate::study::table::{Figure as RayFigure, counted};
use crate::study::tradeoff::figures::{Figure, csv};
use crate::study::tradeoff::{self, Options, Tradeoff, reference};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::Path;
use std::time::Instant;

/// Measures; returns the exit code.
pub(super) fn run(job: &TradeoffJob) -> anyhow::Result<u8> {
    // Whatever can be known to fail fails before the work.
    let written = job.csv.iter().chain(&job.plots).chain(&job.report);
    studied::keep([&job.scene].into_iter().chain(&job.reference), written)?;
    let table = job.csv.as_deref().map(TextFile::new).transpose()?;
    let plots = job.plots.iter().map(|path| PlotFile::new(path)).collect::<Result<Vec<PlotFile>>>()?;
    let page = job.report.as_deref().map(page_file).transpose()?;
    let size = [job.frame.width, job.frame.height];
    let reference = job.reference.as_deref().map(|path| reference::read(path, size)).transpose()?;
    let (scene, world) = studied::load(&job.scene, job.frame.width, job.quiet)?;
    let options = Options {
        frame: job.frame.clone(),
        grid: job.grid(&world.requires),
        seeds: job.seeds,
        first_seed: job.first_seed,
        reference,
        target: job.target,
        rays: job.rays,
        leak_rays: job.leak_rays,
    };
    if let Some(warning) = Machine::here(job.frame.isa, job.frame.threads)?.warning().filter(|_| !job.quiet) {
        say(format_args!("warning: {warning}"));
    }
    let name = job.scene.to_string_lossy().into_owned();
    let start = Instant::now();
    let found = tradeoff::run(name, &world, &scene.desc.camera, &options, &|done, all| {
        tell(job, start, done, all);
    })?;
    let figures = found.figures();
    if let Some(file) = table {
        file.write(&csv(&figures))?;
    }
    let sheet = found.sheet();
    plots.iter().try_for_each(|file| file.write(&sheet))?;
    if let Some(file) = page {
        file.write(&found.page()?)?;
    }
    if job.json {
        emit_all(&found, &figures);
    } else {
        // A reader that has gone away does not change the answer.
        let _ = write!(io::stdout(), "{}", report(&found));
    }
    Ok(0)
}

fn page_file(path: &Path) -> Result<TextFile> {
    let is_html = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("html"));
    if !is_html {
        return Err(Error::Usage(format!("the report {} must end in .html", path.display())));
    }
    TextFile::new(path)
}

/// Says which round begins, and how long it goes on.
fn tell(job: &TradeoffJob, start: Instant, done: usize, all: usize) {
    if job.quiet {
        return;
    }
    let left = match done {
        0 => String::new(),
        _ => format!(", about {} left", duration(start.elapsed() * (all - done) as u32 / done as u32)),
    };
    say(format_args!("round {} of {all}{left} ...", done + 1));
}

fn report(found: &Tradeoff) -> String {
    let [width, height] = found.size;
    let against = if found.has_reference { "the reference" } else { "variance across seeds and bias" };
    let mut text = String::new();
    // Writing to a string can't fail.
    let _ = writeln!(
        text,
        "{}: {width} x {height} pixels, {}, errors: {against}\n{}\ndefault: {}\n\n{}",
        found.scene,
        counted(found.seeds, "seed"),
        found.machine.line(),
        found.variants[0].name(),
        found.table()
    );
    for table in [found.convergence_table(), found.rays_table()].into_iter().flatten() {
        let _ = writeln!(text, "{table}");
    }
    let _ = writeln!(text, "{}", found.recommendation_line());
    text
}

fn emit_all(found: &Tradeoff, figures: &[Figure]) {
    emit(&Event::Start {
        scene: &found.scene,
        machine: &found.machine,
        width: found.size[0],
        height: found.size[1],
        seeds: found.seeds,
        reference: found.has_reference,
    });
    figures.iter().for_each(|figure| emit(&Event::Figure(figure)));
    let rays: Vec<RayFigure> = found.rays.iter().flat_map(|rung| rung.figures()).collect();
    rays.iter().for_each(|figure| emit(&Event::Rays(figure)));
    let chosen = found.recommendation.as_ref();
    emit(&Event::Done {
        target: found.target,
        recommendation: found.recommendation_line(),
        command: found.recommended_command(),
        seconds: chosen.map(|chosen| chosen.seconds.value),
        samples: chosen.map(|chosen| chosen.samples),
        figures: figures.len() + rays.len(),
    });
}

/// A line of `--json`.
#[derive(Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
enum Event<'e> {
    Start {
        scene: &'e str,
        machine: &'e Machine,
        width: u32,
        height: u32,
        seeds: u64,
        reference: bool,
    },
    Figure(&'e Figure),
    Rays(&'e RayFigure),
    Done {
        target: f64,
        recommendation: String,
        command: Option<String>,
        seconds: Option<f64>,
        samples: Option<u64>,
        figures: usize,
    },
}
