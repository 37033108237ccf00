//! A trade-off of small pictures: what is known comes out.

use crate::support::build::{ball, diffuse, glowing, grey, scene, sky};
use pathtracer::accel::Precision;
use pathtracer::math::DVec3;
use pathtracer::picture::Denoiser;
use pathtracer::render::AccelKind;
use pathtracer::sampling::SamplerKind;
use pathtracer::scene::desc::SceneDesc;
use pathtracer::study::statistics::Estimate;
use pathtracer::study::tradeoff::figures::csv;
use pathtracer::study::tradeoff::grid::{Frame, Grid};
use pathtracer::study::tradeoff::plan::{Curve, Plan};
use pathtracer::study::tradeoff::{self, Options, Row, Tradeoff};
use pathtracer::world::World;

fn grid() -> Grid {
    Grid {
        samples: vec![1, 4, 16],
        bounces: vec![8],
        accels: vec![AccelKind::Native],
        precisions: vec![Precision::Exact],
        samplers: vec![SamplerKind::Independent],
        light_sampling: vec![true],
        clamps: vec![None],
        noises: vec![None],
        denoise: vec![false],
        crossed: false,
    }
}

fn options(grid: Grid) -> Options {
    Options {
        frame: Frame { width: 16, height: 12, threads: 2, isa: None },
        grid,
        seeds: 8,
        first_seed: 3,
        reference: None,
        target: 0.01,
        rays: 0,
        leak_rays: 0,
    }
}

fn run(desc: &SceneDesc, options: &Options) -> Tradeoff {
    let world = World::compile(desc).expect("a valid scene");
    tradeoff::run("scene".into(), &world, &desc.camera, options, &|_, _| {}).expect("a measurement")
}

/// A grey ball under the sky, seen from near.
fn lit_ball() -> SceneDesc {
    let mut desc =
        scene(DVec3::new(-4.0, 0.0, 0.5), DVec3::ZERO, vec![(ball(DVec3::ZERO, 1.0), diffuse(grey(0.7)))]);
    desc.environment = sky(1.0);
    desc.environment.ground = grey(0.0);
    desc.camera.fov = 0.2;
    desc
}

#[test]
fn denoising_is_named_and_counted_among_the_settings() {
    let grid = Grid { denoise: vec![false, true], ..grid() };
    let variants = grid.variants();
    let differences: Vec<String> = variants.iter().map(|variant| variant.difference(&variants[0])).collect();
    assert_eq!(differences, ["default", "denoised"]);
    assert!(variants[1].options().ends_with(" --denoise"));
}

/// Runs where the denoiser is found.
#[test]
fn the_bias_of_a_denoiser_counts_as_error() {
    if Denoiser::load().is_err() {
        println!("no denoiser here: nothing is tested");
        return;
    }
    let grid = Grid { denoise: vec![false, true], samples: vec![1, 64], ..grid() };
    let result = run(&lit_ball(), &options(grid));
    let errors: Vec<f64> = result.rows.iter().map(|row| row.rel_mse.value).collect();
    // Of one sample noise is what lacks, of 64 the denoiser blurs what is no noise any more.
    assert!(errors[2] < errors[0], "{errors:?}");
    assert!(errors[3] > 0.0, "{errors:?}");
}

/// The inside of a ball with Le = 1 - rho: after N segments every path brings 1 - rho^N.
fn furnace(rho: f64) -> SceneDesc {
    let body = (ball(DVec3::ZERO, 1.0), glowing(grey(rho), grey(1.0 - rho)));
    scene(DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.4, 0.1, -0.2), vec![body])
}

#[test]
fn every_setting_is_tried_with_every_number_of_samples() {
    let grid = Grid {
        bounces: vec![8, 2],
        precisions: vec![Precision::Exact, Precision::Fast],
        samplers: SamplerKind::ALL.to_vec(),
        ..grid()
    };
    assert_eq!(grid.variants().len(), 1 + 3);
    let crossed = Grid { crossed: true, ..grid.clone() };
    assert_eq!(crossed.variants().len(), 2 * 2 * 2);
    let found = run(&lit_ball(), &options(grid));
    assert_eq!(found.rows.len(), 4 * 3);
    let labels: Vec<String> = (0..4).map(|i| found.label(i)).collect();
    assert_eq!(labels, ["default", "fast", "independent", "2 bounces"]);
    assert_eq!(csv(&found.figures()).lines().count(), found.figures().len() + 1);
}

#[test]
fn the_default_is_as_efficient_as_itself() {
    let found = run(&lit_ball(), &options(grid()));
    let efficiency = found.rows[found.baseline].efficiency;
    assert_eq!(found.rows[found.baseline].configuration.samples, 16);
    assert_eq!((efficiency.value, efficiency.low, efficiency.high), (1.0, 1.0, 1.0));
}

#[test]
fn independent_samples_converge_as_one_over_their_number() {
    let found = run(&lit_ball(), &options(grid()));
    let slope = found.convergence[0].slope;
    // Four standard errors, which are those of 8 seeds of 192 pixels.
    assert!((slope.value + 1.0).abs() < 4.0 * slope.standard_error, "{slope:?}");
    assert!(slope.standard_error < 0.05, "{slope:?}");
}

#[test]
fn the_error_across_seeds_is_that_against_the_truth() {
    let plain = options(Grid { samples: vec![4], ..grid() });
    let across = run(&lit_ball(), &plain).rows[0].clone();
    let many = options(Grid { samples: vec![1024], ..grid() });
    let truth = run(&lit_ball(), &Options { first_seed: 100, ..many }).truth;
    let against = run(&lit_ball(), &Options { reference: Some(truth), ..plain }).rows[0].clone();
    for (name, error) in [("mse", (|row| row.mse) as fn(&Row) -> _), ("relMSE", |row| row.rel_mse)] {
        let (a, b) = (error(&across), error(&against));
        // The reference's own noise is 1/2048 of the error. Both estimates have 8 seeds, so at most double standard errors.
        let allowed = 4.0 * (a.standard_error + b.standard_error) + b.value / 2048.0;
        assert!((a.value - b.value).abs() < allowed, "{name}: {a:?} {b:?}");
    }
    assert!((across.flip.value - against.flip.value).abs() < 0.2 * against.flip.value);
}

#[test]
fn the_bias_of_cut_paths_is_what_they_would_have_brought() {
    let rho: f64 = 0.5;
    let grid = Grid { bounces: vec![20, 2], light_sampling: vec![false], ..grid() };
    let found = run(&furnace(rho), &options(grid));
    let (whole, cut) = (1.0 - rho.powi(20), 1.0 - rho.powi(2));
    let row = found.rows.last().expect("a row");
    assert_eq!(row.configuration.variant, 1);
    // The paths cut at 2 segments have no noise, the whole ones that of Russian roulette; pictures are f32.
    let near = |what: &str, estimate: Estimate, expected: f64| {
        let allowed = 4.0 * estimate.standard_error + 1e-6;
        assert!(
            (estimate.value - expected).abs() < allowed && allowed < 0.02,
            "{what}: {estimate:?}, {expected}"
        );
    };
    near("bias", row.bias.expect("a bias"), cut / whole - 1.0);
    let square = (cut - whole).powi(2);
    near("mse", row.mse, square);
    near("relMSE", row.rel_mse, square / (whole * whole + 0.01));
    // One pixel of 192 is left out.
    assert!((0.9..=1.0).contains(&(row.trimmed.value / row.rel_mse.value)), "{:?}", row.trimmed);
    assert!(found.rows[2].bias.is_none());
}

#[test]
fn settings_that_can_not_reach_the_error_are_not_recommended() {
    let grid = Grid { bounces: vec![20, 1], light_sampling: vec![false], ..grid() };
    let found = run(&furnace(0.5), &Options { target: 0.05, ..options(grid) });
    let chosen = found.recommendation.as_ref().expect("a recommendation");
    assert_eq!(found.variants[chosen.variant].bounces, 20);
    assert!(found.recommendation_line().starts_with("for relMSE 0.05: native exact"));
    assert!(found.recommended_command().expect("a command").starts_with("pathtracer scene 16 12 1 20 IMAGE"));
}

#[test]
fn one_seed_and_a_reference_of_another_size_are_refused() {
    let desc = lit_ball();
    let world = World::compile(&desc).expect("a valid scene");
    let refused =
        |options: &Options| tradeoff::run(String::new(), &world, &desc.camera, options, &|_, _| {}).is_err();
    assert!(refused(&Options { seeds: 1, ..options(grid()) }));
    assert!(refused(&Options { reference: Some(vec![0.0; 3]), ..options(grid()) }));
}

/// Variances 1 / n and a second for 1000 samples.
fn curve(floor: f64) -> Curve<'static> {
    Curve {
        samples: &[1, 4, 16],
        variances: vec![1.0, 0.25, 0.0625],
        seconds: vec![1e-3, 4e-3, 16e-3],
        floor,
    }
}

#[test]
fn a_plan_follows_the_power_law_between_and_beyond_what_was_measured() {
    let plan = |target: f64| curve(0.0).plan(target).expect("a plan");
    let near = |plan: Plan, samples: u64, extrapolated: bool| {
        assert_eq!((plan.samples, plan.extrapolated), (samples, extrapolated));
        assert!((plan.seconds - 1e-3 * samples as f64).abs() < 1e-9 * samples as f64);
    };
    near(plan(0.125), 8, false);
    near(plan(0.0625), 16, false);
    near(plan(0.01), 100, true);
    near(plan(5.0), 1, false);
}

#[test]
fn a_bias_leaves_less_room_for_noise() {
    assert_eq!(curve(0.005).plan(0.01).expect("a plan").samples, 200);
    assert_eq!(curve(0.01).plan(0.01), None);
    assert_eq!(curve(f64::NAN).plan(0.01), None);
}

#[test]
fn a_page_holds_everything_and_asks_for_nothing() {
    let grid = Grid { bounces: vec![8, 2], ..grid() };
    let page = run(&lit_ball(), &options(grid)).page().expect("a page");
    assert!(page.starts_with("<!DOCTYPE html>") && page.trim_end().ends_with("</html>"));
    // Error against time, and energy against bounces.
    assert_eq!(page.matches("<svg").count(), 2);
    // Two variants of three numbers of samples, and the truth.
    assert_eq!(page.matches("data:image/png;base64,iVBORw0KGgo").count(), 7);
    for outside in ["src=\"http", "href", "@import", "url(", "<link", "fetch("] {
        assert!(!page.contains(outside), "{outside}");
    }
}
