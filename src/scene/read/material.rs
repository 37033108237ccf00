//! The `Material` section of an object.

use super::{Context, MOST_RADIANCE, picture};
use crate::math::Rgb;
use crate::scene::desc::{MaterialDesc, MaterialKind, PictureDesc, TexturesDesc};
use crate::scene::diagnostic::Report;
use crate::scene::yaml::fields::{Fields, Section};
use crate::scene::yaml::value::{Range, Value};

/// The keys of all materials.
pub(super) const SECTION: Section = Section {
    name: "Material",
    keys: &[
        "Type",
        "Name",
        "Color",
        "EmissionStrength",
        "EmissionColor",
        "Specularity",
        "ClearCoat",
        "ClearCoatColor",
        "RefractionRatio",
    ],
};

/// A material's type: its name, the keys that it uses, and how they are read.
type Type = (&'static str, &'static [&'static str], fn(&Fields<'_>, &mut Report) -> Option<MaterialKind>);

const TYPES: [Type; 4] = [
    ("Diffuse", &["Type", "Name", "Color", "EmissionStrength", "EmissionColor"], diffuse),
    ("Reflective", &["Type", "Name", "Color", "Specularity"], reflective),
    ("ClearCoat", &["Type", "Name", "Color", "ClearCoat", "ClearCoatColor", "Specularity"], clear_coat),
    ("Refractive", &["Type", "Name", "Color", "RefractionRatio"], refractive),
];

/// Reads a material; `None` after an error.
pub(super) fn read(value: Value<'_>, context: &mut Context<'_>) -> Option<MaterialDesc> {
    let report = &mut *context.report;
    let fields = Fields::open(value, &SECTION, &super::SECTIONS, report)?;
    let name = fields.name(report);
    let choices = TYPES.map(|material| (material.0, material));
    let kind = fields.require("Type", "Diffuse, Reflective, ClearCoat or Refractive", report)?;
    let Some((type_name, used, read_kind)) = kind.choice(&choices, report) else {
        kind.meant(&choices).and_then(|(_, _, read_kind)| read_kind(&fields, report));
        return None;
    };
    fields.warn_unused(&SECTION, used, type_name, report);
    let kind = read_kind(&fields, report);
    let mut texture = |key| if used.contains(&key) { texture(&fields, key, context) } else { Some(None) };
    let (color, coat_color) = (texture("Color"), texture("ClearCoatColor"));
    let textures = TexturesDesc { color: color?, coat_color: coat_color? };
    Some(MaterialDesc { name, kind: kind?, textures })
}

/// The picture of a colour, if it is one; `None` after an error.
fn texture(fields: &Fields<'_>, key: &str, context: &mut Context<'_>) -> Option<Option<PictureDesc>> {
    match fields.get(key).filter(picture::is_named) {
        Some(value) => picture::read(value, context).map(Some),
        None => Some(None),
    }
}

/// A reflectance; white if it is not given, or a picture, which is read by [`texture`].
fn reflectance(fields: &Fields<'_>, key: &str, report: &mut Report) -> Option<Rgb> {
    let value = fields.get(key).filter(|value| !picture::is_named(value));
    value.map_or(Some(Rgb::ONE), |value| value.vector(Range::Unit, report))
}

fn diffuse(fields: &Fields<'_>, report: &mut Report) -> Option<MaterialKind> {
    let color = reflectance(fields, "Color", report);
    let strength = fields.number_or("EmissionStrength", Range::NonNegative, 0.0, report);
    let emitted = fields.vector_or("EmissionColor", Range::NonNegative, Rgb::ONE, report);
    let emission = emitted? * strength?;
    if emission.max_element() > MOST_RADIANCE {
        let value = fields.get("EmissionStrength").or(fields.get("EmissionColor"))?;
        value.error(&format!("times EmissionColor must be at most {MOST_RADIANCE:e}"), None, report);
        return None;
    }
    Some(MaterialKind::Diffuse { color: color?, emission })
}

fn reflective(fields: &Fields<'_>, report: &mut Report) -> Option<MaterialKind> {
    let color = reflectance(fields, "Color", report);
    let specularity = fields.number_or("Specularity", Range::Unit, 1.0, report);
    Some(MaterialKind::Reflective { color: color?, specularity: specularity? })
}

fn clear_coat(fields: &Fields<'_>, report: &mut Report) -> Option<MaterialKind> {
    let color = reflectance(fields, "Color", report);
    let coat = fields.number_or("ClearCoat", Range::Unit, 0.5, report);
    let coat_color = reflectance(fields, "ClearCoatColor", report);
    let specularity = fields.number_or("Specularity", Range::Unit, 1.0, report);
    Some(MaterialKind::ClearCoat {
        color: color?,
        coat: coat?,
        coat_color: coat_color?,
        specularity: specularity?,
    })
}

fn refractive(fields: &Fields<'_>, report: &mut Report) -> Option<MaterialKind> {
    let color = reflectance(fields, "Color", report);
    let ratio = fields.number_or("RefractionRatio", Range::Positive, 1.0, report);
    Some(MaterialKind::Refractive { color: color?, ratio: ratio? })
}
