//! The camera's rays as the path tracer sends them: even over the pixel, even over the lens, and the one whatever the
//! other.

use crate::support::build::*;
use crate::support::stats::{SIGNIFICANCE, chi_square_uniform, sidak};
use pathtracer::accel::Accelerator;
use pathtracer::geometry::{Hit, PrimitiveId, Ray};
use pathtracer::integrator::{Counters, PathTracer};
use pathtracer::math::DVec3;
use pathtracer::sampling::{Independent, Sampler, Sobol};
use pathtracer::scene::desc::ApertureDesc;
use pathtracer::world::World;
use std::sync::Mutex;

/// Hits nothing and remembers what it was asked.
#[derive(Default)]
struct Recorder(Mutex<Vec<Ray>>);

impl Accelerator for Recorder {
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.0.lock().expect("no panic before").push(*ray);
        None
    }

    fn occluded(&self, _: &Ray, _: f64, _: PrimitiveId) -> bool {
        false
    }
}

const PIXEL: [u32; 2] = [3, 1];
const SIZE: [u32; 2] = [5, 4];
const LENS: f64 = 0.2;
const FOCUS: f64 = 3.0;
/// Field of view 90 degrees: half of the view is 1 wide at distance 1.
const FOV: f64 = 0.5;

/// Of every sample of one pixel: where in the pixel and where on the lens, both as two numbers in [0, 1) that are even
/// where the points are: x and y; squared radius and turn.
fn places<S: Sampler>(seed: u64, samples: u64) -> Vec<[f64; 4]> {
    let eye = DVec3::new(1.0, 2.0, 3.0);
    let mut desc = scene(eye, eye + DVec3::X, vec![(ball(DVec3::ZERO, 1.0), diffuse(grey(0.5)))]);
    desc.camera.fov = FOV;
    desc.camera.focus_distance = FOCUS;
    desc.camera.aperture = ApertureDesc::Radius(LENS);
    let world = World::compile(&desc).expect("a valid scene");
    let camera = world.camera(&desc.camera, SIZE[0], SIZE[1]);
    let recorder = Recorder::default();
    let tracer = PathTracer::new(&world, &camera, &recorder, 1, true);
    let sampler = S::new(seed);
    for index in 0..samples {
        tracer.sample(&sampler, PIXEL[0], PIXEL[1], index, &mut Counters::default());
    }
    let place = |ray: &Ray| {
        // The view is along x, right is -y, up is z; origins are relative to the world's.
        let lens = ray.origin - camera.position;
        let sharp = lens + ray.direction * (FOCUS / ray.direction.x);
        let half = [1.0, f64::from(SIZE[1]) / f64::from(SIZE[0])];
        let x = 0.5 * (1.0 - sharp.y / FOCUS / half[0]) * f64::from(SIZE[0]);
        let y = 0.5 * (1.0 - sharp.z / FOCUS / half[1]) * f64::from(SIZE[1]);
        let radius2 = (lens.y * lens.y + lens.z * lens.z) / (LENS * LENS);
        let turn = libm::atan2(lens.z, lens.y) / std::f64::consts::TAU + 0.5;
        [x - f64::from(PIXEL[0]), y - f64::from(PIXEL[1]), radius2, turn]
    };
    recorder.0.into_inner().expect("no panic before").iter().map(place).collect()
}

/// Counts in cells: `steps` of each of the four numbers.
fn counts(places: &[[f64; 4]], steps: [usize; 4]) -> Vec<u64> {
    let mut counts = vec![0; steps.iter().product()];
    for place in places {
        let cell = place.iter().zip(steps).fold(0, |cell, (&x, steps)| {
            // Roundings may take a point over the border of pixel or lens by a few units in the last place.
            assert!((-1e-12..=1.0 + 1e-12).contains(&x), "outside pixel or lens: {place:?}");
            cell * steps + ((x * steps as f64) as usize).min(steps - 1)
        });
        counts[cell] += 1;
    }
    counts
}

fn assert_even<S: Sampler>(name: &str) {
    let places = places::<S>(7, 1 << 18);
    let cells =
        [[32, 32, 1, 1], [1, 1, 32, 32], [8, 1, 8, 8], [1, 8, 8, 8], [8, 8, 8, 1], [8, 8, 1, 8], [6; 4]];
    let least = sidak(SIGNIFICANCE, cells.len());
    for steps in cells {
        let p = chi_square_uniform(&counts(&places, steps));
        assert!(p > least, "{name} {steps:?}: p = {p:e}");
    }
}

#[test]
fn rays_are_even_over_pixel_and_lens() {
    assert_even::<Independent>("independent");
    assert_even::<Sobol>("sobol");
}

/// The test can fail: points of the lens that are even in radius, not in area.
#[test]
fn an_uneven_lens_is_noticed() {
    let mut places = places::<Independent>(7, 1 << 14);
    places.iter_mut().for_each(|place| place[2] = place[2].sqrt());
    assert!(chi_square_uniform(&counts(&places, [1, 1, 8, 8])) < 1e-6);
}
