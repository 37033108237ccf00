//! Smooth random functions of space.

use crate::math::DVec3;
use crate::sampling::stream;

/// Sums octaves of [`value`], each of half the size and half the height of the one before; about -1 to 1.
pub(super) fn octaves(p: DVec3, count: u32, seed: u64) -> f64 {
    let (mut sum, mut height, mut size) = (0.0, 0.5, 1.0);
    for octave in 0..count {
        sum += height * value(p * size, seed.wrapping_add(octave.into()));
        height *= 0.5;
        size *= 2.0;
    }
    sum
}

/// A vector of three such functions.
pub(super) fn octaves3(p: DVec3, count: u32, seed: u64) -> DVec3 {
    let component = |axis: u64| octaves(p, count, seed.wrapping_add(1000 * (axis + 1)));
    DVec3::new(component(0), component(1), component(2))
}

/// Random values from -1 to 1 at the points with whole coordinates, smoothly interpolated between them.
fn value(p: DVec3, seed: u64) -> f64 {
    let cell = p.floor();
    let f = p - cell;
    let ease = f * f * (DVec3::splat(3.0) - 2.0 * f);
    let corner = |dx: i64, dy: i64, dz: i64| lattice(cell, [dx, dy, dz], seed);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let edge = |dy, dz| mix(corner(0, dy, dz), corner(1, dy, dz), ease.x);
    let face = |dz| mix(edge(0, dz), edge(1, dz), ease.y);
    mix(face(0), face(1), ease.z)
}

fn lattice(cell: DVec3, offset: [i64; 3], seed: u64) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|axis| (cell[axis] as i64 + offset[axis]) as u64);
    let bits = stream(stream(stream(seed, x), y), z);
    (bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}
