//! The tree itself: whole, bounded, the same for any number of threads.

use pathtracer::accel::bvh::{Bvh, triangle_blocks};
use pathtracer::accel::{Accelerator, BuildOptions, BvhQuality, Isa, Precision};
use pathtracer::geometry::{Geometry, MeshPart, MeshSpace, Ray};
use pathtracer::math::DVec3;

use super::{QUALITIES, native, native_of};
use crate::support::compare::assert_identical;
use crate::support::meshes;
use crate::support::random::Random;
use crate::support::rays::rays;
use crate::support::scenes::{FAR, KINDS, TestScene, scene};

fn of_mesh(mesh: MeshPart) -> Geometry {
    Geometry::new(Vec::new(), &[mesh])
}

fn assert_valid(what: &str, geometry: &Geometry) {
    assert_eq!(native(geometry).validate(), Ok(()), "{what}");
}

#[test]
fn every_kind_of_scene_makes_a_valid_tree() {
    for center in [DVec3::ZERO, FAR] {
        for kind in KINDS {
            assert_valid(kind, &scene(kind, center).geometry);
        }
    }
    assert_valid("large sphere", &of_mesh(meshes::sphere(1.0, 400, 0.1, 61)));
}

#[test]
fn nothing_makes_a_valid_tree() {
    let geometry = Geometry::new(Vec::new(), &[]);
    assert_valid("empty", &geometry);
    let ray = Ray::new(DVec3::ZERO, DVec3::X);
    assert_eq!(native(&geometry).intersect(&ray), None);
    assert!(triangle_blocks(&MeshSpace::new(Vec::new()), BvhQuality::Default).is_empty());
}

#[test]
fn few_triangles_make_a_valid_tree() {
    for count in 1..40 {
        assert_valid(&format!("{count} triangles"), &of_mesh(meshes::soup(count, 0.5, 62)));
    }
}

#[test]
fn equal_triangles_are_halved_until_they_fit() {
    let mut mesh = meshes::soup(1, 0.5, 63);
    mesh.triangles = vec![[0, 1, 2]; 100_000];
    assert_valid("equal triangles", &of_mesh(mesh));
}

#[test]
fn triangles_that_split_badly_do_not_make_a_deep_tree() {
    // Each is half as far and half as large as the one before it: the best cut takes few off at a time.
    let mut mesh = MeshPart::default();
    for i in 0..2000u32 {
        let size = libm::exp2(-f64::from(i) / 16.0);
        let corner = DVec3::splat(size);
        mesh.positions.extend([corner, corner + DVec3::X * size, corner + DVec3::Y * size]);
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    assert_valid("geometric series", &of_mesh(mesh));
}

#[test]
fn huge_and_tiny_coordinates_make_a_valid_tree() {
    for exponent in [-300.0, -30.0, 30.0, 300.0] {
        let mut mesh = meshes::soup(500, 0.3, 64);
        mesh.positions.iter_mut().for_each(|p| *p *= libm::exp10(exponent));
        assert_valid(&format!("1e{exponent}"), &of_mesh(mesh));
    }
    let mut outlier = meshes::soup(500, 0.3, 65);
    outlier.positions[0] *= 1e12;
    assert_valid("outlier", &of_mesh(outlier));
}

#[test]
fn blocks_hold_every_triangle_once() {
    let geometry = of_mesh(meshes::terrain(30, 0.2, 66));
    let mut found: Vec<u32> = triangle_blocks(&geometry.spaces[0], BvhQuality::Default)
        .iter()
        .flat_map(|block| block.indices().collect::<Vec<_>>())
        .collect();
    found.sort_unstable();
    assert_eq!(found, (0..geometry.spaces[0].triangles.len() as u32).collect::<Vec<_>>());
}

#[test]
fn meshes_take_at_most_90_bytes_a_triangle() {
    for mesh in
        [meshes::sphere(1.0, 300, 0.1, 71), meshes::terrain(200, 0.2, 72), meshes::soup(50_000, 0.1, 73)]
    {
        let geometry = of_mesh(mesh);
        let bytes = native(&geometry).bytes() as f64 / geometry.spaces[0].triangles.len() as f64;
        assert!(bytes <= 90.0, "{bytes} bytes a triangle");
    }
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let mut mesh = meshes::sphere(1.0, 420, 0.2, 67);
    mesh.positions.iter_mut().step_by(97).for_each(|p| *p *= 1.5);
    let geometry = of_mesh(mesh);
    for quality in QUALITIES {
        let build = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| native_of(&geometry, quality))
        };
        assert!(build(1) == build(2), "{quality:?}");
    }
}

#[test]
fn every_quality_makes_a_valid_tree() {
    for quality in QUALITIES {
        for kind in KINDS {
            let geometry = scene(kind, DVec3::ZERO).geometry;
            assert_eq!(native_of(&geometry, quality).validate(), Ok(()), "{kind}, {quality:?}");
        }
        let large = of_mesh(meshes::sphere(1.0, 400, 0.1, 61));
        assert_eq!(native_of(&large, quality).validate(), Ok(()), "large sphere, {quality:?}");
    }
}

#[test]
fn triangles_in_pieces_take_at_most_90_bytes_a_triangle() {
    for mesh in [meshes::soup(50_000, 0.1, 73), meshes::soup(5000, 1.0, 74)] {
        let geometry = of_mesh(mesh);
        let bytes = native_of(&geometry, BvhQuality::Quality).bytes() as f64;
        assert!(bytes <= 90.0 * geometry.spaces[0].triangles.len() as f64, "{bytes} bytes");
    }
}

#[test]
fn pieces_are_cut_off_large_triangles() {
    let geometry = of_mesh(meshes::soup(1000, 1.0, 75));
    assert!(native_of(&geometry, BvhQuality::Quality).bytes() > native(&geometry).bytes());
}

#[test]
fn solids_alone_are_found() {
    let mixed = scene("mixed", DVec3::ZERO);
    let solids = TestScene::new("solids", mixed.geometry.solids.clone(), Vec::new(), DVec3::ZERO, 1.0);
    let brute = pathtracer::accel::brute_force::BruteForce::new(&solids.geometry);
    assert_identical("solids", &brute, &native(&solids.geometry), &rays(&solids, 20_000, 68));
}

#[test]
fn solids_left_by_a_ray_are_respected() {
    let scene = scene("mixed", DVec3::ZERO);
    let accelerator = native(&scene.geometry);
    let brute = pathtracer::accel::brute_force::BruteForce::new(&scene.geometry);
    let mut random = Random::new(69);
    let bounced: Vec<Ray> = rays(&scene, 20_000, 70)
        .into_iter()
        .filter_map(|ray| {
            let hit = brute.intersect(&ray)?;
            Some(scene.geometry.surface(&ray, &hit).leave(random.direction()))
        })
        .collect();
    assert!(bounced.len() > 5000);
    assert_identical("bounced rays", &brute, &accelerator, &bounced);
}

#[test]
fn an_instruction_set_that_the_machine_lacks_is_a_usage_error() {
    let geometry = Geometry::new(Vec::new(), &[]);
    let best = native(&geometry).isa();
    for isa in [Isa::Sse2, Isa::Avx2, Isa::Avx512] {
        let built = Bvh::build(
            &geometry,
            &BuildOptions { precision: Precision::Exact, isa: Some(isa), ..Default::default() },
        );
        assert_eq!(built.is_ok(), isa <= best);
        if let Err(error) = built {
            assert_eq!(error.exit_code(), 2);
        }
    }
}
