//! Every accelerator gives the hit that the definition names, to the last bit.

#[cfg(feature = "embree")]
use pathtracer::accel::BuildOptions;
use pathtracer::accel::brute_force::BruteForce;
#[cfg(feature = "embree")]
use pathtracer::accel::embree::Embree;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::Geometry;
use pathtracer::math::DVec3;

#[cfg(feature = "embree")]
use super::instruction_sets;
use super::{QUALITIES, every_isa, native, native_of};
use crate::support::compare::assert_identical;
use crate::support::meshes;
use crate::support::rays::rays;
use crate::support::scenes::{FAR, KINDS, TestScene, on_a_large_ball, scene};

/// An accelerator with its name.
type Named<'g> = (String, Box<dyn Accelerator + 'g>);

/// Both accelerators at exact in every instruction set that this machine has.
fn all_exact(geometry: &Geometry) -> Vec<Named<'_>> {
    let native = every_isa(geometry, Precision::Exact).into_iter();
    let all =
        native.map(|kernel| (format!("native {:?}", kernel.isa()), Box::new(kernel) as Box<dyn Accelerator>));
    #[cfg(feature = "embree")]
    let all = all.chain(instruction_sets().map(|isa| {
        let options = BuildOptions { isa: Some(isa), ..BuildOptions::default() };
        let kernel = Embree::build(geometry, &options).expect("a tree");
        (format!("Embree {isa:?}"), Box::new(kernel) as Box<dyn Accelerator>)
    }));
    all.collect()
}

/// 1e7 from the origin, where a step of f32 is 1.
const AWAY: DVec3 = DVec3::new(1e7, -1e7, 1e7);

/// Compares all accelerators with each other on `count` rays, the first also with brute force on `checked` of them.
fn assert_all_agree(scene: &TestScene, count: usize, checked: usize) {
    let rays = rays(scene, count, 11);
    let all = all_exact(&scene.geometry);
    let what = |name: &str| format!("{} at {}: {name}", scene.name, scene.center);
    let (first, others) = all.split_first().expect("an accelerator");
    let oracle = BruteForce::new(&scene.geometry);
    assert_identical(&what(&first.0), &oracle, first.1.as_ref(), &rays[..checked]);
    for (name, other) in others {
        let what = what(&format!("{name} against {}", first.0));
        assert_identical(&what, first.1.as_ref(), other.as_ref(), &rays);
    }
}

#[test]
fn all_accelerators_equal_brute_force_on_every_kind_of_scene() {
    for center in [DVec3::ZERO, FAR] {
        for kind in KINDS {
            assert_all_agree(&scene(kind, center), 50_000, 20_000);
        }
    }
}

#[test]
fn all_accelerators_agree_on_a_mesh_that_stands_on_a_ball_of_radius_1e7() {
    assert_all_agree(&on_a_large_ball(DVec3::ZERO), 50_000, 100);
    assert_all_agree(&on_a_large_ball(AWAY), 50_000, 100);
}

#[test]
#[ignore = "10^6 rays a kind against all primitives: minutes"]
fn all_accelerators_equal_brute_force_on_a_million_rays_of_every_kind() {
    for center in [DVec3::ZERO, FAR] {
        for kind in KINDS {
            assert_all_agree(&scene(kind, center), 1_000_000, 1_000_000);
        }
    }
    assert_all_agree(&on_a_large_ball(DVec3::ZERO), 1_000_000, 20_000);
    assert_all_agree(&on_a_large_ball(AWAY), 1_000_000, 20_000);
}

#[test]
fn trees_of_every_quality_equal_brute_force() {
    for quality in QUALITIES {
        for kind in KINDS {
            let scene = scene(kind, FAR);
            let what = format!("{kind}, {quality:?}");
            let native = native_of(&scene.geometry, quality);
            assert_identical(&what, &BruteForce::new(&scene.geometry), &native, &rays(&scene, 10_000, 12));
        }
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
fn robust_equals_exact() {
    let scene = scene("duplicated faces", DVec3::ZERO);
    let kernels = every_isa(&scene.geometry, Precision::Robust);
    assert_identical("robust", &native(&scene.geometry), &kernels[0], &rays(&scene, 50_000, 24));
}
