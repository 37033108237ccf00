//! Balls, boxes, rectangles and instances: Embree finds their boxes, the shared f64 routines decide.

use super::Embree;
use super::scene::{BoundingBox, Device, Queries, Scene, UserGeometry, reach};
use crate::accel::{any_in_solid, closest_in_solid};
use crate::error::Result;
use crate::geometry::{Geometry, Hit, LocalRay, PrimitiveId, Ray};

/// A scene of user primitives, the `tree_solids` of the geometry.
pub(super) struct Solids<'g> {
    scene: Scene<'g, SolidBoxes<'g>>,
}

impl<'g> Solids<'g> {
    pub(super) fn build(device: &Device, geometry: &'g Geometry) -> Result<Solids<'g>> {
        let count = geometry.tree_solids.len();
        let over = format!("{count} balls, boxes, rectangles and instances");
        let scene = Scene::of_boxes(device, &SolidBoxes { geometry }, count, &over)?;
        Ok(Solids { scene })
    }

    /// `kernel` is the whole, which knows what is in instances.
    pub(super) fn closest(
        &self,
        kernel: &Embree<'g>,
        ray: &Ray,
        local: &LocalRay,
        best: Option<Hit>,
    ) -> Option<Hit> {
        let mut query = Closest { kernel, ray, local, best };
        self.scene.intersect(local, &mut query);
        query.best
    }

    pub(super) fn any(
        &self,
        kernel: &Embree<'g>,
        ray: &Ray,
        local: &LocalRay,
        t_max: f64,
        target: PrimitiveId,
    ) -> bool {
        self.scene.occluded(local, &mut Any { kernel, ray, t_max, target })
    }
}

struct SolidBoxes<'g> {
    geometry: &'g Geometry,
}

struct Closest<'q, 'g> {
    kernel: &'q Embree<'g>,
    ray: &'q Ray,
    local: &'q LocalRay,
    best: Option<Hit>,
}

struct Any<'q, 'g> {
    kernel: &'q Embree<'g>,
    ray: &'q Ray,
    t_max: f64,
    target: PrimitiveId,
}

impl<'g> Queries for SolidBoxes<'g> {
    type Closest<'q> = Closest<'q, 'q>;
    type Any<'q> = Any<'q, 'q>;
}

impl UserGeometry for SolidBoxes<'_> {
    fn bounds(&self, primitive: u32) -> Option<BoundingBox> {
        let solid = *self.geometry.tree_solids.get(primitive as usize)?;
        Some(self.geometry.solid_node_bounds(solid))
    }

    #[inline(always)]
    fn closest(query: &mut Closest<'_, '_>, primitive: u32) -> Option<f32> {
        let geometry = query.kernel.geometry;
        let solid = *geometry.tree_solids.get(primitive as usize)?;
        query.best = closest_in_solid(query.kernel, solid, query.ray, query.best);
        let frame = &geometry.solid_frame;
        let nearest = query.best.as_ref()?;
        Some(reach(((frame.widen(nearest.t) - query.local.shift) * frame.scale).max(0.0)))
    }

    #[inline(always)]
    fn any(query: &mut Any<'_, '_>, primitive: u32) -> bool {
        let solid = query.kernel.geometry.tree_solids.get(primitive as usize);
        solid.is_some_and(|&s| any_in_solid(query.kernel, s, query.ray, query.t_max, query.target))
    }
}
