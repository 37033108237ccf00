//! What a scene needs: decided once, so that what it does not use costs nothing.

use super::World;
use super::sky::SkyKind;
use crate::geometry::Shape;
use crate::material::Material;
use crate::scene::desc::{ApertureDesc, SceneDesc};
use crate::words::{counted, grouped};
use serde::Serialize;
use std::fmt;

/// What the renderer switches on for a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Requires {
    /// Triangles of meshes, in trees in f32; those of a mesh that several objects show count once.
    pub triangles: usize,
    /// Objects that show a mesh which others show too: they share its triangles and its tree.
    pub instances: usize,
    /// Balls, boxes, rectangles and instances that every ray is tried against.
    pub linear_solids: usize,
    /// Balls, boxes, rectangles and instances in a tree of their own.
    pub tree_solids: usize,
    /// Objects that emit.
    pub area_lights: usize,
    /// What the sky is.
    pub sky: SkyKind,
    /// Whether rays are aimed at lights.
    pub light_sampling: bool,
    /// Balls by way of which lights are sought.
    pub smooth_balls: usize,
    /// In how many directions a path goes on from the first surface that rays are aimed at lights from.
    pub branches: u32,
    /// Whether the lens has a size.
    pub lens: bool,
    /// Whether normals of mesh files are kept.
    pub shading_normals: bool,
    /// Pictures that are colours of surfaces: they are kept at all halves of their size, and paths carry cones.
    pub textures: usize,
    /// Whether anything refracts.
    pub refraction: bool,
}

impl Requires {
    /// Of an empty scene; of a world until it is known.
    pub(super) const NOTHING: Requires = Requires {
        triangles: 0,
        instances: 0,
        linear_solids: 0,
        tree_solids: 0,
        area_lights: 0,
        sky: SkyKind::Black,
        light_sampling: false,
        smooth_balls: 0,
        branches: 1,
        lens: false,
        shading_normals: false,
        textures: 0,
        refraction: false,
    };

    pub(super) fn of(desc: &SceneDesc, world: &World) -> Requires {
        let materials = || world.materials.iter().chain(world.varied.face_materials());
        let diffuse = materials().any(|material| !material.is_delta());
        Requires {
            triangles: world.geometry.triangle_count(),
            instances: world
                .geometry
                .solids
                .iter()
                .filter(|solid| matches!(solid.shape, Shape::Instance(_)))
                .count(),
            linear_solids: world.geometry.linear_solids.len(),
            tree_solids: world.geometry.tree_solids.len(),
            area_lights: world.lights.count(),
            sky: world.sky.kind(),
            light_sampling: world.lights.can_sample() && diffuse,
            smooth_balls: if diffuse { world.smooth_balls().len() } else { 0 },
            branches: branches(world),
            lens: match desc.camera.aperture {
                ApertureDesc::DepthOfField(size) | ApertureDesc::Radius(size) => size > 0.0,
            },
            shading_normals: !world.normals.is_empty(),
            textures: world.varied.textures(),
            refraction: materials().any(|material| matches!(material, Material::Refractive(_))),
        }
    }
}

impl fmt::Display for Requires {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut parts = Vec::new();
        if self.triangles > 0 {
            parts.push(format!("a tree over {}", counted(self.triangles as u64, "triangle")));
        }
        let solids = if self.instances > 0 {
            "balls, boxes, rectangles and instances"
        } else {
            "balls, boxes and rectangles"
        };
        if self.instances > 0 {
            parts.push(format!("{} of shared meshes", counted(self.instances as u64, "instance")));
        }
        if self.tree_solids > 0 {
            parts.push(format!("a tree over {} {solids}", grouped(self.tree_solids as u64)));
        }
        if self.linear_solids > 0 {
            parts.push(format!("{} without a tree", counted(self.linear_solids as u64, "shape")));
        }
        parts.push(match self.sky {
            SkyKind::Black => "no sky".into(),
            SkyKind::Constant => "a constant sky".into(),
            SkyKind::Gradient => "a gradient sky".into(),
            SkyKind::Map => "an environment map".into(),
        });
        let mut option = |on: bool, name: &str| {
            if on {
                parts.push(name.into());
            }
        };
        option(
            self.light_sampling,
            &format!("light sampling ({})", counted(self.area_lights as u64, "area light")),
        );
        option(self.smooth_balls > 0, &format!("caustics of {}", counted(self.smooth_balls as u64, "ball")));
        option(self.branches > 1, &format!("{} branches of a path", self.branches));
        option(self.lens, "a lens");
        option(self.shading_normals, "shading normals");
        option(self.textures > 0, &format!("{} with mip maps", counted(self.textures as u64, "texture")));
        option(self.refraction, "refraction");
        write!(f, "{}", parts.join(", "))
    }
}

/// Paths of diffuse scenes go on in several directions. Aiming at an area light leaves so little noise there that one look
/// at it serves several at what comes from elsewhere: with four, a room of diffuse walls had 1.6 times the efficiency in
/// relMSE, an open scene with two 1.1 times. Where skies, mirrors or glass bring noise of their own it gained nothing
/// (0.8 to 1.1 times).
fn branches(world: &World) -> u32 {
    let mut materials = world.materials.iter().chain(world.varied.face_materials());
    let plain = materials.all(|material| matches!(material, Material::Diffuse(_)));
    match world.sky.kind() {
        _ if !plain || world.lights.count() == 0 => 1,
        SkyKind::Black => 4,
        SkyKind::Constant => 2,
        SkyKind::Gradient | SkyKind::Map => 1,
    }
}
