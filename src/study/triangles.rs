//! The only part of the studies that knows how a [`Geometry`] keeps its triangles.

use crate::geometry::{
    Geometry, Hit, Instance, LocalRay, MeshPart, MeshSpace, PrimitiveId, Ray, Shape, Solid,
};
use crate::math::{Bounds, DVec3};
use std::ops::Range;

/// A geometry of one mesh.
pub(super) fn geometry_of(mesh: MeshPart) -> Geometry {
    Geometry::new(Vec::new(), &[mesh])
}

/// How many triangles there are in memory.
pub(super) fn count(geometry: &Geometry) -> usize {
    geometry.triangle_count()
}

/// The instance that a solid is.
pub(super) fn as_instance(solid: &Solid) -> Option<&Instance> {
    match &solid.shape {
        Shape::Instance(instance) => Some(instance),
        _ => None,
    }
}

/// How many primitives a ray may meet: solids, and triangles as often as they are seen.
pub(super) fn seen_count(geometry: &Geometry) -> usize {
    let of_solid = |solid| as_instance(solid).map_or(1, |i: &Instance| geometry.space_of(i).triangles.len());
    let solids: usize = geometry.solids.iter().map(of_solid).sum();
    solids + geometry.world_spaces().map(|(_, space)| space.triangles.len()).sum::<usize>()
}

/// The corners of a triangle in world space, as they were rounded for the accelerators; of a geometry of one mesh.
pub(super) fn world_corners(geometry: &Geometry, triangle: usize) -> [DVec3; 3] {
    let space = &geometry.spaces[0];
    space.corners(triangle as u32).map(|corner| space.frame.to_world(corner))
}

/// The box around every mesh that lies in the world.
pub(super) fn mesh_bounds(geometry: &Geometry) -> Vec<Bounds> {
    let of_space = |(_, space): (u32, &MeshSpace)| {
        let bounds = |range: Range<u32>| {
            let corners = range.flat_map(|triangle| space.corners(triangle));
            corners.map(|corner| space.frame.to_world(corner)).fold(Bounds::EMPTY, Bounds::with_point)
        };
        space.mesh_ranges().map(|(_, range)| bounds(range)).collect::<Vec<Bounds>>()
    };
    geometry.world_spaces().flat_map(of_space).collect()
}

/// A triangle that was hit, in the space in which it was decided.
pub(super) struct LocalTriangle {
    pub(super) ray: LocalRay,
    pub(super) corners: [DVec3; 3],
    /// Local length of one world unit.
    pub(super) scale: f64,
}

/// What a ray saw of the triangle it hit; `None` if the hit is a solid's.
pub(super) fn local_triangle(geometry: &Geometry, ray: &Ray, hit: &Hit) -> Option<LocalTriangle> {
    let triangle = hit.primitive.as_triangle()?;
    let everywhere = f64::INFINITY;
    if let Some(space) = hit.primitive.space() {
        let ray = geometry.localize(space, ray, everywhere, PrimitiveId::NONE)?;
        let space = &geometry.spaces[space as usize];
        return Some(LocalTriangle { ray, corners: space.corners(triangle), scale: space.frame.scale });
    }
    let solid = hit.primitive.as_solid()?;
    let instance = as_instance(&geometry.solids[solid as usize])?;
    let space = geometry.space_of(instance);
    let ray = instance.localize(space, solid, ray, everywhere, PrimitiveId::NONE)?;
    let scale = space.frame.scale / instance.scale;
    Some(LocalTriangle { ray, corners: space.corners(triangle), scale })
}
