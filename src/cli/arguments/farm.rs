//! `pathtracer farm` as it was typed.

use super::{Job, RenderArguments};
use std::path::PathBuf;

/// The most parts: the names of so many fit on the command line of the merge, which takes 2 MB on Linux.
const MOST_PARTS: i64 = 10_000;

/// For which engine.
#[derive(Debug, clap::Subcommand)]
pub(in crate::cli) enum FarmCommand {
    /// Print the job as an Open Job Description template
    #[command(override_usage = "pathtracer farm export --parts N SCENE WIDTH HEIGHT SAMPLES BOUNCES IMAGE")]
    Export(Box<FarmArguments>),
    /// Print a shell script that gives the job to Slurm
    #[command(override_usage = "pathtracer farm slurm --parts N SCENE WIDTH HEIGHT SAMPLES BOUNCES IMAGE")]
    Slurm(Box<FarmArguments>),
}

/// A render, and into how many parts it is cut.
#[derive(Debug, clap::Args)]
pub(in crate::cli) struct FarmArguments {
    /// The number of parts
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST_PARTS))]
    parts: u32,
    /// Where the parts go [default: IMAGE.parts]
    #[arg(long, value_name = "FOLDER")]
    folder: Option<PathBuf>,
    #[command(flatten)]
    render: RenderArguments,
}

impl FarmArguments {
    /// The render, the number of parts, and where they go.
    pub(in crate::cli) fn resolve(self) -> anyhow::Result<(Job, u32, PathBuf)> {
        let job = self.render.resolve()?;
        let name = format!("{}.parts", job.image.display());
        Ok((job, self.parts, self.folder.unwrap_or_else(|| name.into())))
    }
}
