//! Sculpting with implicit surfaces: shapes as functions that are negative inside, and their mesh.
//!
//! The mesh is made by surface nets (Gibson, "Constrained Elastic Surface Nets", MICCAI 1998): one vertex in every
//! cell of a grid that the surface passes, one quadrilateral for every edge of the grid that it crosses.

use super::mesh::{Corner, Mesh};
use glam::DVec3;
use std::collections::BTreeMap;

/// Distance to a ball.
pub(crate) fn ball(p: DVec3, center: DVec3, radius: f64) -> f64 {
    p.distance(center) - radius
}

/// About the distance to the hull of two balls: the radius changes linearly between the ends.
pub(crate) fn limb(p: DVec3, (a, ra): (DVec3, f64), (b, rb): (DVec3, f64)) -> f64 {
    let axis = b - a;
    let t = ((p - a).dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
    p.distance(a + axis * t) - (ra + (rb - ra) * t)
}

/// Union whose seam is filled over a width of about `k` (polynomial smooth minimum).
pub(crate) fn join(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

/// `a` without `b`, the rim rounded over a width of about `k`.
pub(crate) fn carve(a: f64, b: f64, k: f64) -> f64 {
    -join(-a, b, k)
}

/// A grid of cubes: its lower corner, the edge of a cube and the number of cubes along each axis.
pub(crate) struct Grid {
    /// Lower corner.
    pub(crate) origin: DVec3,
    /// Edge of a cube.
    pub(crate) step: f64,
    /// Number of cubes along x, y, z.
    pub(crate) cells: [usize; 3],
}

impl Grid {
    /// The position of a corner of the grid.
    fn corner(&self, [i, j, k]: [usize; 3]) -> DVec3 {
        self.origin + DVec3::new(i as f64, j as f64, k as f64) * self.step
    }

    /// The index of a corner in an array of all.
    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        (k * (self.cells[1] + 1) + j) * (self.cells[0] + 1) + i
    }

    /// All corners from the lower end up to but without `end`, x fastest.
    fn corners(end: [usize; 3]) -> impl Iterator<Item = [usize; 3]> {
        let [nx, ny, nz] = end;
        (0..nz).flat_map(move |k| (0..ny).flat_map(move |j| (0..nx).map(move |i| [i, j, k])))
    }
}

/// The smooth closed mesh of the surface `shape` = 0, which must lie inside the grid.
pub(crate) fn polygonise(shape: impl Fn(DVec3) -> f64, grid: &Grid) -> Mesh {
    let end = grid.cells.map(|n| n + 1);
    let values: Vec<f64> = Grid::corners(end).map(|c| shape(grid.corner(c))).collect();
    let mut mesh = Mesh::default();
    let mut vertices = BTreeMap::new();
    for cell in Grid::corners(grid.cells) {
        if let Some(start) = mean_crossing(grid, &values, cell) {
            let (position, normal) = onto_surface(&shape, start, grid.step);
            vertices.insert(cell, mesh.positions.len());
            mesh.positions.push(position);
            mesh.normals.push(normal);
        }
    }
    for corner in Grid::corners(grid.cells) {
        for axis in 0..3 {
            add_face(&mut mesh, grid, &values, &vertices, corner, axis);
        }
    }
    mesh
}

/// The mean of the points where the edges of a cell cross the surface, if any does.
fn mean_crossing(grid: &Grid, values: &[f64], cell: [usize; 3]) -> Option<DVec3> {
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for low in Grid::corners([2, 2, 2]) {
        for axis in (0..3).filter(|&axis| low[axis] == 0) {
            let from = [0, 1, 2].map(|i| cell[i] + low[i]);
            let to = step_along(from, axis);
            let (a, b) = (values[grid.index(from)], values[grid.index(to)]);
            if (a < 0.0) != (b < 0.0) {
                sum += grid.corner(from).lerp(grid.corner(to), a / (a - b));
                count += 1.0;
            }
        }
    }
    (count > 0.0).then(|| sum / count)
}

/// Moves a point near the surface onto it by Newton's steps along the gradient, at most half a cell away, and
/// returns it with the normal there.
fn onto_surface(shape: impl Fn(DVec3) -> f64, start: DVec3, cell: f64) -> (DVec3, DVec3) {
    let gradient = |p: DVec3| {
        let h = 0.05 * cell;
        let slope = |axis: DVec3| (shape(p + axis * h) - shape(p - axis * h)) / (2.0 * h);
        DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z))
    };
    let mut p = start;
    for _ in 0..4 {
        let g = gradient(p);
        p -= g * (shape(p) / g.length_squared());
    }
    let position = if p.distance(start) < 0.5 * cell { p } else { start };
    (position, gradient(position).normalize())
}

/// The next corner along an axis.
fn step_along(mut corner: [usize; 3], axis: usize) -> [usize; 3] {
    corner[axis] += 1;
    corner
}

/// Adds the quadrilateral around the edge from `corner` along `axis`, if the edge crosses the surface.
fn add_face(
    mesh: &mut Mesh,
    grid: &Grid,
    values: &[f64],
    vertices: &BTreeMap<[usize; 3], usize>,
    corner: [usize; 3],
    axis: usize,
) {
    let inside = values[grid.index(corner)] < 0.0;
    if inside == (values[grid.index(step_along(corner, axis))] < 0.0) {
        return;
    }
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    // The four cells around the edge, counter-clockwise seen from its far end.
    let around = [(1, 1), (0, 1), (0, 0), (1, 0)].map(|(du, dv)| {
        let mut cell = corner;
        cell[u] -= du;
        cell[v] -= dv;
        Corner::smooth(vertices[&cell])
    });
    let [a, b, c, d] = around;
    mesh.add_quad(if inside { [a, b, c, d] } else { [d, c, b, a] });
}
