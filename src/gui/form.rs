//! Fields of text with numbers in them: what they show, what is read from them, and what is wrong with that.

use super::settings::Knobs;
use crate::cli::console::digits;
use crate::render::{MAX_BOUNCES, MAX_SAMPLES, MAX_SIDE, MIN_TIME};
use crate::scene::desc::{ApertureDesc, CameraDesc};
use eframe::egui::{Color32, Response, RichText, Stroke, StrokeKind, TextEdit, Ui};
use std::collections::HashMap;

/// The fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Field {
    /// Pixels in a row.
    Width,
    /// Rows.
    Height,
    /// Samples per pixel.
    Samples,
    /// Longest path.
    Bounces,
    /// Relative error at which blocks stop.
    Noise,
    /// Seconds of a final render.
    Time,
    /// Brightness in stops.
    Exposure,
    /// Degrees.
    Fov,
    /// `DepthOfField` or `ApertureRadius`.
    Lens,
    /// Distance of the sharp plane.
    Focus,
    /// Degrees.
    Roll,
    /// A coordinate of the camera.
    Position(usize),
    /// A coordinate of the point that it looks at.
    LookingAt(usize),
}

impl Field {
    /// The name in the window.
    pub const fn label(self) -> &'static str {
        match self {
            Field::Width => "Width",
            Field::Height => "Height",
            Field::Samples => "Samples",
            Field::Bounces => "Bounces",
            Field::Noise => "Noise target",
            Field::Time => "Time budget (s)",
            Field::Exposure => "Exposure (stops)",
            Field::Fov => "Field of view (°)",
            Field::Lens => "Depth of field",
            Field::Focus => "Focus distance",
            Field::Roll => "Roll (°)",
            Field::Position(0) => "Position x",
            Field::Position(1) => "Position y",
            Field::Position(_) => "Position z",
            Field::LookingAt(0) => "Look at x",
            Field::LookingAt(1) => "Look at y",
            Field::LookingAt(_) => "Look at z",
        }
    }

    /// What it is about.
    pub const fn help(self) -> &'static str {
        match self {
            Field::Width | Field::Height => "Pixels of the picture",
            Field::Samples => {
                "Samples per pixel; with a noise target or a time budget the most, 0 for no limit"
            }
            Field::Bounces => "Longest path in ray segments; 1 shows only lights and the sky",
            Field::Noise => {
                "Relative error at which blocks of the final picture stop, such as 0.02; empty: all take the samples"
            }
            Field::Time => "The best picture within this time of sampling; empty: no limit",
            Field::Exposure => "Brightness of what is shown, and of pictures that are not linear",
            Field::Fov => "Horizontal, between the edges of the picture",
            Field::Lens => "Size of the lens: 0 is a pinhole, where everything is sharp",
            Field::Focus => "Distance of the sharp plane along the viewing direction; F and a click set it",
            Field::Roll => "Turns the camera about its viewing direction",
            Field::Position(_) => "Centre of the lens",
            Field::LookingAt(_) => "The point in the middle of the picture",
        }
    }

    /// What it shows.
    pub fn read(self, knobs: &Knobs, camera: &CameraDesc) -> String {
        let shown = |x: f64| digits(x, 7);
        match self {
            Field::Width => knobs.width.to_string(),
            Field::Height => knobs.height.to_string(),
            Field::Samples => knobs.samples.to_string(),
            Field::Bounces => knobs.bounces.to_string(),
            Field::Noise => knobs.noise.map(shown).unwrap_or_default(),
            Field::Time => knobs.time.map(shown).unwrap_or_default(),
            Field::Exposure => shown(knobs.exposure),
            Field::Fov => shown(camera.fov * 180.0),
            Field::Lens => match camera.aperture {
                ApertureDesc::DepthOfField(size) | ApertureDesc::Radius(size) => shown(size),
            },
            Field::Focus => shown(camera.focus_distance),
            Field::Roll => shown(camera.angle),
            Field::Position(axis) => shown(camera.position[axis]),
            Field::LookingAt(axis) => shown(camera.looking_at[axis]),
        }
    }

    /// Takes what was typed.
    ///
    /// # Errors
    /// Why it can't be taken; then nothing is changed.
    pub fn write(self, text: &str, knobs: &mut Knobs, camera: &mut CameraDesc) -> Result<(), String> {
        match self {
            Field::Width => knobs.width = whole(text, 1, MAX_SIDE.into())? as u32,
            Field::Height => knobs.height = whole(text, 1, MAX_SIDE.into())? as u32,
            Field::Samples => {
                let least = u64::from(knobs.noise.is_none() && knobs.time.is_none());
                knobs.samples = whole(text, least, MAX_SAMPLES)?;
            }
            Field::Bounces => knobs.bounces = whole(text, 1, MAX_BOUNCES.into())? as u32,
            Field::Noise => knobs.noise = optional(text, number(|x| x > 0.0, " > 0"))?,
            Field::Time => {
                let least = MIN_TIME.as_secs_f64();
                let in_range = number(move |x| (least..1e9).contains(&x), " of at least 0.1");
                knobs.time = optional(text, in_range)?;
            }
            Field::Exposure => knobs.exposure = number(|x| x.abs() <= 100.0, " from -100 to 100")(text)?,
            Field::Fov => camera.fov = number(|x| x > 0.0 && x < 180.0, " > 0 and < 180")(text)? / 180.0,
            Field::Lens => {
                let size = number(|x| x >= 0.0, " >= 0")(text)?;
                camera.aperture = match camera.aperture {
                    ApertureDesc::DepthOfField(_) => ApertureDesc::DepthOfField(size),
                    ApertureDesc::Radius(_) => ApertureDesc::Radius(size),
                };
            }
            Field::Focus => camera.focus_distance = number(|x| x > 0.0, " > 0")(text)?,
            Field::Roll => camera.angle = number(|_| true, "")(text)?,
            Field::Position(axis) => {
                let mut position = camera.position;
                position[axis] = number(|_| true, "")(text)?;
                apart(position, camera.looking_at)?;
                camera.position = position;
            }
            Field::LookingAt(axis) => {
                let mut looking_at = camera.looking_at;
                looking_at[axis] = number(|_| true, "")(text)?;
                apart(camera.position, looking_at)?;
                camera.looking_at = looking_at;
            }
        }
        Ok(())
    }
}

fn apart(a: crate::math::DVec3, b: crate::math::DVec3) -> Result<(), String> {
    if a == b { Err("the camera must not look at itself".into()) } else { Ok(()) }
}

fn whole(text: &str, least: u64, most: u64) -> Result<u64, String> {
    let number = text.trim().parse().ok().filter(|number| (least..=most).contains(number));
    number.ok_or_else(|| format!("expected a whole number from {least} to {most}"))
}

fn number(is_right: impl Fn(f64) -> bool, range: &'static str) -> impl Fn(&str) -> Result<f64, String> {
    move |text| {
        let number = text.trim().parse().ok().filter(|&x: &f64| x.is_finite() && is_right(x));
        number.ok_or_else(|| format!("expected a number{range}"))
    }
}

fn optional(text: &str, parse: impl Fn(&str) -> Result<f64, String>) -> Result<Option<f64>, String> {
    if text.trim().is_empty() { Ok(None) } else { parse(text).map(Some) }
}

/// What is in a field while it differs from what it should show.
#[derive(Clone, Debug, Default)]
struct Draft {
    text: String,
    error: Option<String>,
}

/// All fields of the window.
#[derive(Debug, Default)]
pub struct Form {
    drafts: HashMap<Field, Draft>,
}

impl Form {
    /// What is wrong with a field.
    pub fn error(&self, field: Field) -> Option<&str> {
        self.drafts.get(&field)?.error.as_deref()
    }

    /// The first field, if any, that holds something wrong.
    pub fn wrong(&self) -> Option<(Field, &str)> {
        self.drafts.iter().find_map(|(&field, draft)| Some((field, draft.error.as_deref()?)))
    }

    /// Forgets what was typed.
    pub fn clear(&mut self) {
        self.drafts.clear();
    }

    /// Types into a field.
    pub fn type_text(
        &mut self,
        field: Field,
        text: &str,
        knobs: &mut Knobs,
        camera: &mut CameraDesc,
    ) -> bool {
        let error = field.write(text, knobs, camera).err();
        let is_right = error.is_none();
        self.drafts.insert(field, Draft { text: text.to_owned(), error });
        is_right
    }

    /// Draws a field; whether what it stands for has changed.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        field: Field,
        width: f32,
        knobs: &mut Knobs,
        camera: &mut CameraDesc,
    ) -> (Response, bool) {
        let draft = self.drafts.get(&field);
        let mut text = draft.map_or_else(|| field.read(knobs, camera), |draft| draft.text.clone());
        let is_wrong = draft.is_some_and(|draft| draft.error.is_some());
        let edit = TextEdit::singleline(&mut text).id_salt(field).desired_width(width);
        let edit = if is_wrong { edit.text_color(wrong_color(ui)) } else { edit };
        let mut response = ui.add(edit);
        let is_changed = response.changed() && self.type_text(field, &text, knobs, camera);
        // What is right is shown as it is understood once the field is left; what is wrong stays to be mended.
        if !response.has_focus() && self.error(field).is_none() {
            self.drafts.remove(&field);
        }
        response = match self.error(field) {
            Some(error) => {
                let stroke = Stroke::new(1.0, wrong_color(ui));
                ui.painter().rect_stroke(response.rect, 2.0, stroke, StrokeKind::Outside);
                response.on_hover_text(error)
            }
            None => response.on_hover_text(field.help()),
        };
        (response, is_changed)
    }

    /// Draws the reason below a field that is wrong.
    pub fn show_error(&self, ui: &mut Ui, field: Field) {
        if let Some(error) = self.error(field) {
            ui.label(RichText::new(error).small().color(wrong_color(ui)));
        }
    }
}

/// The colour of mistakes.
pub fn wrong_color(ui: &Ui) -> Color32 {
    if ui.visuals().dark_mode { Color32::from_rgb(255, 120, 110) } else { Color32::from_rgb(190, 20, 20) }
}
