//! No ray leaves a closed mesh.

use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::Ray;
use pathtracer::math::DVec3;

use super::{every_isa, native};
use crate::support::compare::count_hits;
use crate::support::meshes;
use crate::support::random::Random;
use crate::support::rays::{AIMS, Aim, target};
use crate::support::scenes::{FAR, TestScene};

fn from_inside(scene: &TestScene, aim: Aim, count: usize) -> Vec<Ray> {
    let mut random = Random::new(51);
    (0..count)
        .map(|_| {
            let origin = scene.center + random.in_cube() * (0.3 * scene.size);
            Ray::new(origin, (target(scene, aim, origin, &mut random) - origin).normalize())
        })
        .collect()
}

fn assert_no_leaks(scene: &TestScene, accelerator: &impl Accelerator, count: usize) {
    for aim in AIMS {
        let rays = from_inside(scene, aim, count);
        let leaks = rays.len() - count_hits(accelerator, &rays);
        assert_eq!(leaks, 0, "{} at {}, aimed at {aim:?}", scene.name, scene.center);
    }
}

#[test]
fn a_sphere_of_500_segments_keeps_all_rays_in() {
    for center in [DVec3::ZERO, FAR] {
        let mesh = meshes::moved(meshes::sphere(2.0, 500, 0.0, 0), center);
        let scene = TestScene::new("sphere", Vec::new(), vec![mesh], center, 2.0);
        assert_no_leaks(&scene, &native(&scene.geometry), 350_000);
    }
}

#[test]
fn closed_meshes_keep_all_rays_in_with_every_instruction_set() {
    let noisy = TestScene::of_meshes("noisy sphere", vec![meshes::sphere(1.0, 120, 0.3, 52)], DVec3::ZERO);
    let cube = TestScene::of_meshes("grid cube", vec![meshes::grid_cube(20)], DVec3::ZERO);
    for scene in [noisy, cube] {
        for kernel in every_isa(&scene.geometry, Precision::Exact) {
            assert_no_leaks(&scene, &kernel, 100_000);
        }
    }
}
