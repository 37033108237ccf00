//! A mesh that is in the scene several times: one space of triangles, seen from many places.
//!
//! An instance is a body like a ball: its box is in the tree of the solids, in world space, and the ray that meets it is
//! brought into the space of the mesh in f64, by the same routine for every accelerator. So all of them decide about the
//! same ray, and hits are equal to the last bit without being equal to those of a copy of the mesh in the world, whose
//! corners are rounded elsewhere.

use super::frame::LocalRay;
use super::surface::ROUNDINGS;
use super::{MeshSpace, PrimitiveId, Ray, SurfacePoint};
use crate::math::{Bounds, DMat3, DVec3};

/// Where a mesh stands.
#[derive(Clone, Copy, Debug)]
pub struct Instance {
    /// Index of the mesh's space.
    pub space: u32,
    /// From the mesh's axes to the world's: orthonormal; it may mirror.
    pub rotation: DMat3,
    /// World length of one unit of the mesh, > 0.
    pub scale: f64,
    /// Where the mesh's origin is in the world.
    pub position: DVec3,
}

impl Instance {
    /// A point of the mesh in the world.
    pub fn to_world(self, p: DVec3) -> DVec3 {
        self.rotation * p * self.scale + self.position
    }

    /// The ray as the mesh sees it; distances along it are in the mesh's units.
    fn seen_by_mesh(&self, ray: &Ray) -> Ray {
        let back = self.rotation.transpose();
        Ray {
            origin: back * ((ray.origin - self.position) / self.scale),
            direction: back * ray.direction,
            side: back * ray.side,
            ..*ray
        }
    }

    /// The ray in the local space of the mesh, for hits up to the world distance `t_max`; `None` if it misses the mesh.
    /// `solid` is the instance's own index.
    pub fn localize(
        &self,
        space: &MeshSpace,
        solid: u32,
        ray: &Ray,
        t_max: f64,
        target: PrimitiveId,
    ) -> Option<LocalRay> {
        let body = PrimitiveId::solid(solid);
        let excluded = [ray.leaving, target].map(|id| id.triangle_beside(body));
        space.frame.localize(&self.seen_by_mesh(ray), t_max / self.scale, excluded)
    }

    /// A box in the world around the mesh's box.
    pub fn bounds(&self, space: &MeshSpace) -> Bounds {
        let Bounds { min, max } = space.frame.bounds;
        let (low, high) = (space.frame.to_world(min), space.frame.to_world(max));
        let (center, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let middle = self.to_world(center);
        let reach = DMat3::from_cols(
            self.rotation.x_axis.abs(),
            self.rotation.y_axis.abs(),
            self.rotation.z_axis.abs(),
        );
        // The roundings of the matrix products above, and those of the corners to f32 (2^-24 of the mesh's extent).
        let half = reach * half * self.scale * (1.0 + 1.0 / 4_194_304.0);
        let error = (middle.abs() + half + center.abs().element_sum() * self.scale) * ROUNDINGS;
        Bounds { min: middle - half - error, max: middle + half + error }
    }

    /// The point of a triangle of the mesh in the world.
    pub(super) fn point(&self, space: &MeshSpace, triangle: u32, u: f64, v: f64) -> SurfacePoint {
        let local = space.point(triangle, u, v);
        // What is outside of the mesh stays outside, mirrored or not.
        let normal = self.rotation * local.normal;
        // Turning mixes the components, and costs as many roundings again.
        let turned = DVec3::splat(local.error.element_sum() * 2.0 * self.scale);
        let error = turned + self.position.abs() * ROUNDINGS;
        SurfacePoint::of_sheet(self.to_world(local.position), normal, error)
    }
}
