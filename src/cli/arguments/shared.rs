//! Options that the commands which measure have in common.

use super::values::{choice, whole};
use crate::accel::Isa;
use crate::render::MAX_THREADS;
use std::num::TryFromIntError;
use std::path::PathBuf;

/// What of the machine is used.
#[derive(Clone, Copy, Debug, clap::Args)]
pub(super) struct Machine {
    /// Threads of renders, and of the measurements on all threads [default: one a core]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole(MAX_THREADS as u64))]
    threads: Option<u64>,
    /// Most instructions to use [default: the machine's best]
    #[arg(long, value_name = "NAME", value_parser = choice(&Isa::ALL, Isa::name))]
    pub(super) isa: Option<Isa>,
}

impl Machine {
    pub(super) fn threads(&self) -> Result<usize, TryFromIntError> {
        super::threads(self.threads)
    }
}

/// Where figures go.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct Sinks {
    /// Write all figures as CSV
    #[arg(long, value_name = "FILE")]
    pub(super) csv: Option<PathBuf>,
    /// Print events as JSON lines on stdout instead of tables
    #[arg(long)]
    pub(super) json: bool,
    /// Do not say what is being done
    #[arg(long, short)]
    pub(super) quiet: bool,
}
