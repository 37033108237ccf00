//! Triangles that are hard for trees of boxes.

use crate::geometry::MeshPart;
use crate::math::DVec3;
use crate::study::random::Random;
use std::f64::consts::TAU;

/// Triangles anywhere in the cube; the more there are the smaller, so that a ray always meets a few.
pub(super) fn soup(triangles: usize, seed: u64) -> MeshPart {
    let mut random = Random::new(seed);
    let size = 4.0 / (triangles as f64).sqrt();
    let mut mesh = MeshPart::default();
    for _ in 0..triangles {
        let center = random.in_cube();
        push(&mut mesh, [0; 3].map(|_| center + random.in_cube() * size));
    }
    mesh
}

/// Slivers around the tip of a cone.
const CONE: usize = 64;

/// Needles and cones, half and half; the more there are the shorter, so that as many boxes overlap everywhere.
pub(super) fn slivers(triangles: usize, seed: u64) -> MeshPart {
    let mut random = Random::new(seed);
    let length = 4.0 / (triangles as f64).cbrt();
    let mut mesh = MeshPart::default();
    for _ in 0..triangles / 2 {
        let (start, along) = (random.in_cube(), random.direction() * length);
        let width = length * libm::exp2(-20.0 * random.unit());
        push(&mut mesh, [start, start + along, start + along + random.direction() * width]);
    }
    while mesh.triangles.len() < triangles {
        let tip = random.in_cube();
        let rim = |i: usize| {
            let (sin, cos) = libm::sincos(TAU * i as f64 / CONE as f64);
            tip + DVec3::new(cos, sin, 0.3) * length
        };
        for i in 0..CONE.min(triangles - mesh.triangles.len()) {
            push(&mut mesh, [tip, rim(i), rim(i + 1)]);
        }
    }
    mesh
}

/// Every triangle of a mesh four times, in shuffled order.
pub(super) fn duplicates(mesh: MeshPart, seed: u64) -> MeshPart {
    let mut triangles = mesh.triangles.repeat(4);
    Random::new(seed).shuffle(&mut triangles);
    MeshPart { triangles, ..mesh }
}

fn push(mesh: &mut MeshPart, corners: [DVec3; 3]) {
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(corners);
    mesh.triangles.push([first, first + 1, first + 2]);
}
