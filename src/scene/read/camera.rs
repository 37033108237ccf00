//! The `Camera` section.

use crate::scene::desc::{ApertureDesc, CameraDesc};
use crate::scene::diagnostic::Report;
use crate::scene::yaml::fields::{Fields, Section};
use crate::scene::yaml::value::{Range, Value};

/// The keys of the camera.
pub(super) const SECTION: Section = Section {
    name: "Camera",
    keys: &[
        "Position",
        "LookingAt",
        "Fov",
        "FocusDistance",
        "DepthOfField",
        "ApertureRadius",
        "Angle",
        "Name",
    ],
};

/// Reads the camera; `None` after an error.
pub(super) fn read(value: Value<'_>, report: &mut Report) -> Option<CameraDesc> {
    let fields = Fields::open(value, &SECTION, &super::SECTIONS, report)?;
    let position = fields.vector("Position", Range::Finite, "[x, y, z], the centre of the lens", report);
    let meaning = "[x, y, z], the point in the middle of the picture";
    let looking_at = fields.vector("LookingAt", Range::Finite, meaning, report);
    if position.is_some()
        && position == looking_at
        && let Some(value) = fields.get("LookingAt")
    {
        value.error(
            "must differ from Position",
            Some("the camera has no direction to look in".into()),
            report,
        );
    }
    let meaning = "the horizontal field of view as a fraction of pi, such as 0.33 for 59.4 degrees";
    let fov = fov(&fields, meaning, report);
    let meaning = "the distance of the sharp plane";
    let focus_distance = fields.number("FocusDistance", Range::Positive, meaning, report);
    let aperture = aperture(&fields, report);
    let angle = fields.number_or("Angle", Range::Finite, 0.0, report);
    fields.name(report);
    Some(CameraDesc {
        position: position?,
        looking_at: looking_at?,
        fov: fov?,
        focus_distance: focus_distance?,
        aperture: aperture?,
        angle: angle?,
    })
}

/// The field of view. Degrees are the usual mistake, and easy to recognise.
fn fov(fields: &Fields<'_>, meaning: &str, report: &mut Report) -> Option<f64> {
    let value = fields.require("Fov", meaning, report)?;
    match value.node.number() {
        Some(degrees) if (10.0..180.0).contains(&degrees) => {
            let help = format!("Fov is a fraction of pi; {degrees} degrees are {:.4}", degrees / 180.0);
            value.refuse("a finite number > 0 and < 1", Some(help), report);
            None
        }
        _ => value.number(Range::OpenUnit, report),
    }
}

/// The size of the lens, given in one way only.
fn aperture(fields: &Fields<'_>, report: &mut Report) -> Option<ApertureDesc> {
    let Some(radius) = fields.get("ApertureRadius") else {
        let strength = fields.number_or("DepthOfField", Range::NonNegative, 0.0, report);
        return strength.map(ApertureDesc::DepthOfField);
    };
    if let Some(strength) = fields.get("DepthOfField") {
        let help = "both say how large the lens is; keep one".to_owned();
        radius.error("excludes DepthOfField", Some(help), report);
        strength.number(Range::NonNegative, report);
    }
    radius.number(Range::NonNegative, report).map(ApertureDesc::Radius)
}
