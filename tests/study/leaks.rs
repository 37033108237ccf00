//! The count of lost rays: none of a watertight accelerator, all that a hole lets through.

use pathtracer::accel::BuildOptions;
use pathtracer::accel::brute_force::BruteForce;
use pathtracer::accel::bvh::Bvh;
use pathtracer::geometry::{Geometry, MeshPart};
use pathtracer::study::leaks::{Aim, lost, rays};
use pathtracer::study::meshes::Family;

fn geometry(mesh: MeshPart) -> Geometry {
    Geometry::new(Vec::new(), &[mesh])
}

#[test]
fn the_exact_accelerator_loses_nothing() {
    for family in Family::ALL.into_iter().filter(|family| family.is_closed()) {
        let geometry = geometry(family.make(2000, 1));
        let bvh = Bvh::build(&geometry, &BuildOptions::default()).expect("a tree");
        for aim in Aim::INSIDE {
            let rays = rays(&geometry, aim, 5000, 2);
            assert_eq!((lost(&bvh, &rays), rays.len()), (0, 5000), "{} at {}", family.name(), aim.name());
        }
    }
}

#[test]
fn rays_along_the_axes_hit_the_cube() {
    let geometry = geometry(Family::Cube.make(1200, 1));
    let rays = rays(&geometry, Aim::Parallel, 2000, 3);
    assert_eq!(rays.len(), 2000);
    assert_eq!(lost(&BruteForce::new(&geometry), &rays), 0);
}

#[test]
fn a_missing_triangle_is_found() {
    let mut mesh = Family::Scan.make(200, 1);
    mesh.triangles.pop();
    let geometry = geometry(mesh);
    for aim in [Aim::Random, Aim::Edge] {
        let rays = rays(&geometry, aim, 20_000, 4);
        assert!(lost(&BruteForce::new(&geometry), &rays) > 0, "{}", aim.name());
    }
}
