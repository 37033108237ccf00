//! Names of primitives.

/// Names a primitive of a [`super::Geometry`]: a solid, a triangle of a mesh that lies in the world, or a triangle of an
/// instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PrimitiveId {
    /// A space of triangles, or a solid from 2^31 on.
    body: u32,
    /// [`PrimitiveId::NO_TRIANGLE`] of a solid that is no instance.
    triangle: u32,
}

impl PrimitiveId {
    /// No primitive.
    pub const NONE: PrimitiveId = PrimitiveId { body: u32::MAX, triangle: Self::NO_TRIANGLE };
    /// An index that no triangle has.
    pub const NO_TRIANGLE: u32 = u32::MAX;
    const SOLID: u32 = 1 << 31;

    /// A triangle of a space in world coordinates; the index of the space is below 2^31.
    #[inline]
    pub fn triangle(space: u32, triangle: u32) -> PrimitiveId {
        PrimitiveId { body: space, triangle }
    }

    /// The solid with this index; below 2^31 - 1.
    #[inline]
    pub fn solid(index: u32) -> PrimitiveId {
        PrimitiveId { body: index | Self::SOLID, triangle: Self::NO_TRIANGLE }
    }

    /// A triangle of the instance that is the solid with this index.
    pub fn of_instance(solid: u32, triangle: u32) -> PrimitiveId {
        PrimitiveId { triangle, ..Self::solid(solid) }
    }

    /// The index of the solid, if this is one or a part of one.
    #[inline]
    pub fn as_solid(self) -> Option<u32> {
        (self.body & Self::SOLID != 0 && self != Self::NONE).then_some(self.body & !Self::SOLID)
    }

    /// The index of the triangle in its space, if this is one, of an instance or not.
    #[inline]
    pub fn as_triangle(self) -> Option<u32> {
        (self.triangle != Self::NO_TRIANGLE).then_some(self.triangle)
    }

    /// The space of a triangle in world coordinates.
    #[inline]
    pub fn space(self) -> Option<u32> {
        (self.body & Self::SOLID == 0).then_some(self.body)
    }

    /// The index of the triangle, if it is one of the same body as `other`; else an index that no triangle has.
    #[inline(always)]
    pub(super) fn triangle_beside(self, other: PrimitiveId) -> u32 {
        if self.body == other.body { self.triangle } else { Self::NO_TRIANGLE }
    }
}
