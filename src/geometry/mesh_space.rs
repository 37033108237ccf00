//! Triangles that share a local f32 space.

use super::frame::LocalRay;
use super::surface::ROUNDINGS;
use super::{LocalFrame, SurfacePoint, TriangleHit};
use crate::math::{Bounds, DVec3};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::ops::Range;

/// A mesh on its way into a [`super::Geometry`]: corners in world space, or of a mesh that has instances in the space of
/// its file.
#[derive(Clone, Debug, Default)]
pub struct MeshPart {
    /// Index of the object in the scene; means nothing for a mesh that has instances.
    pub object: u32,
    /// Corners.
    pub positions: Vec<DVec3>,
    /// Indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
}

/// Triangles in the f32 coordinates of one [`LocalFrame`].
#[derive(Clone, Debug)]
pub struct MeshSpace {
    /// From outer coordinates to the local ones: from the world's, or from those of the file of a mesh that has
    /// instances.
    pub frame: LocalFrame,
    /// Corners; the last one is a copy, so that 16 bytes can be read from every corner.
    pub vertices: Vec<[f32; 3]>,
    /// Corners of the triangles; a mesh's triangles follow each other, meshes in the order of the scene.
    pub triangles: Vec<[u32; 3]>,
    /// The meshes in it, ascending by object and by first triangle.
    pub meshes: Vec<MeshEntry>,
}

/// A mesh of a space.
#[derive(Clone, Copy, Debug)]
pub struct MeshEntry {
    /// Index of the object in the scene; means nothing for a mesh that has instances.
    pub object: u32,
    /// Index of its first triangle.
    pub first: u32,
    /// Its largest side, in outer units, before corners were rounded.
    pub extent: f64,
    /// By how much, at most, its corners were moved along an axis when they were rounded, in outer units.
    pub rounding: f64,
}

impl MeshSpace {
    /// Brings meshes into a space of their own; they ascend by object, all numbers are finite. They are taken, so that large
    /// ones are not in memory twice.
    pub fn new(meshes: Vec<MeshPart>) -> MeshSpace {
        let corners = || meshes.iter().flat_map(|mesh| mesh.positions.iter().copied());
        let frame = LocalFrame::around(corners().fold(Bounds::EMPTY, Bounds::with_point), median(corners));
        let vertices = meshes.iter().map(|mesh| mesh.positions.len()).sum::<usize>() + 1;
        let mut space = MeshSpace {
            frame,
            vertices: Vec::with_capacity(vertices),
            triangles: Vec::new(),
            meshes: Vec::with_capacity(meshes.len()),
        };
        meshes.into_iter().for_each(|mesh| space.add(mesh));
        space.vertices.extend(space.vertices.last().copied());
        space
    }

    fn add(&mut self, mesh: MeshPart) {
        let MeshPart { object, positions, triangles } = mesh;
        let first = self.vertices.len() as u32;
        let (mut moved, mut bounds) = (0f64, Bounds::EMPTY);
        for position in positions {
            bounds = bounds.with_point(position);
            let exact = self.frame.to_local(position);
            let rounded = exact.as_vec3();
            moved = moved.max((exact - rounded.as_dvec3()).abs().max_element());
            self.vertices.push(rounded.to_array());
        }
        self.meshes.push(MeshEntry {
            object,
            first: self.triangles.len() as u32,
            extent: bounds.extent(),
            rounding: moved / self.frame.scale,
        });
        if self.triangles.is_empty() {
            self.triangles = triangles;
        } else {
            self.triangles.extend(triangles.into_iter().map(|t| t.map(|corner| corner + first)));
        }
    }

    /// The corners of a triangle in local f32 coordinates.
    #[inline(always)]
    pub fn corners32(&self, triangle: u32) -> [[f32; 3]; 3] {
        self.triangles[triangle as usize].map(|corner| self.vertices[corner as usize])
    }

    /// The corners of a triangle in local coordinates, in f64.
    #[inline(always)]
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.corners32(triangle).map(|[x, y, z]| DVec3::new(x.into(), y.into(), z.into()))
    }

    /// Every mesh with its triangles.
    pub fn mesh_ranges(&self) -> impl Iterator<Item = (&MeshEntry, Range<u32>)> {
        let ends = self.meshes.iter().skip(1).map(|mesh| mesh.first);
        let ends = ends.chain(std::iter::once(self.triangles.len() as u32));
        self.meshes.iter().zip(ends).map(|(mesh, end)| (mesh, mesh.first..end))
    }

    /// How often triangles go around a point in outer coordinates: +-1 inside a closed mesh, 0 outside of it, something
    /// else where a mesh is open. The sum of their solid angles (van Oosterom and Strackee, "The Solid Angle of a Plane
    /// Triangle", 1983).
    pub(crate) fn winding(&self, triangles: Range<u32>, p: DVec3) -> f64 {
        let p = self.frame.to_local(p);
        let half_angle = |triangle: u32| {
            let [a, b, c] = self.corners(triangle).map(|corner| corner - p);
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let across = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            libm::atan2(a.dot(b.cross(c)), across)
        };
        triangles.into_par_iter().map(half_angle).sum::<f64>() / (2.0 * PI)
    }

    /// Object of a triangle, and its index in the mesh.
    #[inline(always)]
    pub(super) fn triangle_owner(&self, triangle: u32) -> (u32, u32) {
        let after = self.meshes.partition_point(|mesh| mesh.first <= triangle);
        let MeshEntry { object, first, .. } = self.meshes[after - 1];
        (object, triangle - first)
    }

    /// The distance of a hit in outer units, from the start of the ray that `ray` was made from.
    #[inline(always)]
    pub(super) fn outer_distance(&self, ray: &LocalRay, hit: &TriangleHit) -> f64 {
        ray.shift + hit.t * self.frame.inverse_scale
    }

    /// The point of a triangle with these weights of its second and third corner, in outer coordinates; it belongs to
    /// no primitive yet.
    #[inline]
    pub(super) fn point(&self, triangle: u32, u: f64, v: f64) -> SurfacePoint {
        let [a, b, c] = self.corners(triangle);
        let (ab, ac) = (b - a, c - a);
        let local = a + ab * u + ac * v;
        let size = a.abs() + ab.abs() + ac.abs();
        // Edges of f32 numbers in [2^-149, 2]: their products do not underflow in f64.
        let across = ab.cross(ac);
        let normal = across.normalize();
        // The products of the normal that accelerators use, and those with the way from the first corner, are rounded 8
        // times; of a thin triangle they nearly cancel, and its plane is found so far from here.
        let (b, c) = (ab.abs(), ac.abs());
        let products = DVec3::new(b.y * c.z + b.z * c.y, b.z * c.x + b.x * c.z, b.x * c.y + b.y * c.x);
        let lean = normal.abs() * (products.dot(b * u + c * v) / across.length());
        let error = (self.frame.pivot.abs() + (size + lean) * self.frame.inverse_scale) * ROUNDINGS;
        SurfacePoint::of_sheet(self.frame.to_world(local), normal, error)
    }

    /// Bytes of its arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.vertices[..]) + size_of_val(&self.triangles[..])
    }
}

/// The component-wise median: robust against a few far triangles. Of an even number of corners it lies between the two in
/// the middle, so that it is in the mirror where the mesh is.
fn median<I: Iterator<Item = DVec3>>(points: impl Fn() -> I) -> DVec3 {
    let component = |axis: usize| {
        let mut values: Vec<f64> = points().map(|p| p[axis]).collect();
        if values.is_empty() {
            return 0.0;
        }
        let (middle, is_even) = (values.len() / 2, values.len().is_multiple_of(2));
        let (below, &mut upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
        let lower = if is_even { below.iter().copied().fold(f64::NEG_INFINITY, f64::max) } else { upper };
        lower * 0.5 + upper * 0.5
    };
    DVec3::new(component(0), component(1), component(2))
}
