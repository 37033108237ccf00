//! The `Environment` section.

use super::{Context, MOST_RADIANCE, picture};
use crate::math::Rgb;
use crate::scene::desc::{EnvironmentDesc, EnvironmentMapDesc};
use crate::scene::diagnostic::Report;
use crate::scene::yaml::fields::{Fields, Section};
use crate::scene::yaml::value::{Range, Value};

/// The keys of the environment.
pub(super) const SECTION: Section = Section {
    name: "Environment",
    keys: &["SkyColor", "HorizonColor", "GroundColor", "Strength", "Image", "Rotation", "ColorSpace", "Name"],
};

/// The keys that a gradient uses.
const GRADIENT: &[&str] = &["SkyColor", "HorizonColor", "GroundColor", "Strength", "Name"];

/// The sky of a scene that does not say which.
pub(super) fn default() -> EnvironmentDesc {
    EnvironmentDesc {
        sky: Rgb::new(0.2, 0.5, 1.0),
        horizon: Rgb::new(0.7, 0.8, 0.8),
        ground: Rgb::new(0.1, 0.1, 0.1),
        strength: 1.0,
    }
}

/// The colours that a picture excludes.
const COLORS: [&str; 3] = ["SkyColor", "HorizonColor", "GroundColor"];

/// Reads the environment and its picture, if it has one; `None` after an error.
pub(super) fn read(
    value: Value<'_>,
    context: &mut Context<'_>,
) -> Option<(EnvironmentDesc, Option<EnvironmentMapDesc>)> {
    let fields = Fields::open(value, &SECTION, &super::SECTIONS, context.report)?;
    fields.name(context.report);
    match fields.get("Image") {
        Some(image) => map(&fields, image, context).map(|(sky, map)| (sky, Some(map))),
        None => gradient(value, &fields, context.report).map(|sky| (sky, None)),
    }
}

/// Reads a picture of the whole sphere.
fn map(
    fields: &Fields<'_>,
    image: Value<'_>,
    context: &mut Context<'_>,
) -> Option<(EnvironmentDesc, EnvironmentMapDesc)> {
    if let Some(color) = COLORS.into_iter().find(|color| fields.get(color).is_some()) {
        let help = "both say what the sky looks like; keep one".to_owned();
        image.error(&format!("excludes {color}"), Some(help), context.report);
        return None;
    }
    let strength = fields.number_or("Strength", Range::NonNegative, 1.0, context.report);
    let rotation = fields.number_or("Rotation", Range::Finite, 0.0, context.report);
    let encoded = picture::color_space(fields, context.report);
    let picture = context.pictures.get(image, encoded?, context.report)?;
    let strength = strength?;
    if f64::from(picture.picture.largest()) * strength > MOST_RADIANCE {
        let value = fields.get("Strength").unwrap_or(image);
        value.error(&format!("times the picture must be at most {MOST_RADIANCE:e}"), None, context.report);
        return None;
    }
    let sky = EnvironmentDesc { strength, ..default() };
    Some((sky, EnvironmentMapDesc { picture, rotation: rotation? }))
}

/// Reads a sky of three colours.
fn gradient(value: Value<'_>, fields: &Fields<'_>, report: &mut Report) -> Option<EnvironmentDesc> {
    fields.warn_unused(&SECTION, GRADIENT, "a sky of three colours", report);
    let sky = fields.vector("SkyColor", Range::NonNegative, "[r, g, b], the radiance from above", report);
    let meaning = "[r, g, b], the radiance from the horizon";
    let horizon = fields.vector("HorizonColor", Range::NonNegative, meaning, report);
    let ground =
        fields.vector("GroundColor", Range::NonNegative, "[r, g, b], the radiance from below", report);
    let strength = fields.number_or("Strength", Range::NonNegative, 1.0, report);
    let (sky, horizon, ground, strength) = (sky?, horizon?, ground?, strength?);
    if [sky, horizon, ground].iter().any(|color| color.max_element() * strength > MOST_RADIANCE) {
        let value = fields.get("Strength").unwrap_or(value);
        value.error(&format!("times the colours must be at most {MOST_RADIANCE:e}"), None, report);
        return None;
    }
    Some(EnvironmentDesc { sky, horizon, ground, strength })
}
