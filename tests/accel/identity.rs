//! Every accelerator gives the hit that the definition names, to the last bit.

use pathtracer::accel::brute_force::BruteForce;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::Geometry;
use pathtracer::math::DVec3;

use super::{QUALITIES, every_isa, native, native_of};
use crate::support::compare::assert_identical;
use crate::support::meshes;
use crate::support::rays::rays;
use crate::support::scenes::{FAR, KINDS, TestScene, scene};

/// Compares an accelerator with brute force on all kinds of scenes at the origin and far from it.
pub(crate) fn assert_equals_brute_force<'s, A, F>(build: F)
where
    A: Accelerator,
    F: Fn(&'s Geometry) -> A,
{
    for center in [DVec3::ZERO, FAR] {
        for kind in KINDS {
            // Leaked so that accelerators of any lifetime can be built in a generic function.
            let scene: &'s TestScene = Box::leak(Box::new(scene(kind, center)));
            let what = format!("{kind} at {center}");
            let accelerator = build(&scene.geometry);
            assert_identical(
                &what,
                &BruteForce::new(&scene.geometry),
                &accelerator,
                &rays(scene, 20_000, 11),
            );
        }
    }
}

#[test]
fn native_equals_brute_force() {
    assert_equals_brute_force(native);
}

#[test]
fn trees_of_every_quality_equal_brute_force() {
    for quality in QUALITIES {
        assert_equals_brute_force(|geometry| native_of(geometry, quality));
    }
}

#[test]
fn instruction_sets_agree_at_every_precision() {
    let sphere = meshes::moved(meshes::sphere(1.0, 300, 0.02, 21), FAR);
    let scene = TestScene::of_meshes("sphere", vec![sphere], FAR);
    let rays = rays(&scene, 1_000_000, 22);
    for precision in [Precision::Exact, Precision::Fast] {
        let kernels = every_isa(&scene.geometry, precision);
        for pair in kernels.windows(2) {
            let what = format!("{precision:?}: {:?} against {:?}", pair[0].isa(), pair[1].isa());
            assert_identical(&what, &pair[0], &pair[1], &rays);
        }
    }
}

#[test]
fn instruction_sets_agree_on_every_kind_of_scene() {
    for kind in KINDS {
        let scene = scene(kind, DVec3::ZERO);
        let rays = rays(&scene, 50_000, 23);
        for pair in every_isa(&scene.geometry, Precision::Exact).windows(2) {
            assert_identical(kind, &pair[0], &pair[1], &rays);
        }
    }
}

#[test]
fn robust_equals_exact() {
    let scene = scene("duplicated faces", DVec3::ZERO);
    let kernels = every_isa(&scene.geometry, Precision::Robust);
    assert_identical("robust", &native(&scene.geometry), &kernels[0], &rays(&scene, 50_000, 24));
}
