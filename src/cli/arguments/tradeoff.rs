//! `pathtracer tradeoff SCENE`, as it was typed.

use super::shared::{Machine, Sinks};
use super::values::{amount, choice, positive, size, switch, whole};
use crate::accel::Precision;
use crate::render::{AccelKind, MAX_BOUNCES, MAX_SAMPLES};
use crate::sampling::SamplerKind;
use crate::study::tradeoff::grid::{Frame, Grid};
use crate::world::Requires;
use std::path::PathBuf;

/// The widest and highest picture.
const MOST_SIDE: u32 = 4096;

#[derive(Debug, clap::Args)]
#[command(
    override_usage = "pathtracer tradeoff [OPTIONS] SCENE",
    after_help = "Lists are separated by commas. The first value of a list is the default that the others are compared with, one \
                  setting at a time; bounces are sorted, since the longest paths are taken for right.\n\
                  No reference is needed: the error of settings is the variance of their pictures across the seeds, plus the \
                  square of their bias where paths or samples are cut short. Intervals are of 95 % confidence, by bootstrap \
                  over the seeds. Seconds are of sampling, without load and build. FLIP compares with the mean of all."
)]
pub(in crate::cli) struct TradeoffArguments {
    /// Scene file (YAML)
    #[arg(value_name = "SCENE")]
    scene: PathBuf,
    /// Size of the pictures [default: 160x90]
    #[arg(long, value_name = "WxH", value_parser = size(MOST_SIDE))]
    size: Option<[u32; 2]>,
    /// Seeds, each of which renders everything once [default: 16]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u64).range(2..=1000))]
    seeds: Option<u64>,
    /// Samples per pixel [default: 1,4,16,64]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = whole(MAX_SAMPLES))]
    samples: Vec<u64>,
    /// Longest paths in ray segments [default: 20,10,5,3,2]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = whole(MAX_BOUNCES.into()))]
    bounces: Vec<u64>,
    /// What finds hits [default: all that are compiled in]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = choice(&AccelKind::ALL, AccelKind::name))]
    accel: Vec<AccelKind>,
    /// How hits of triangles are found [default: exact,robust,fast; exact without meshes]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = choice(&Precision::ALL, Precision::name))]
    precision: Vec<Precision>,
    /// Where random numbers come from [default: sobol,independent]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = choice(&SamplerKind::ALL, SamplerKind::name))]
    sampler: Vec<SamplerKind>,
    /// Whether lights are sampled [default: on,off; on without lights]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = switch())]
    light_sampling: Vec<bool>,
    /// Limits of the components of a sample, beside none [default: none]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = positive)]
    clamp: Vec<f64>,
    /// Errors at which blocks of pixels stop, beside none; the samples are then the most of a pixel [default: 0.1]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = positive)]
    noise: Vec<f64>,
    /// Also denoise the pictures, whose bias counts as error
    #[arg(long)]
    denoise: bool,
    /// Try all combinations of settings instead of one at a time
    #[arg(long)]
    all: bool,
    /// Measure errors against this picture of the same size (.exr)
    #[arg(long, value_name = "PICTURE")]
    reference: Option<PathBuf>,
    /// The relMSE for which settings are recommended
    #[arg(long, value_name = "E", allow_negative_numbers = true, default_value = "0.01", value_parser = positive)]
    target: f64,
    /// Rays of a kind for the cost of a ray by precision, on scenes with meshes [default: 50k]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = amount(10_000_000))]
    rays: Option<u64>,
    /// Rays that look for leaks at seams, at corners and inside of triangles each [default: 1M]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = amount(100_000_000))]
    leak_rays: Option<u64>,
    #[command(flatten)]
    machine: Machine,
    /// The first seed
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0, value_parser = clap::value_parser!(u64).range(..u64::MAX - 1000))]
    seed: u64,
    /// A glance within seconds: 64x36 pixels, 8 seeds, 1 to 16 samples, 20, 5 and 2 bounces, few rays
    #[arg(long)]
    quick: bool,
    /// Draw error against time, energy against bounces, cost of a ray against leaks: .svg or .png; may be given more than
    /// once
    #[arg(long, value_name = "FILE")]
    plot: Vec<PathBuf>,
    /// Write everything, with pictures to compare, as one page that needs no network
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    #[command(flatten)]
    sinks: Sinks,
}

/// A measurement as it was meant, but for what depends on the scene.
#[derive(Debug)]
pub(in crate::cli) struct TradeoffJob {
    pub(in crate::cli) scene: PathBuf,
    pub(in crate::cli) frame: Frame,
    pub(in crate::cli) seeds: u64,
    pub(in crate::cli) first_seed: u64,
    pub(in crate::cli) reference: Option<PathBuf>,
    pub(in crate::cli) target: f64,
    pub(in crate::cli) rays: usize,
    pub(in crate::cli) leak_rays: usize,
    pub(in crate::cli) csv: Option<PathBuf>,
    pub(in crate::cli) plots: Vec<PathBuf>,
    pub(in crate::cli) report: Option<PathBuf>,
    pub(in crate::cli) json: bool,
    pub(in crate::cli) quiet: bool,
    /// As asked for; empty lists stand for the defaults.
    grid: Grid,
}

impl TradeoffArguments {
    pub(in crate::cli) fn resolve(self) -> anyhow::Result<TradeoffJob> {
        let or = |value: Option<u64>, quick: u64, default: u64| {
            value.unwrap_or(if self.quick { quick } else { default })
        };
        let [width, height] = self.size.unwrap_or(if self.quick { [64, 36] } else { [160, 90] });
        let mut samples = self.samples.clone();
        if samples.is_empty() {
            samples = if self.quick { vec![1, 4, 16] } else { vec![1, 4, 16, 64] };
        }
        samples.sort_unstable();
        samples.dedup();
        let mut bounces: Vec<u32> =
            self.bounces.iter().map(|&bounces| u32::try_from(bounces)).collect::<Result<_, _>>()?;
        if bounces.is_empty() {
            bounces = if self.quick { vec![20, 5, 2] } else { vec![20, 10, 5, 3, 2] };
        }
        bounces.sort_unstable_by(|a, b| b.cmp(a));
        bounces.dedup();
        let noise = if self.noise.is_empty() { vec![0.1] } else { distinct(&self.noise) };
        let grid = Grid {
            samples,
            bounces,
            accels: distinct(&self.accel),
            precisions: distinct(&self.precision),
            samplers: distinct(&self.sampler),
            light_sampling: distinct(&self.light_sampling),
            clamps: std::iter::once(None).chain(distinct(&self.clamp).into_iter().map(Some)).collect(),
            noises: std::iter::once(None).chain(noise.into_iter().map(Some)).collect(),
            denoise: if self.denoise { vec![false, true] } else { vec![false] },
            crossed: self.all,
        };
        let Sinks { csv, json, quiet } = self.sinks;
        let (threads, isa) = (self.machine.threads()?, self.machine.isa);
        Ok(TradeoffJob {
            frame: Frame { width, height, threads, isa },
            seeds: or(self.seeds, 8, 16),
            first_seed: self.seed,
            target: self.target,
            rays: usize::try_from(or(self.rays, 2000, 50_000))?,
            leak_rays: usize::try_from(or(self.leak_rays, 20_000, 1_000_000))?,
            grid,
            scene: self.scene,
            reference: self.reference,
            csv,
            plots: self.plot,
            report: self.report,
            json,
            quiet,
        })
    }
}

impl TradeoffJob {
    /// The grid for a scene: what it does not need is not tried unless asked for.
    pub(in crate::cli) fn grid(&self, requires: &Requires) -> Grid {
        let precisions = match requires.triangles {
            0 => vec![Precision::Exact],
            _ => vec![Precision::Exact, Precision::Robust, Precision::Fast],
        };
        let lights = if requires.light_sampling { vec![true, false] } else { vec![true] };
        let grid = self.grid.clone();
        Grid {
            accels: or_else(grid.accels, AccelKind::BUILT.to_vec()),
            precisions: or_else(grid.precisions, precisions),
            samplers: or_else(grid.samplers, SamplerKind::ALL.to_vec()),
            light_sampling: or_else(grid.light_sampling, lights),
            ..grid
        }
    }
}

fn or_else<T>(list: Vec<T>, default: Vec<T>) -> Vec<T> {
    if list.is_empty() { default } else { list }
}

/// The values of a list, each once, in their order.
fn distinct<T: Copy + PartialEq>(values: &[T]) -> Vec<T> {
    let mut distinct: Vec<T> = Vec::new();
    for &value in values {
        if !distinct.contains(&value) {
            distinct.push(value);
        }
    }
    distinct
}
