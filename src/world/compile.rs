//! From what the file says to what is rendered.

use super::World;
use super::light::Lights;
use super::requires::Requires;
use super::shading::ShadingNormals;
use super::sky::{Sky, SkyKind};
use crate::error::{Diagnostic, Error, Result, Severity};
use crate::geometry::{Ball, Cuboid, Geometry, MeshPart, Rectangle, Shape, Solid};
use crate::material::{ClearCoat, Diffuse, Material, Reflective, Refractive};
use crate::math::{Bounds, DMat3, DVec3, Rgb, sin_cos_degrees};
use crate::scene::desc::{Axes, MaterialKind, MeshDesc, ObjectDesc, SceneDesc, ShapeDesc};

impl World {
    /// Compiles a scene. Fails where an object lies beyond what numbers can hold.
    pub fn compile(desc: &SceneDesc) -> Result<World> {
        countable(&desc.objects)?;
        let origin = median_position(&desc.objects);
        let mut parts = Parts::default();
        let mut problems = Vec::new();
        for (index, object) in desc.objects.iter().enumerate() {
            parts.add(index as u32, object, origin);
            if !parts.last_is_finite() {
                problems.push(out_of_range(
                    object,
                    format!("reaches farther than {LARGEST:e} units from the middle of the scene"),
                ));
            } else if parts.last_extent() < SMALLEST {
                problems.push(out_of_range(object, format!("is smaller than {SMALLEST:e} units")));
            }
        }
        if !problems.is_empty() {
            return Err(Error::Scene(problems));
        }
        let geometry = Geometry::new(parts.solids, &parts.meshes);
        let mesh_rounding = mesh_rounding(&geometry, &parts.meshes);
        let emission: Vec<Rgb> =
            desc.objects.iter().map(|object| emission_of(&object.material.kind)).collect();
        let sky = Sky::new(&desc.environment);
        let lights = Lights::new(&geometry, &emission, &sky);
        let mut world = World {
            geometry,
            sky,
            lights,
            requires: Requires::NOTHING,
            origin,
            materials: desc.objects.iter().map(|object| material_of(&object.material.kind)).collect(),
            emission,
            normals: parts.normals,
            mesh_rounding,
        };
        world.requires = Requires::of(desc, &world);
        Ok(world)
    }
}

/// Whether the triangles, corners and normals of all meshes can be counted by 31 bits.
fn countable(objects: &[ObjectDesc]) -> Result<()> {
    let mut counts = [0usize; 3];
    for object in objects {
        if let ShapeDesc::TriangleMesh { mesh, .. } = &object.shape {
            let more = [mesh.triangles.len(), mesh.positions.len(), mesh.normals.len()];
            counts = [0, 1, 2].map(|i| counts[i] + more[i]);
            if counts.iter().any(|&count| count >= MOST_INDICES) {
                let what =
                    format!("takes the meshes of the scene beyond {MOST_INDICES} triangles or corners");
                return Err(Error::Scene(vec![out_of_range(object, what)]));
            }
        }
    }
    Ok(())
}

/// Indices of triangles, corners and normals stay below this.
const MOST_INDICES: usize = 0x7fff_ffff;

/// By how much, at most, each mesh's corners have been moved along an axis when they were rounded.
fn mesh_rounding(geometry: &Geometry, meshes: &[MeshPart]) -> Vec<f64> {
    let mut corners = geometry.vertices.iter();
    let moved = |(&world, &[x, y, z]): (&DVec3, &[f32; 3])| {
        let rounded = DVec3::new(x.into(), y.into(), z.into());
        (geometry.mesh_frame.to_local(world) - rounded).abs().max_element() / geometry.mesh_frame.scale
    };
    let most = |mesh: &MeshPart| mesh.positions.iter().zip(corners.by_ref()).map(moved).fold(0.0, f64::max);
    meshes.iter().map(most).collect()
}

/// The component-wise lower median of the objects' positions: a number that stands in the file, so that moving the
/// whole scene by amounts that its numbers can hold moves it exactly.
fn median_position(objects: &[ObjectDesc]) -> DVec3 {
    if objects.is_empty() {
        return DVec3::ZERO;
    }
    let component = |axis: usize| {
        let mut values: Vec<f64> = objects.iter().map(|object| position_of(&object.shape)[axis]).collect();
        values.sort_by(f64::total_cmp);
        values[(values.len() - 1) / 2]
    };
    DVec3::new(component(0), component(1), component(2))
}

fn position_of(shape: &ShapeDesc) -> DVec3 {
    match *shape {
        ShapeDesc::Ball { position, .. }
        | ShapeDesc::Box { position, .. }
        | ShapeDesc::Rectangle { position, .. }
        | ShapeDesc::TriangleMesh { position, .. } => position,
    }
}

/// The shapes of a scene, as they are collected.
#[derive(Default)]
struct Parts {
    solids: Vec<Solid>,
    meshes: Vec<MeshPart>,
    normals: ShadingNormals,
    triangles: usize,
    last_is_mesh: bool,
}

impl Parts {
    fn add(&mut self, index: u32, object: &ObjectDesc, origin: DVec3) {
        let at = position_of(&object.shape) - origin;
        let shape = match &object.shape {
            &ShapeDesc::Ball { radius, .. } => Shape::Ball(Ball { center: at, radius }),
            &ShapeDesc::Box { size, rotation, .. } => {
                Shape::Cuboid(Cuboid { center: at, half: size * 0.5, rotation: rotation_matrix(rotation) })
            }
            &ShapeDesc::Rectangle { width, height, rotation, .. } => {
                let r = rotation_matrix(rotation);
                // Seen from its front, which faces -x, +y is to the left.
                let (half_u, half_v) =
                    (r * DVec3::new(0.0, -0.5 * width, 0.0), r * DVec3::new(0.0, 0.0, 0.5 * height));
                Shape::Rectangle(Rectangle::new(at, half_u, half_v))
            }
            ShapeDesc::TriangleMesh { mesh, scale, rotation, axes, smooth, .. } => {
                let r = rotation_matrix(*rotation);
                return self.add_mesh(index, mesh, &Placement { r, scale: *scale, at, axes: *axes }, *smooth);
            }
        };
        self.last_is_mesh = false;
        self.solids.push(Solid { object: index, shape });
    }

    fn add_mesh(&mut self, object: u32, mesh: &MeshDesc, placement: &Placement, smooth: bool) {
        let positions = mesh.positions.iter().map(|&p| placement.point(p)).collect();
        let triangles: Vec<[u32; 3]> = mesh.triangles.iter().map(|&t| placement.winding(t)).collect();
        if smooth && !mesh.normal_indices.is_empty() {
            let first = self.normals.normals.len() as u32;
            self.normals.normals.extend(mesh.normals.iter().map(|&n| placement.normal(n)));
            self.normals.indices.resize(self.triangles, FLAT);
            let shifted = |index: u32| if index == u32::MAX { index } else { index + first };
            self.normals
                .indices
                .extend(mesh.normal_indices.iter().map(|&t| placement.winding(t).map(shifted)));
        }
        self.triangles += triangles.len();
        if !self.normals.indices.is_empty() {
            self.normals.indices.resize(self.triangles, FLAT);
        }
        self.last_is_mesh = true;
        self.meshes.push(MeshPart { object, positions, triangles });
    }

    fn last_is_finite(&self) -> bool {
        let small = |p: DVec3| p.is_finite() && p.abs().max_element() < LARGEST;
        if self.last_is_mesh {
            self.meshes.last().is_some_and(|mesh| mesh.positions.iter().all(|&p| small(p)))
        } else {
            self.solids.last().is_some_and(|solid| small(solid.bounds().min) && small(solid.bounds().max))
        }
    }
}

impl Parts {
    /// The shortest edge, the radius, or the largest side of a mesh.
    fn last_extent(&self) -> f64 {
        if self.last_is_mesh {
            let corners = self.meshes.last().map_or(&[][..], |mesh| &mesh.positions);
            let bounds = corners.iter().fold(Bounds::EMPTY, |bounds, &p| bounds.with_point(p));
            return if bounds.is_empty() { 1.0 } else { (bounds.max - bounds.min).max_element() };
        }
        self.solids.last().map_or(1.0, |solid| match solid.shape {
            Shape::Ball(ball) => ball.radius,
            Shape::Cuboid(cuboid) => 2.0 * cuboid.half.min_element(),
            Shape::Rectangle(r) => r.edge_u.abs().max_element().min(r.edge_v.abs().max_element()),
        })
    }
}

const FLAT: [u32; 3] = [u32::MAX; 3];

/// Fourth powers of lengths must stay within the range of f64.
pub(super) const LARGEST: f64 = 1e75;

/// Fourth powers of lengths must not vanish.
const SMALLEST: f64 = 1e-75;

/// How the coordinates of a mesh file become the world's.
struct Placement {
    r: DMat3,
    scale: f64,
    at: DVec3,
    axes: Axes,
}

impl Placement {
    fn turned([x, y, z]: [f64; 3], axes: Axes) -> DVec3 {
        match axes {
            Axes::YUp => DVec3::new(x, -z, y),
            Axes::ZUp => DVec3::new(x, y, z),
            Axes::SwapYZ => DVec3::new(x, z, y),
        }
    }

    fn point(&self, p: [f64; 3]) -> DVec3 {
        self.r * (Self::turned(p, self.axes) * self.scale) + self.at
    }

    fn normal(&self, n: [f32; 3]) -> [f32; 3] {
        (self.r * Self::turned(n.map(f64::from), self.axes)).normalize_or_zero().as_vec3().to_array()
    }

    /// A mirrored mesh keeps its outside: the corners are taken the other way round.
    fn winding(&self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        if self.axes == Axes::SwapYZ { [a, c, b] } else { [a, b, c] }
    }
}

/// Turns about the world's x, then y, then z axis, by angles in degrees.
fn rotation_matrix(degrees: DVec3) -> DMat3 {
    let [(sx, cx), (sy, cy), (sz, cz)] = degrees.to_array().map(sin_cos_degrees);
    let x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, cx, sx), DVec3::new(0.0, -sx, cx));
    let y = DMat3::from_cols(DVec3::new(cy, 0.0, -sy), DVec3::Y, DVec3::new(sy, 0.0, cy));
    let z = DMat3::from_cols(DVec3::new(cz, sz, 0.0), DVec3::new(-sz, cz, 0.0), DVec3::Z);
    z * y * x
}

fn emission_of(kind: &MaterialKind) -> Rgb {
    match *kind {
        MaterialKind::Diffuse { emission, .. } => emission,
        _ => Rgb::ZERO,
    }
}

fn material_of(kind: &MaterialKind) -> Material {
    match *kind {
        MaterialKind::Diffuse { color, .. } => Material::Diffuse(Diffuse { color }),
        MaterialKind::Reflective { color, specularity } => {
            Material::Reflective(Reflective { color, specularity })
        }
        MaterialKind::ClearCoat { color, coat, coat_color, specularity } => Material::ClearCoat(ClearCoat {
            base: Diffuse { color },
            coat: Reflective { color: coat_color, specularity },
            probability: coat,
        }),
        MaterialKind::Refractive { color, ratio } => Material::Refractive(Refractive { color, ratio }),
    }
}

fn out_of_range(object: &ObjectDesc, problem: String) -> Diagnostic {
    Diagnostic {
        severity: Severity::Error,
        message: format!("the object {problem}"),
        location: Some(object.location.clone()),
        source_line: None,
        help: Some("bring positions and sizes into the range that numbers can hold".into()),
    }
}

impl Requires {
    /// Of an empty scene.
    const NOTHING: Requires = Requires {
        triangles: 0,
        linear_solids: 0,
        tree_solids: 0,
        area_lights: 0,
        sky: SkyKind::Black,
        light_sampling: false,
        lens: false,
        shading_normals: false,
        refraction: false,
    };
}
