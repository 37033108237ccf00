//! Rays that must hit, and don't.

use super::random::Random;
use super::triangles;
use crate::accel::Accelerator;
use crate::geometry::{Geometry, Ray};
use crate::math::{Bounds, DVec3};
use rayon::prelude::*;

/// What rays from inside a closed mesh are aimed at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// Anywhere.
    Random,
    /// Corners of triangles.
    Vertex,
    /// The middles of edges.
    Edge,
    /// Corners, edges and insides of triangles of a cube, from outside, along an axis.
    Parallel,
}

impl Aim {
    /// Those that need nothing but a closed mesh.
    pub const INSIDE: [Aim; 3] = [Aim::Random, Aim::Vertex, Aim::Edge];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Aim::Random => "random",
            Aim::Vertex => "vertices",
            Aim::Edge => "edges",
            Aim::Parallel => "parallel",
        }
    }
}

/// Rays from within a quarter of a unit of the origin, which is inside the mesh, or ([`Aim::Parallel`]) from outside
/// onto the cube [-1, 1]^3. Each must hit.
pub fn rays(geometry: &Geometry, aim: Aim, count: usize, seed: u64) -> Vec<Ray> {
    let mut random = Random::new(seed);
    if triangles::count(geometry) == 0 {
        return Vec::new();
    }
    if aim == Aim::Parallel {
        return parallel(geometry, count, &mut random);
    }
    let ray = |_| {
        let origin = random.in_cube() * 0.14;
        if aim == Aim::Random {
            return Ray::new(origin, random.direction());
        }
        let corners = triangles::world_corners(geometry, random.index(triangles::count(geometry)));
        let first = random.index(3);
        let (a, b) = (corners[first], corners[(first + 1) % 3]);
        let target = if aim == Aim::Vertex { a } else { a.midpoint(b) };
        Ray::new(origin, (target - origin).normalize())
    };
    (0..count).map(ray).collect()
}

/// Along the axis of the face that the target lies on; targets on the cube's own edges may be missed and are left out.
fn parallel(geometry: &Geometry, count: usize, random: &mut Random) -> Vec<Ray> {
    let mut rays = Vec::with_capacity(count);
    // A cube without a corner inside a face has only edges and insides to aim at; so tries end.
    for _ in 0..20 * count {
        if rays.len() == count {
            break;
        }
        let [a, b, c] = triangles::world_corners(geometry, random.index(triangles::count(geometry)));
        let target = match random.index(3) {
            0 => a,
            1 => a.midpoint(b),
            _ => a + (b - a) * random.between(0.2, 0.4) + (c - a) * random.between(0.2, 0.4),
        };
        let bounds = Bounds::EMPTY.with_point(a).with_point(b).with_point(c);
        let flat = (0..3).find(|&axis| bounds.min[axis] == bounds.max[axis] && target[axis].abs() > 0.999);
        let Some(axis) = flat else { continue };
        if [1, 2].iter().any(|i| target[(axis + i) % 3].abs() > 0.999) {
            continue;
        }
        let mut outward = DVec3::ZERO;
        outward[axis] = target[axis].signum();
        rays.push(Ray::new(target + outward, -outward));
    }
    rays
}

/// How many of the rays hit nothing.
pub fn lost(accelerator: &dyn Accelerator, rays: &[Ray]) -> u64 {
    rays.par_iter().map(|ray| u64::from(accelerator.intersect(ray).is_none())).sum()
}
