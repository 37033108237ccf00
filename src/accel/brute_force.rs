//! A loop over all primitives: the definition of a hit as code, and the tests' oracle.

use super::{Kernel, any_in_solid, closest_in_solid};
use crate::geometry::{Geometry, Hit, LocalRay, PrimitiveId, Ray, TriangleHit, intersect_triangle};

/// Tries every primitive; exact.
pub struct BruteForce<'g> {
    geometry: &'g Geometry,
}

impl<'g> BruteForce<'g> {
    /// Needs no building.
    pub fn new(geometry: &'g Geometry) -> BruteForce<'g> {
        BruteForce { geometry }
    }

    fn hits<'r>(&'r self, space: u32, ray: &'r LocalRay) -> impl Iterator<Item = TriangleHit> + 'r {
        let mesh = &self.geometry.spaces[space as usize];
        let triangles = 0..mesh.triangles.len() as u32;
        triangles.filter(|&index| !ray.excludes(index)).filter_map(|index| {
            let (t, u, v) = intersect_triangle(ray, mesh.corners(index))?;
            (t > 0.0).then_some(TriangleHit { t, index, u, v })
        })
    }
}

impl Kernel for BruteForce<'_> {
    fn geometry(&self) -> &Geometry {
        self.geometry
    }

    fn closest_triangle(&self, space: u32, ray: &LocalRay) -> Option<TriangleHit> {
        self.hits(space, ray)
            .filter(|hit| hit.t <= ray.t_max)
            .min_by(|a, b| a.t.total_cmp(&b.t).then(a.index.cmp(&b.index)))
    }

    fn any_triangle(&self, space: u32, ray: &LocalRay) -> bool {
        self.hits(space, ray).any(|hit| hit.t < ray.t_max)
    }

    fn closest_solid(&self, ray: &Ray, _: &LocalRay, best: Option<Hit>) -> Option<Hit> {
        let solids = self.geometry.tree_solids.iter();
        solids.fold(best, |best, &solid| closest_in_solid(self, solid, ray, best))
    }

    fn any_solid(&self, ray: &Ray, _: &LocalRay, t_max: f64, target: PrimitiveId) -> bool {
        self.geometry.tree_solids.iter().any(|&solid| any_in_solid(self, solid, ray, t_max, target))
    }
}
