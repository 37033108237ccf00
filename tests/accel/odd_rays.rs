//! Rays that are legal but unusual, and rays that are not.

use pathtracer::accel::brute_force::BruteForce;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{PrimitiveId, Ray};
use pathtracer::math::DVec3;

use super::{every_isa, native};
use crate::support::compare::{assert_identical, count_hits};
use crate::support::meshes;
use crate::support::random::Random;
use crate::support::scenes::{KINDS, TestScene, scene};

/// Direction components: signed zeros, far below and above 1, subnormal in f32.
const COMPONENTS: [f64; 10] = [0.0, -0.0, 1.0, -1.0, 1e-30, -1e-30, 1e30, -1e30, 1e-41, -1e-41];

fn odd_rays(scene: &TestScene, count: usize) -> Vec<Ray> {
    let mut random = Random::new(31);
    let positions = &scene.parts[0].positions;
    (0..count)
        .map(|i| {
            let mut component = || COMPONENTS[random.index(COMPONENTS.len())];
            let mut direction = DVec3::new(component(), component(), component());
            // Distances must stay within what f32 holds.
            if direction.abs().max_element() < 1e-30 {
                direction[i % 3] = 1.0;
            }
            // Corners of boxes, faces of boxes, and anywhere.
            let mut origin = positions[random.index(positions.len())];
            if i % 3 == 1 {
                origin[random.index(3)] = scene.center[0] + random.between(-1.5, 1.5);
            } else if i % 3 == 2 {
                origin = scene.center + random.in_cube() * 1.5;
            }
            Ray::new(origin, direction)
        })
        .collect()
}

#[test]
fn zeros_and_extreme_components_give_the_hits_of_brute_force() {
    for kind in KINDS {
        let scene = scene(kind, DVec3::ZERO);
        let rays = odd_rays(&scene, 40_000);
        let kernels = every_isa(&scene.geometry, Precision::Exact);
        assert_identical(kind, &BruteForce::new(&scene.geometry), &kernels[0], &rays[..5000]);
        for pair in kernels.windows(2) {
            assert_identical(kind, &pair[0], &pair[1], &rays);
        }
    }
}

#[test]
fn rays_that_are_not_finite_hit_nothing() {
    let scene = scene("mixed", DVec3::ZERO);
    let accelerator = native(&scene.geometry);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for place in 0..6 {
            let mut numbers = [0.0, 0.0, -5.0, 0.0, 0.0, 1.0];
            numbers[place] = bad;
            let ray = Ray::new(DVec3::from_slice(&numbers[..3]), DVec3::from_slice(&numbers[3..]));
            assert_eq!(accelerator.intersect(&ray), None);
            assert!(!accelerator.occluded(&ray, f64::INFINITY, PrimitiveId::NONE));
        }
    }
}

#[test]
fn rays_along_the_axes_through_a_grid_cube_lose_nothing() {
    let scene = TestScene::of_meshes("grid cube", vec![meshes::grid_cube(30)], DVec3::ZERO);
    let mut random = Random::new(32);
    let rays: Vec<Ray> = (0..200_000)
        .map(|i| {
            let axis = i % 3;
            let mut direction = DVec3::ZERO;
            direction[axis] = if random.unit() < 0.5 { 1.0 } else { -1.0 };
            // On the lines of the grid as often as between them, inside and outside the cube.
            let mut coordinate = |on_line: bool| {
                if on_line { random.index(31) as f64 / 15.0 - 1.0 } else { random.between(-1.0, 1.0) }
            };
            let mut origin = DVec3::new(coordinate(i % 2 == 0), coordinate(i % 5 < 3), coordinate(i % 7 < 4));
            origin[axis] = if i % 2 == 0 { 0.0 } else { -3.0 * direction[axis] };
            Ray::new(origin, direction)
        })
        .collect();
    for kernel in every_isa(&scene.geometry, Precision::Exact) {
        assert_eq!(count_hits(&kernel, &rays), rays.len(), "{:?}", kernel.isa());
    }
}
