//! A ray that leaves a surface does not meet it again, at sizes and places of 1e-8 to 1e8 (as pbrt's tests of this name,
//! which ask it of an accelerator that knows nothing of the primitive that was left).

use super::accelerators;
use crate::support::random::Random;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{
    Ball, Cuboid, Geometry, Hit, MeshPart, PrimitiveId, Ray, Rectangle, Shape, Solid,
};
use pathtracer::math::{DMat3, DVec3};
use std::collections::BTreeMap;

/// Shapes of each kind; 1000 are asked for, and a tenth is run by default.
const SHAPES: u64 = 100;
const ALL_SHAPES: u64 = 1000;
const RAYS: usize = 1000;

/// 10^U(-8, 8).
fn magnitude(random: &mut Random) -> f64 {
    libm::pow(10.0, random.between(-8.0, 8.0))
}

fn coordinate(random: &mut Random) -> f64 {
    magnitude(random) * if random.unit() < 0.5 { 1.0 } else { -1.0 }
}

fn point(random: &mut Random) -> DVec3 {
    DVec3::new(coordinate(random), coordinate(random), coordinate(random))
}

fn rotation(random: &mut Random) -> DMat3 {
    let x = random.direction();
    let y = x.cross(random.direction()).normalize();
    DMat3::from_cols(x, y, x.cross(y))
}

fn solid(shape: Shape) -> Geometry {
    Geometry::new(vec![Solid { object: 0, shape }], &[])
}

fn triangle(random: &mut Random) -> Geometry {
    let positions = (0..3).map(|_| point(random)).collect();
    Geometry::new(Vec::new(), &[MeshPart { object: 0, positions, triangles: vec![[0, 1, 2]] }])
}

fn any_ball(random: &mut Random) -> Geometry {
    solid(Shape::Ball(Ball { center: point(random), radius: magnitude(random) }))
}

fn any_box(random: &mut Random) -> Geometry {
    let half = DVec3::new(magnitude(random), magnitude(random), magnitude(random));
    solid(Shape::Cuboid(Cuboid { center: point(random), half, rotation: rotation(random) }))
}

fn any_rectangle(random: &mut Random) -> Geometry {
    let r = rotation(random);
    let (u, v) = (r.x_axis * magnitude(random), r.y_axis * magnitude(random));
    solid(Shape::Rectangle(Rectangle::new(point(random), u, v)))
}

/// A place inside the shape's outline, to aim at.
fn aim(geometry: &Geometry, random: &mut Random) -> DVec3 {
    match geometry.solids.first().map(|solid| solid.shape) {
        None => {
            let [a, b, c] = geometry.spaces[0].corners(0).map(|p| geometry.spaces[0].frame.to_world(p));
            let (mut u, mut v) = (random.unit(), random.unit());
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            a + (b - a) * u + (c - a) * v
        }
        Some(Shape::Ball(ball)) => ball.center + random.in_cube() * (0.5 * ball.radius),
        Some(Shape::Cuboid(cuboid)) => cuboid.center + cuboid.rotation * (random.in_cube() * cuboid.half),
        Some(Shape::Rectangle(rectangle)) => {
            rectangle.center + rectangle.offset_at(random.unit(), random.unit())
        }
        Some(Shape::Instance(_)) => unreachable!("not made"),
    }
}

fn extent(geometry: &Geometry) -> f64 {
    match geometry.solids.first() {
        None => 2.0 / geometry.spaces[0].frame.scale,
        Some(_) => (geometry.solid_bounds(0).max - geometry.solid_bounds(0).min).length(),
    }
}

/// A hit of the only shape, from outside.
fn arrive(geometry: &Geometry, accelerator: &impl Accelerator, random: &mut Random) -> Option<(Ray, Hit)> {
    (0..100).find_map(|_| {
        let target = aim(geometry, random);
        let origin = target + random.direction() * (extent(geometry) * random.between(1.0, 10.0));
        let ray = Ray::new(origin, (target - origin).normalize());
        accelerator.intersect(&ray).map(|hit| (ray, hit))
    })
}

/// No hit of the shape that a ray leaves, neither left out by its name nor, to the outside, kept off by the offset alone.
fn assert_left(what: &str, accelerator: &impl Accelerator, next: Ray) {
    for ray in [next, Ray { leaving: PrimitiveId::NONE, ..next }] {
        assert_eq!(accelerator.intersect(&ray), None, "{what}: {ray:?}");
        assert!(!accelerator.occluded(&ray, f64::INFINITY, PrimitiveId::NONE), "{what}: {ray:?}");
    }
}

/// A shape may be thinner than the last digit of its place, so that nothing arrives at it: so many are drawn for each that
/// is wanted, at most.
const DRAWN: u64 = 3;

/// Draws shapes until rays have arrived at so many with each accelerator.
fn assert_no_self_hits(kind: &str, make: impl Fn(&mut Random) -> Geometry, shapes: u64) {
    let mut arrivals = BTreeMap::new();
    let mut drawn = 0;
    while drawn == 0 || arrivals.values().any(|&count| count < shapes) {
        let seed = drawn;
        drawn += 1;
        assert!(drawn <= DRAWN * shapes, "{kind}: rays arrived at {arrivals:?} of {drawn} shapes");
        let mut random = Random::new(8100 + seed);
        let geometry = make(&mut random);
        for accelerator in accelerators(&geometry, Precision::Exact) {
            let count = arrivals.entry(accelerator.name.clone()).or_insert(0);
            let Some((ray, hit)) = arrive(&geometry, &accelerator, &mut random) else { continue };
            *count += 1;
            let point = geometry.surface(&ray, &hit);
            let side = if ray.direction.dot(point.normal) < 0.0 { point.normal } else { -point.normal };
            for _ in 0..RAYS {
                let direction = random.direction();
                let direction = if direction.dot(side) < 0.0 { -direction } else { direction };
                assert_left(
                    &format!("{kind} {seed}, {}", accelerator.name),
                    &accelerator,
                    point.leave(direction),
                );
            }
        }
    }
}

fn all_kinds(shapes: u64) {
    assert_no_self_hits("triangle", triangle, shapes);
    assert_no_self_hits("ball", any_ball, shapes);
    assert_no_self_hits("box", any_box, shapes);
    assert_no_self_hits("rectangle", any_rectangle, shapes);
}

#[test]
fn rays_that_leave_a_shape_do_not_meet_it_again() {
    all_kinds(SHAPES);
}

#[test]
#[ignore = "long: 16 million rays; run by `cargo test --release -- --ignored`"]
fn rays_that_leave_any_of_1000_shapes_do_not_meet_it_again() {
    all_kinds(ALL_SHAPES);
}

/// Ten thousand position errors: what is smaller is reported by the guards.
const SIGNIFICANT: f64 = 1e4;

/// Points of the surface where the near side could be missed: anywhere and, of a box, at its edges and corners.
fn inward_start(shape: &Shape, random: &mut Random) -> (DVec3, DVec3) {
    match shape {
        Shape::Ball(ball) => {
            let normal = random.direction();
            (normal * ball.radius, normal)
        }
        Shape::Cuboid(cuboid) => {
            let face = random.index(6);
            let mut p = random.in_cube();
            p[face / 2] = if face.is_multiple_of(2) { -1.0 } else { 1.0 };
            if random.unit() < 0.5 {
                let along = random.index(3);
                p = DVec3::select(DVec3::splat(along as f64).cmpeq(DVec3::new(0.0, 1.0, 2.0)), p, p.signum());
            }
            (cuboid.rotation * (p * cuboid.half), cuboid.face_normal(face as u32))
        }
        Shape::Rectangle(_) | Shape::Instance(_) => unreachable!("no inside"),
    }
}

fn assert_far_side_is_met(shapes: u64) {
    let makers: [fn(&mut Random) -> Geometry; 2] = [any_ball, any_box];
    let (mut tried, mut seed) = (0, 0);
    while tried < RAYS * shapes as usize {
        assert!(seed < DRAWN * shapes, "only {tried} rays tried at {seed} shapes");
        let mut random = Random::new(8200 + seed);
        let geometry = makers[seed as usize % 2](&mut random);
        let shape = geometry.solids[0].shape;
        let (center, size) = match shape {
            Shape::Ball(ball) => (ball.center, ball.radius),
            Shape::Cuboid(cuboid) => (cuboid.center, cuboid.half.min_element()),
            Shape::Rectangle(_) | Shape::Instance(_) => unreachable!("not made"),
        };
        let starts = (0..RAYS).map(|_| inward_start(&shape, &mut random)).collect::<Vec<_>>();
        let points = starts.iter().map(|&(offset, normal)| geometry.solid_point(0, center, offset, normal));
        let points: Vec<_> = points.filter(|point| point.error.max_element() * SIGNIFICANT <= size).collect();
        tried += points.len();
        for accelerator in accelerators(&geometry, Precision::Exact) {
            for point in &points {
                let direction = random.direction();
                let direction = if direction.dot(point.normal) > 0.0 { -direction } else { direction };
                let next = point.leave(direction);
                let again = accelerator.intersect(&next);
                assert!(again.is_some(), "{} {seed}: {next:?} leaves {shape:?}", accelerator.name);
            }
        }
        seed += 1;
    }
}

#[test]
fn rays_into_a_body_meet_its_far_side() {
    assert_far_side_is_met(2 * SHAPES);
}

#[test]
#[ignore = "long: 2 million rays; run by `cargo test --release -- --ignored`"]
fn rays_into_any_of_2000_bodies_meet_their_far_side() {
    assert_far_side_is_met(2 * ALL_SHAPES);
}

/// An octahedron: every edge is sharp, so that a ray that leaves one face outward has nothing before it.
fn octahedron(center: DVec3, size: f64) -> MeshPart {
    let tips = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let positions = tips.iter().map(|&tip| center + tip * size).collect();
    let face = |i: usize| {
        let [x, y, z] = [(i & 1) as u32, 2 + (i >> 1 & 1) as u32, 4 + (i >> 2 & 1) as u32];
        if (i & 1) ^ (i >> 1 & 1) ^ (i >> 2 & 1) == 0 { [x, y, z] } else { [x, z, y] }
    };
    MeshPart { object: 0, positions, triangles: (0..8).map(face).collect() }
}

fn assert_no_neighbour_is_met(shapes: u64) {
    let mut random = Random::new(83);
    for _ in 0..shapes {
        let size = magnitude(&mut random);
        // So far away that six digits of the size are left.
        let center = random.direction() * size * libm::pow(10.0, random.between(-3.0, 9.0));
        let geometry = Geometry::new(Vec::new(), &[octahedron(center, size)]);
        for accelerator in accelerators(&geometry, Precision::Exact) {
            for _ in 0..RAYS {
                // On an edge, or a corner, or within 1e-16 to 1 of them.
                let near = |random: &mut Random| libm::pow(10.0, random.between(-16.0, 0.0));
                let (u, v) = match random.index(4) {
                    0 => (0.0, random.unit()),
                    1 => (0.0, 0.0),
                    2 => (near(&mut random) * 0.5, random.unit() * 0.5),
                    _ => (near(&mut random) * 0.5, near(&mut random) * 0.5),
                };
                let point = geometry.triangle_point(PrimitiveId::triangle(0, random.index(8) as u32), u, v);
                let direction = random.direction();
                let direction = if direction.dot(point.normal) < 0.0 { -direction } else { direction };
                let next = point.leave(direction);
                assert_eq!(accelerator.intersect(&next), None, "{} {size} {next:?}", accelerator.name);
            }
        }
    }
}

#[test]
fn rays_that_leave_a_convex_mesh_beside_its_edges_meet_no_neighbour() {
    assert_no_neighbour_is_met(SHAPES);
}

#[test]
#[ignore = "long: a million rays; run by `cargo test --release -- --ignored`"]
fn rays_that_leave_any_of_1000_convex_meshes_meet_no_neighbour() {
    assert_no_neighbour_is_met(ALL_SHAPES);
}
