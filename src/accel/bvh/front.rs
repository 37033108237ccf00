//! The whole way of a ray, from the world through the triangles' trees and back, in one instruction set.

use super::fast::FastTriangles;
use super::leaf::ExactTriangles;
use super::node::NodeRay;
use super::simd::NodeTest;
use super::{Bvh, TriangleTree, traverse};
use crate::accel::Kernel;
use crate::geometry::{Geometry, Hit, LocalRay, PrimitiveId, Ray, TriangleHit};

/// A [`Bvh`] in the instructions of `lanes`, at [`crate::accel::Precision::Fast`] or not.
///
/// Everything about the triangles of the world is inlined into the entry points of [`super::simd`]: the ray and its hit stay
/// in registers, where calls between instruction sets would hand them over in memory. Solids, and the triangles of
/// instances among them, are left to the [`Bvh`].
pub(super) struct Using<'b, S, const FAST: bool> {
    pub(super) bvh: &'b Bvh<'b>,
    pub(super) lanes: S,
}

impl<S: NodeTest + Sync, const FAST: bool> Kernel for Using<'_, S, FAST> {
    #[inline(always)]
    fn geometry(&self) -> &Geometry {
        self.bvh.geometry
    }

    #[inline(always)]
    fn closest_triangle(&self, space: u32, ray: &LocalRay) -> Option<TriangleHit> {
        let node_ray = NodeRay::new(ray);
        let TriangleTree { nodes, blocks } = &self.bvh.triangles[space as usize];
        if FAST {
            let mut leaf = FastTriangles::new(blocks, ray);
            traverse::closest(nodes, &node_ray, &mut leaf, self.lanes);
            return leaf.hit();
        }
        let mut leaf = ExactTriangles::new(blocks, ray);
        traverse::closest(nodes, &node_ray, &mut leaf, self.lanes);
        leaf.best
    }

    #[inline(always)]
    fn any_triangle(&self, space: u32, ray: &LocalRay) -> bool {
        let node_ray = NodeRay::new(ray);
        let TriangleTree { nodes, blocks } = &self.bvh.triangles[space as usize];
        if FAST {
            return traverse::any(nodes, &node_ray, &mut FastTriangles::new(blocks, ray), self.lanes);
        }
        traverse::any(nodes, &node_ray, &mut ExactTriangles::new(blocks, ray), self.lanes)
    }

    #[inline]
    fn closest_linear_solid(&self, ray: &Ray) -> Option<Hit> {
        self.bvh.closest_linear_solid(ray)
    }

    #[inline]
    fn any_linear_solid(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        self.bvh.any_linear_solid(ray, t_max, target)
    }

    #[inline]
    fn closest_solid(&self, ray: &Ray, local: &LocalRay, best: Option<Hit>) -> Option<Hit> {
        self.bvh.closest_solid(ray, local, best)
    }

    #[inline]
    fn any_solid(&self, ray: &Ray, local: &LocalRay, t_max: f64, target: PrimitiveId) -> bool {
        self.bvh.any_solid(ray, local, t_max, target)
    }
}
