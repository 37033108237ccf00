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
    /// The middle of a ball in the world around the mesh.
    center: DVec3,
    /// Its radius, widened by what roundings could hide.
    radius: f64,
}

impl Instance {
    /// The mesh of `space`, which is the one with the index `index`, turned by `rotation` (orthonormal), `scale` > 0 times
    /// as large, its origin at `position`.
    pub fn new(index: u32, space: &MeshSpace, rotation: DMat3, scale: f64, position: DVec3) -> Instance {
        let flat = Instance { space: index, rotation, scale, position, center: position, radius: 0.0 };
        let Bounds { min, max } = space.frame.bounds;
        let center = flat.to_world(space.frame.to_world(min * 0.5 + max * 0.5));
        let radius = ((max - min) * 0.5).length() / space.frame.scale * scale;
        // Corners are rounded by up to 2^-23 of the frame, places by a few f64 roundings.
        let places = (center.abs() + position.abs()).element_sum() * 4.0 * ROUNDINGS;
        Instance { center, radius: radius * (1.0 + 1.0 / 1_048_576.0) + places, ..flat }
    }

    /// Whether a ray passes by the ball around the mesh within `t_max`: a few operations for most rays, before those of
    /// bringing it into the space of the mesh.
    #[inline(always)]
    fn is_passed_by(&self, ray: &Ray, t_max: f64) -> bool {
        let to = self.center - ray.origin;
        let along = to.dot(ray.direction);
        let beside = (to - ray.direction * along).length_squared();
        // Directions have a length of 1 to within 1e-9; what that and roundings do to the distances here is less.
        let reach = self.radius + to.abs().element_sum() * 1e-8;
        beside > reach * reach || along < -reach || along - reach > t_max
    }

    /// A point of the mesh in the world.
    pub fn to_world(self, p: DVec3) -> DVec3 {
        self.rotation * p * self.scale + self.position
    }

    /// A point of the world in the mesh's units.
    pub(crate) fn in_mesh(&self, p: DVec3) -> DVec3 {
        self.rotation.transpose() * ((p - self.position) / self.scale)
    }

    /// The ray as the mesh sees it; distances along it are in the mesh's units.
    fn seen_by_mesh(&self, ray: &Ray) -> Ray {
        let back = self.rotation.transpose();
        Ray {
            origin: self.in_mesh(ray.origin),
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
        if self.is_passed_by(ray, t_max) {
            return None;
        }
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
