//! Closed bodies that the origin sees whole, or nearly so.

use super::noise;
use crate::geometry::MeshPart;
use crate::math::DVec3;
use crate::study::random::Random;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Meridians and parallels; every radius is 1 to 1.05 at random, the finer the mesh the spikier.
pub(super) fn noise_sphere(triangles: usize, seed: u64) -> MeshPart {
    // s meridians and s / 2 bands make s (s - 2) triangles.
    let rings = (((1.0 + (1.0 + triangles as f64).sqrt()) * 0.5).round() as usize).max(2);
    let segments = 2 * rings;
    let mut random = Random::new(seed);
    let mut positions = Vec::with_capacity(segments * rings);
    let mut push = |direction: DVec3| positions.push(direction * (1.0 + 0.05 * random.unit()));
    push(DVec3::Z);
    let turns: Vec<(f64, f64)> =
        (0..segments).map(|segment| libm::sincos(TAU * segment as f64 / segments as f64)).collect();
    for ring in 1..rings {
        let (sin, cos) = libm::sincos(PI * ring as f64 / rings as f64);
        turns.iter().for_each(|&(s, c)| push(DVec3::new(sin * c, sin * s, cos)));
    }
    push(DVec3::NEG_Z);
    let last = positions.len() - 1;
    let at = |ring: usize, segment: usize| match ring {
        0 => 0,
        _ if ring == rings => last as u32,
        _ => (1 + (ring - 1) * segments + segment % segments) as u32,
    };
    let quad = |i: usize| {
        let (ring, s) = (i / segments, i % segments);
        let (a, b, c, d) = (at(ring, s), at(ring, s + 1), at(ring + 1, s), at(ring + 1, s + 1));
        [(ring + 1 < rings).then_some([a, c, d]), (ring > 0).then_some([a, d, b])]
    };
    let triangles = (0..rings * segments).flat_map(quad).flatten().collect();
    MeshPart { object: 0, positions, triangles }
}

/// A body of lumps and folds with detail down to its triangles, which are of many shapes.
pub(super) fn scan(triangles: usize, seed: u64) -> MeshPart {
    // An octahedron whose faces are cut into n^2 triangles each.
    let n = ((triangles as f64 / 8.0).sqrt().round() as usize).max(2);
    let (mut positions, triangles) = octahedron(n);
    let octaves = 2 + (n as f64).log2().round() as u32;
    positions.par_iter_mut().enumerate().for_each(|(i, p)| {
        let mut random = Random::new(seed ^ i as u64);
        let direction = (*p + random.in_cube() * (0.3 / n as f64)).normalize();
        let radius = 1.0 + 0.35 * noise::octaves(direction * 2.0, octaves, seed);
        *p = direction * radius + 0.2 * noise::octaves3(direction * 3.0, 3, seed);
    });
    MeshPart { object: 0, positions, triangles }
}

/// The octahedron with each face cut into n^2 triangles, corners numbered ring by ring from the upper tip.
fn octahedron(n: usize) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let axes = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
    let quarter = |ring: usize| ring.min(2 * n - ring);
    let mut firsts = vec![0];
    let mut positions = Vec::with_capacity(4 * n * n + 2);
    for ring in 0..=2 * n {
        let steps = quarter(ring);
        let height = DVec3::Z * (n as f64 - ring as f64);
        if steps == 0 {
            positions.push(height / n as f64);
        }
        for side in 0..4 {
            let (from, to) = (axes[side], axes[(side + 1) % 4]);
            let point = |i: usize| (from * (steps - i) as f64 + to * i as f64 + height) / n as f64;
            positions.extend((0..steps).map(point));
        }
        firsts.push(positions.len());
    }
    // Corner `i` of a side of a ring.
    let at = |ring: usize, side: usize, i: usize| {
        let steps = quarter(ring);
        (firsts[ring] + if steps == 0 { 0 } else { (side * steps + i) % (4 * steps) }) as u32
    };
    let mut triangles = Vec::with_capacity(8 * n * n);
    for band in 0..2 * n {
        for side in 0..4 {
            // The ring nearer to its tip has one step less.
            let upper = band < n;
            let (short, long) = if upper { (band, band + 1) } else { (band + 1, band) };
            let mut push = |t: [u32; 3]| triangles.push(if upper { t } else { [t[0], t[2], t[1]] });
            for i in 0..quarter(long) {
                push([at(short, side, i), at(long, side, i), at(long, side, i + 1)]);
                if i + 1 < quarter(long) {
                    push([at(short, side, i), at(long, side, i + 1), at(short, side, i + 1)]);
                }
            }
        }
    }
    (positions, triangles)
}
