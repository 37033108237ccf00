//! `pathtracer bench [SCENE | OBJ]`: what the accelerators cost, and how that grows.

use super::arguments::{BenchJob, Subject};
use super::console::say;
use super::event::emit;
use super::plot_file::PlotFile;
use super::studied;
use crate::error::{Error, Result};
use crate::output::TextFile;
use crate::render::available_bytes;
use crate::scene;
use crate::study::bench::{self, Growth, Row, Rung};
use crate::study::machine::Machine;
use crate::study::meshes::Family;
use crate::study::plot::Plot;
use crate::study::table::{Figure, Table, counted, csv, grouped, short};
use crate::words::bytes;
use serde::Serialize;
use std::io::{self, Write as _};

/// Measures; returns the exit code.
pub(super) fn run(job: &BenchJob) -> anyhow::Result<u8> {
    if let Subject::Scaling(options) = &job.subject {
        return super::scaling::run(job, options);
    }
    // Whatever can be known to fail fails before the work.
    if let Subject::Mesh(path) | Subject::Scene(path) = &job.subject {
        studied::keep([path], job.csv.iter().chain(&job.plots))?;
    }
    let table = job.csv.as_deref().map(TextFile::new).transpose()?;
    let plots = job.plots.iter().map(|path| PlotFile::new(path)).collect::<Result<Vec<PlotFile>>>()?;
    let machine = Machine::here(job.options.isa, job.options.threads)?;
    let shown = Shown { job, machine: &machine };
    shown.start();
    let rungs = measure(job, &shown)?;
    let figures: Vec<Figure> = rungs.iter().flat_map(Rung::figures).collect();
    if let Some(file) = table {
        file.write(&csv(&figures))?;
    }
    let line = machine.line();
    let plot = Plot { heading: ["pathtracer bench", &line], rungs: &rungs };
    plots.iter().try_for_each(|file| file.write(&plot))?;
    if job.json {
        emit(&Event::Done { meshes: rungs.len(), figures: figures.len() });
    }
    Ok(0)
}

/// All rungs, shown as they are done.
fn measure(job: &BenchJob, shown: &Shown<'_>) -> anyhow::Result<Vec<Rung>> {
    let options = &job.options;
    match &job.subject {
        Subject::Mesh(path) => {
            let mesh = scene::load_mesh(path)?;
            shown.tell(&path.to_string_lossy(), mesh.triangles.len());
            let rung = bench::mesh(path.to_string_lossy().into_owned(), mesh, options)?;
            shown.rung(&rung);
            Ok(vec![rung])
        }
        Subject::Scene(path) => {
            let (scene, world) = studied::load(path, bench::scene_size(options)[0], job.quiet)?;
            let name = path.to_string_lossy().into_owned();
            shown.tell(&name, super::describe::triangles(&scene.desc));
            let rung = bench::scene(name, &world, &scene.desc.camera, options)?;
            shown.rung(&rung);
            Ok(vec![rung])
        }
        Subject::Scaling(_) => Ok(Vec::new()),
        Subject::Generated(families, sizes) => {
            check_memory(sizes)?;
            let mut all = Vec::new();
            for &family in families {
                all.extend(ladder(family, sizes, job, shown)?);
            }
            Ok(all)
        }
    }
}

fn ladder(family: Family, sizes: &[usize], job: &BenchJob, shown: &Shown<'_>) -> Result<Vec<Rung>> {
    let mut rungs = Vec::new();
    for &size in sizes {
        shown.tell(family.name(), size);
        let rung = bench::family(family, size, &job.options)?;
        shown.rung(&rung);
        rungs.push(rung);
    }
    shown.growth(&bench::growth(&rungs.iter().collect::<Vec<&Rung>>()));
    Ok(rungs)
}

/// Refuses sizes that the machine has not the memory for; passes where the system does not say.
fn check_memory(sizes: &[usize]) -> Result<()> {
    let largest = sizes.iter().copied().max().unwrap_or(0);
    match available_bytes() {
        Some(available) if bench::memory_bytes(largest) > available => Err(Error::Usage(format!(
            "meshes of {} need up to {} of memory, and {} are free: end the range of --triangles earlier",
            counted(largest as u64, "triangle"),
            bytes(bench::memory_bytes(largest)),
            bytes(available)
        ))),
        _ => Ok(()),
    }
}

/// What goes to stdout and stderr.
struct Shown<'s> {
    job: &'s BenchJob,
    machine: &'s Machine,
}

impl Shown<'_> {
    fn start(&self) {
        let options = &self.job.options;
        if self.job.json {
            emit(&Event::Start {
                machine: self.machine,
                rays: options.rays,
                rounds: options.rounds,
                seed: options.seed,
            });
        } else {
            let (rays, rounds) = (grouped(options.rays as u64), options.rounds);
            print(&format!(
                "{}\n{rays} rays of a kind, medians of {} in turn; Mrays/s on 1 thread\n",
                self.machine.line(),
                counted(rounds as u64, "round")
            ));
        }
        if let Some(warning) = self.machine.warning().filter(|_| !self.job.quiet) {
            say(format_args!("warning: {warning}"));
        }
    }

    fn tell(&self, mesh: &str, triangles: usize) {
        if !self.job.quiet {
            say(format_args!("measuring {mesh} with {} ...", counted(triangles as u64, "triangle")));
        }
    }

    fn rung(&self, rung: &Rung) {
        if self.job.json {
            return rung.figures().iter().for_each(|figure| emit(&Event::Figure(figure)));
        }
        print(&format!("{}, {}\n{}", rung.mesh, counted(rung.triangles as u64, "triangle"), table(rung)));
        if let Some(leaks) = leaks(rung) {
            print(&leaks.to_string());
        }
    }

    fn growth(&self, growth: &[Growth]) {
        if self.job.json || growth.is_empty() {
            return growth.iter().for_each(|growth| {
                emit(&Event::Growth {
                    accelerator: growth.kind.accel_name(),
                    precision: growth.kind.precision_name(),
                    trace: growth.trace,
                    build: growth.build,
                });
            });
        }
        let mut table = Table::new(["time grows as triangles ^", "a ray", "a build"]);
        for Growth { kind, trace, build } in growth {
            let name = format!("{} {}", kind.accel_name(), kind.precision_name());
            table.push([name, format!("{trace:.2}"), format!("{build:.2}")]);
        }
        print(&table.to_string());
    }
}

/// Prints with an empty line behind. A reader that has gone away does not stop the measurement.
pub(super) fn print(text: &str) {
    let mut stdout = io::stdout().lock();
    let _ = writeln!(stdout, "{text}").and_then(|()| stdout.flush());
}

fn table(rung: &Rung) -> Table {
    let mut headings = vec![String::new()];
    headings.extend(rung.sets.iter().map(|(kind, _)| kind.name().to_owned()));
    headings.extend(["mean", "±", "relative"].map(str::to_owned));
    // On one thread alone there is nothing more to say.
    let more = rung.thread_counts().get(1).copied();
    headings.extend(more.iter().flat_map(|all| [format!("mean, {all} thr."), "relative".into()]));
    headings.push("build ms".into());
    headings.extend(more.iter().map(|all| format!("{all} thr.")));
    headings.push("bytes/tri.".into());
    let mut table = Table::new(headings);
    for row in &rung.rows {
        let Row { kind, build_seconds, bytes, rates, mean, relative, .. } = row;
        let rate = |rate: f64| short(rate * 1e-6);
        let mut cells = vec![format!("{} {}", kind.accel_name(), kind.precision_name())];
        cells.extend(rates[0].iter().map(|spread| rate(spread.median)));
        cells.extend([
            rate(mean[0].median),
            format!("{:.0} %", 100.0 * mean[0].relative()),
            format!("{:.2}", relative[0].median),
        ]);
        if more.is_some() {
            cells.extend([rate(mean[1].median), format!("{:.2}", relative[1].median)]);
        }
        let threads = rung.thread_counts().len();
        cells.extend(build_seconds[..threads].iter().map(|seconds| short(seconds.median * 1e3)));
        cells.push(per_triangle(*bytes, rung.triangles));
        table.push(cells);
    }
    table
}

/// A dash where there are no triangles.
fn per_triangle(bytes: usize, triangles: usize) -> String {
    if triangles == 0 { "-".into() } else { format!("{:.1}", bytes as f64 / triangles as f64) }
}

/// Lost rays by aim; `None` if none were looked for.
fn leaks(rung: &Rung) -> Option<Table> {
    let aims = &rung.rows.first()?.leaks;
    if aims.is_empty() {
        return None;
    }
    let heading = |leak: &bench::Leak| format!("{} of {}", leak.aim.name(), grouped(leak.rays));
    let mut table = Table::new(["lost rays".to_owned()].into_iter().chain(aims.iter().map(heading)));
    for row in &rung.rows {
        let name = format!("{} {}", row.kind.accel_name(), row.kind.precision_name());
        table.push([name].into_iter().chain(row.leaks.iter().map(|leak| grouped(leak.lost))));
    }
    Some(table)
}

/// A line of `--json`.
#[derive(Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
enum Event<'e> {
    Start { machine: &'e Machine, rays: usize, rounds: usize, seed: u64 },
    Figure(&'e Figure),
    Growth { accelerator: &'static str, precision: &'static str, trace: f64, build: f64 },
    Done { meshes: usize, figures: usize },
}
