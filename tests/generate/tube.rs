//! Branches: closed tubes that taper along a curve.

use super::mesh::{Corner, Mesh};
use glam::DVec3;
use std::f64::consts::TAU;

/// A point of a branch's curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Joint {
    /// Where the middle of the branch is.
    pub(crate) position: DVec3,
    /// Half its thickness.
    pub(crate) radius: f64,
}

/// Adds a tube around `curve` to a mesh that has as many normals as positions: a ring of `sides` vertices at every joint but the last, which is its point. The start
/// is closed by a flat cap.
pub(crate) fn add_tube(mesh: &mut Mesh, curve: &[Joint], sides: usize) {
    let Some(end) = curve.last() else { return };
    let mut side = (curve[1].position - curve[0].position).any_orthonormal_vector();
    let first = mesh.positions.len();
    for k in 0..curve.len() - 1 {
        let along = direction(curve, k);
        // The part of the old side that is still across the curve: the rings do not twist.
        side = (side - along * side.dot(along)).normalize();
        let other = along.cross(side);
        for i in 0..sides {
            let angle = TAU * i as f64 / sides as f64;
            let outward = side * libm::cos(angle) + other * libm::sin(angle);
            mesh.normals.push(outward);
            mesh.positions.push(curve[k].position + outward * curve[k].radius);
        }
    }
    mesh.positions.push(end.position);
    mesh.normals.push(direction(curve, curve.len() - 2));
    add_faces(mesh, first, curve.len() - 1, sides);
    add_cap(mesh, first, sides, direction(curve, 0));
}

/// The direction of the curve at joint `k`.
fn direction(curve: &[Joint], k: usize) -> DVec3 {
    let before = k.saturating_sub(1);
    (curve[k + 1].position - curve[before].position).normalize()
}

/// Adds the sides between `rings` rings whose vertices start at index `first`, and the point after the last ring.
fn add_faces(mesh: &mut Mesh, first: usize, rings: usize, sides: usize) {
    let corner = |ring: usize, i: usize| Corner::smooth(first + ring * sides + i % sides);
    for i in 0..sides {
        for k in 0..rings - 1 {
            mesh.add_quad([corner(k, i), corner(k, i + 1), corner(k + 1, i + 1), corner(k + 1, i)]);
        }
        // The point has as many normals as sides, for one alone could not face all of them.
        let point = Corner { position: first + rings * sides, ..corner(rings - 1, i) };
        mesh.triangles.push([corner(rings - 1, i), corner(rings - 1, i + 1), point]);
    }
}

/// Closes the start of a tube, whose first ring begins at index `first`.
fn add_cap(mesh: &mut Mesh, first: usize, sides: usize, along: DVec3) {
    let normal = Some(mesh.normals.len());
    mesh.normals.push(-along);
    // Keeps positions and normals in step for the next tube.
    mesh.positions.push((0..sides).map(|i| mesh.positions[first + i]).sum::<DVec3>() / sides as f64);
    let centre = mesh.positions.len() - 1;
    let corner = |position: usize| Corner { position, normal };
    for i in 0..sides {
        mesh.triangles.push([corner(centre), corner(first + (i + 1) % sides), corner(first + i)]);
    }
}
