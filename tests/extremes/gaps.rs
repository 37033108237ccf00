//! Surfaces that nearly touch: what lies in the gap, and what is beyond it.

use super::{accelerators, watertight_accelerators};
use crate::support::meshes;
use crate::support::random::Random;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{
    Ball, Cuboid, Geometry, MeshPart, PrimitiveId, Ray, Rectangle, Shape, Solid, SurfacePoint,
};
use pathtracer::math::{DMat3, DVec3};

/// Gaps of a few 1e-5 between bodies of size 1, and smaller ones.
const GAPS: [f64; 5] = [4e-5, 1e-5, 1e-7, 1e-9, 1e-12];

fn solid(object: u32, shape: Shape) -> Solid {
    Solid { object, shape }
}

/// Leaves `point` of object 0 along its normal and must arrive at object 1 after the gap.
fn assert_crosses(what: &str, accelerator: &impl Accelerator, point: &SurfacePoint, gap: f64, error: f64) {
    let ray = point.leave(point.normal);
    let hit = accelerator.intersect(&ray).unwrap_or_else(|| panic!("{what}: nothing behind a gap of {gap}"));
    assert_eq!(hit.object, 1, "{what}: gap {gap}");
    assert!((hit.t - gap).abs() <= error, "{what}: t {} across a gap of {gap}", hit.t);
}

#[test]
fn gaps_between_solids_are_crossed() {
    let mut random = Random::new(121);
    for gap in GAPS {
        for place in [0.0, 1.0, 1e3] {
            let n = random.direction();
            let here = random.direction() * place;
            let x = n.cross(random.direction()).normalize();
            let rotation = DMat3::from_cols(x, n.cross(x), n);
            let first = Shape::Ball(Ball { center: here - n, radius: 1.0 });
            let others = [
                Shape::Ball(Ball { center: here + n * (gap + 0.7), radius: 0.7 }),
                Shape::Cuboid(Cuboid { center: here + n * (gap + 0.5), half: DVec3::splat(0.5), rotation }),
                Shape::Rectangle(Rectangle::new(here + n * gap, x, n.cross(x))),
            ];
            // Positions are rounded a dozen times, by 2^-53 of their distance and size.
            let error = 24.0 * f64::EPSILON * (place + 2.0);
            if gap < 2.0 * error {
                continue;
            }
            for other in others {
                let geometry = Geometry::new(vec![solid(0, first), solid(1, other)], &[]);
                let point = geometry.solid_point(0, here - n, n, n);
                for accelerator in watertight_accelerators(&geometry) {
                    let what = format!("{other:?}, {}", accelerator.name);
                    assert_crosses(&what, &accelerator, &point, gap, error);
                }
            }
        }
    }
}

/// A mesh of radius `size` and a ball of radius 1 that hovers over the middle of one of its triangles.
fn mesh_and_ball(size: f64, gap: f64, random: &mut Random) -> (Geometry, SurfacePoint, SurfacePoint) {
    let mesh = MeshPart { object: 1, ..meshes::moved(meshes::sphere(size, 40, 0.02, 5), random.direction()) };
    // Where the triangle is once its corners are rounded, which the ball has no part in.
    let alone = Geometry::new(Vec::new(), std::slice::from_ref(&mesh));
    let index = random.index(alone.spaces[0].triangles.len()) as u32;
    let below = alone.triangle_point(PrimitiveId::triangle(0, index), 1.0 / 3.0, 1.0 / 3.0);
    let outward = if below.normal.dot(below.position) > 0.0 { below.normal } else { -below.normal };
    let center = below.position + outward * (gap + 1.0);
    let geometry = Geometry::new(vec![solid(0, Shape::Ball(Ball { center, radius: 1.0 }))], &[mesh]);
    let on_ball = geometry.solid_point(0, center, -outward, -outward);
    let below = geometry.triangle_point(PrimitiveId::triangle(0, index), 1.0 / 3.0, 1.0 / 3.0);
    (geometry, on_ball, below)
}

#[test]
fn gaps_between_a_ball_and_a_mesh_are_crossed_at_exact() {
    let mut random = Random::new(122);
    for size in [1.0, 1e2, 1e4] {
        for gap in GAPS {
            let error = 24.0 * f64::EPSILON * (4.0 * size + 2.0);
            if gap < 2.0 * error {
                continue;
            }
            for _ in 0..100 {
                let (geometry, on_ball, below) = mesh_and_ball(size, gap, &mut random);
                for accelerator in accelerators(&geometry, Precision::Exact) {
                    assert_crosses(&accelerator.name, &accelerator, &on_ball, gap, error);
                    let up = below.leave(-on_ball.normal);
                    let hit = accelerator.intersect(&up).expect("the ball is above");
                    assert_eq!(hit.object, 0, "{} size {size} gap {gap}", accelerator.name);
                    assert!((hit.t - gap).abs() <= error, "{} size {size} gap {gap}", accelerator.name);
                }
            }
        }
    }
}

/// Embree decides in f32 at robust: gaps above a few 2^-22 of the mesh's size are seen.
#[test]
fn gaps_above_the_steps_of_f32_are_crossed_at_robust() {
    let mut random = Random::new(123);
    for gap in [4e-5, 1e-5] {
        for _ in 0..200 {
            let (geometry, on_ball, _) = mesh_and_ball(1.0, gap, &mut random);
            for accelerator in accelerators(&geometry, Precision::Robust) {
                assert_crosses(&accelerator.name, &accelerator, &on_ball, gap, 24.0 * f64::EPSILON * 6.0);
            }
        }
    }
}

/// Camera rays at the thin slit between two balls: what is behind it is seen through it.
#[test]
fn a_slit_of_4e_5_between_two_balls_is_seen_through() {
    let gap = 4e-5;
    let centers = [DVec3::new(0.0, -1.0 - 0.5 * gap, 0.0), DVec3::new(0.0, 1.0 + 0.5 * gap, 0.0)];
    let mut solids: Vec<Solid> = centers
        .iter()
        .zip(0..)
        .map(|(&center, object)| solid(object, Shape::Ball(Ball { center, radius: 1.0 })))
        .collect();
    solids.push(solid(2, Shape::Rectangle(Rectangle::new(DVec3::X * 5.0, DVec3::NEG_Y, DVec3::Z))));
    let geometry = Geometry::new(solids, &[]);
    for accelerator in watertight_accelerators(&geometry) {
        for i in 0..1000 {
            let y = gap * (f64::from(i) / 999.0 - 0.5) * 1.2;
            for distance in [2.0, 10.0, 1000.0] {
                let hit = accelerator.intersect(&Ray::new(DVec3::new(-distance, y, 0.0), DVec3::X));
                let beyond = hit.is_some_and(|hit| hit.object == 2);
                // At the slit's very edge the rounding of a distance of 1000 decides.
                if (y.abs() - 0.5 * gap).abs() > 1e-12 {
                    assert_eq!(beyond, y.abs() < 0.5 * gap, "{} {y} from {distance}", accelerator.name);
                }
            }
        }
    }
}
