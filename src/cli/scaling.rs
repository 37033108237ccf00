//! `pathtracer bench --scaling`: how the cost of a sample grows.

use super::arguments::BenchJob;
use super::bench::print;
use super::console::say;
use super::event::emit;
use super::plot_file::PlotFile;
use crate::error::Result;
use crate::output::TextFile;
use crate::study::machine::Machine;
use crate::study::scaling::{self, Growth, Kind, Options};
use crate::study::table::counted;
use serde::Serialize;

/// Measures; returns the exit code.
pub(super) fn run(job: &BenchJob, options: &Options) -> anyhow::Result<u8> {
    let table = job.csv.as_deref().map(TextFile::new).transpose()?;
    let plots = job.plots.iter().map(|path| PlotFile::new(path)).collect::<Result<Vec<PlotFile>>>()?;
    let machine = Machine::here(options.isa, options.threads)?;
    if job.json {
        emit(&Event::Start { machine: &machine, rounds: options.rounds, seed: options.seed });
    } else {
        print(&format!(
            "{}\nmedians of {} in turn\n",
            machine.line(),
            counted(options.rounds as u64, "round")
        ));
    }
    if let Some(warning) = machine.warning().filter(|_| !job.quiet) {
        say(format_args!("warning: {warning}"));
    }
    let mut growths = Vec::new();
    for kind in Kind::ALL {
        if !job.quiet {
            say(format_args!("measuring more {} ...", kind.name()));
        }
        let growth = scaling::run(kind, options)?;
        if job.json {
            let powers = growth.powers();
            emit(&Event::Growth { growth: &growth, powers });
        } else {
            print(&format!("{}{}\n", growth.table(), growth.verdict()));
        }
        growths.push(growth);
    }
    if let Some(file) = table {
        file.write(&scaling::csv(&growths))?;
    }
    let sheet = scaling::sheet(&growths, ["pathtracer bench --scaling".into(), machine.line()]);
    plots.iter().try_for_each(|file| file.write(&sheet))?;
    if job.json {
        emit(&Event::Done { kinds: growths.len() });
    }
    Ok(0)
}

/// A line of `--json`.
#[derive(Serialize)]
#[serde(tag = "event", rename_all = "snake_case")]
enum Event<'e> {
    Start {
        machine: &'e Machine,
        rounds: usize,
        seed: u64,
    },
    Growth {
        #[serde(flatten)]
        growth: &'e Growth,
        powers: [f64; 2],
    },
    Done {
        kinds: usize,
    },
}
