//! Faces with more than three corners become triangles.

use crate::math::DVec3;

/// Most corners of a concave polygon that is split by ears: the time grows with their square at least.
const MAX_CONCAVE: usize = 4096;

/// A polygon's triangles, as indices into its corners.
pub(super) struct Split {
    /// Three corners each, in the winding of the polygon.
    pub(super) triangles: Vec<[usize; 3]>,
    /// Whether a fan was made of a polygon that is not convex, because it has too many corners.
    pub(super) fanned: bool,
}

/// Splits a polygon: a fan if it is strictly convex, else by cutting ears (Meisters, "Polygons have ears", 1975) in
/// the coordinate plane that it faces most. A fan would lose corners on straight edges, which a neighbour may share.
pub(super) fn split(corners: &[DVec3]) -> Split {
    let flat = flatten(corners);
    let count = flat.len();
    let convex = (0..count).all(|i| {
        let turn = doubled_area(flat[i], flat[(i + 1) % count], flat[(i + 2) % count]);
        // Also true for NaN: what overflows is not looked at more closely.
        !(turn <= 0.0)
    });
    if convex || count > MAX_CONCAVE {
        let triangles = (2..count).map(|i| [0, i - 1, i]).collect();
        return Split { triangles, fanned: !convex };
    }
    Split { triangles: cut_ears(&flat), fanned: false }
}

/// The corners in the plane that drops the largest component of the polygon's normal (Newell's sum), wound
/// counter-clockwise.
fn flatten(corners: &[DVec3]) -> Vec<[f64; 2]> {
    let origin = corners.first().copied().unwrap_or_default();
    let next = corners.iter().cycle().skip(1);
    let normal: DVec3 = corners.iter().zip(next).map(|(a, b)| (*a - origin).cross(*b - origin)).sum();
    let size = normal.abs();
    corners
        .iter()
        .map(|p| {
            if size.x >= size.y && size.x >= size.z {
                [p.y * normal.x.signum(), p.z]
            } else if size.y >= size.z {
                [p.z * normal.y.signum(), p.x]
            } else {
                [p.x * normal.z.signum(), p.y]
            }
        })
        .collect()
}

/// Twice the area of a triangle, positive if it is counter-clockwise.
fn doubled_area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Cuts corners off whose triangle holds no other corner, until three are left. Where corners coincide or edges
/// cross there may be no ear; then the flattest corner goes.
fn cut_ears(flat: &[[f64; 2]]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..flat.len()).collect();
    let mut triangles = Vec::with_capacity(flat.len());
    let mut at = 0;
    let mut tried = 0;
    while left.len() > 3 {
        let count = left.len();
        let around = |at: usize| [left[(at + count - 1) % count], left[at], left[(at + 1) % count]];
        if tried == count {
            let flatness = |at: &usize| {
                let [a, b, c] = around(*at).map(|i| flat[i]);
                doubled_area(a, b, c).abs()
            };
            at = (0..count).min_by(|a, b| flatness(a).total_cmp(&flatness(b))).unwrap_or(0);
        } else if !is_ear(around(at), &left, flat) {
            at = (at + 1) % count;
            tried += 1;
            continue;
        }
        triangles.push(around(at));
        left.remove(at);
        // Going on behind the neighbour makes fewer slivers.
        at = (at + 1) % left.len();
        tried = 0;
    }
    triangles.extend(<[usize; 3]>::try_from(left));
    triangles
}

/// Whether the corner `ear[1]` can be cut off: it is convex and no other corner lies in the triangle.
fn is_ear(ear: [usize; 3], left: &[usize], flat: &[[f64; 2]]) -> bool {
    let [a, b, c] = ear.map(|i| flat[i]);
    if doubled_area(a, b, c) <= 0.0 {
        return false;
    }
    left.iter().filter(|i| !ear.contains(i)).all(|&i| {
        let p = flat[i];
        let inside =
            doubled_area(a, b, p) >= 0.0 && doubled_area(b, c, p) >= 0.0 && doubled_area(c, a, p) >= 0.0;
        // Corners in the same place do not block each other: polygons with holes visit the bridge twice.
        !inside || p == a || p == b || p == c
    })
}
