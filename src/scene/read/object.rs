//! One item of `Objects`.

use super::{Context, material};
use crate::math::DVec3;
use crate::scene::desc::{Axes, MaterialDesc, ObjectDesc, ShapeDesc, TexturesDesc};
use crate::scene::diagnostic::Report;
use crate::scene::from_file::{self, Part};
use crate::scene::yaml::fields::{Fields, Section};
use crate::scene::yaml::node::Kind;
use crate::scene::yaml::value::{Range, Value};
use std::sync::Arc;

/// The keys of all shapes.
pub(super) const SECTION: Section = Section {
    name: "Object",
    keys: &[
        "Type", "Name", "Material", "Position", "Radius", "Width", "Height", "Depth", "Rotation", "Filepath",
        "Scale", "Axes", "Smooth",
    ],
};

/// The one key of an item.
const ITEM: Section = Section { name: "each item of Objects", keys: &["Object"] };

/// A shape's type: its name, the keys that it uses, and how they are read.
type Type = (&'static str, &'static [&'static str], fn(&Fields<'_>, &mut Context<'_>) -> Option<ShapeDesc>);

const TYPES: [Type; 4] = [
    ("Ball", &["Type", "Name", "Material", "Position", "Radius"], ball),
    ("Box", &["Type", "Name", "Material", "Position", "Width", "Height", "Depth", "Rotation"], cuboid),
    ("Rectangle", &["Type", "Name", "Material", "Position", "Width", "Height", "Rotation"], rectangle),
    (
        "TriangleMesh",
        &["Type", "Name", "Material", "Filepath", "Scale", "Position", "Rotation", "Axes", "Smooth"],
        mesh,
    ),
];

const CENTER: &str = "[x, y, z], the centre";

/// Reads an item: one object, or one for each emitting material of a mesh and one for the others; `None` after an error.
pub(super) fn read(item: Value<'_>, context: &mut Context<'_>) -> Option<Vec<ObjectDesc>> {
    if has_keys_of_object(item) {
        let help =
            "write \"- Object:\" and indent Type, Position and so on further than the word Object".to_owned();
        item.error("has the keys of an object beside Object instead of below it", Some(help), context.report);
        return None;
    }
    let fields = Fields::open(item, &ITEM, &[], context.report)?;
    let object = fields.require("Object", "its keys, indented below it", context.report)?;
    let location = context.source.location(object.near());
    let fields = Fields::open(object, &SECTION, &super::SECTIONS, context.report)?;
    let name = fields.name(context.report);
    let shape = shape(&fields, context);
    let material = fields.require("Material", "a mapping with Type, Color and so on", context.report);
    if let Some(value) = material.filter(|value| value.node.text() == Some("FromFile")) {
        let parts = from_file(&shape?, value, context)?;
        let object = |(shape, material, faces)| ObjectDesc {
            name: name.clone(),
            location: location.clone(),
            shape,
            material,
            faces,
        };
        return Some(parts.into_iter().map(object).collect());
    }
    let read = material.and_then(|value| material::read(value, context));
    let (shape, read) = (shape?, read?);
    check_coordinates(&shape, &read, material?, context)?;
    Some(vec![ObjectDesc { name, location, shape, material: read, faces: Vec::new() }])
}

/// Whether a picture has a place on a mesh.
fn check_coordinates(
    shape: &ShapeDesc,
    material: &MaterialDesc,
    value: Value<'_>,
    context: &mut Context<'_>,
) -> Option<()> {
    let has_picture = material.textures != TexturesDesc::default();
    match shape {
        ShapeDesc::TriangleMesh { mesh, .. } if has_picture && mesh.texcoord_indices.is_empty() => {
            let help = "give the mesh texture coordinates (vt), or the material a plain colour".to_owned();
            let text = "has a picture, but the mesh does not say where it goes";
            value.error(text, Some(help), context.report);
            None
        }
        _ => Some(()),
    }
}

/// The shape, the material of the first face and where others begin.
type MeshPart = (ShapeDesc, MaterialDesc, Vec<(u32, Arc<MaterialDesc>)>);

/// The parts of a mesh whose materials are `FromFile`.
fn from_file(shape: &ShapeDesc, value: Value<'_>, context: &mut Context<'_>) -> Option<Vec<MeshPart>> {
    let ShapeDesc::TriangleMesh { file, mesh, .. } = shape else {
        value.error("can be FromFile for a TriangleMesh only", None, context.report);
        return None;
    };
    let key = Arc::as_ptr(mesh);
    let known = context.meshes.parts.get(&key).cloned();
    let parts = known.unwrap_or_else(|| {
        let parts = from_file::parts(file, mesh, value, context);
        context.meshes.parts.insert(key, parts.clone());
        parts
    });
    let with_mesh = |part: Part| {
        let mut shape = shape.clone();
        if let ShapeDesc::TriangleMesh { mesh, .. } = &mut shape {
            *mesh = part.mesh;
        }
        (shape, (*part.material).clone(), part.faces)
    };
    Some(parts?.into_iter().map(with_mesh).collect())
}

/// Whether the keys of an object stand beside the word `Object`, or without it: one mistake, and one message.
fn has_keys_of_object(item: Value<'_>) -> bool {
    let Kind::Map(entries) = &item.node.kind else { return false };
    let value = |key: &str| entries.iter().find(|(k, _)| k.text() == Some(key)).map(|(_, value)| &value.kind);
    value("Type").is_some() && matches!(value("Object"), None | Some(Kind::Null))
}

fn shape(fields: &Fields<'_>, context: &mut Context<'_>) -> Option<ShapeDesc> {
    let choices = TYPES.map(|shape| (shape.0, shape));
    let kind = fields.require("Type", "Ball, Box, Rectangle or TriangleMesh", context.report)?;
    let Some((type_name, used, read)) = kind.choice(&choices, context.report) else {
        kind.meant(&choices).and_then(|(_, _, read)| read(fields, context));
        return None;
    };
    fields.warn_unused(&SECTION, used, type_name, context.report);
    read(fields, context)
}

fn ball(fields: &Fields<'_>, context: &mut Context<'_>) -> Option<ShapeDesc> {
    let report = &mut *context.report;
    let position = fields.vector("Position", Range::Finite, CENTER, report);
    let radius = fields.number("Radius", Range::Positive, "a number > 0", report);
    Some(ShapeDesc::Ball { position: position?, radius: radius? })
}

fn cuboid(fields: &Fields<'_>, context: &mut Context<'_>) -> Option<ShapeDesc> {
    let report = &mut *context.report;
    let position = fields.vector("Position", Range::Finite, CENTER, report);
    let width = fields.number("Width", Range::Positive, "the length along y, > 0", report);
    let height = fields.number("Height", Range::Positive, "the length along z, > 0", report);
    let depth = fields.number("Depth", Range::Positive, "the length along x, > 0", report);
    let rotation = rotation(fields, report);
    let size = DVec3::new(depth?, width?, height?);
    Some(ShapeDesc::Box { position: position?, size, rotation: rotation? })
}

fn rectangle(fields: &Fields<'_>, context: &mut Context<'_>) -> Option<ShapeDesc> {
    let report = &mut *context.report;
    let position = fields.vector("Position", Range::Finite, CENTER, report);
    let width = fields.number("Width", Range::Positive, "the length along y, > 0", report);
    let height = fields.number("Height", Range::Positive, "the length along z, > 0", report);
    let rotation = rotation(fields, report);
    Some(ShapeDesc::Rectangle { position: position?, width: width?, height: height?, rotation: rotation? })
}

fn mesh(fields: &Fields<'_>, context: &mut Context<'_>) -> Option<ShapeDesc> {
    let report = &mut *context.report;
    let path = fields.require("Filepath", "the OBJ file", report);
    let mesh = path.and_then(|value| context.meshes.get(value, report));
    let scale = fields.number_or("Scale", Range::Positive, 1.0, report);
    let position =
        fields.vector("Position", Range::Finite, "[x, y, z], where the file's origin goes", report);
    let rotation = rotation(fields, report);
    let choices = [("YUp", Axes::YUp), ("ZUp", Axes::ZUp), ("SwapYZ", Axes::SwapYZ)];
    let axes = fields.get("Axes").map_or(Some(Axes::YUp), |value| value.choice(&choices, report));
    let smooth = fields.get("Smooth").map_or(Some(true), |value| value.flag(report));
    let (file, mesh) = mesh?;
    Some(ShapeDesc::TriangleMesh {
        file,
        mesh,
        scale: scale?,
        position: position?,
        rotation: rotation?,
        axes: axes?,
        smooth: smooth?,
    })
}

/// Angles about x, y and z in degrees, 0 if they are not given.
fn rotation(fields: &Fields<'_>, report: &mut Report) -> Option<DVec3> {
    fields.vector_or("Rotation", Range::Finite, DVec3::ZERO, report)
}
