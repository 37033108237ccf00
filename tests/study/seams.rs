//! Rays that must hit the meshes of a scene.

use crate::support::build::{diffuse, grey, mesh, scene};
use crate::support::meshes;
use pathtracer::accel::brute_force::BruteForce;
use pathtracer::math::DVec3;
use pathtracer::study::leaks::Aim;
use pathtracer::study::seams::{lost, rays};
use pathtracer::world::World;

fn world(positions: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> World {
    let body = (mesh(positions, triangles), diffuse(grey(0.5)));
    World::compile(&scene(DVec3::new(-4.0, 0.0, 0.0), DVec3::ZERO, vec![body])).expect("a valid scene")
}

#[test]
fn brute_force_loses_none() {
    let part = meshes::sphere(1.0, 8, 0.1, 5);
    let world = world(part.positions.iter().map(DVec3::to_array).collect(), part.triangles);
    let brute_force = BruteForce::new(&world.geometry);
    for aim in Aim::INSIDE {
        let rays = rays(&world.geometry, aim, 2000, 7);
        assert_eq!(rays.len(), 2000, "{aim:?}");
        assert_eq!(lost(&brute_force, &rays), 0, "{aim:?}");
    }
}

#[test]
fn open_borders_are_no_seams() {
    let corners = vec![[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, 0.0, 1.0]];
    let world = world(corners, vec![[0, 1, 2], [0, 2, 3]]);
    assert!(rays(&world.geometry, Aim::Vertex, 100, 1).is_empty());
    // Only the diagonal is shared.
    let edges = rays(&world.geometry, Aim::Edge, 100, 1);
    let middle = DVec3::new(0.0, 0.5, 0.5) - world.origin;
    assert!(!edges.is_empty());
    for sure in &edges {
        let to = middle - sure.ray.origin;
        // Roundings of f32 corners and of a unit direction.
        assert!(to.cross(sure.ray.direction).length() < 1e-6, "{sure:?}");
    }
    assert!(!rays(&world.geometry, Aim::Random, 100, 1).is_empty());
}

#[test]
fn what_is_behind_does_not_count_as_a_hit() {
    let part = meshes::sphere(1.0, 8, 0.1, 5);
    let world = world(part.positions.iter().map(DVec3::to_array).collect(), part.triangles);
    let mut rays = rays(&world.geometry, Aim::Edge, 100, 7);
    rays.iter_mut().for_each(|sure| sure.reach = 0.0);
    assert_eq!(lost(&BruteForce::new(&world.geometry), &rays), 100);
}
