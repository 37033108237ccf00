//! Turned work: a profile revolved about the y axis.

use super::mesh::{Corner, Mesh};
use glam::DVec3;
use std::f64::consts::TAU;

/// Edges of the profile that bend by more than this cosine (30 degrees) stay sharp.
const SMOOTH_COSINE: f64 = 0.866;

/// Revolves a profile of (radius, height) points, given from the bottom of the axis to its top, both of radius 0.
pub(crate) fn turn(profile: &[(f64, f64)], sides: usize) -> Mesh {
    let mut mesh = Mesh::default();
    let rings = rings_of(profile, sides, &mut mesh);
    for (k, pair) in profile.windows(2).enumerate() {
        let (lower, upper) = corner_normals(profile, k);
        let (below, above) = (mesh.normals.len(), mesh.normals.len() + sides);
        mesh.normals.extend((0..sides).map(|i| around_axis(lower, i, sides)));
        mesh.normals.extend((0..sides).map(|i| around_axis(upper, i, sides)));
        for i in 0..sides {
            let j = (i + 1) % sides;
            let low = |i: usize| Corner { position: rings[k] + i, normal: Some(below + i) };
            let high = |i: usize| Corner { position: rings[k + 1] + i, normal: Some(above + i) };
            if pair[0].0 == 0.0 {
                mesh.triangles.push([Corner { position: rings[k], ..low(i) }, high(i), high(j)]);
            } else if pair[1].0 == 0.0 {
                mesh.triangles.push([low(i), Corner { position: rings[k + 1], ..high(i) }, low(j)]);
            } else {
                mesh.add_quad([low(i), high(i), high(j), low(j)]);
            }
        }
    }
    mesh
}

/// Adds the circles of the profile's points (one vertex on the axis) and returns the first index of each.
fn rings_of(profile: &[(f64, f64)], sides: usize, mesh: &mut Mesh) -> Vec<usize> {
    let mut rings = Vec::with_capacity(profile.len());
    for &point in profile {
        rings.push(mesh.positions.len());
        let count = if point.0 == 0.0 { 1 } else { sides };
        mesh.positions.extend((0..count).map(|i| around_axis(point, i, sides)));
    }
    rings
}

/// The vector (radius, height) of the profile's plane, turned to side `i`.
fn around_axis((radius, height): (f64, f64), i: usize, sides: usize) -> DVec3 {
    let angle = TAU * i as f64 / sides as f64;
    DVec3::new(radius * libm::cos(angle), height, radius * libm::sin(angle))
}

/// Normals in the profile's plane at both ends of its edge `k`: averaged with the neighbouring edge unless the
/// profile has a sharp corner there.
fn corner_normals(profile: &[(f64, f64)], k: usize) -> ((f64, f64), (f64, f64)) {
    let own = edge_normal(profile, k);
    let blend = |neighbour: Option<(f64, f64)>| match neighbour {
        Some(other) if own.0 * other.0 + own.1 * other.1 > SMOOTH_COSINE => {
            unit((own.0 + other.0, own.1 + other.1))
        }
        _ => own,
    };
    let before = (k > 0).then(|| edge_normal(profile, k - 1));
    let after = (k + 2 < profile.len()).then(|| edge_normal(profile, k + 1));
    (blend(before), blend(after))
}

/// The outward normal of the profile's edge `k`.
fn edge_normal(profile: &[(f64, f64)], k: usize) -> (f64, f64) {
    let ((r0, h0), (r1, h1)) = (profile[k], profile[k + 1]);
    unit((h1 - h0, r0 - r1))
}

/// The plane vector with length 1.
fn unit((x, y): (f64, f64)) -> (f64, f64) {
    let length = (x * x + y * y).sqrt();
    (x / length, y / length)
}
