//! A scene in words, in the form of the original program's manual.

use super::console::{number, printable};
use crate::math::DVec3;
use crate::scene::desc::{
    ApertureDesc, CameraDesc, MaterialDesc, MaterialKind, ObjectDesc, SceneDesc, ShapeDesc,
};
use std::collections::BTreeMap;

/// Up to this many objects get a line each.
const MOST_LINES: usize = 100;

/// The scene information: a line an object, or a line a type if there are many, and the camera.
pub(super) fn scene(desc: &SceneDesc) -> String {
    let mut lines = vec!["===== SCENE INFORMATION =====".to_owned()];
    if desc.objects.len() <= MOST_LINES {
        lines.extend(desc.objects.iter().map(object));
    } else {
        lines.extend(counts(desc).into_iter().map(|(name, count)| format!("{name}: {count}")));
    }
    lines.push(camera(&desc.camera));
    lines.join("\n")
}

/// How many objects of each type there are.
pub(super) fn counts(desc: &SceneDesc) -> BTreeMap<&'static str, usize> {
    let mut counts = BTreeMap::new();
    for object in &desc.objects {
        *counts.entry(type_name(&object.shape)).or_default() += 1;
    }
    counts
}

/// How many triangles the meshes have together.
pub(super) fn triangles(desc: &SceneDesc) -> usize {
    let of = |object: &ObjectDesc| match &object.shape {
        ShapeDesc::TriangleMesh { mesh, .. } => mesh.triangles.len(),
        _ => 0,
    };
    desc.objects.iter().map(of).sum()
}

fn object(object: &ObjectDesc) -> String {
    let name = object.name.as_ref().map(|name| format!(" {}", printable(name))).unwrap_or_default();
    let kind = type_name(&object.shape);
    let (position, shape) = match &object.shape {
        ShapeDesc::Ball { position, radius } => (position, format!("radius: {}", number(*radius))),
        ShapeDesc::Box { position, size, rotation } => {
            let [depth, width, height] = size.to_array().map(number);
            let turn = rotated(*rotation);
            (position, format!("width: {width}, height: {height}, depth: {depth}{turn}"))
        }
        ShapeDesc::Rectangle { position, width, height, rotation } => {
            let turn = rotated(*rotation);
            (position, format!("width: {}, height: {}{turn}", number(*width), number(*height)))
        }
        ShapeDesc::TriangleMesh { file, mesh, scale, position, rotation, .. } => {
            let file = printable(&file.to_string_lossy());
            let turn = rotated(*rotation);
            let triangles = mesh.triangles.len();
            (position, format!("file: {file}, triangles: {triangles}, scale: {}{turn}", number(*scale)))
        }
    };
    format!(
        "{kind}{name} at: {} with {shape}, with material: {}",
        vector(*position),
        material(&object.material)
    )
}

fn camera(camera: &CameraDesc) -> String {
    let lens = match camera.aperture {
        ApertureDesc::DepthOfField(strength) => format!("DOF: {}", number(strength)),
        ApertureDesc::Radius(radius) => format!("aperture radius: {}", number(radius)),
    };
    let roll = if camera.angle == 0.0 { String::new() } else { format!(", angle: {}", number(camera.angle)) };
    format!(
        "Camera at: {} looking at point: {} with FOV: {} degrees, {lens} and focus distance: {}{roll}",
        vector(camera.position),
        vector(camera.looking_at),
        number(camera.fov * 180.0),
        number(camera.focus_distance)
    )
}

fn type_name(shape: &ShapeDesc) -> &'static str {
    match shape {
        ShapeDesc::Ball { .. } => "Ball",
        ShapeDesc::Box { .. } => "Box",
        ShapeDesc::Rectangle { .. } => "Rectangle",
        ShapeDesc::TriangleMesh { .. } => "TriangleMesh",
    }
}

/// The name as given, else the type.
fn material(material: &MaterialDesc) -> String {
    let kind = match material.kind {
        MaterialKind::Diffuse { .. } => "DIFFUSE",
        MaterialKind::Reflective { .. } => "REFLECTIVE",
        MaterialKind::ClearCoat { .. } => "CLEARCOAT",
        MaterialKind::Refractive { .. } => "REFRACTIVE",
    };
    material.name.as_deref().map_or_else(|| kind.to_owned(), printable)
}

fn vector(v: DVec3) -> String {
    format!("({})", v.to_array().map(number).join(" "))
}

fn rotated(rotation: DVec3) -> String {
    if rotation == DVec3::ZERO { String::new() } else { format!(", rotation: {}", vector(rotation)) }
}
