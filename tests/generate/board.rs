//! A chess board: 8 x 8 bevelled squares of edge 1, its middle in the origin and its top at y = 0.

use super::mesh::{Corner, Mesh};
use glam::DVec3;

/// One of the two colours of the squares.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shade {
    /// As the square a1.
    Dark,
    /// As the square h1.
    Light,
}

/// Width and depth of the bevel.
const BEVEL: f64 = 0.025;

/// How far the squares reach down.
const DEPTH: f64 = 0.2;

/// All squares of one colour.
pub(crate) fn squares(shade: Shade) -> Mesh {
    let mut mesh = Mesh::default();
    for row in 0..8 {
        for column in 0..8 {
            let own = if (row + column) % 2 == 0 { Shade::Dark } else { Shade::Light };
            if own == shade {
                add_square(&mut mesh, f64::from(column) - 3.5, f64::from(row) - 3.5);
            }
        }
    }
    mesh
}

/// A closed square around (x, z): bottom, sides, bevel, top.
fn add_square(mesh: &mut Mesh, x: f64, z: f64) {
    // A gap of a hundredth keeps neighbours from sharing a face.
    let half = 0.495;
    let first = mesh.positions.len();
    for (half, y) in [(half, -DEPTH), (half, -BEVEL), (half - BEVEL, 0.0)] {
        let corners = [(-half, half), (half, half), (half, -half), (-half, -half)];
        mesh.positions.extend(corners.map(|(dx, dz)| DVec3::new(x + dx, y, z + dz)));
    }
    let corner = |ring: usize, i: usize| Corner::flat(first + 4 * ring + i % 4);
    mesh.add_quad([corner(0, 3), corner(0, 2), corner(0, 1), corner(0, 0)]);
    for ring in 0..2 {
        for i in 0..4 {
            mesh.add_quad([
                corner(ring, i),
                corner(ring, i + 1),
                corner(ring + 1, i + 1),
                corner(ring + 1, i),
            ]);
        }
    }
    mesh.add_quad([corner(2, 0), corner(2, 1), corner(2, 2), corner(2, 3)]);
}
