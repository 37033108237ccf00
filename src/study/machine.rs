//! What was measured on.

use super::contender::instructions;
use crate::accel::Isa;
use crate::error::Result;
use serde::Serialize;
use std::fs;

/// The machine and the program.
#[derive(Clone, Debug, Serialize)]
pub struct Machine {
    /// The processor's name, as far as the system tells it.
    pub processor: String,
    /// Processors that the program may use.
    pub processors: usize,
    /// The threads of the measurements on all threads.
    pub threads: usize,
    /// The instruction set in use.
    pub isa: &'static str,
    /// The program's version.
    pub version: &'static str,
    /// The version of Embree that the program was built for.
    pub embree: Option<&'static str>,
    /// How many threads wanted to run over the last minute, before the measurement; where the system tells it.
    pub load: Option<f64>,
}

impl Machine {
    /// This one.
    ///
    /// # Errors
    /// It lacks the instruction set asked for.
    pub fn here(isa: Option<Isa>, threads: usize) -> Result<Machine> {
        let model = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        });
        let load = fs::read_to_string("/proc/loadavg").ok();
        Ok(Machine {
            processor: model.unwrap_or_else(|| std::env::consts::ARCH.to_owned()),
            processors: std::thread::available_parallelism().map_or(1, usize::from),
            threads,
            isa: instructions(isa)?,
            version: env!("CARGO_PKG_VERSION"),
            embree: option_env!("PATHTRACER_EMBREE_VERSION"),
            load: load.and_then(|text| text.split_whitespace().next()?.parse().ok()),
        })
    }

    /// A line for tables and plots.
    pub fn line(&self) -> String {
        let threads = if self.threads == 1 { "1 thread".into() } else { format!("{} threads", self.threads) };
        let embree = self.embree.map_or("no Embree".into(), |version| format!("Embree {version}"));
        format!("{}, {threads}, {}, {embree}, pathtracer {}", self.processor, self.isa, self.version)
    }

    /// What to say if others use the machine too.
    pub fn warning(&self) -> Option<String> {
        let load = self.load.filter(|&load| load > 0.25 * self.processors as f64)?;
        Some(format!(
            "other programs are running (load {load:.1} on {} processors): read ratios, not times",
            self.processors
        ))
    }
}
