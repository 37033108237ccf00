//! From what the file says to what is rendered.

use super::World;
use super::light::Lights;
use super::meshes::{Placement, SharedMeshes};
use super::place;
use super::requires::Requires;
use super::shading::NormalsBuilder;
use super::sky::Sky;
use super::varied::VariedBuilder;
use crate::error::{Diagnostic, Error, Result, Severity};
use crate::geometry::{Ball, Cuboid, Geometry, MeshPart, Rectangle, Shape, Solid};
use crate::material::{ClearCoat, Diffuse, Material, Reflective, Refractive};
use crate::math::{Bounds, DMat3, DVec3, Rgb, sin_cos_degrees};
use crate::scene::desc::{MaterialKind, ObjectDesc, SceneDesc, ShapeDesc};
use std::collections::HashSet;
use std::sync::Arc;

impl World {
    /// Compiles a scene.
    ///
    /// # Errors
    /// Objects that lie, or reach, beyond what numbers can hold, or are too small for them, and meshes with too many triangles to be
    /// counted; each with its place in the file.
    pub fn compile(desc: &SceneDesc) -> Result<World> {
        countable(&desc.objects)?;
        let origin = place::origin(&desc.objects);
        let mut parts = Parts { shared: SharedMeshes::of(&desc.objects), ..Parts::default() };
        let mut problems = Vec::new();
        for (index, object) in desc.objects.iter().enumerate() {
            let (bounds, size) = parts.add(index as u32, object, origin);
            let within = |p: DVec3| p.is_finite() && p.abs().max_element() < LARGEST;
            if !(within(bounds.min) && within(bounds.max)) {
                problems.push(out_of_range(
                    object,
                    format!("reaches farther than {LARGEST:e} units from the middle of the scene"),
                ));
            } else if size < SMALLEST {
                problems.push(out_of_range(object, format!("is smaller than {SMALLEST:e} units")));
            }
        }
        if !problems.is_empty() {
            return Err(Error::Scene(problems));
        }
        let Parts { solids, meshes, shared, normals, varied } = parts;
        let geometry = Arc::new(Geometry::with_instances(solids, meshes, shared.spaces));
        let emission: Vec<Rgb> = desc.objects.iter().map(|object| object.material.kind.emission()).collect();
        let sky = Sky::new(&desc.environment, desc.environment_map.as_ref());
        let lights = Lights::new(&geometry, &emission, &sky);
        let mut world = World {
            geometry,
            sky,
            lights,
            requires: Requires::NOTHING,
            origin,
            materials: desc.objects.iter().map(|object| material_of(&object.material.kind)).collect(),
            emission,
            normals: normals.finish(),
            varied: varied.finish(),
        };
        world.requires = Requires::of(desc, &world);
        Ok(world)
    }
}

/// Whether the triangles, corners and normals of all meshes can be counted by 31 bits. What several objects show counts
/// once, unless they emit: then it is copied.
fn countable(objects: &[ObjectDesc]) -> Result<()> {
    let mut counts = [0usize; 3];
    let mut seen = HashSet::new();
    for object in objects {
        if let ShapeDesc::TriangleMesh { mesh, .. } = &object.shape
            && (object.material.kind.emits() || seen.insert(Arc::as_ptr(mesh)))
        {
            let more = [mesh.triangles.len(), mesh.positions.len(), mesh.normals.len()];
            counts = [0, 1, 2].map(|i| counts[i] + more[i]);
            if counts.iter().any(|&count| count >= MOST_INDICES) {
                let what =
                    format!("takes the meshes of the scene beyond {MOST_INDICES} triangles or corners");
                let help =
                    "use fewer or coarser meshes, or name the same file several times: it is kept once";
                return Err(Error::Scene(vec![refusal(object, what, help)]));
            }
        }
    }
    Ok(())
}

/// Indices of triangles, corners and normals stay below this.
const MOST_INDICES: usize = 0x7fff_ffff;

/// The shapes of a scene, as they are collected.
#[derive(Default)]
struct Parts {
    solids: Vec<Solid>,
    meshes: Vec<MeshPart>,
    shared: SharedMeshes,
    normals: NormalsBuilder,
    varied: VariedBuilder,
}

impl Parts {
    /// Adds an object; the box around it, and its shortest edge, its radius, or the largest side of a mesh.
    fn add(&mut self, index: u32, object: &ObjectDesc, origin: DVec3) -> (Bounds, f64) {
        let at = place::position_of(&object.shape) - origin;
        let (shape, bounds, size) = match &object.shape {
            &ShapeDesc::Ball { radius, .. } => {
                let ball = Ball { center: at, radius };
                (Shape::Ball(ball), ball.bounds(), radius)
            }
            &ShapeDesc::Box { size, rotation, .. } => {
                let cuboid = Cuboid { center: at, half: size * 0.5, rotation: rotation_matrix(rotation) };
                (Shape::Cuboid(cuboid), cuboid.bounds(), size.min_element())
            }
            &ShapeDesc::Rectangle { width, height, rotation, .. } => {
                let r = rotation_matrix(rotation);
                // Seen from its front, which faces -x, +y is to the left.
                let (half_u, half_v) =
                    (r * DVec3::new(0.0, -0.5 * width, 0.0), r * DVec3::new(0.0, 0.0, 0.5 * height));
                let rectangle = Rectangle::new(at, half_u, half_v);
                let (u, v) = (rectangle.edge_u.abs(), rectangle.edge_v.abs());
                (Shape::Rectangle(rectangle), rectangle.bounds(), u.max_element().min(v.max_element()))
            }
            ShapeDesc::TriangleMesh { mesh, scale, rotation, axes, smooth, .. } => {
                let placement = Placement::new(rotation_matrix(*rotation), *axes, *scale, at);
                let space = self.shared.space_of(object);
                self.varied.add(index, object, space.is_none().then_some(&placement));
                if *smooth {
                    self.normals.add(index, mesh, &placement, space.is_some());
                }
                let Some(space) = space else { return self.add_mesh(placement.part(index, mesh)) };
                let mesh = &self.shared.spaces[space as usize];
                let instance = placement.instance(space, mesh);
                let bounds = instance.bounds(mesh);
                (Shape::Instance(instance), bounds, bounds.extent())
            }
        };
        if !matches!(shape, Shape::Instance(_)) {
            self.varied.add(index, object, None);
        }
        self.solids.push(Solid { object: index, shape });
        (bounds, size)
    }

    /// Adds a mesh that lies in the world.
    fn add_mesh(&mut self, mesh: MeshPart) -> (Bounds, f64) {
        let bounds = mesh.positions.iter().fold(Bounds::EMPTY, |bounds, &p| bounds.with_point(p));
        self.meshes.push(mesh);
        let nowhere = Bounds { min: DVec3::ZERO, max: DVec3::ZERO };
        if bounds.is_empty() { (nowhere, 1.0) } else { (bounds, bounds.extent()) }
    }
}

/// Fourth powers of lengths must stay within the range of f64.
pub(super) const LARGEST: f64 = 1e75;

/// Fourth powers of lengths must not vanish.
const SMALLEST: f64 = 1e-75;

/// Turns about the world's x, then y, then z axis, by angles in degrees.
fn rotation_matrix(degrees: DVec3) -> DMat3 {
    let [(sx, cx), (sy, cy), (sz, cz)] = degrees.to_array().map(sin_cos_degrees);
    let x = DMat3::from_cols(DVec3::X, DVec3::new(0.0, cx, sx), DVec3::new(0.0, -sx, cx));
    let y = DMat3::from_cols(DVec3::new(cy, 0.0, -sy), DVec3::Y, DVec3::new(sy, 0.0, cy));
    let z = DMat3::from_cols(DVec3::new(cz, sz, 0.0), DVec3::new(-sz, cz, 0.0), DVec3::Z);
    z * y * x
}

/// The material with its colours as they are given.
pub(super) fn material_of(kind: &MaterialKind) -> Material {
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
    refusal(object, problem, "bring positions and sizes into the range that numbers can hold")
}

fn refusal(object: &ObjectDesc, problem: String, help: &str) -> Diagnostic {
    Diagnostic {
        severity: Severity::Error,
        message: format!("the object {problem}"),
        location: Some(object.location.clone()),
        source_line: None,
        help: Some(help.into()),
    }
}
