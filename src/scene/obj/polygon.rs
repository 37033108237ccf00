//! Faces with more than three corners become triangles.

use crate::math::DVec3;

/// Most corners of a concave polygon that is split by ears: the time grows with their square.
const MAX_CONCAVE: usize = 4096;

/// How often all corners are looked at again when no ear is known.
const MAX_ROUNDS: usize = 8;

/// A polygon's triangles, as indices into its corners.
pub(super) struct Split<'s> {
    /// Three corners each, in the winding of the polygon.
    pub(super) triangles: &'s [[usize; 3]],
    /// Whether a fan was made of a polygon that is not convex, because it has too many corners.
    pub(super) fanned: bool,
}

/// Splits polygons; keeps the room that it needs for the next one.
#[derive(Default)]
pub(super) struct Splitter {
    points: Vec<DVec3>,
    flat: Vec<[f64; 2]>,
    triangles: Vec<[usize; 3]>,
}

impl Splitter {
    /// Splits a polygon: a fan if it is strictly convex, else by cutting ears (Meisters, "Polygons have ears", 1975)
    /// in the coordinate plane that it faces most. A fan would lose corners on straight edges, which a neighbour may
    /// share.
    pub(super) fn split(&mut self, corners: impl Iterator<Item = DVec3>) -> Split<'_> {
        self.points.clear();
        self.points.extend(corners);
        flatten(&self.points, &mut self.flat);
        let flat = &self.flat;
        let count = flat.len();
        let convex = (0..count).all(|i| {
            let turn = doubled_area(flat[i], flat[(i + 1) % count], flat[(i + 2) % count]);
            // What overflows is not looked at more closely.
            turn > 0.0 || turn.is_nan()
        });
        self.triangles.clear();
        let fanned = !convex && count > MAX_CONCAVE;
        if convex || fanned {
            self.triangles.extend((2..count).map(|i| [0, i - 1, i]));
        } else {
            Clipping::new(flat).cut_ears(&mut self.triangles);
        }
        Split { triangles: &self.triangles, fanned }
    }
}

/// The corners in the plane that drops the largest component of the polygon's normal (Newell's sum), wound
/// counter-clockwise.
fn flatten(corners: &[DVec3], flat: &mut Vec<[f64; 2]>) {
    let origin = corners.first().copied().unwrap_or_default();
    let next = corners.iter().cycle().skip(1);
    let normal: DVec3 = corners.iter().zip(next).map(|(a, b)| (*a - origin).cross(*b - origin)).sum();
    let size = normal.abs();
    flat.clear();
    flat.extend(corners.iter().map(|p| {
        if size.x >= size.y && size.x >= size.z {
            [p.y * normal.x.signum(), p.z]
        } else if size.y >= size.z {
            [p.z * normal.y.signum(), p.x]
        } else {
            [p.x * normal.z.signum(), p.y]
        }
    }));
}

/// Twice the area of a triangle, positive if it is counter-clockwise.
fn doubled_area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// A polygon from which corners are cut.
///
/// In a simple polygon a cut changes only at its two neighbours whether they are ears: what lies in another corner's
/// triangle is there as long as it is a corner itself. So each cut costs two looks at all corners, and all cuts
/// together the square of the number of corners. Where corners coincide or edges cross that is not certain, and all
/// corners are looked at again when no ear is known, but only a few times.
struct Clipping<'p> {
    flat: &'p [[f64; 2]],
    /// The corners that are left.
    left: Vec<usize>,
    /// Whether each of them was an ear when it was last looked at.
    ears: Vec<bool>,
}

impl Clipping<'_> {
    fn new(flat: &[[f64; 2]]) -> Clipping<'_> {
        Clipping { flat, left: (0..flat.len()).collect(), ears: Vec::new() }
    }

    /// Cuts corners off whose triangle holds no other corner, until three are left. Where corners coincide or edges
    /// cross there may be none; then the flattest corner goes.
    fn cut_ears(mut self, triangles: &mut Vec<[usize; 3]>) {
        self.look_at_all();
        let mut rounds = 0;
        let mut is_fresh = true;
        let mut at = 0;
        while self.left.len() > 3 {
            let count = self.left.len();
            let ear = (0..count).map(|step| (at + step) % count).find(|&at| self.ears[at]);
            if ear.is_none() && !is_fresh && rounds < MAX_ROUNDS {
                self.look_at_all();
                is_fresh = true;
                rounds += 1;
                continue;
            }
            at = ear.unwrap_or_else(|| self.flattest());
            triangles.push(self.around(at));
            self.left.remove(at);
            self.ears.remove(at);
            let count = self.left.len();
            let (before, behind) = ((at + count - 1) % count, at % count);
            self.ears[before] = self.is_ear(before);
            self.ears[behind] = self.is_ear(behind);
            is_fresh = false;
            // Going on behind the neighbour makes fewer slivers.
            at = (at + 1) % count;
        }
        triangles.extend(<[usize; 3]>::try_from(self.left));
    }

    fn look_at_all(&mut self) {
        self.ears = (0..self.left.len()).map(|at| self.is_ear(at)).collect();
    }

    /// The corner that makes the smallest triangle with its neighbours.
    fn flattest(&self) -> usize {
        let flatness = |at: &usize| {
            let [a, b, c] = self.around(*at).map(|i| self.flat[i]);
            doubled_area(a, b, c).abs()
        };
        (0..self.left.len()).min_by(|a, b| flatness(a).total_cmp(&flatness(b))).unwrap_or(0)
    }

    /// The corner with its neighbours.
    fn around(&self, at: usize) -> [usize; 3] {
        let count = self.left.len();
        [self.left[(at + count - 1) % count], self.left[at], self.left[(at + 1) % count]]
    }

    /// Whether a corner can be cut off: it is convex and no other corner lies in the triangle.
    fn is_ear(&self, at: usize) -> bool {
        let ear = self.around(at);
        let [a, b, c] = ear.map(|i| self.flat[i]);
        if doubled_area(a, b, c) <= 0.0 {
            return false;
        }
        self.left.iter().filter(|i| !ear.contains(i)).all(|&i| {
            let p = self.flat[i];
            let inside =
                doubled_area(a, b, p) >= 0.0 && doubled_area(b, c, p) >= 0.0 && doubled_area(c, a, p) >= 0.0;
            // Corners in the same place do not block each other: polygons with holes visit the bridge twice.
            !inside || p == a || p == b || p == c
        })
    }
}
