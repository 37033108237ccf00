//! A floor of two triangles, a million times larger than the height of the eye.

use super::{accelerators, watertight_accelerators};
use crate::support::double_double::DoubleDouble;
use crate::support::random::Random;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{Geometry, MeshPart, Ray, Rectangle, Shape, Solid};
use pathtracer::math::DVec3;

const HALF: f64 = 1e6;

fn floor_of_triangles() -> Geometry {
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let positions = vec![corner(-HALF, -HALF), corner(HALF, -HALF), corner(HALF, HALF), corner(-HALF, HALF)];
    Geometry::new(Vec::new(), &[MeshPart { object: 0, positions, triangles: vec![[0, 1, 2], [0, 2, 3]] }])
}

fn floor_of_a_rectangle() -> Geometry {
    let shape = Shape::Rectangle(Rectangle::new(DVec3::ZERO, DVec3::X * HALF, DVec3::Y * HALF));
    Geometry::new(vec![Solid { object: 0, shape }], &[])
}

/// From a height of 1 to every distance from 1e-3 to the edge.
fn oblique_rays(count: usize, random: &mut Random) -> Vec<Ray> {
    let ray = |_| {
        let origin = DVec3::new(random.between(-100.0, 100.0), random.between(-100.0, 100.0), 1.0);
        let distance = libm::pow(10.0, random.between(-3.0, 5.99));
        let (sin, cos) = libm::sincos(random.between(0.0, std::f64::consts::TAU));
        let to = DVec3::new(cos * distance, sin * distance, -1.0);
        Ray::new(origin, to.normalize())
    };
    (0..count).map(ray).collect()
}

#[test]
fn distances_to_a_big_floor_are_exact_to_f32() {
    let mut random = Random::new(101);
    let rays = oblique_rays(100_000, &mut random);
    for geometry in [floor_of_triangles(), floor_of_a_rectangle()] {
        for accelerator in watertight_accelerators(&geometry) {
            for ray in &rays {
                let hit = accelerator.intersect(ray).expect("the floor is there");
                let t = (-DoubleDouble::from(ray.origin.z) / DoubleDouble::from(ray.direction.z)).to_f64();
                let error = (hit.t / t - 1.0).abs();
                assert!(error < f64::from(f32::EPSILON), "{}: {error:e} {ray:?}", accelerator.name);
            }
        }
    }
}

/// Tilted, the corners are no round numbers in any space: what counts is the distance to the plane that f32 left.
#[test]
fn distances_to_a_tilted_big_floor_are_exact_to_f32() {
    let mut random = Random::new(102);
    for _ in 0..20 {
        let u = random.direction();
        let v = u.cross(random.direction()).normalize();
        let positions =
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| (u * x + v * y) * HALF);
        let mesh =
            MeshPart { object: 0, positions: positions.to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]] };
        let geometry = Geometry::new(Vec::new(), &[mesh]);
        for accelerator in accelerators(&geometry, Precision::Exact) {
            for ray in oblique_rays(2000, &mut random) {
                // The same ray in the floor's own frame: z up becomes the normal.
                let turn = |p: DVec3| u * p.x + v * p.y + u.cross(v) * p.z;
                let ray = Ray::new(turn(ray.origin), turn(ray.direction).normalize());
                let Some(hit) = accelerator.intersect(&ray) else {
                    panic!("{}: the floor is missed by {ray:?}", accelerator.name);
                };
                let triangle = hit.primitive.as_triangle().expect("a triangle");
                let t = plane_distance(&geometry, triangle, &ray);
                // The eye's height of 1 is 2^-20 of the floor, and 2^-53 of the floor is 2^-33 of the height.
                let error = (hit.t / t - 1.0).abs();
                assert!(error < f64::from(f32::EPSILON), "{}: {error:e} {ray:?}", accelerator.name);
            }
        }
    }
}

/// Distance along a ray to the plane of a triangle, in double-double.
fn plane_distance(geometry: &Geometry, triangle: u32, ray: &Ray) -> f64 {
    let dd = |p: DVec3| p.to_array().map(DoubleDouble::from);
    let frame = &geometry.spaces[0].frame;
    let [a, b, c] = geometry.spaces[0].corners(triangle).map(dd);
    let sub = |p: [DoubleDouble; 3], q: [DoubleDouble; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
    let dot = |p: [DoubleDouble; 3], q: [DoubleDouble; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let (e, f) = (sub(b, a), sub(c, a));
    let normal = [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
    // Powers of two scale exactly.
    let origin = sub(dd(ray.origin * frame.scale), dd(frame.pivot * frame.scale));
    (dot(sub(a, origin), normal) / dot(dd(ray.direction), normal)).to_f64() / frame.scale
}
