//! The f32 leaf of [`crate::accel::Precision::Fast`]: eight triangles at once, no second look in f64.

use super::traverse::Leaf;
use crate::geometry::{
    Lanes, LazyShear, LocalRay, Seen, ShearedRay, TriangleBlock, TriangleHit, sheared_plane_hit,
};
use crate::math::DVec3;

/// Blocks decided in f32. Rays may slip through edges; neighbours do not agree on them.
pub(super) struct FastTriangles<'t> {
    pub(super) blocks: &'t [TriangleBlock],
    ray: LazyShear<'t>,
    /// Distance of the best hit, or the end of the ray.
    t: f32,
    best: Option<Winner>,
}

/// Where the best hit is: fetching its corners by index would touch memory that the traversal has not.
#[derive(Clone, Copy)]
struct Winner {
    index: u32,
    leaf: u32,
    lane: usize,
}

impl<'t> FastTriangles<'t> {
    #[inline(always)]
    pub(super) fn new(blocks: &'t [TriangleBlock], ray: &'t LocalRay) -> FastTriangles<'t> {
        FastTriangles { blocks, ray: LazyShear::new(ray), t: ray.t_max32(), best: None }
    }

    /// The best hit, its t, u and v computed in f64.
    #[inline(always)]
    pub(super) fn hit(&mut self) -> Option<TriangleHit> {
        let Winner { index, leaf, lane } = self.best?;
        let corners = self.blocks[leaf as usize].corners_of(lane & 7);
        let (t, u, v) = sheared_plane_hit(self.ray.get(), corners)?;
        Some(TriangleHit { t, index, u, v })
    }
}

impl Leaf for FastTriangles<'_> {
    #[inline(always)]
    fn limit(&self) -> f32 {
        self.t
    }

    #[inline(always)]
    fn closest<L: Lanes>(&mut self, leaf: u32, lanes: L) {
        let block = &self.blocks[leaf as usize];
        let (mut mask, distances) = hits(block, self.ray.get(), self.t, lanes);
        if mask == 0 {
            return;
        }
        let distances = lanes.to_array(distances);
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            let (t, index) = (distances[lane], block.lane_index(lane));
            let tie = t == self.t && self.best.is_none_or(|best| index < best.index);
            if (t < self.t || tie)
                && !self.ray.local().excludes(index)
                && is_ahead(t, self.ray.get(), block, lane)
            {
                (self.t, self.best) = (t, Some(Winner { index, leaf, lane }));
            }
        }
    }

    #[inline(always)]
    fn address(&self, leaf: u32) -> *const u8 {
        self.blocks.as_ptr().wrapping_add(leaf as usize).cast()
    }

    #[inline(always)]
    fn any<L: Lanes>(&mut self, leaf: u32, lanes: L) -> bool {
        let block = &self.blocks[leaf as usize];
        let (mut mask, distances) = hits(block, self.ray.get(), self.t, lanes);
        if mask == 0 {
            return false;
        }
        let distances = lanes.to_array(distances);
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            let t = distances[lane];
            if t < self.t
                && !self.ray.local().excludes(block.lane_index(lane))
                && is_ahead(t, self.ray.get(), block, lane)
            {
                return true;
            }
        }
        false
    }
}

/// Up to here f32 can't tell what is ahead of the start of a ray: the start is within 8 of the local origin
/// ([`crate::geometry::LocalFrame::localize`]), which leaves depths wrong by up to some 2^-19, and distances by a few times
/// that where a triangle is not seen edge-on.
const NEAR: f32 = 1.0 / 65_536.0;

/// Whether the hit of a lane lies ahead of the start. A face may lie on the one that the ray leaves; both would shade each
/// other.
#[inline(always)]
fn is_ahead(t: f32, ray: &ShearedRay, block: &TriangleBlock, lane: usize) -> bool {
    t > NEAR || is_ahead_in_f64(ray, block.corners_of(lane))
}

#[cold]
fn is_ahead_in_f64(ray: &ShearedRay, corners: [DVec3; 3]) -> bool {
    sheared_plane_hit(ray, corners).is_some_and(|(t, ..)| t > 0.0)
}

/// A bit for every lane, from the lowest on, that is hit at a distance in (0, `limit`]; and the distances.
///
/// Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1) 2013, without its second look at edges that
/// are hit exactly.
#[inline(always)]
fn hits<L: Lanes>(block: &TriangleBlock, ray: &ShearedRay, limit: f32, lanes: L) -> (u32, L::Floats) {
    let Seen { corners: [a, b, c], areas: [u, v, w] } = block.seen(ray, lanes);
    let zero = lanes.splat(0.0);
    let sum = lanes.add(lanes.add(u, v), w);
    let depths = lanes.add(lanes.add(lanes.mul(u, a[2]), lanes.mul(v, b[2])), lanes.mul(w, c[2]));
    // 0 / 0 without an area: NaN, no hit.
    let distances = lanes.mul(lanes.div(depths, sum), lanes.splat(ray.stretch32));
    let (least, most) = (lanes.min(lanes.min(u, v), w), lanes.max(lanes.max(u, v), w));
    let inside = lanes.at_most(zero, least) | lanes.at_most(most, zero);
    let beyond = lanes.at_most(lanes.splat(f32::MIN_POSITIVE), distances);
    (inside & beyond & lanes.at_most(distances, lanes.splat(limit)), distances)
}
