//! The point where a ray arrives, and rays that leave it.

use super::{Geometry, Hit, PrimitiveId, Ray, Shape};
use crate::math::{DVec3, EPSILON};

/// A point of a surface, in world space.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Where; on the surface to within `error`.
    pub position: DVec3,
    /// Unit geometric normal: outward of balls and boxes, the front of rectangles, the counter-clockwise side of
    /// triangles.
    pub normal: DVec3,
    /// Bound of each component's error in `position`.
    pub error: DVec3,
    /// What it belongs to.
    pub primitive: PrimitiveId,
    /// Whether the primitive is the surface of a body that a ray can be inside of: balls and boxes.
    closed: bool,
}

impl SurfacePoint {
    /// A point of a surface that has no inside; it belongs to no primitive yet.
    pub(super) fn of_sheet(position: DVec3, normal: DVec3, error: DVec3) -> SurfacePoint {
        SurfacePoint { position, normal, error, primitive: PrimitiveId::NONE, closed: false }
    }

    /// A point of no surface, from which things are only looked at.
    pub fn nowhere(position: DVec3) -> SurfacePoint {
        SurfacePoint::of_sheet(position, DVec3::ZERO, DVec3::ZERO)
    }

    /// A ray that leaves in the unit direction `direction`. Its origin is moved by the error bound along the normal
    /// (Pharr, Jakob, Humphreys, "Physically Based Rendering" 4th ed., 6.8.6), here in f64.
    #[inline]
    pub fn leave(&self, direction: DVec3) -> Ray {
        let outward = direction.dot(self.normal) > 0.0;
        let side = if outward { self.normal } else { -self.normal };
        Ray {
            origin: self.beside(side),
            direction,
            side,
            leaving: self.primitive,
            inward: self.closed && !outward,
        }
    }

    /// The ray to another surface's point, and its length; `None` if the two are so near that their error bounds hide
    /// the direction. Both ends are moved off their surfaces.
    #[inline]
    pub fn leave_to(&self, target: &SurfacePoint) -> Option<(Ray, f64)> {
        let toward = target.position - self.position;
        let side_here = if toward.dot(self.normal) > 0.0 { self.normal } else { -self.normal };
        let side_there = if toward.dot(target.normal) < 0.0 { target.normal } else { -target.normal };
        let origin = self.beside(side_here);
        let way = target.beside(side_there) - origin;
        let length = way.length();
        // Offsets that turn the way round to the other side of the surface hide it too: at a point of one surface that lies
        // on another one.
        if !(way.dot(toward) > 0.0 && way.dot(side_here) >= 0.0 && length.is_finite()) {
            return None;
        }
        let direction = way * length.recip();
        let ray = Ray {
            origin,
            direction,
            side: side_here,
            leaving: self.primitive,
            inward: self.closed && side_here != self.normal,
        };
        Some((ray, length))
    }

    #[inline]
    fn beside(&self, side: DVec3) -> DVec3 {
        self.position + side * self.error.dot(side.abs())
    }
}

/// Roundings of a position: those of its own computation, of moving it and of the next ray's first steps.
pub(super) const ROUNDINGS: f64 = 16.0 * EPSILON;

impl Geometry {
    /// The point of a hit of `ray`.
    #[inline]
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        match hit.primitive.as_solid() {
            Some(solid) => self.solid_surface(solid, ray, hit),
            None => self.triangle_point(hit.primitive, hit.u, hit.v),
        }
    }

    #[inline]
    fn solid_surface(&self, solid: u32, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let shape = &self.solids[solid as usize].shape;
        let (origin, direction) = (ray.origin, ray.direction);
        let (center, offset, normal) = match shape {
            Shape::Ball(ball) => {
                let normal = ball.normal_at(origin, direction, hit.t);
                (ball.center, normal * ball.radius, normal)
            }
            Shape::Cuboid(cuboid) => {
                let offset = cuboid.rotation * cuboid.point_on_face(origin, direction, hit.t, hit.part);
                (cuboid.center, offset, cuboid.face_normal(hit.part))
            }
            Shape::Rectangle(rectangle) => {
                (rectangle.center, rectangle.offset_at(hit.u, hit.v), rectangle.normal)
            }
            Shape::Instance(_) => return self.triangle_point(hit.primitive, hit.u, hit.v),
        };
        self.solid_point(solid, center, offset, normal)
    }

    /// The point of a solid at `offset` from its centre.
    #[inline]
    pub fn solid_point(&self, solid: u32, center: DVec3, offset: DVec3, normal: DVec3) -> SurfacePoint {
        // Of a turned body every component of the offset takes part in every other.
        let shape = &self.solids[solid as usize].shape;
        let size = match shape {
            Shape::Ball(ball) => ball.radius,
            Shape::Cuboid(cuboid) => cuboid.half.length(),
            Shape::Rectangle(rectangle) => rectangle.reach,
            Shape::Instance(_) => offset.length(),
        };
        let position = center + offset;
        SurfacePoint {
            position,
            normal,
            error: (center.abs() + size) * ROUNDINGS,
            primitive: PrimitiveId::solid(solid),
            closed: matches!(shape, Shape::Ball(_) | Shape::Cuboid(_)),
        }
    }

    /// The edges of a triangle, of an instance or not, from its first corner to the second and the third, and the world
    /// length of their unit; their directions are turned alike, not those of the world. `None` of other primitives.
    pub fn triangle_edges(&self, primitive: PrimitiveId) -> Option<([DVec3; 2], f64)> {
        let triangle = primitive.as_triangle()?;
        let (space, scale) = match primitive.as_solid().map(|solid| &self.solids[solid as usize].shape) {
            Some(Shape::Instance(instance)) => (self.space_of(instance), instance.scale),
            _ => (&self.spaces[primitive.space()? as usize], 1.0),
        };
        let [a, b, c] = space.corners(triangle);
        Some(([b - a, c - a], scale * space.frame.inverse_scale))
    }

    /// The point of a triangle, of an instance or not, with these weights of its second and third corner.
    #[inline]
    pub fn triangle_point(&self, primitive: PrimitiveId, u: f64, v: f64) -> SurfacePoint {
        let triangle = primitive.as_triangle().unwrap_or_default();
        let point = match primitive.as_solid().map(|solid| &self.solids[solid as usize].shape) {
            Some(Shape::Instance(instance)) => instance.point(self.space_of(instance), triangle, u, v),
            _ => self.spaces[primitive.space().unwrap_or_default() as usize].point(triangle, u, v),
        };
        SurfacePoint { primitive, ..point }
    }
}
