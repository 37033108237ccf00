//! The `Environment` section.

use super::MOST_RADIANCE;
use super::PICTURES;
use crate::math::Rgb;
use crate::scene::desc::EnvironmentDesc;
use crate::scene::diagnostic::Report;
use crate::scene::yaml::fields::{Fields, Section};
use crate::scene::yaml::value::{Range, Value};

/// The keys of the environment.
pub(super) const SECTION: Section = Section {
    name: "Environment",
    keys: &["SkyColor", "HorizonColor", "GroundColor", "Strength", "Image", "Rotation", "Name"],
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

/// Reads the environment; `None` after an error.
pub(super) fn read(value: Value<'_>, report: &mut Report) -> Option<EnvironmentDesc> {
    let fields = Fields::open(value, &SECTION, &super::SECTIONS, report)?;
    fields.name(report);
    if let Some(image) = fields.get("Image") {
        let help = "give SkyColor, HorizonColor and GroundColor instead".to_owned();
        image.error(PICTURES, Some(help), report);
        return None;
    }
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
