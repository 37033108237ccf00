//! The pixel under the mouse, the histogram, and the stored picture.

use super::Desk;
use super::objects::name;
use crate::cli::console::{digits, printable};
use crate::gui::display::{Shown, View};
use crate::gui::session::Frame;
use crate::gui::studio::Studio;
use crate::render::FAR;
use eframe::egui::{CollapsingHeader, Color32, Grid, Pos2, Sense, Shape, Slider, Stroke, Ui, vec2};

pub(super) fn show(ui: &mut Ui, studio: &mut Studio, desk: &mut Desk) {
    let canvas = &desk.canvas;
    CollapsingHeader::new("Pixel").default_open(true).show(ui, |ui| {
        let frame = studio.session.frame();
        let lines = frame.zip(canvas.pixel).and_then(|(frame, pixel)| lines(&frame, pixel));
        let lines = lines.unwrap_or_else(|| NAMES.map(|name| (name, "–".to_owned())));
        Grid::new("pixel").num_columns(2).show(ui, |ui| {
            for (name, value) in lines {
                ui.label(name);
                ui.monospace(value);
                ui.end_row();
            }
        });
    });
    CollapsingHeader::new("Histogram").default_open(true).show(ui, |ui| {
        if let Some(shown) = canvas.shown() {
            if shown.request.view.shows_values() {
                histogram(ui, shown);
            } else {
                ui.weak("of the picture and of the albedo");
            }
            if let Some(error) = shown.error {
                ui.weak(format!("relative error of all: {} %", digits(100.0 * error, 2)));
            }
        }
    });
    CollapsingHeader::new("Compare").default_open(true).show(ui, |ui| compare(ui, studio, desk));
}

/// The lines of the inspector.
const NAMES: [&str; 10] =
    ["Pixel", "Red", "Green", "Blue", "Samples", "Std. error", "Depth", "Normal", "Object", "Material"];

fn lines(frame: &Frame, [x, y]: [usize; 2]) -> Option<[(&'static str, String); 10]> {
    let pixel = frame.index(x, y)?;
    let light = frame.light.get(pixel)?;
    let look = frame.look.as_ref();
    let depth = look.and_then(|look| look.depth.get(pixel)).filter(|&&depth| depth < FAR);
    let normal = look.and_then(|look| look.normal.get(3 * pixel..3 * pixel + 3));
    let object = look.map(|look| match look.object_at(pixel) {
        Some(object) => {
            frame.loaded.scene.desc.objects.get(object).map_or_else(String::new, |desc| name(object, desc))
        }
        None => "sky".to_owned(),
    });
    let material = look.and_then(|look| look.object_at(pixel)).map(|object| {
        let surface = frame.editable.surfaces.get(object).and_then(Option::as_ref);
        surface.map_or("of the mesh's file", |surface| surface.kind.name()).to_owned()
    });
    let shown = |value: Option<String>| value.unwrap_or_else(|| "–".into());
    let number = |value: f64| digits(value, 5);
    let normal = normal.map(|normal| {
        let parts: Vec<String> = normal.iter().map(|value| format!("{value:.2}")).collect();
        parts.join(" ")
    });
    let values = [
        format!("{x}, {y}"),
        number(light.x),
        number(light.y),
        number(light.z),
        frame.count(pixel).to_string(),
        shown(frame.error(pixel).map(|error| digits(error.into(), 3))),
        shown(depth.map(|&depth| digits(depth.into(), 5))),
        shown(normal),
        shown(object),
        shown(material),
    ];
    let mut lines = NAMES.map(|name| (name, String::new()));
    for (line, value) in lines.iter_mut().zip(values) {
        line.1 = value;
    }
    Some(lines)
}

fn histogram(ui: &mut Ui, shown: &Shown) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 60.0), Sense::hover());
    ui.painter().rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
    let most = shown.histogram.iter().flat_map(|channel| &channel[1..255]).copied().max().unwrap_or(0).max(1);
    let is_dark = ui.visuals().dark_mode;
    let colors = if is_dark {
        [Color32::from_rgb(255, 90, 90), Color32::from_rgb(90, 220, 90), Color32::from_rgb(110, 150, 255)]
    } else {
        [Color32::from_rgb(200, 30, 30), Color32::from_rgb(20, 130, 20), Color32::from_rgb(30, 60, 200)]
    };
    for (channel, color) in shown.histogram.iter().zip(colors) {
        let points = channel.iter().enumerate().map(|(byte, &count)| {
            let height = (count as f32 / most as f32).sqrt().min(1.0);
            Pos2::new(
                rect.left() + rect.width() * (byte as f32 + 0.5) / 256.0,
                rect.bottom() - height * (rect.height() - 2.0),
            )
        });
        ui.painter().add(Shape::line(points.collect(), Stroke::new(1.0, color)));
    }
    response.on_hover_text("How often each brightness is on the screen; heights are square roots");
    let total = shown.image.pixels.len().max(1) as f64;
    let share = |byte: usize| {
        let count = shown.histogram.iter().map(|channel| channel[byte]).max().unwrap_or(0);
        100.0 * f64::from(count) / total
    };
    if shown.request.view == View::Picture {
        ui.weak(format!("black {:.1} %, white {:.1} %", share(0), share(255)));
    }
}

fn compare(ui: &mut Ui, studio: &mut Studio, desk: &mut Desk) {
    ui.horizontal(|ui| {
        if ui.button("Store as A").on_hover_text("Keep this picture to compare others with (A)").clicked() {
            studio.store();
        }
        if ui.button("A from file…").on_hover_text("Compare with a picture of this size").clicked() {
            desk.dialogs.store_picture(studio, ui.ctx());
        }
        let mut is_on = studio.wipe.is_some();
        let has_stored = studio.stored.is_some();
        ui.add_enabled_ui(has_stored, |ui| {
            if ui.checkbox(&mut is_on, "Wipe").on_hover_text("A on the left (W)").changed() {
                studio.wipe = is_on.then_some(0.5);
            }
        });
    });
    if let Some(share) = &mut studio.wipe {
        ui.horizontal(|ui| {
            let label = ui.label("A ends at");
            ui.add(Slider::new(share, 0.0..=1.0).show_value(false)).labelled_by(label.id);
        });
    }
    if let Some(stored) = &studio.stored {
        let [width, height] = stored.size();
        let file = studio.stored_file.as_ref().and_then(|path| path.file_name());
        let origin = file
            .map_or_else(|| format!("{} samples", stored.samples), |name| printable(&name.to_string_lossy()));
        ui.weak(format!("A: {width} x {height}, {origin}"));
    }
}
