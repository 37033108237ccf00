//! Pictures in place of colours.

use super::Context;
use crate::scene::desc::PictureDesc;
use crate::scene::diagnostic::Report;
use crate::scene::yaml::fields::{Fields, Section};
use crate::scene::yaml::node::Kind;
use crate::scene::yaml::value::Value;

/// The keys of a colour that is a picture.
pub(super) const SECTION: Section = Section { name: "a picture", keys: &["Image", "ColorSpace"] };

/// Whether a value is a mapping that names a picture.
pub(super) fn is_named(value: &Value<'_>) -> bool {
    matches!(&value.node.kind, Kind::Map(entries) if entries.iter().any(|(key, _)| key.text() == Some("Image")))
}

/// Reads a mapping that names a picture; `None` after an error.
pub(super) fn read(value: Value<'_>, context: &mut Context<'_>) -> Option<PictureDesc> {
    let fields = Fields::open(value, &SECTION, &super::SECTIONS, context.report)?;
    let encoded = color_space(&fields, context.report);
    let image = fields.require("Image", "the name of a picture", context.report)?;
    context.pictures.get(image, encoded?, context.report)
}

/// `ColorSpace`: whether values are sRGB-encoded, if it is given; `None` after an error.
pub(super) fn color_space(fields: &Fields<'_>, report: &mut Report) -> Option<Option<bool>> {
    let choices = [("sRGB", true), ("Linear", false)];
    match fields.get("ColorSpace") {
        Some(value) => value.choice(&choices, report).map(Some),
        None => Some(None),
    }
}
