//! Robust and fast: Embree's own triangle tests choose, and the choice is measured in f64.

use super::scene::{Device, Filter, Queries, Scene};
use crate::accel::BuildOptions;
use crate::error::Result;
use crate::geometry::{LocalRay, MeshSpace, TriangleHit, plane_hit};

/// A scene of triangles, in the buffers of a space.
pub(super) struct NativeTriangles<'g> {
    scene: Scene<'g, TriangleFilter>,
    space: &'g MeshSpace,
}

impl<'g> NativeTriangles<'g> {
    pub(super) fn build(
        device: &Device,
        space: &'g MeshSpace,
        options: &BuildOptions,
    ) -> Result<NativeTriangles<'g>> {
        Ok(NativeTriangles { scene: Scene::of_triangles(device, space, options)?, space })
    }

    pub(super) fn closest(&self, ray: &LocalRay) -> Option<TriangleHit> {
        let mut query = Query { space: self.space, ray, measure: false };
        let triangle = self.scene.intersect(ray, &mut query)?;
        query.hit(triangle).or_else(|| {
            // Embree and f64 disagree about the range: ask again, and measure every candidate.
            query.measure = true;
            let triangle = self.scene.intersect(ray, &mut query)?;
            query.hit(triangle)
        })
    }

    pub(super) fn any(&self, ray: &LocalRay) -> bool {
        self.scene.occluded(ray, &mut Query { space: self.space, ray, measure: true })
    }
}

/// What decides about a candidate.
struct Query<'q> {
    space: &'q MeshSpace,
    ray: &'q LocalRay,
    /// Whether a candidate must lie in range by its f64 distance too. That costs a look at its corners.
    measure: bool,
}

impl Query<'_> {
    /// The candidate's hit, if it is in (0, t_max].
    fn hit(&self, triangle: u32) -> Option<TriangleHit> {
        let corners = self.space.corners(triangle);
        let (t, u, v) = plane_hit(self.ray, corners)?;
        (t > 0.0 && t <= self.ray.t_max).then_some(TriangleHit { t, index: triangle, u, v })
    }
}

struct TriangleFilter;

impl Queries for TriangleFilter {
    type Closest<'q> = Query<'q>;
    type Any<'q> = Query<'q>;
}

impl Filter for TriangleFilter {
    fn keeps_closest(query: &mut Query<'_>, triangle: u32) -> bool {
        !query.ray.excludes(triangle) && (!query.measure || query.hit(triangle).is_some())
    }

    fn keeps_any(query: &mut Query<'_>, triangle: u32) -> bool {
        !query.ray.excludes(triangle) && query.hit(triangle).is_some_and(|hit| hit.t < query.ray.t_max)
    }
}
