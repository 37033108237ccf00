//! No ray gets out of a closed mesh (`tests/accel/watertight.rs` asks the same of the native accelerator).

use super::accelerators;
use crate::support::compare::count_hits;
use crate::support::meshes;
use crate::support::random::Random;
use crate::support::rays::{AIMS, Aim, target};
use crate::support::scenes::{FAR, TestScene};
use pathtracer::accel::Precision;
use pathtracer::geometry::{MeshPart, Ray};
use pathtracer::math::DVec3;

fn from_inside(scene: &TestScene, aim: Aim, count: usize, seed: u64) -> Vec<Ray> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|_| {
            let origin = scene.center + random.in_cube() * (0.3 * scene.size);
            Ray::new(origin, (target(scene, aim, origin, &mut random) - origin).normalize())
        })
        .collect()
}

fn assert_no_leaks(segments: u32, count: usize) {
    for center in [DVec3::ZERO, FAR] {
        let mesh = meshes::moved(meshes::sphere(2.0, segments, 0.0, 0), center);
        let scene = TestScene::new("sphere", Vec::new(), vec![mesh], center, 2.0);
        for accelerator in accelerators(&scene.geometry, Precision::Exact) {
            for aim in AIMS {
                let rays = from_inside(&scene, aim, count, 61);
                let leaks = rays.len() - count_hits(&accelerator, &rays);
                assert_eq!(leaks, 0, "{} at {center}, aimed at {aim:?}", accelerator.name);
            }
        }
    }
}

#[test]
fn a_closed_sphere_keeps_all_rays_in() {
    assert_no_leaks(200, 100_000);
}

#[test]
#[ignore = "long: 12 million rays; run by `cargo test --release -- --ignored`"]
fn a_closed_sphere_of_500_segments_keeps_a_million_rays_of_each_kind_in() {
    assert_no_leaks(500, 1_000_000);
}

/// A fan around a corner, seen from straight above it: rays to that corner pass within a rounding of all its edges.
#[test]
fn rays_at_the_corner_of_a_fan_hit_it() {
    let mut random = Random::new(62);
    for spokes in [3, 4, 7, 100] {
        let tip = random.in_cube();
        let mut mesh = MeshPart { positions: vec![tip], ..MeshPart::default() };
        for spoke in 0..spokes {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(spoke) / f64::from(spokes));
            mesh.positions.push(tip + DVec3::new(cos, sin, 0.3 * random.unit()));
            mesh.triangles.push([0, 1 + spoke, 1 + (spoke + 1) % spokes]);
        }
        let scene = TestScene::of_meshes("fan", vec![mesh], tip);
        // Where the corner is after its coordinates are rounded to f32.
        let frame = &scene.geometry.spaces[0].frame;
        let [x, y, z] = scene.geometry.spaces[0].vertices[0].map(f64::from);
        let corner = frame.to_world(DVec3::new(x, y, z));
        let rays: Vec<Ray> = (0..30_000)
            .map(|_| {
                let origin = corner + DVec3::new(random.between(-0.2, 0.2), random.between(-0.2, 0.2), -1.0);
                Ray::new(origin, (corner - origin).normalize())
            })
            .collect();
        for accelerator in accelerators(&scene.geometry, Precision::Exact) {
            assert_eq!(count_hits(&accelerator, &rays), rays.len(), "{} {spokes}", accelerator.name);
        }
    }
}
