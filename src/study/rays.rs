//! Sets of rays, and the chords of a scene.

use super::random::Random;
use super::triangles;
use crate::accel::Accelerator;
use crate::geometry::{Geometry, PrimitiveId, Ray};
use crate::math::{Bounds, DVec3};

/// What a ray is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RayKind {
    /// The first of a path: neighbours are alike.
    Primary,
    /// A later one of a path, to the closest hit.
    Bounce,
    /// Asks for any hit before a distance.
    Shadow,
    /// A chord of the sphere around the scene, to the closest hit.
    Random,
}

impl RayKind {
    /// In the order of tables.
    pub const ALL: [RayKind; 4] = [RayKind::Primary, RayKind::Bounce, RayKind::Shadow, RayKind::Random];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            RayKind::Primary => "primary",
            RayKind::Bounce => "bounce",
            RayKind::Shadow => "shadow",
            RayKind::Random => "random",
        }
    }

    /// Whether any hit answers the question.
    pub fn asks_any(self) -> bool {
        self == RayKind::Shadow
    }
}

/// A question to an accelerator.
#[derive(Clone, Copy, Debug)]
pub struct Query {
    /// The ray.
    pub ray: Ray,
    /// Of a shadow ray: before which distance it asks; else infinite.
    pub t_max: f64,
    /// Of a shadow ray: what does not stop it.
    pub target: PrimitiveId,
}

impl Query {
    /// A question for the closest hit.
    pub fn closest(ray: Ray) -> Query {
        Query { ray, t_max: f64::INFINITY, target: PrimitiveId::NONE }
    }
}

/// Rays of one kind.
#[derive(Clone, Debug)]
pub struct RaySet {
    /// What they ask.
    pub kind: RayKind,
    /// The rays in the order in which they are traced.
    pub queries: Vec<Query>,
}

/// Asks an accelerator every question of one kind; how many were answered by a hit.
pub fn count_hits<A: Accelerator + ?Sized>(accelerator: &A, kind: RayKind, queries: &[Query]) -> u64 {
    let hits = |query: &Query| {
        if kind.asks_any() {
            accelerator.occluded(&query.ray, query.t_max, query.target)
        } else {
            accelerator.intersect(&query.ray).is_some()
        }
    };
    queries.iter().map(|query| u64::from(hits(query))).sum()
}

/// A sphere, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre.
    pub center: DVec3,
    /// Radius.
    pub radius: f64,
}

/// An object is left out of the scene's sphere if it is so many times larger than the median one: a ball underfoot, a
/// wide floor.
const LARGE: f64 = 16.0;

impl Sphere {
    /// The sphere around the box of all objects but the huge ones; `None` without any object.
    pub fn around(geometry: &Geometry) -> Option<Sphere> {
        let solids = 0..geometry.solids.len() as u32;
        let mut all: Vec<Bounds> = solids.map(|solid| geometry.solid_bounds(solid)).collect();
        all.extend(triangles::mesh_bounds(geometry));
        let extent = |bounds: &Bounds| (bounds.max - bounds.min).max_element();
        all.sort_by(|a, b| extent(a).total_cmp(&extent(b)));
        let largest = LARGE * extent(all.get(all.len().saturating_sub(1) / 2)?);
        let kept = all.into_iter().filter(|bounds| extent(bounds) <= largest);
        let bounds = kept.fold(Bounds::EMPTY, Bounds::union);
        Some(Sphere { center: bounds.center(), radius: 0.5 * (bounds.max - bounds.min).length() })
    }

    /// `count` chords between random points of the sphere.
    pub fn chords(&self, count: usize, seed: u64) -> RaySet {
        let mut random = Random::new(seed);
        let mut chord = || loop {
            let [from, to] = [0; 2].map(|_| self.center + random.direction() * self.radius);
            let direction = (to - from).normalize();
            if direction.is_finite() {
                return Query::closest(Ray::new(from, direction));
            }
        };
        RaySet { kind: RayKind::Random, queries: (0..count).map(|_| chord()).collect() }
    }
}

/// `count` items evenly out of a list, in its order.
pub(super) fn thinned<T: Copy>(items: Vec<T>, count: usize) -> Vec<T> {
    if items.len() <= count {
        return items;
    }
    (0..count).map(|i| items[i * items.len() / count]).collect()
}
