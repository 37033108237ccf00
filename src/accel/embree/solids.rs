//! Balls, boxes and rectangles: Embree finds their boxes, the shared f64 routines decide.

use super::scene::{BoundingBox, Device, Queries, Scene, UserGeometry, reach};
use crate::accel::{distance, nearer};
use crate::error::Result;
use crate::geometry::{Geometry, Hit, LocalRay, PrimitiveId, Ray};

/// A scene of user primitives, the `tree_solids` of the geometry.
pub(super) struct Solids<'g> {
    scene: Scene<'g, SolidBoxes<'g>>,
    geometry: &'g Geometry,
}

impl<'g> Solids<'g> {
    pub(super) fn build(device: &Device, geometry: &'g Geometry) -> Result<Solids<'g>> {
        let scene = Scene::of_boxes(device, &SolidBoxes { geometry }, geometry.tree_solids.len())?;
        Ok(Solids { scene, geometry })
    }

    pub(super) fn closest(&self, ray: &Ray, local: &LocalRay, best: Option<Hit>) -> Option<Hit> {
        let mut query = Closest { geometry: self.geometry, ray, local, best };
        self.scene.intersect(local, &mut query);
        query.best
    }

    pub(super) fn any(&self, ray: &Ray, local: &LocalRay, t_max: f64, target: PrimitiveId) -> bool {
        self.scene.occluded(local, &mut Any { geometry: self.geometry, ray, t_max, target })
    }
}

struct SolidBoxes<'g> {
    geometry: &'g Geometry,
}

struct Closest<'q> {
    geometry: &'q Geometry,
    ray: &'q Ray,
    local: &'q LocalRay,
    best: Option<Hit>,
}

struct Any<'q> {
    geometry: &'q Geometry,
    ray: &'q Ray,
    t_max: f64,
    target: PrimitiveId,
}

impl Queries for SolidBoxes<'_> {
    type Closest<'q> = Closest<'q>;
    type Any<'q> = Any<'q>;
}

impl UserGeometry for SolidBoxes<'_> {
    fn bounds(&self, primitive: u32) -> Option<BoundingBox> {
        let solid = *self.geometry.tree_solids.get(primitive as usize)?;
        Some(self.geometry.solid_node_bounds(solid))
    }

    #[inline(always)]
    fn closest(query: &mut Closest<'_>, primitive: u32) -> Option<f32> {
        let solid = *query.geometry.tree_solids.get(primitive as usize)?;
        let hit = query.geometry.intersect_solid(solid, query.ray, distance(&query.best))?;
        query.best = nearer(query.best, Some(hit));
        let frame = &query.geometry.solid_frame;
        let local_t = (frame.widen(distance(&query.best)) - query.local.shift) * frame.scale;
        Some(reach(local_t.max(0.0)))
    }

    #[inline(always)]
    fn any(query: &mut Any<'_>, primitive: u32) -> bool {
        let solid = query.geometry.tree_solids.get(primitive as usize);
        solid.is_some_and(|&s| query.geometry.solid_occludes(s, query.ray, query.t_max, query.target))
    }
}
