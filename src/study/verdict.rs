//! What two answers to a ray are to each other.
//!
//! Both accelerators see the same f32 corners. The shared leaf decides in f64, which is exact for what follows; Embree's
//! own kernels decide in f32 with the ray rounded to f32, so they may differ only where a value that decides is smaller
//! than the error of its computation. Two kinds of values decide: the edge functions, and distances. The bounds are
//! those of Embree's robust kernel (Pluecker); the fast ones are held to them too.
//!
//! # The bound of an edge function
//! u = 2^-24 is the greatest relative error of one operation; v is the greatest distance of a corner from the ray's
//! origin, e the length of the longest edge, so e <= 2 v; |d| = 1. Embree computes dot(cross(p - q, p + q), d) with
//! p = a - o, q = b - o. A triangle that is hit has its corners within e of the ray, so |(p + q) x d| <= 2 e.
//! 1. p and q are off by u v each. The edge is off by twice that, against (p + q) x d: 4 u e v; the sum is off by twice
//!    that, against the edge: 2 u e v.
//! 2. The rounding of p - q, u e, against (p + q) x d: 2 u e^2 <= 4 u e v. That of p + q, 2 u v, against the edge:
//!    2 u e v.
//! 3. The cross product: a component is off by 2 u of the sum of its two products' sizes; d adds these up to 2 u times
//!    the permanent of three vectors, which is at most 2 / sqrt(3) of the product of their lengths (Carlen, Lieb, Loss
//!    2006): 4.7 u e v. The dot product: 3 u e (2 v) = 6 u e v.
//! 4. Embree also accepts what is outside by up to 2 u |U + V + W|; the sum is twice dot(n, d), n the cross product of
//!    two edges and at most sqrt(3) / 2 e^2 long: 3.5 u e^2 <= 7 u e v.
//! 5. The ray: its origin o is rounded by up to 2 u |o| (away from the surface that it leaves), its direction by u, so at
//!    the triangle it lies up to 2 u |o| + u v aside. An edge function is twice the distance of the two lines times
//!    |e x d|: u e (4 |o| + 2 v).
//!
//! Together u e (31.7 v + 4 |o|); 32 with the products of roundings.
//!
//! # The bound of a distance
//! t = dot(p, n) / dot(n, d) <= v; c is the absolute cosine between n and d.
//! 1. The hit is a mean of the corners, which are off by u v: so is the plane there, and t by u v / c.
//! 2. n is off by 2 u e^2 by the rounding of the edges and by 4 / sqrt(3) u e^2 by that of the cross product. This turns
//!    the plane about a corner, which is at most e from the hit: 4.4 u e^3 / (|n| c).
//! 3. The two dot products: 3 u v / c and 3 u t / c; the reciprocal, good to 2^-22, product and comparison: 6 u t.
//! 4. The ray lies aside by u (2 |o| + v), the hit along it by that over c.
//!
//! Together (14 u v + 2 u |o| + 4.4 u e^3 / |n|) / c; 15 and 5 with the products of roundings.

use super::rays::Query;
use super::triangles::{LocalTriangle, local_triangle};
use crate::accel::Accelerator;
use crate::geometry::{Geometry, Hit, PrimitiveId, Ray};
use crate::math::DVec3;

/// The greatest relative error of one f32 operation.
const U: f64 = 1.0 / 16_777_216.0;

/// What two answers are to each other, from the harmless to the fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Verdict {
    /// Equal to the last bit.
    Same,
    /// Equal distances of different primitives.
    Tie,
    /// f32 can't tell: two distances (of two triangles, or of one and an end of the ray) or the side of an edge.
    Edge,
    /// Anything else.
    Other,
}

impl Verdict {
    /// In the order of the columns of tables.
    pub const ALL: [Verdict; 4] = [Verdict::Same, Verdict::Tie, Verdict::Edge, Verdict::Other];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Same => "same",
            Verdict::Tie => "tie",
            Verdict::Edge => "edge",
            Verdict::Other => "other",
        }
    }

    /// On the closest hits of a ray by two accelerators.
    pub fn on_hits(geometry: &Geometry, ray: &Ray, a: Option<Hit>, b: Option<Hit>) -> Verdict {
        // What only one of them takes as the answer, and the other's.
        let (nearer, farther) = match (a, b) {
            (Some(a), Some(b)) if same_bits(&a, &b) => return Verdict::Same,
            (Some(a), Some(b)) if (a.primitive, a.part) == (b.primitive, b.part) => return Verdict::Other,
            (Some(a), Some(b)) if a.t == b.t => return Verdict::Tie,
            (Some(a), Some(b)) if a.t < b.t => (a, Some(b)),
            (Some(a), Some(b)) => (b, Some(a)),
            (Some(only), None) | (None, Some(only)) => (only, None),
            (None, None) => return Verdict::Same,
        };
        // The ray's start decides as another triangle does.
        let error = error(geometry, ray, &nearer);
        let gap = farther.map_or(f64::INFINITY, |far| far.t - nearer.t - self::error(geometry, ray, &far));
        if gap.min(nearer.t) <= error || is_on_edge(geometry, ray, &nearer) {
            Verdict::Edge
        } else {
            Verdict::Other
        }
    }

    /// On whether anything is in the way; `finder` is the accelerator that found something if they differ.
    pub fn on_shadow(geometry: &Geometry, query: &Query, finder: &dyn Accelerator) -> Verdict {
        let ray = &query.ray;
        let Some(hit) = finder.intersect(ray).filter(|hit| hit.primitive != query.target) else {
            return Verdict::Other;
        };
        let error = error(geometry, ray, &hit);
        let near_an_end = hit.t.min((query.t_max - hit.t).abs()) <= error;
        if near_an_end || is_on_edge(geometry, ray, &hit) { Verdict::Edge } else { Verdict::Other }
    }
}

type Bits = ([u64; 3], u32, PrimitiveId, u32);

fn same_bits(a: &Hit, b: &Hit) -> bool {
    let bits = |hit: &Hit| -> Bits {
        ([hit.t, hit.u, hit.v].map(f64::to_bits), hit.object, hit.primitive, hit.part)
    };
    bits(a) == bits(b)
}

/// How far a distance may be off in world units; 0 for solids, which are decided in f64 by all.
fn error(geometry: &Geometry, ray: &Ray, hit: &Hit) -> f64 {
    local_triangle(geometry, ray, hit).map_or(0.0, |seen| Sight::new(&seen).distance_error() / seen.scale)
}

fn is_on_edge(geometry: &Geometry, ray: &Ray, hit: &Hit) -> bool {
    local_triangle(geometry, ray, hit).is_some_and(|seen| Sight::new(&seen).is_on_edge())
}

/// A triangle as a ray sees it, in local units.
struct Sight {
    /// Distance of the ray's start from the origin of the f32 coordinates.
    start: f64,
    /// Greatest distance of a corner from the ray's start, and greatest length of an edge.
    far: f64,
    edge: f64,
    /// Smallest absolute edge function.
    nearest: f64,
    /// Length of the normal (two edges' cross product), and the absolute cosine between it and the ray.
    normal: f64,
    cosine: f64,
}

impl Sight {
    fn new(seen: &LocalTriangle) -> Sight {
        let (origin, d) = (seen.ray.origin64(), seen.ray.direction64());
        let v = seen.corners.map(|corner| corner - origin);
        let edges = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (v[i], v[j]));
        let greatest = |values: [f64; 3]| values.into_iter().fold(0.0, f64::max);
        let function = |(p, q): (DVec3, DVec3)| (p - q).cross(p + q).dot(d).abs();
        let normal = (v[1] - v[0]).cross(v[2] - v[0]);
        Sight {
            start: origin.length(),
            far: greatest(v.map(DVec3::length)),
            edge: greatest(edges.map(|(p, q)| (p - q).length())),
            nearest: edges.map(function).into_iter().fold(f64::INFINITY, f64::min),
            normal: normal.length(),
            cosine: (normal.dot(d) / normal.length()).abs(),
        }
    }

    fn is_on_edge(&self) -> bool {
        self.nearest <= U * self.edge * (32.0 * self.far + 4.0 * self.start)
    }

    fn distance_error(&self) -> f64 {
        let tilt = 5.0 * self.edge * self.edge * self.edge / self.normal;
        (15.0 * self.far + 2.0 * self.start + tilt) * U / self.cosine
    }
}
