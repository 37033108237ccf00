//! Shapes, and what a hit is.
//!
//! # The definition of a hit
//! The hit of a ray is the primitive with the smallest key (t, object, part) with t in (0, t_max]; t is an f64 distance
//! along the unit direction; among the triangles of one space, it is compared as it is there, before it becomes a
//! distance in the world. No traversal is in this definition: an accelerator only finds candidates, and the shared
//! routines of this module decide. A brute-force loop over all primitives is the third implementation.
//!
//! # Two kinds of primitives, two rays
//! - **Solids** (balls, boxes, rectangles) are few and may be of any size. They are decided in f64, with the f64 ray.
//! - **Triangles of meshes** are many. They are stored in f32 in a [`LocalFrame`]: moved by an f64 pivot, scaled by the
//!   power of two that brings their extent into [1, 2). The ray that all accelerators see alike is made by
//!   [`LocalFrame::localize`], in f64, from the ray of the path: moved to the mesh if it starts far away. Its roundings
//!   to f32 only find candidates; the decision is made in f64 with the f64 ray, so that a ball that rests on a floor a
//!   million times larger, or a gap of 1e-5 beside a large mesh, is seen as it is. So neither the place nor the size of
//!   a scene, nor a ball of radius 1e7 under a mesh, costs the mesh precision.
//!
//! A ray that leaves a flat primitive, or the outside of a convex one, can't meet it again: such a primitive is left
//! out by its id ([`Ray::leaving`]), which holds at every scale. Offsets only have to keep a ray off *other* surfaces.

mod ball;
mod cuboid;
mod doubles;
mod frame;
mod id;
mod instance;
mod lanes;
mod linear_solids;
mod mesh_space;
mod rectangle;
mod scene;
mod shear;
mod surface;
mod triangle;

pub use ball::Ball;
pub use cuboid::Cuboid;
pub(crate) use doubles::{Doubles, FourDoubles};
pub use frame::{LocalFrame, LocalRay};
pub use id::PrimitiveId;
pub use instance::Instance;
pub(crate) use lanes::Lanes;
pub(crate) use linear_solids::{LinearSolids, Nearest};
pub use mesh_space::{MeshEntry, MeshPart, MeshSpace};
pub use rectangle::Rectangle;
pub use scene::{Geometry, Shape, Solid};
pub(crate) use shear::{LazyShear, ShearedRay};
pub use surface::SurfacePoint;
pub(crate) use triangle::{Seen, any_in_lanes, closest_in_lanes, sheared_plane_hit};
pub use triangle::{
    TriangleBlock, TriangleHit, any_in_block, closest_in_block, intersect_triangle, plane_hit,
};

use crate::math::DVec3;

/// A ray of a path, in world space.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts; off the surface by that point's error bound.
    pub origin: DVec3,
    /// Unit direction.
    pub direction: DVec3,
    /// The geometric normal of the surface it leaves, on the side that it leaves to; zero for a camera's ray.
    pub side: DVec3,
    /// The primitive it leaves, or [`PrimitiveId::NONE`].
    pub leaving: PrimitiveId,
    /// Whether it goes into the solid that it leaves from; then it meets only the far side of that solid.
    pub inward: bool,
}

impl Ray {
    /// A ray that starts in free space.
    pub fn new(origin: DVec3, direction: DVec3) -> Ray {
        Ray { origin, direction, side: DVec3::ZERO, leaving: PrimitiveId::NONE, inward: false }
    }

    /// The point at distance `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// Whether all numbers are finite; other rays hit nothing.
    #[inline]
    pub fn is_finite(&self) -> bool {
        self.origin.is_finite() && self.direction.is_finite()
    }
}

/// What a ray meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray's direction, > 0, in world units.
    pub t: f64,
    /// Index of the object in the scene.
    pub object: u32,
    /// What was hit.
    pub primitive: PrimitiveId,
    /// Which part of it: index of the triangle in its mesh or rectangle, face of the box (0 to 5: -x +x -y +y -z +z),
    /// 0 for a ball.
    pub part: u32,
    /// First surface coordinate: of a triangle the weight of its second corner; of a rectangle or a box's face in
    /// [0, 1] from edge to edge; 0 for a ball.
    pub u: f64,
    /// Second surface coordinate: of a triangle the weight of its third corner.
    pub v: f64,
}

impl Hit {
    /// Whether this one comes before `other` by the key (t, object, part).
    #[inline]
    pub fn before(&self, other: &Hit) -> bool {
        (self.t, self.object, self.part) < (other.t, other.object, other.part)
    }
}
