//! Fields of text with numbers in them: what they show, what is read from them, and what is wrong with that.

use super::settings::Knobs;
use crate::cli::console::digits;
use crate::picture::Format;
use crate::render::{MAX_BOUNCES, MAX_PIXELS, MAX_SAMPLES, MAX_SIDE, MIN_TIME};
use crate::scene::desc::{ApertureDesc, CameraDesc};
use eframe::egui::{Color32, Label, Response, RichText, Stroke, StrokeKind, TextEdit, Ui, Visuals};
use std::collections::HashMap;
use std::path::Path;

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
    /// The file of the final picture.
    File,
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
            Field::File => "File",
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

    /// Whether it is about the camera.
    fn is_of_camera(self) -> bool {
        use Field::{Focus, Fov, Lens, LookingAt, Position, Roll};
        matches!(self, Fov | Lens | Focus | Roll | Position(_) | LookingAt(_))
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
            Field::File => {
                "The final picture is written there: .png, .exr (linear), with OpenImageIO .tif, .hdr, .jpg"
            }
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
            Field::File => knobs.image.clone(),
            Field::Fov => shown(camera.fov * 180.0),
            Field::Lens => match camera.aperture {
                ApertureDesc::DepthOfField(size) | ApertureDesc::Radius(size) => shown(size),
            },
            Field::Focus => shown(camera.focus_distance),
            Field::Roll => shown(camera.angle),
            Field::Position(axis) => coordinate(camera.position[axis]),
            Field::LookingAt(axis) => coordinate(camera.looking_at[axis]),
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
            Field::Samples => knobs.samples = whole(text, 0, MAX_SAMPLES)?,
            Field::Bounces => knobs.bounces = whole(text, 1, MAX_BOUNCES.into())? as u32,
            Field::Noise => knobs.noise = optional(text, number(|x| x > 0.0, " > 0"))?,
            Field::Time => {
                let least = MIN_TIME.as_secs_f64();
                let in_range = number(move |x| (least..1e9).contains(&x), " of at least 0.1");
                knobs.time = optional(text, in_range)?;
            }
            Field::File => knobs.image = picture(text)?,
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

/// A coordinate, whose field is narrow: what was written as it was, what the mouse made with five digits.
fn coordinate(x: f64) -> String {
    let exact = digits(x, 7);
    if exact.parse() == Ok(x) { exact } else { digits(x, 5) }
}

/// Whether the numbers of the fields, each of which may be right, can't be together: the field to blame, and the reason.
fn conflict(knobs: &Knobs) -> Option<(Field, String)> {
    if knobs.samples == 0 && knobs.noise.is_none() && knobs.time.is_none() {
        return Some((Field::Samples, "0 needs a noise target or a time budget".into()));
    }
    let is_large = u64::from(knobs.width) * u64::from(knobs.height) > MAX_PIXELS;
    is_large.then(|| (Field::Height, format!("more than {MAX_PIXELS} pixels in all")))
}

/// The name of a picture.
fn picture(text: &str) -> Result<String, String> {
    match Format::of(Path::new(text)) {
        Ok(_) if Path::new(text).file_stem().is_some() => Ok(text.to_owned()),
        _ => Err(format!("expected a name that ends in {}", Format::extensions())),
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
    /// Why the picture's file could not be written when that was last tried.
    refusal: Option<String>,
}

impl Form {
    /// What is wrong with a field.
    pub fn error(&self, field: Field, knobs: &Knobs) -> Option<String> {
        let typed = || self.drafts.get(&field)?.error.clone();
        let refused = || self.refusal.clone().filter(|_| field == Field::File);
        let together = || conflict(knobs).filter(|(blamed, _)| *blamed == field).map(|(_, why)| why);
        typed().or_else(refused).or_else(together)
    }

    /// A field, if any, with which nothing can be rendered.
    pub fn wrong(&self, knobs: &Knobs) -> Option<(Field, String)> {
        let mut typed = self.drafts.iter().filter_map(|(&field, draft)| Some((field, draft.error.clone()?)));
        typed.next().or_else(|| conflict(knobs))
    }

    /// Forgets what was typed.
    pub fn clear(&mut self) {
        *self = Form::default();
    }

    /// Forgets what was typed about the camera.
    pub fn clear_camera(&mut self) {
        self.drafts.retain(|field, _| !field.is_of_camera());
    }

    /// Marks the picture's file, or no longer.
    pub fn set_refusal(&mut self, why: Option<String>) {
        self.refusal = why;
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
        if field == Field::File {
            self.refusal = None;
        }
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
        let is_wrong = self.error(field, knobs).is_some();
        let hint = if matches!(field, Field::Noise | Field::Time) { "none" } else { "" };
        let edit = TextEdit::singleline(&mut text).id_salt(field).desired_width(width).hint_text(hint);
        let edit = if is_wrong { edit.text_color(wrong_color(ui.visuals())) } else { edit };
        let mut response = ui.add(edit);
        let is_changed = response.changed() && self.type_text(field, &text, knobs, camera);
        // What is right is shown as it is understood once the field is left; what is wrong stays to be mended.
        if !response.has_focus() && self.drafts.get(&field).is_some_and(|draft| draft.error.is_none()) {
            self.drafts.remove(&field);
        }
        response = match self.error(field, knobs) {
            Some(error) => {
                let stroke = Stroke::new(1.0, wrong_color(ui.visuals()));
                ui.painter().rect_stroke(response.rect, 2.0, stroke, StrokeKind::Outside);
                response.on_hover_text(error)
            }
            None => response.on_hover_text(field.help()),
        };
        (response, is_changed)
    }

    /// Draws the reason below a field that is wrong.
    pub fn show_error(&self, ui: &mut Ui, field: Field, knobs: &Knobs) {
        if let Some(error) = self.error(field, knobs) {
            let text = RichText::new(error).small().color(wrong_color(ui.visuals()));
            ui.add(Label::new(text).wrap());
        }
    }
}

/// The colour of mistakes.
pub fn wrong_color(visuals: &Visuals) -> Color32 {
    if visuals.dark_mode { Color32::from_rgb(255, 120, 110) } else { Color32::from_rgb(190, 20, 20) }
}
