//! What the path tracer counts, where it is known.

use crate::support::build::*;
use crate::support::watch::Unwatched;
use pathtracer::accel::Accelerator;
use pathtracer::accel::brute_force::BruteForce;
use pathtracer::geometry::{Geometry, Hit, PrimitiveId, Ray};
use pathtracer::integrator::{Counters, PathTracer};
use pathtracer::math::DVec3;
use pathtracer::render::{Settings, render};
use pathtracer::sampling::{Independent, Sampler};
use pathtracer::scene::desc::{MaterialKind, SceneDesc, ShapeDesc};
use pathtracer::world::World;

const SAMPLES: u64 = 2000;
const EYE: DVec3 = DVec3::new(-4.0, 0.3, 0.4);

/// Finds hits with `spoil` between them and the path tracer.
struct Spoilt<'g, F> {
    inner: BruteForce<'g>,
    spoil: F,
}

impl<F: Fn(&Ray, Option<Hit>) -> Option<Hit> + Sync> Accelerator for Spoilt<'_, F> {
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        (self.spoil)(ray, self.inner.intersect(ray))
    }

    fn occluded(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        self.inner.occluded(ray, t_max, target)
    }
}

/// The samples of a pixel, first channel, and what was counted; `eye` replaces the camera's place.
fn trace<F>(desc: &SceneDesc, bounces: u32, eye: Option<DVec3>, spoil: F) -> (Vec<f64>, Counters)
where
    F: Fn(&Ray, Option<Hit>) -> Option<Hit> + Sync,
{
    let world = World::compile(desc).expect("a valid scene");
    let mut camera = world.camera(&desc.camera, 1, 1);
    camera.position = eye.unwrap_or(camera.position);
    let geometry: &Geometry = &world.geometry;
    let accelerator = Spoilt { inner: BruteForce::new(geometry), spoil };
    let tracer = PathTracer::new(&world, &camera, &accelerator, bounces, true);
    let sampler = Independent::new(1);
    let mut counters = Counters::default();
    let sample = |index| tracer.sample(&sampler, 0, 0, index, &mut counters).x;
    ((0..SAMPLES).map(sample).collect(), counters)
}

fn honest(_: &Ray, hit: Option<Hit>) -> Option<Hit> {
    hit
}

/// A body under a sky of radiance 1.
fn under_sky(shape: ShapeDesc, kind: MaterialKind) -> SceneDesc {
    let mut desc = scene(EYE, DVec3::ZERO, vec![(shape, kind)]);
    desc.environment = sky(1.0);
    desc
}

/// Under a sky that is sampled.
fn under_gradient(kind: MaterialKind) -> SceneDesc {
    let mut desc = under_sky(ball(DVec3::ZERO, 1.0), kind);
    desc.environment.sky = grey(2.0);
    desc
}

/// All paths in a closed body are cut, with rho^(N - 1) after N segments; none ends by chance before the fifth.
#[test]
fn in_a_closed_body_all_throughput_is_cut() {
    for shape in [ball(DVec3::ZERO, 1.0), cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO)] {
        for bounces in 1..=4 {
            let body = (shape.clone(), glowing(grey(0.5), grey(0.5)));
            let desc = scene(DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.4, 0.1, -0.2), vec![body]);
            let (_, counters) = trace(&desc, bounces, None, honest);
            // A path of a diffuse room goes on in four branches from where it first meets a wall.
            let ends = if bounces == 1 { SAMPLES } else { 4 * SAMPLES };
            assert_eq!(counters.cut_paths, ends);
            let share = counters.cut_throughput.value() / SAMPLES as f64;
            // The weight of a step is rho to a few roundings, far below the half step of 2^-33 of the sum.
            assert!((share - 0.5f64.powi(bounces as i32 - 1)).abs() <= 2f64.powi(-32), "{bounces}: {share}");
            assert_eq!(counters.self_hits, 0);
        }
    }
}

/// Inside a closed body with Le = 1 - rho of the light 1 a share of rho^N comes after N segments.
#[test]
fn the_light_that_a_closed_body_lacks_is_told() {
    let shape = cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), DVec3::ZERO);
    for bounces in 2..=4 {
        for light_sampling in [false, true] {
            let body = (shape.clone(), glowing(grey(0.5), grey(0.5)));
            let desc = scene(DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.4, 0.1, -0.2), vec![body]);
            let world = World::compile(&desc).expect("a valid scene");
            let settings = Settings { light_sampling, ..Settings::new(16, 16, 64, bounces) };
            let rendered = render(&world, &desc.camera, &settings, &Unwatched).expect("a picture");
            let share = rendered.cut_light().expect("light");
            // Found by chance, all light of a segment is the same; aimed at, it has a standard deviation of about its mean.
            let deviation = if light_sampling { 4.0 / f64::sqrt(16.0 * 16.0 * 64.0) } else { 1e-9 };
            let expected = 0.5f64.powi(bounces as i32);
            assert!((share / expected - 1.0).abs() <= deviation, "{bounces} {light_sampling}: {share}");
        }
    }
}

#[test]
fn paths_that_leave_are_not_cut() {
    let desc = under_sky(ball(DVec3::ZERO, 1.0), diffuse(grey(1.0)));
    let (_, counters) = trace(&desc, 2, None, honest);
    assert_eq!((counters.cut_paths, counters.cut_throughput.value()), (0, 0.0));
    let (_, counters) = trace(&desc, 1, None, honest);
    assert_eq!((counters.cut_paths, counters.cut_throughput.value()), (SAMPLES, SAMPLES as f64));
}

/// White glass under a white sky is 1 where the path got out and 0 where it was cut.
#[test]
fn what_white_glass_lacks_is_what_was_cut() {
    let kind = MaterialKind::Refractive { color: grey(1.0), ratio: 0.67 };
    let shape = cuboid(DVec3::ZERO, DVec3::new(1.0, 1.5, 2.0), DVec3::new(10.0, 20.0, 30.0));
    let (samples, counters) = trace(&under_sky(shape, kind), 3, None, honest);
    let black = samples.iter().filter(|&&sample| sample == 0.0).count() as u64;
    assert!(black > 0);
    assert_eq!((counters.cut_paths, counters.cut_throughput.value()), (black, black as f64));
}

#[test]
fn rays_from_nowhere_are_refused_and_see_no_sky() {
    let desc = under_sky(ball(DVec3::ZERO, 1.0), diffuse(grey(1.0)));
    for eye in [DVec3::splat(f64::NAN), DVec3::new(f64::INFINITY, 0.0, 0.0)] {
        let (samples, counters) = trace(&desc, 4, Some(eye), honest);
        assert_eq!((counters.refused, counters.rays), (SAMPLES, SAMPLES));
        assert!(samples.iter().all(|&sample| sample == 0.0));
    }
}

#[test]
fn rays_that_go_on_from_nowhere_are_refused_and_bring_no_light() {
    // The coordinates of a rectangle's hit make its position.
    let lost = |_: &Ray, hit: Option<Hit>| hit.map(|hit| Hit { u: f64::NAN, ..hit });
    let mut desc = under_sky(square(DVec3::ZERO, 1.0), diffuse(grey(1.0)));
    desc.environment.sky = grey(2.0);
    let (samples, counters) = trace(&desc, 4, None, lost);
    // All but the camera's: the one that goes on, and the one to the sky unless that was sampled below the square.
    assert_eq!(counters.refused, counters.rays - SAMPLES);
    assert!(counters.refused > SAMPLES);
    assert!(samples.iter().all(|&sample| sample == 0.0));
}

#[test]
fn a_hit_on_the_primitive_that_the_ray_left_is_a_self_hit() {
    let again = |ray: &Ray, hit: Option<Hit>| {
        let itself = Hit { t: 1.0, object: 0, primitive: ray.leaving, part: 0, u: 0.0, v: 0.0 };
        if ray.leaving == PrimitiveId::NONE { hit } else { Some(itself) }
    };
    let (_, counters) = trace(&under_gradient(diffuse(grey(1.0))), 2, None, again);
    assert_eq!(counters.self_hits, SAMPLES);
}

#[test]
fn a_hit_within_the_error_bound_of_the_origin_is_a_self_hit() {
    // A ball of radius 1 at the origin: every component of its points' error is at most 16 x 2^-53, so the bound along
    // the normal is below sqrt(3) of that, and no smaller than one of it.
    let bound = 2f64.powi(-49);
    for (t, expected) in [(f64::MIN_POSITIVE, SAMPLES), (bound, SAMPLES), (2.0 * bound, 0)] {
        let near = move |ray: &Ray, hit: Option<Hit>| {
            let other = Hit { t, object: 1, primitive: PrimitiveId::solid(1), part: 0, u: 0.0, v: 0.0 };
            if ray.leaving == PrimitiveId::NONE { hit } else { Some(other) }
        };
        let mut desc = under_gradient(diffuse(grey(1.0)));
        desc.objects.extend(under_sky(ball(DVec3::splat(9.0), 1.0), diffuse(grey(1.0))).objects);
        let (_, counters) = trace(&desc, 2, None, near);
        assert_eq!(counters.self_hits, expected, "{t}");
    }
}

#[test]
fn the_far_side_of_a_body_is_no_self_hit_however_near() {
    let near = |ray: &Ray, hit: Option<Hit>| {
        let t = if ray.inward { f64::MIN_POSITIVE } else { f64::INFINITY };
        hit.map(|hit| Hit { t: hit.t.min(t), ..hit })
    };
    let kind = MaterialKind::Refractive { color: grey(1.0), ratio: 0.67 };
    let (_, counters) = trace(&under_sky(ball(DVec3::ZERO, 1.0), kind), 2, None, near);
    assert!(counters.cut_paths > 0);
    assert_eq!(counters.self_hits, 0);
}
