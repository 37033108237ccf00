//! Balls that are small, far away, or both.

use super::{Named, accelerators};
use crate::support::double_double::DoubleDouble;
use crate::support::random::Random;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{Ball, Geometry, Hit, Ray, Shape, Solid};
use pathtracer::math::DVec3;

fn one(center: DVec3, radius: f64) -> Geometry {
    Geometry::new(vec![Solid { object: 0, shape: Shape::Ball(Ball { center, radius }) }], &[])
}

/// The hit on which all accelerators agree.
fn hit(accelerators: &[Named<'_>], ray: &Ray) -> Option<Hit> {
    let hits: Vec<Option<Hit>> = accelerators.iter().map(|accelerator| accelerator.intersect(ray)).collect();
    assert!(hits.iter().all(|hit| *hit == hits[0]), "{hits:?}");
    hits[0]
}

/// Parallel rays at a ball of radius 1 at a distance: hits and misses as they should be up to 1e-15 of the distance
/// from its outline, and the place on the ball right to as much.
#[test]
fn parallel_rays_meet_a_ball_where_they_should_from_afar() {
    let mut random = Random::new(111);
    for distance in [1e2, 2e3, 4.1e3, 8e3, 1e5, 1e6, 1e7, 1e9] {
        let geometry = one(DVec3::ZERO, 1.0);
        let accelerators = accelerators(&geometry, Precision::Exact);
        for _ in 0..20_000 {
            let (across, up) = (random.between(-1.2, 1.2), random.between(-1.2, 1.2));
            let ray = Ray::new(DVec3::new(-distance, across, up), DVec3::X);
            let [y, z] = [across, up].map(DoubleDouble::from);
            let inside = (DoubleDouble::from(1.0) - y * y - z * z).to_f64();
            let doubt = 1e-15 * distance;
            let found = hit(&accelerators, &ray);
            if inside.abs() > doubt {
                assert_eq!(found.is_some(), inside > 0.0, "{distance}: {across} {up}");
            }
            if let Some(found) = found
                && inside > doubt
            {
                // The root of `inside` is as wrong as its argument over itself.
                let error = (found.t - distance + inside.sqrt()).abs();
                assert!(error <= doubt * (1.0 + 1.0 / inside.sqrt()), "{distance}: {across} {up} {error:e}");
            }
        }
    }
}

/// A case of another renderer's suite: a small sphere, just inside its outline, from 1e7 away.
#[test]
fn a_ball_of_radius_a_tenth_is_hit_near_its_outline_from_1e7() {
    let geometry = one(DVec3::ZERO, 0.1);
    let accelerators = accelerators(&geometry, Precision::Exact);
    assert!(hit(&accelerators, &Ray::new(DVec3::new(-1e7, 0.095, 0.0), DVec3::X)).is_some());
    assert!(hit(&accelerators, &Ray::new(DVec3::new(-1e7, 0.105, 0.0), DVec3::X)).is_none());
}

/// Balls of radius 1e-6 on a grid of 1e-5, many enough for a tree, seen from 1 to 1e6: each in its place.
#[test]
fn tiny_balls_in_a_tree_are_hit_one_by_one_from_afar() {
    let place = |i: u32| DVec3::new(0.0, f64::from(i % 30), f64::from(i / 30)) * 1e-5;
    let ball = |object| Solid { object, shape: Shape::Ball(Ball { center: place(object), radius: 1e-6 }) };
    let geometry = Geometry::new((0..900).map(ball).collect(), &[]);
    let accelerators = accelerators(&geometry, Precision::Exact);
    let mut random = Random::new(112);
    for distance in [1.0, 1e2, 1e4, 1e6] {
        for object in 0..900 {
            let ray = Ray::new(place(object) - DVec3::X * distance, DVec3::X);
            assert_eq!(hit(&accelerators, &ray).map(|hit| hit.object), Some(object), "from {distance}");
            let beside = ray.origin + DVec3::new(0.0, 3e-6, random.between(-2e-6, 2e-6));
            assert_eq!(hit(&accelerators, &Ray::new(beside, DVec3::X)), None, "from {distance}");
        }
    }
}

/// Sizes from 2^-30 to 2^30 in one scene: every ball in front of the next larger one.
#[test]
fn balls_of_all_sizes_stand_in_line() {
    let ball = |object: u32| {
        let radius = libm::ldexp(1.0, 2 * object as i32 - 30);
        let center = DVec3::new(4.0 * radius, 0.0, 0.0);
        Solid { object, shape: Shape::Ball(Ball { center, radius }) }
    };
    // Each spans from 3 to 5 radii, the next one from 12: none touches another.
    let geometry = Geometry::new((0..31).map(ball).collect(), &[]);
    let accelerators = accelerators(&geometry, Precision::Exact);
    for object in 0..31 {
        let radius = libm::ldexp(1.0, 2 * object as i32 - 30);
        let ray = Ray::new(DVec3::new(2.5 * radius, 0.0, 0.0), DVec3::X);
        let found = hit(&accelerators, &ray).expect("a ball is before it");
        assert_eq!(found.object, object);
        assert!((found.t / (0.5 * radius) - 1.0).abs() < 1e-14, "{object}: {}", found.t);
    }
}
