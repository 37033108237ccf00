//! A knight of chess: a turned base and a sculpted horse's head, each a closed surface; the head stands in the collar.
//!
//! The axes are those of OBJ files: y up, the horse looks along +x, z is its side.

use super::implicit::{Grid, ball, carve, join, limb, polygonise};
use super::lathe::turn;
use super::mesh::Mesh;
use glam::DVec3;
use std::f64::consts::PI;

/// Sides of the turned base.
const SIDES: usize = 96;

/// The whole piece: 2 units high, base of radius 0.62.
pub(crate) fn piece() -> Mesh {
    let mut mesh = turn(&base_profile(), SIDES);
    // An odd number of cells across keeps the plane of symmetry in the middle of a layer.
    let grid = Grid { origin: DVec3::new(-0.66, 0.6, -0.4625), step: 0.025, cells: [59, 62, 37] };
    mesh.append(&polygonise(head, &grid));
    mesh
}

/// The profile of the base as (radius, height), from the axis at the bottom to the axis at the top.
fn base_profile() -> Vec<(f64, f64)> {
    let mut profile = vec![(0.0, 0.0)];
    arc(&mut profile, (0.585, 0.035), (0.035, 0.035), -90.0, 0.0);
    arc(&mut profile, (0.56, 0.15), (0.06, 0.045), 0.0, 90.0);
    arc(&mut profile, (0.555, 0.235), (0.045, 0.04), 270.0, 180.0);
    arc(&mut profile, (0.475, 0.27), (0.065, 0.045), -60.0, 90.0);
    arc(&mut profile, (0.475, 0.62), (0.125, 0.29), 250.0, 180.0);
    arc(&mut profile, (0.36, 0.655), (0.07, 0.035), -90.0, 90.0);
    profile.extend([(0.33, 0.7), (0.0, 0.7)]);
    profile
}

/// Appends an elliptic arc of the profile, angles in degrees, with a point every 15 degrees or less.
fn arc(profile: &mut Vec<(f64, f64)>, center: (f64, f64), radii: (f64, f64), from: f64, to: f64) {
    let steps = ((to - from).abs() / 15.0).ceil() as usize;
    for i in 0..=steps {
        let angle = (from + (to - from) * i as f64 / steps as f64) * PI / 180.0;
        profile.push((center.0 + radii.0 * libm::cos(angle), center.1 + radii.1 * libm::sin(angle)));
    }
}

/// A point of the plane of symmetry.
fn middle(x: f64, y: f64) -> DVec3 {
    DVec3::new(x, y, 0.0)
}

/// The horse: negative inside.
fn head(p: DVec3) -> f64 {
    // Both sides are alike.
    let p = DVec3::new(p.x, p.y, p.z.abs());
    let mut shape = join(neck(p), skull(p), 0.12);
    shape = join(shape, mane(p), 0.035);
    shape = join(shape, ear(p), 0.05);
    shape = carve_face(shape, p);
    // The flat foot is hidden in the collar of the base.
    shape.max(0.64 - p.y)
}

/// Neck and chest: round where they stand in the collar, flatter above.
fn neck(p: DVec3) -> f64 {
    let rise = ((p.y - 0.66) / 0.55).clamp(0.0, 1.0);
    let width = 1.0 - 0.36 * rise * rise * (3.0 - 2.0 * rise);
    let q = DVec3::new(p.x, p.y, p.z / width);
    let spine = [
        (middle(0.0, 0.55), 0.33),
        (middle(-0.05, 0.9), 0.3),
        (middle(-0.11, 1.24), 0.26),
        (middle(-0.01, 1.6), 0.21),
    ];
    let trunk =
        spine.windows(2).map(|pair| limb(q, pair[0], pair[1])).fold(f64::INFINITY, |a, b| join(a, b, 0.06));
    join(trunk, ball(q, middle(0.13, 0.87), 0.225), 0.14)
}

/// Forehead, cheeks and muzzle.
fn skull(p: DVec3) -> f64 {
    let q = DVec3::new(p.x, p.y, p.z / 0.78);
    let forehead = limb(q, (middle(0.06, 1.66), 0.2), (middle(0.3, 1.5), 0.165));
    let muzzle = limb(q, (middle(0.3, 1.5), 0.15), (middle(0.53, 1.335), 0.125));
    let lips = limb(q, (middle(0.5, 1.235), 0.085), (middle(0.555, 1.3), 0.12));
    let jaw = limb(q, (middle(0.16, 1.43), 0.205), (middle(0.42, 1.255), 0.095));
    let brow = limb(p, (DVec3::new(0.16, 1.72, 0.11), 0.05), (DVec3::new(0.31, 1.61, 0.115), 0.035));
    let face = join(join(forehead, muzzle, 0.05), join(jaw, lips, 0.05), 0.03);
    join(face, brow, 0.05)
}

/// The ear: a cone with a hollow in front.
fn ear(p: DVec3) -> f64 {
    let outside = limb(p, (DVec3::new(0.0, 1.8, 0.095), 0.075), (DVec3::new(0.02, 2.0, 0.12), 0.018));
    let hollow = limb(p, (DVec3::new(0.075, 1.84, 0.115), 0.035), (DVec3::new(0.055, 1.96, 0.135), 0.012));
    carve(outside, hollow, 0.02)
}

/// Locks along the crest, from the forelock to the withers, each swept back over the next.
fn mane(p: DVec3) -> f64 {
    let crest = [
        (0.16, 1.79),
        (0.02, 1.84),
        (-0.13, 1.78),
        (-0.24, 1.65),
        (-0.31, 1.49),
        (-0.345, 1.31),
        (-0.355, 1.13),
        (-0.34, 0.96),
        (-0.31, 0.81),
    ];
    let q = DVec3::new(p.x, p.y, p.z / 0.8);
    let mut shape = f64::INFINITY;
    for pair in crest.windows(2) {
        let (from, to) = (middle(pair[0].0, pair[0].1), middle(pair[1].0, pair[1].1));
        let along = (to - from).normalize();
        let outward = DVec3::new(along.y, -along.x, 0.0);
        let root = from - outward * 0.02;
        let tip = to + outward * 0.075 + along * 0.045;
        shape = join(shape, limb(q, (root, 0.115), (tip, 0.032)), 0.01);
    }
    shape
}

/// Cuts mouth, nostril and the socket of the eye, and sets the eye in.
fn carve_face(shape: f64, p: DVec3) -> f64 {
    // The mouth goes through the whole width, so its distance leaves z out.
    let mouth = limb(middle(p.x, p.y), (middle(0.72, 1.21), 0.03), (middle(0.5, 1.27), 0.02));
    let nostril = limb(p, (DVec3::new(0.6, 1.375, 0.1), 0.036), (DVec3::new(0.635, 1.33, 0.1), 0.022));
    let socket = ball(p, DVec3::new(0.27, 1.585, 0.195), 0.075);
    let eye = ball(p, DVec3::new(0.262, 1.583, 0.105), 0.055);
    let carved = carve(carve(carve(shape, mouth, 0.03), nostril, 0.025), socket, 0.03);
    join(carved, eye, 0.025)
}
