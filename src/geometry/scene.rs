//! All primitives of a scene: flat arrays joined by indices.

use super::{Ball, Cuboid, Hit, LocalFrame, LocalRay, PrimitiveId, Ray, Rectangle, TriangleHit};
use crate::math::{Bounds, DVec3, round_down, round_up};

/// The shape of a solid, in world space.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// A sphere.
    Ball(Ball),
    /// A box.
    Cuboid(Cuboid),
    /// A rectangle.
    Rectangle(Rectangle),
}

/// A primitive that is decided in f64.
#[derive(Clone, Copy, Debug)]
pub struct Solid {
    /// Index of the object in the scene.
    pub object: u32,
    /// Its shape.
    pub shape: Shape,
}

/// A mesh on its way into a [`Geometry`]: corners in world space.
#[derive(Clone, Debug, Default)]
pub struct MeshPart {
    /// Index of the object in the scene.
    pub object: u32,
    /// Corners in world space.
    pub positions: Vec<DVec3>,
    /// Indices into `positions`.
    pub triangles: Vec<[u32; 3]>,
}

/// All primitives, as accelerators see them.
#[derive(Clone, Debug)]
pub struct Geometry {
    /// The space of the triangles.
    pub mesh_frame: LocalFrame,
    /// Corners in the space of the triangles; the last one is a copy, so that 16 bytes can be read from every corner.
    pub vertices: Vec<[f32; 3]>,
    /// Corners of the triangles; a mesh's triangles follow each other, meshes in the order of the scene.
    pub triangles: Vec<[u32; 3]>,
    /// Object and first triangle of every mesh, ascending.
    pub meshes: Vec<(u32, u32)>,
    /// The solids in the order of the scene.
    pub solids: Vec<Solid>,
    /// The space of the nodes over `tree_solids`.
    pub solid_frame: LocalFrame,
    /// Indices of the solids that every ray is tried against: few ones, or much larger than the rest.
    pub linear_solids: Vec<u32>,
    /// Indices of the solids that need a tree.
    pub tree_solids: Vec<u32>,
}

/// Up to this many solids are tried one after the other: no tree over three balls.
const LINEAR_SOLIDS: usize = 8;

/// A solid so many times larger than the median one would widen every node and stays out of the tree.
const LARGE: f64 = 64.0;

impl Geometry {
    /// Collects the primitives. `solids` and `meshes` ascend by object; all numbers are finite.
    pub fn new(solids: Vec<Solid>, meshes: &[MeshPart]) -> Geometry {
        let (linear_solids, tree_solids) = split_solids(&solids);
        let solid_bounds =
            tree_solids.iter().fold(Bounds::EMPTY, |b, &i| b.union(solids[i as usize].bounds()));
        let solid_frame = frame_of(solid_bounds, solid_bounds.center());
        let corners = || meshes.iter().flat_map(|mesh| mesh.positions.iter().copied());
        let mesh_frame = frame_of(corners().fold(Bounds::EMPTY, Bounds::with_point), median(corners));
        let mut geometry = Geometry {
            mesh_frame,
            vertices: Vec::new(),
            triangles: Vec::new(),
            meshes: Vec::new(),
            solids,
            solid_frame,
            linear_solids,
            tree_solids,
        };
        for mesh in meshes {
            let first = geometry.vertices.len() as u32;
            geometry.meshes.push((mesh.object, geometry.triangles.len() as u32));
            geometry
                .vertices
                .extend(mesh.positions.iter().map(|&p| mesh_frame.to_local(p).as_vec3().to_array()));
            geometry.triangles.extend(mesh.triangles.iter().map(|t| t.map(|corner| corner + first)));
        }
        geometry.vertices.extend(geometry.vertices.last().copied());
        geometry
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

    /// Object of a triangle, and its index in the mesh.
    pub fn triangle_owner(&self, triangle: u32) -> (u32, u32) {
        let after = self.meshes.partition_point(|&(_, first)| first <= triangle);
        let (object, first) = self.meshes[after - 1];
        (object, triangle - first)
    }

    /// Local box of a solid in the space of `tree_solids`, widened as [`LocalFrame::padding`] says.
    pub fn solid_node_bounds(&self, solid: u32) -> ([f32; 3], [f32; 3]) {
        let bounds = self.solids[solid as usize].bounds();
        let padding = self.solid_frame.padding();
        let low = self.solid_frame.to_local(bounds.min) - padding;
        let high = self.solid_frame.to_local(bounds.max) + padding;
        (low.to_array().map(round_down), high.to_array().map(round_up))
    }

    /// The hit of a solid with t in (0, t_max]. The shared routine of every accelerator.
    pub fn intersect_solid(&self, solid: u32, ray: &Ray, t_max: f64) -> Option<Hit> {
        let &Solid { object, ref shape } = &self.solids[solid as usize];
        let primitive = PrimitiveId::solid(solid);
        let leaves = ray.leaving == primitive;
        let hit = |t, part, u, v| Hit { t, object, primitive, part, u, v };
        if leaves && !ray.inward {
            return None;
        }
        match shape {
            Shape::Ball(ball) => {
                let t = if leaves {
                    ball.exit(ray.origin, ray.direction)
                } else {
                    let (near, far) = ball.roots(ray.origin, ray.direction)?;
                    if near > 0.0 { near } else { far }
                };
                (t > 0.0 && t <= t_max).then(|| hit(t, 0, 0.0, 0.0))
            }
            Shape::Cuboid(cuboid) => {
                let (t, face) = if leaves {
                    cuboid.exit(ray.origin, ray.direction)
                } else {
                    let (enter, leave) = cuboid.slabs(ray.origin, ray.direction)?;
                    if enter.0 > 0.0 { enter } else { leave }
                };
                if !(t > 0.0 && t <= t_max) {
                    return None;
                }
                let p = cuboid.point_on_face(ray.origin, ray.direction, t, face);
                let (u, v) = cuboid.face_coordinates(p, face);
                Some(hit(t, face, u, v))
            }
            Shape::Rectangle(rectangle) => {
                let (t, part, u, v) = rectangle.intersect(ray.origin, ray.direction, t_max)?;
                Some(hit(t, part, u, v))
            }
        }
    }

    /// Whether a solid other than `target` is hit with t in (0, t_max).
    pub fn solid_occludes(&self, solid: u32, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        target != PrimitiveId::solid(solid)
            && self.intersect_solid(solid, ray, t_max).is_some_and(|h| h.t < t_max)
    }

    /// The hit of the local ray `ray` as a hit of the path's ray: distance in world units from the start of that one.
    pub fn world_hit(&self, ray: &LocalRay, hit: &TriangleHit) -> Hit {
        let (object, part) = self.triangle_owner(hit.index);
        let t = (ray.shift + hit.t * self.mesh_frame.inverse_scale).max(f64::MIN_POSITIVE);
        Hit { t, object, primitive: PrimitiveId::triangle(hit.index), part, u: hit.u, v: hit.v }
    }
}

impl Solid {
    /// The box around it in world space.
    pub fn bounds(&self) -> Bounds {
        match self.shape {
            Shape::Ball(ball) => ball.bounds(),
            Shape::Cuboid(cuboid) => cuboid.bounds(),
            Shape::Rectangle(rectangle) => rectangle.bounds(),
        }
    }

    fn extent(&self) -> f64 {
        let bounds = self.bounds();
        (bounds.max - bounds.min).max_element()
    }
}

fn frame_of(bounds: Bounds, pivot: DVec3) -> LocalFrame {
    if bounds.is_empty() {
        return LocalFrame::new(DVec3::ZERO, Bounds { min: DVec3::ZERO, max: DVec3::ONE });
    }
    LocalFrame::new(pivot, bounds)
}

/// Indices of the solids that every ray is tried against, and of those that need a tree.
fn split_solids(solids: &[Solid]) -> (Vec<u32>, Vec<u32>) {
    let all = 0..solids.len() as u32;
    if solids.len() <= LINEAR_SOLIDS {
        return (all.collect(), Vec::new());
    }
    let mut extents: Vec<f64> = solids.iter().map(Solid::extent).collect();
    extents.sort_by(f64::total_cmp);
    let cut = (LARGE * extents[extents.len() / 2]).max(extents[extents.len() - 1 - LINEAR_SOLIDS]);
    all.partition(|&i| solids[i as usize].extent() > cut)
}

/// The component-wise lower median: robust against a few far triangles.
fn median<I: Iterator<Item = DVec3>>(points: impl Fn() -> I) -> DVec3 {
    let component = |axis: usize| {
        let mut values: Vec<f64> = points().map(|p| p[axis]).collect();
        if values.is_empty() {
            return 0.0;
        }
        let middle = (values.len() - 1) / 2;
        *values.select_nth_unstable_by(middle, f64::total_cmp).1
    };
    DVec3::new(component(0), component(1), component(2))
}
