//! `pathtracer bench [SCENE | OBJ]`, as it was typed.

use super::shared::{Machine, Sinks};
use super::values::{Ladder, amount, ladder, whole};
use crate::error::Error;
use crate::study::bench::Options;
use crate::study::meshes::Family;
use crate::study::scaling;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
#[command(
    override_usage = "pathtracer bench [OPTIONS] [SCENE | OBJ]",
    after_help = "Without a file, generated meshes grow by steps of ten. Rays a second are medians over rounds in which all \
                  take turns; `relative` is the geometric mean over the kinds of rays beside that of embree fast.\n\
                  All accelerators are held at once: about 1 KB of memory a triangle."
)]
pub(in crate::cli) struct BenchArguments {
    /// Scene (YAML) or mesh (.obj) to measure instead of generated meshes
    #[arg(value_name = "SCENE | OBJ")]
    file: Option<PathBuf>,
    /// Sizes of the generated meshes: a number of triangles, or from..to [default: 1k..1M]
    #[arg(long, value_name = "N | A..B", value_parser = ladder)]
    triangles: Option<Ladder>,
    /// Only these meshes, separated by commas [default: all]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = family())]
    mesh: Vec<Family>,
    /// Rays of a kind [default: 50k]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = amount(10_000_000))]
    rays: Option<u64>,
    /// How often everything is timed [default: 5]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole(1000))]
    rounds: Option<u64>,
    #[command(flatten)]
    machine: Machine,
    /// Seed of meshes and rays
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0)]
    seed: u64,
    /// Count rays that are lost: from inside the closed meshes at corners, edges and anywhere, and along the axes at the
    /// cube
    #[arg(long)]
    leaks: bool,
    /// Rays of a kind that look for leaks [default: 500k]
    #[arg(long, value_name = "N", allow_negative_numbers = true, requires = "leaks", value_parser = amount(100_000_000))]
    leak_rays: Option<u64>,
    /// Measure instead how the cost of a sample grows with threads, pixels, triangles and lights, in whole renders
    #[arg(long, conflicts_with_all = ["file", "triangles", "mesh", "rays", "leaks"])]
    scaling: bool,
    /// A glance within seconds: 1k..10k triangles, few rays, 2 rounds
    #[arg(long)]
    quick: bool,
    /// Draw how the costs grow: .svg or .png; may be given more than once
    #[arg(long, value_name = "FILE")]
    plot: Vec<PathBuf>,
    #[command(flatten)]
    sinks: Sinks,
}

/// What is measured.
#[derive(Debug)]
pub(in crate::cli) enum Subject {
    /// Generated meshes at these sizes.
    Generated(Vec<Family>, Vec<usize>),
    /// An OBJ file.
    Mesh(PathBuf),
    /// A scene file.
    Scene(PathBuf),
    /// How the cost of a sample grows.
    Scaling(scaling::Options),
}

/// A bench as it was meant.
#[derive(Debug)]
pub(in crate::cli) struct BenchJob {
    pub(in crate::cli) subject: Subject,
    pub(in crate::cli) options: Options,
    pub(in crate::cli) csv: Option<PathBuf>,
    pub(in crate::cli) plots: Vec<PathBuf>,
    pub(in crate::cli) json: bool,
    pub(in crate::cli) quiet: bool,
}

impl BenchArguments {
    pub(in crate::cli) fn resolve(self) -> anyhow::Result<BenchJob> {
        let subject = self.subject()?;
        let or = |value: Option<u64>, quick: u64, default: u64| {
            usize::try_from(value.unwrap_or(if self.quick { quick } else { default }))
        };
        let options = Options {
            isa: self.machine.isa,
            threads: self.machine.threads()?,
            rays: or(self.rays, 2000, 50_000)?,
            rounds: or(self.rounds, 2, 5)?,
            seed: self.seed,
            leak_rays: if self.leaks { or(self.leak_rays, 10_000, 500_000)? } else { 0 },
        };
        let subject = if self.scaling {
            let Options { isa, threads, rounds, seed, .. } = options;
            let rounds = rounds.max(2);
            Subject::Scaling(scaling::Options { isa, threads, rounds, seed, quick: self.quick })
        } else {
            subject
        };
        let Sinks { csv, json, quiet } = self.sinks;
        Ok(BenchJob { subject, options, csv, plots: self.plot, json, quiet })
    }

    fn subject(&self) -> Result<Subject, Error> {
        let Some(file) = &self.file else {
            let families = if self.mesh.is_empty() { Family::ALL.to_vec() } else { self.mesh.clone() };
            let last = if self.quick { 10_000 } else { 1_000_000 };
            let standard = || [1000, 10_000, 100_000, 1_000_000].into_iter().filter(|&n| n <= last).collect();
            let sizes = self.triangles.clone().map_or_else(standard, |Ladder(sizes)| sizes);
            return Ok(Subject::Generated(families, sizes));
        };
        let generated = [
            (self.triangles.is_some(), "--triangles"),
            (!self.mesh.is_empty(), "--mesh"),
            (self.leaks, "--leaks"),
        ];
        if let Some((_, option)) = generated.iter().find(|(is_given, _)| *is_given) {
            return Err(Error::Usage(format!(
                "{option} is for generated meshes: leave it out, or leave out {}",
                file.display()
            )));
        }
        Ok(if is_obj(file) { Subject::Mesh(file.clone()) } else { Subject::Scene(file.clone()) })
    }
}

fn is_obj(file: &Path) -> bool {
    file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj"))
}

/// Parses the name of a family.
fn family() -> impl TypedValueParser<Value = Family> {
    PossibleValuesParser::new(Family::ALL.map(Family::name))
        .try_map(|name| Family::ALL.into_iter().find(|family| family.name() == name).ok_or("unknown name"))
}
