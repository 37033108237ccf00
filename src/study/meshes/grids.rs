//! Regular grids.

use super::noise;
use crate::geometry::MeshPart;
use crate::math::DVec3;
use rayon::prelude::*;

/// Hills over the square [-1, 1]^2.
pub(super) fn terrain(triangles: usize, seed: u64) -> MeshPart {
    let cells = side(triangles, 2);
    let step = |i: usize| 2.0 * i as f64 / cells as f64 - 1.0;
    let corner = |i: usize| {
        let (x, y) = (step(i % (cells + 1)), step(i / (cells + 1)));
        let hill = noise::octaves(DVec3::new(x, y, 0.0) * 2.5, 10, seed);
        // Valleys are wider than ridges.
        DVec3::new(x, y, 0.5 * (1.0 - hill.abs()) * (1.0 - hill.abs()))
    };
    let positions = (0..(cells + 1) * (cells + 1)).into_par_iter().map(corner).collect();
    MeshPart { object: 0, positions, triangles: quads(cells, 0, false) }
}

/// The surface of [-1, 1]^3, outward. The corners along the cube's edges are there once a face, at equal places.
pub(super) fn cube(triangles: usize) -> MeshPart {
    let cells = side(triangles, 12);
    let step = |i: usize| 2.0 * i as f64 / cells as f64 - 1.0;
    let mut mesh = MeshPart::default();
    for face in 0..6 {
        let (axis, level) = (face % 3, if face < 3 { -1.0 } else { 1.0 });
        let first = mesh.positions.len();
        for y in 0..=cells {
            for x in 0..=cells {
                let mut p = DVec3::splat(level);
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (step(x), step(y));
                mesh.positions.push(p);
            }
        }
        mesh.triangles.extend(quads(cells, first, level < 0.0));
    }
    mesh
}

/// How many cells a side give a number of triangles, at `per_square` triangles for one cell a side.
fn side(triangles: usize, per_square: usize) -> usize {
    ((triangles as f64 / per_square as f64).sqrt().round() as usize).max(1)
}

/// Two triangles a cell; the corners are numbered row by row from `first`.
fn quads(cells: usize, first: usize, turned: bool) -> Vec<[u32; 3]> {
    let at = |x: usize, y: usize| (first + y * (cells + 1) + x) as u32;
    let cell = |i: usize| {
        let (x, y) = (i % cells, i / cells);
        let (a, b, c, d) = (at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1));
        if turned { [[a, c, b], [a, d, c]] } else { [[a, b, c], [a, c, d]] }
    };
    (0..cells * cells).flat_map(cell).collect()
}
