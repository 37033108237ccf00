//! Long thin triangles, seen at a glance.

use super::watertight_accelerators;
use crate::support::random::Random;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{Geometry, MeshPart, Ray};
use pathtracer::math::DVec3;

/// A closed prism over a triangle of side `width`, along `along`.
fn needle(start: DVec3, along: DVec3, width: f64) -> MeshPart {
    let x = along.any_orthonormal_vector_of();
    let y = along.cross(x).normalize();
    let corner = |i: u32| {
        let (s, c) = libm::sincos(std::f64::consts::TAU * f64::from(i) / 3.0);
        (x * c + y * s) * width
    };
    let mut positions: Vec<DVec3> = (0..3).map(|i| start + corner(i)).collect();
    positions.extend((0..3).map(|i| start + along + corner(i)));
    let mut triangles = vec![[0, 2, 1], [3, 4, 5]];
    for i in 0..3 {
        let j = (i + 1) % 3;
        triangles.extend([[i, j, j + 3], [i, j + 3, i + 3]]);
    }
    MeshPart { object: 0, positions, triangles }
}

/// A unit vector at right angles to this one, which need not be of length 1.
trait Across {
    fn any_orthonormal_vector_of(self) -> DVec3;
}

impl Across for DVec3 {
    fn any_orthonormal_vector_of(self) -> DVec3 {
        let least = self.abs().min_element();
        let axis = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().find(|a| self.dot(*a).abs() == least);
        self.cross(axis.unwrap_or(DVec3::X)).normalize()
    }
}

/// Embree issue 387: a skinny triangle within 600 of the ray, at 0.52 degrees, was reported at t = 12291.
#[test]
fn distances_to_slivers_lie_between_those_of_their_corners() {
    let mut random = Random::new(131);
    let mut hits = 0;
    for _ in 0..300 {
        let along = random.direction() * random.between(100.0, 600.0);
        let width = libm::pow(10.0, random.between(-4.0, -1.0));
        let mesh = needle(random.in_cube(), along, width);
        let geometry = Geometry::new(Vec::new(), std::slice::from_ref(&mesh));
        for accelerator in watertight_accelerators(&geometry) {
            for _ in 0..200 {
                let target = mesh.positions[0] + along * random.unit();
                let glance =
                    along.normalize() + random.direction() * libm::pow(10.0, random.between(-5.0, -1.0));
                let direction = glance.normalize();
                let ray = Ray::new(target - direction * random.between(1.0, 600.0), direction);
                let Some(hit) = accelerator.intersect(&ray) else { continue };
                hits += 1;
                let depths = mesh.positions.iter().map(|&p| (p - ray.origin).dot(ray.direction));
                let (low, high) =
                    depths.fold((f64::INFINITY, 0f64), |(low, high), d| (low.min(d), high.max(d)));
                // The corners are rounded to f32 of the mesh's size, 2^-24 of up to 1200.
                let step = 1200.0 / 16_777_216.0;
                assert!(hit.t >= low - step && hit.t <= high + step, "{} {hit:?} {ray:?}", accelerator.name);
            }
        }
    }
    assert!(hits > 10_000, "only {hits} hits");
}

#[test]
fn no_ray_gets_out_of_a_needle() {
    let mut random = Random::new(132);
    for _ in 0..300 {
        let along = random.direction() * random.between(100.0, 600.0);
        let mesh = needle(random.in_cube(), along, libm::pow(10.0, random.between(-2.0, 0.0)));
        let geometry = Geometry::new(Vec::new(), std::slice::from_ref(&mesh));
        let middle = mesh.positions.iter().sum::<DVec3>() / 6.0;
        for accelerator in super::accelerators(&geometry, Precision::Exact) {
            for i in 0..300 {
                let origin = middle + along * random.between(-0.4, 0.4);
                let target = match i % 3 {
                    0 => mesh.positions[random.index(6)],
                    1 => mesh.positions[0].lerp(mesh.positions[3], random.unit()),
                    _ => origin + random.direction(),
                };
                let ray = Ray::new(origin, (target - origin).normalize());
                assert!(accelerator.intersect(&ray).is_some(), "{} {ray:?}", accelerator.name);
            }
        }
    }
}
