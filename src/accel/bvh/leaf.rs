//! What the leaves hold: blocks of triangles at two precisions, and solids.

use super::Bvh;
use super::traverse::Leaf;
use crate::accel::{any_in_solid, closest_in_solid};
use crate::geometry::{
    Hit, Lanes, LazyShear, LocalRay, PrimitiveId, Ray, TriangleBlock, TriangleHit, any_in_lanes,
    closest_in_lanes,
};
use crate::math::round_up;

/// Blocks decided by the shared leaf.
pub(super) struct ExactTriangles<'t> {
    pub(super) blocks: &'t [TriangleBlock],
    ray: LazyShear<'t>,
    pub(super) best: Option<TriangleHit>,
    limit: f32,
}

impl<'t> ExactTriangles<'t> {
    #[inline(always)]
    pub(super) fn new(blocks: &'t [TriangleBlock], ray: &'t LocalRay) -> ExactTriangles<'t> {
        ExactTriangles { blocks, ray: LazyShear::new(ray), best: None, limit: ray.t_max32() }
    }
}

impl Leaf for ExactTriangles<'_> {
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.limit
    }

    #[inline(always)]
    fn closest<L: Lanes>(&mut self, leaf: u32, lanes: L) {
        if closest_in_lanes(&self.blocks[leaf as usize], self.ray.get(), &mut self.best, lanes)
            && let Some(best) = &self.best
        {
            self.limit = round_up(best.t);
        }
    }

    #[inline(always)]
    fn address(&self, leaf: u32) -> *const u8 {
        self.blocks.as_ptr().wrapping_add(leaf as usize).cast()
    }

    #[inline(always)]
    fn any<L: Lanes>(&mut self, leaf: u32, lanes: L) -> bool {
        any_in_lanes(&self.blocks[leaf as usize], self.ray.get(), lanes)
    }
}

/// One solid a leaf.
pub(super) struct Solids<'t> {
    /// The whole, which knows what is in instances.
    pub(super) kernel: &'t Bvh<'t>,
    /// Ids, by the index of the leaf.
    pub(super) order: &'t [u32],
    pub(super) ray: &'t Ray,
    pub(super) local: &'t LocalRay,
    pub(super) best: Option<Hit>,
    /// For any-hit: the end of the ray in world units, and what does not count.
    pub(super) t_max: f64,
    pub(super) target: PrimitiveId,
}

impl Leaf for Solids<'_> {
    #[inline(always)]
    fn limit(&self) -> f32 {
        // From the world's distance to the nodes' with all roundings of that way. The ray's own end comes first where
        // that is shorter.
        let frame = &self.kernel.geometry.solid_frame;
        let end = self.best.map_or(self.local.t_max, |best| {
            ((frame.widen(best.t) - self.local.shift) * frame.scale).min(self.local.t_max)
        });
        round_up(end)
    }

    #[inline(always)]
    fn closest<L: Lanes>(&mut self, leaf: u32, _: L) {
        self.best = closest_in_solid(self.kernel, self.order[leaf as usize], self.ray, self.best);
    }

    #[inline(always)]
    fn address(&self, leaf: u32) -> *const u8 {
        self.order.as_ptr().wrapping_add(leaf as usize).cast()
    }

    #[inline(always)]
    fn any<L: Lanes>(&mut self, leaf: u32, _: L) -> bool {
        any_in_solid(self.kernel, self.order[leaf as usize], self.ray, self.t_max, self.target)
    }
}
