//! `pathtracer compare SCENE`, as it was typed.

use super::shared::{Machine, Sinks};
use super::values::{amount, choice, size, whole};
use crate::accel::Precision;
use crate::render::MAX_BOUNCES;
use crate::study::compare::Options;
use crate::study::record::Recording;
use std::path::PathBuf;

/// The widest and highest picture whose paths are recorded, and the most paths a pixel.
const MOST_SIDE: u32 = 4096;
const MOST_SAMPLES: u64 = 1024;

#[derive(Debug, clap::Args)]
#[command(
    override_usage = "pathtracer compare [OPTIONS] SCENE",
    after_help = "The rays are those of the scene's own paths, and chords of the sphere around it. Hits are the same to \
                  the last bit, a tie (equal distance of two primitives), at an edge (f32 can't tell), or other.\n\
                  Exit codes: 0 done, 4 hits or pictures differ at --precision exact."
)]
pub(in crate::cli) struct CompareArguments {
    /// Scene file (YAML)
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// How hits of triangles are found, by both [default: exact]
    #[arg(long, value_name = "NAME", value_parser = choice(&Precision::ALL, Precision::name))]
    precision: Option<Precision>,
    #[command(flatten)]
    machine: Machine,
    /// Size of the picture whose paths are recorded, and of the pictures that are compared
    #[arg(long, value_name = "WxH", default_value = "320x180", value_parser = size(MOST_SIDE))]
    size: [u32; 2],
    /// Paths a pixel to record
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value = "1", value_parser = whole(MOST_SAMPLES))]
    samples: u64,
    /// Longest path in ray segments
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value = "8", value_parser = whole(MAX_BOUNCES.into()))]
    bounces: u64,
    /// Most rays of a kind; of more, evenly chosen ones are kept
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value = "100k", value_parser = amount(10_000_000))]
    rays: u64,
    /// How often everything is timed
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value = "5", value_parser = whole(1000))]
    rounds: u64,
    /// Seed of the paths
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0)]
    seed: u64,
    /// How many of the worst differing rays of a kind to print
    #[arg(long, value_name = "N", default_value_t = 3)]
    worst: usize,
    #[command(flatten)]
    sinks: Sinks,
}

/// A comparison as it was meant.
#[derive(Debug)]
pub(in crate::cli) struct CompareJob {
    pub(in crate::cli) scene: PathBuf,
    pub(in crate::cli) options: Options,
    pub(in crate::cli) csv: Option<PathBuf>,
    pub(in crate::cli) json: bool,
    pub(in crate::cli) quiet: bool,
}

impl CompareArguments {
    pub(in crate::cli) fn resolve(self) -> anyhow::Result<CompareJob> {
        let recording = Recording {
            width: self.size[0],
            height: self.size[1],
            samples: u32::try_from(self.samples)?,
            bounces: u32::try_from(self.bounces)?,
            rays: usize::try_from(self.rays)?,
            seed: self.seed,
        };
        let options = Options {
            precision: self.precision.unwrap_or_default(),
            isa: self.machine.isa,
            threads: self.machine.threads()?,
            recording,
            rounds: usize::try_from(self.rounds)?,
            worst: self.worst,
        };
        let Sinks { csv, json, quiet } = self.sinks;
        Ok(CompareJob { scene: self.scene, options, csv, json, quiet })
    }
}
