//! What a scene needs: decided once, so that what it does not use costs nothing.

use super::World;
use super::sky::SkyKind;
use crate::geometry::Shape;
use crate::material::Material;
use crate::scene::desc::{ApertureDesc, SceneDesc};
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
    /// Whether the lens has a size.
    pub lens: bool,
    /// Whether normals of mesh files are kept.
    pub shading_normals: bool,
    /// Pictures that are colours of surfaces.
    pub textures: usize,
    /// Whether anything refracts.
    pub refraction: bool,
}

impl Requires {
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
            parts.push(format!("a tree over {}", counted(self.triangles, "triangle")));
        }
        let solids = if self.instances > 0 {
            "balls, boxes, rectangles and instances"
        } else {
            "balls, boxes and rectangles"
        };
        if self.instances > 0 {
            parts.push(format!("{} of shared meshes", counted(self.instances, "instance")));
        }
        if self.tree_solids > 0 {
            parts.push(format!("a tree over {} {solids}", self.tree_solids));
        }
        if self.linear_solids > 0 {
            parts.push(format!("{} without a tree", counted(self.linear_solids, "shape")));
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
        option(self.light_sampling, &format!("light sampling ({})", counted(self.area_lights, "area light")));
        option(self.lens, "a lens");
        option(self.shading_normals, "shading normals");
        option(self.textures > 0, &counted(self.textures, "texture"));
        option(self.refraction, "refraction");
        write!(f, "{}", parts.join(", "))
    }
}

fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
