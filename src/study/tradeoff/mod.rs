//! What every knob of a render costs in time and gains in accuracy.
//!
//! Every configuration of a [`grid`] is rendered with several seeds by the same function as the command line's
//! renders. The errors need no reference: they are the variance across the seeds and, where paths or samples are cut
//! short, the square of the bias against those that are not. From the numbers of every seed come estimates with
//! intervals, ratios to the default, the Pareto front and the convergence ([`Row`], [`Convergence`]), and the
//! cheapest settings for a wanted error ([`plan`]). On scenes with meshes also what a ray costs and how many are lost at
//! each precision. [`figures`], [`charts`] and [`page`] show it.

mod analysis;
pub mod charts;
mod errors;
pub mod figures;
pub mod grid;
pub mod page;
pub mod plan;
pub mod reference;
mod shots;
mod truth;

pub use analysis::{Convergence, Recommendation, Row};
pub use shots::{Configuration, Shot, Tell};

use self::errors::{Errors, SquaredBias};
use self::grid::{Frame, Grid, Variant};
use self::truth::Truth;
use super::bench::{self, Rung};
use super::machine::Machine;
use crate::error::{Error, Result};
use crate::render::Settings;
use crate::scene::desc::CameraDesc;
use crate::world::World;
use rayon::prelude::*;

/// How to measure.
#[derive(Clone, Debug)]
pub struct Options {
    /// Size, threads and instruction set.
    pub frame: Frame,
    /// The settings.
    pub grid: Grid,
    /// How many seeds, at least 2.
    pub seeds: u64,
    /// The first of them.
    pub first_seed: u64,
    /// The right picture, linear R G B row by row, if there is one.
    pub reference: Option<Vec<f32>>,
    /// The relMSE for which settings are recommended, > 0.
    pub target: f64,
    /// Rays of each kind for the cost of a ray by precision, or 0 to leave that out.
    pub rays: usize,
    /// Rays of each aim that look for leaks.
    pub leak_rays: usize,
}

/// What came out.
#[derive(Clone, Debug)]
pub struct Tradeoff {
    /// The scene's name.
    pub scene: String,
    /// What it was measured on.
    pub machine: Machine,
    /// Pixels in a row, and rows.
    pub size: [u32; 2],
    /// How many seeds.
    pub seeds: u64,
    /// Whether errors are against a reference.
    pub has_reference: bool,
    /// All variants, the default first.
    pub variants: Vec<Variant>,
    /// The numbers of samples of each.
    pub samples: Vec<u64>,
    /// Every variant with every number of samples, variant by variant.
    pub rows: Vec<Row>,
    /// Place of the row to which all others are compared.
    pub baseline: usize,
    /// How the error of every variant falls; empty with a single number of samples.
    pub convergence: Vec<Convergence>,
    /// The relMSE for which settings are recommended.
    pub target: f64,
    /// The cheapest settings for it, if any reach it.
    pub recommendation: Option<Recommendation>,
    /// The cost of a ray, and lost ones, by accelerator and precision; on scenes with meshes.
    pub rays: Option<Rung>,
    /// A picture of every row, that of the first seed: linear R G B, row by row.
    pub pictures: Vec<Vec<f32>>,
    /// The right picture, as well as it is known.
    pub truth: Vec<f32>,
}

/// Samples of the row to which others are compared, if they are in the grid; else the most.
const BASELINE_SAMPLES: u64 = 16;

/// Measures a scene; `tell` hears of rounds.
///
/// # Errors
/// Fewer than two seeds; a reference of another size; too little memory; what a render may fail with.
pub fn run(
    scene: String,
    world: &World,
    camera: &CameraDesc,
    options: &Options,
    tell: Tell<'_>,
) -> Result<Tradeoff> {
    let Options { frame, grid, .. } = options;
    check(options)?;
    let machine = Machine::here(frame.isa, frame.threads)?;
    let variants = grid.variants();
    let configurations = configurations(variants.len(), &grid.samples);
    let seeds = options.first_seed..options.first_seed + options.seeds;
    let shots = shots::take(world, camera, frame, (&variants, &configurations), seeds, tell)?;
    let pool = super::contender::Pools::new(frame.threads)?;
    let (truth, errors) = pool.all().install(|| judge(&variants, &shots, options));
    let baseline = baseline(&grid.samples);
    let analysis = analysis::Analysis {
        grid,
        variants: &variants,
        configurations: &configurations,
        shots: &shots,
        errors: &errors,
        energy: options.reference.as_ref().map(|_| truth.energy()),
        baseline,
        seeds: options.seeds as usize,
    };
    let (rows, convergence) = (analysis.rows(), analysis.convergence());
    let recommendation = analysis.recommend(options.target);
    let has_meshes = world.geometry.triangle_count() > 0 && options.rays > 0;
    let rays = has_meshes.then(|| ray_costs(scene.clone(), world, camera, options)).transpose()?;
    Ok(Tradeoff {
        scene,
        machine,
        size: [frame.width, frame.height],
        seeds: options.seeds,
        has_reference: options.reference.is_some(),
        variants,
        samples: grid.samples.clone(),
        rows,
        baseline,
        convergence,
        target: options.target,
        recommendation,
        rays,
        pictures: shots.into_iter().map(|mut shots| shots.swap_remove(0).pixels).collect(),
        truth: truth.pixels,
    })
}

/// Every variant with every number of samples.
fn configurations(variants: usize, samples: &[u64]) -> Vec<Configuration> {
    let of = |variant| samples.iter().map(move |&samples| Configuration { variant, samples });
    (0..variants).flat_map(of).collect()
}

/// The place of the samples of the row to which others are compared.
fn baseline(samples: &[u64]) -> usize {
    let usual = samples.iter().position(|&samples| samples == BASELINE_SAMPLES);
    usual.unwrap_or(samples.len() - 1)
}

/// Refuses what can't be measured.
fn check(options: &Options) -> Result<()> {
    let Frame { width, height, .. } = options.frame;
    Settings::new(width, height, 1, 1).check()?;
    if options.seeds < 2 {
        return Err(Error::Usage("an error needs at least 2 seeds".into()));
    }
    match &options.reference {
        Some(pixels) if pixels.len() as u64 != 3 * u64::from(width) * u64::from(height) => {
            Err(Error::Usage(format!("the reference has not {width} x {height} pixels")))
        }
        _ => Ok(()),
    }
}

/// The right picture, and the errors of every configuration beside it.
fn judge(variants: &[Variant], shots: &[Vec<Shot>], options: &Options) -> (Truth, Vec<Errors>) {
    let Options { frame, grid, .. } = options;
    let width = frame.width as usize;
    let counts = grid.samples.len();
    // Of every variant the shots with the most samples.
    let best = |variant: usize| shots[(variant + 1) * counts - 1].as_slice();
    if let Some(reference) = &options.reference {
        let truth = Truth::given(reference.clone(), width);
        let errors = shots.par_iter().map(|shots| Errors::against(shots, &truth, width)).collect();
        return (truth, errors);
    }
    let partner = |variant: &Variant| variants.iter().position(|other| *other == grid.truth_of(variant));
    let is_right = |i: &usize| partner(&variants[*i]) == Some(*i);
    let right: Vec<&[Shot]> = (0..variants.len()).filter(is_right).map(best).collect();
    let truth = Truth::mean(&right, width);
    // The bias of a denoiser falls with more samples; that of other settings is best seen with the most.
    let shown_by = |i: usize| if variants[i / counts].denoise { i } else { i - i % counts + counts - 1 };
    let bias: Vec<Option<SquaredBias>> = (0..shots.len())
        .into_par_iter()
        .map(|i| {
            let right = partner(&variants[i / counts]).filter(|&right| right != i / counts)?;
            let right = &shots[right * counts + i % counts];
            (shown_by(i) == i).then(|| SquaredBias::of(&shots[i], right, &truth))
        })
        .collect();
    let of = |(i, shots): (usize, &Vec<Shot>)| {
        Errors::across_seeds(shots, &truth, bias[shown_by(i)].as_ref(), width)
    };
    let errors = shots.par_iter().enumerate().map(of).collect();
    (truth, errors)
}

/// What a ray costs and how many are lost, on one thread and with the rays of the scene's own paths.
fn ray_costs(scene: String, world: &World, camera: &CameraDesc, options: &Options) -> Result<Rung> {
    let options = bench::Options {
        isa: options.frame.isa,
        threads: 1,
        rays: options.rays,
        rounds: 5,
        seed: options.first_seed,
        leak_rays: options.leak_rays,
    };
    bench::scene(scene, world, camera, &options)
}
