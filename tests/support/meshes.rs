//! Meshes that are hard for accelerators, of a size around 1 around the origin.

use pathtracer::geometry::MeshPart;
use pathtracer::math::DVec3;

use super::random::Random;

/// Moves a mesh.
pub(crate) fn moved(mut mesh: MeshPart, by: DVec3) -> MeshPart {
    mesh.positions.iter_mut().for_each(|p| *p += by);
    mesh
}

/// A closed sphere of `segments` around and half as many from pole to pole, each radius scaled by 1 up to 1 + `noise`.
pub(crate) fn sphere(radius: f64, segments: u32, noise: f64, seed: u64) -> MeshPart {
    let mut random = Random::new(seed);
    let rings = segments / 2;
    let mut positions = Vec::new();
    for ring in 0..=rings {
        let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(ring) / f64::from(rings));
        let around = if ring == 0 || ring == rings { 1 } else { segments };
        for segment in 0..around {
            let (s, c) = libm::sincos(std::f64::consts::TAU * f64::from(segment) / f64::from(segments));
            let direction = if around == 1 {
                DVec3::new(0.0, 0.0, cos.signum())
            } else {
                DVec3::new(sin * c, sin * s, cos)
            };
            positions.push(direction * (radius * (1.0 + noise * random.unit())));
        }
    }
    let at = |ring: u32, segment: u32| match ring {
        0 => 0,
        _ if ring == rings => 1 + (rings - 1) * segments,
        _ => 1 + (ring - 1) * segments + segment % segments,
    };
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for s in 0..segments {
            let (a, b) = (at(ring, s), at(ring, s + 1));
            let (c, d) = (at(ring + 1, s), at(ring + 1, s + 1));
            triangles.extend(
                [[a, c, d], [a, d, b]].into_iter().filter(|t| t[0] != t[1] && t[1] != t[2] && t[0] != t[2]),
            );
        }
    }
    MeshPart { object: 0, positions, triangles }
}

/// Triangles of any shape and place, edges up to `size`.
pub(crate) fn soup(count: u32, size: f64, seed: u64) -> MeshPart {
    let mut random = Random::new(seed);
    let mut mesh = MeshPart::default();
    for i in 0..count {
        let center = random.in_cube();
        mesh.positions.extend([0; 3].map(|_| center + random.in_cube() * size));
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    mesh
}

/// A square of `cells` by `cells` quads, each corner raised by up to `height`.
pub(crate) fn terrain(cells: u32, height: f64, seed: u64) -> MeshPart {
    let mut random = Random::new(seed);
    let step = |i: u32| 2.0 * f64::from(i) / f64::from(cells) - 1.0;
    let corners = (0..=cells).flat_map(|y| (0..=cells).map(move |x| (x, y)));
    let positions = corners.map(|(x, y)| DVec3::new(step(x), step(y), height * random.unit())).collect();
    MeshPart { object: 0, positions, triangles: grid(cells) }
}

fn grid(cells: u32) -> Vec<[u32; 3]> {
    let at = |x: u32, y: u32| y * (cells + 1) + x;
    let quads = (0..cells).flat_map(|y| (0..cells).map(move |x| (x, y)));
    quads
        .flat_map(|(x, y)| {
            let (a, b, c, d) = (at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// The triangles of a mesh `copies` times, in a shuffled order.
pub(crate) fn duplicated(mut mesh: MeshPart, copies: usize, seed: u64) -> MeshPart {
    mesh.triangles = mesh.triangles.repeat(copies);
    Random::new(seed).shuffle(&mut mesh.triangles);
    mesh
}

/// A plane in strips whose corners lie on the edges of their neighbours.
pub(crate) fn t_junctions(strips: u32) -> MeshPart {
    let mut mesh = MeshPart::default();
    for strip in 0..strips {
        let y = [strip, strip + 1].map(|i| 2.0 * f64::from(i) / f64::from(strips) - 1.0);
        let cells = 5 + 2 * (strip % 7);
        for cell in 0..cells {
            let x = [cell, cell + 1].map(|i| 2.0 * f64::from(i) / f64::from(cells) - 1.0);
            let first = mesh.positions.len() as u32;
            let corner = |i: usize, j: usize| DVec3::new(x[i], y[j], 0.3 * x[i] + 0.1 * y[j]);
            mesh.positions.extend([corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)]);
            mesh.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t: [u32; 3]| t.map(|i| i + first)));
        }
    }
    mesh
}

/// A fan of triangles with angles down to 1e-6 that share a corner, and needles of that width through the space.
pub(crate) fn slivers(count: u32, seed: u64) -> MeshPart {
    let mut random = Random::new(seed);
    let mut mesh = MeshPart::default();
    for i in 0..count {
        let width = libm::exp2(-20.0 * random.unit());
        let (start, along) = (random.in_cube() * if i % 2 == 0 { 0.0 } else { 1.0 }, random.direction());
        let end = start + along;
        mesh.positions.extend([start, end, end + random.in_cube() * width]);
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    mesh
}

/// The surface of the cube [-1, 1]^3, `cells` by `cells` quads a side.
pub(crate) fn grid_cube(cells: u32) -> MeshPart {
    let mut mesh = MeshPart::default();
    let step = |i: u32| 2.0 * f64::from(i) / f64::from(cells) - 1.0;
    for side in 0..6 {
        let (axis, level) = (side % 3, if side < 3 { -1.0 } else { 1.0 });
        let first = mesh.positions.len() as u32;
        for y in 0..=cells {
            for x in 0..=cells {
                let mut p = DVec3::splat(level);
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (step(x), step(y));
                mesh.positions.push(p);
            }
        }
        mesh.triangles.extend(grid(cells).into_iter().map(|t| t.map(|i| i + first)));
    }
    mesh
}
