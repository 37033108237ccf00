//! Legal rays that are unusual, and rays that are none: all accelerators agree with brute force and none crashes.

use super::accelerators;
use crate::support::compare::assert_identical;
use crate::support::random::Random;
use crate::support::scenes::{KINDS, TestScene, scene};
use pathtracer::accel::brute_force::BruteForce;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{PrimitiveId, Ray, Shape};
use pathtracer::math::DVec3;

/// Rays of each kind by default, and in the long run.
const COUNT: usize = 20_000;
const ALL: usize = 100_000;

/// A place in or on the scene: a corner, on an edge or on a face of a mesh, a corner or a face of a box, the outline of
/// a rectangle, the surface of a ball, the origin of an instance.
fn place(scene: &TestScene, random: &mut Random) -> DVec3 {
    let part = &scene.parts[random.index(scene.parts.len())];
    let [a, b, c] =
        part.triangles[random.index(part.triangles.len())].map(|corner| part.positions[corner as usize]);
    let (u, v) = (random.unit(), random.unit());
    let solids = &scene.geometry.solids;
    match random.index(if solids.is_empty() { 3 } else { 5 }) {
        0 => a,
        1 => a.lerp(b, u),
        2 => a + (b - a) * (u * (1.0 - v)) + (c - a) * (u * v),
        _ => match solids[random.index(solids.len())].shape {
            Shape::Ball(ball) => ball.center + random.direction() * ball.radius,
            Shape::Rectangle(rectangle) => rectangle.center + rectangle.offset_at(u.round(), v),
            Shape::Cuboid(cuboid) => {
                let mut p = random.in_cube();
                p[random.index(3)] = 1.0;
                let p = if u < 0.5 { p.signum() } else { p };
                cuboid.center + cuboid.rotation * (p * cuboid.half)
            }
            Shape::Instance(instance) => instance.position,
        },
    }
}

/// Directions with each component chosen among `components`.
fn of_components(components: &[f64], random: &mut Random) -> DVec3 {
    let mut pick = || components[random.index(components.len())];
    DVec3::new(pick(), pick(), pick())
}

fn assert_odd(scene: &TestScene, what: &str, count: usize, direction: impl Fn(&mut Random) -> DVec3) {
    let what = format!("{}, {what}", scene.name);
    let mut random = Random::new(141);
    let rays: Vec<Ray> = (0..count)
        .map(|i| {
            let at = place(scene, &mut random);
            let direction = direction(&mut random);
            // On the surface, and on the way to it.
            let back = if i % 2 == 0 { DVec3::ZERO } else { direction.normalize_or_zero() };
            Ray::new(at - back, direction)
        })
        .collect();
    let oracle = BruteForce::new(&scene.geometry);
    for accelerator in accelerators(&scene.geometry, Precision::Exact) {
        assert_identical(&format!("{what}, {}", accelerator.name), &oracle, &accelerator, &rays);
    }
    // The others only have to give an answer.
    for precision in [Precision::Robust, Precision::Fast] {
        for accelerator in accelerators(&scene.geometry, precision) {
            for ray in &rays {
                if let Some(hit) = accelerator.intersect(ray) {
                    assert!(hit.t > 0.0 && hit.t.is_finite(), "{what}, {}: {hit:?}", accelerator.name);
                }
                accelerator.occluded(ray, f64::INFINITY, PrimitiveId::NONE);
            }
        }
    }
}

fn all_kinds(scene: &TestScene, count: usize) {
    let odd = |what: &str, components: &[f64]| {
        assert_odd(scene, what, count, |random| of_components(components, random));
    };
    odd("zeros", &[0.0, -0.0, 1.0, -1.0]);
    odd("1e-30", &[1e-30, -1e-30, 1.0, -0.5, 0.0]);
    odd("1e30", &[1e30, -1e30, 1.0, 1e-30]);
    let any_length = |random: &mut Random| random.direction() * libm::exp2(random.between(-60.0, 60.0));
    assert_odd(scene, "not unit", count, any_length);
    assert_odd(scene, "ordinary", count, Random::direction);
}

#[test]
fn unusual_rays_get_the_hits_of_brute_force() {
    all_kinds(&scene("mixed", DVec3::ZERO), COUNT);
    for kind in KINDS {
        all_kinds(&scene(kind, DVec3::ZERO), COUNT / 20);
    }
}

#[test]
#[ignore = "long: 100,000 rays of each kind in each scene by brute force; run by `cargo test --release -- --ignored`"]
fn a_hundred_thousand_unusual_rays_of_each_kind_get_the_hits_of_brute_force() {
    for kind in KINDS {
        all_kinds(&scene(kind, DVec3::ZERO), ALL);
    }
}

#[test]
fn rays_that_are_not_finite_hit_nothing() {
    let scene = scene("mixed", DVec3::ZERO);
    let mut random = Random::new(142);
    for precision in [Precision::Exact, Precision::Robust, Precision::Fast] {
        for accelerator in accelerators(&scene.geometry, precision) {
            for _ in 0..ALL {
                let mut numbers = [0.0; 6].map(|_: f64| random.between(-2.0, 2.0));
                let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][random.index(3)];
                numbers[random.index(6)] = bad;
                let ray = Ray::new(DVec3::from_slice(&numbers[..3]), DVec3::from_slice(&numbers[3..]));
                assert_eq!(accelerator.intersect(&ray), None);
                assert!(!accelerator.occluded(&ray, f64::INFINITY, PrimitiveId::NONE));
            }
        }
    }
}
