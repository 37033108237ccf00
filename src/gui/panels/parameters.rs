//! The fields on the left: the picture, the render, the camera.

use super::number::{ranged, reason};
use crate::accel::Precision;
use crate::gui::form::Field;
use crate::gui::settings::{Knobs, PreviewSize};
use crate::gui::studio::Studio;
use crate::output::Aov;
use crate::picture::{Depth, Format};
use crate::render::AccelKind;
use crate::sampling::SamplerKind;
use crate::scene::desc::ApertureDesc;
use eframe::egui::{CollapsingHeader, ComboBox, Grid, Id, Key, Slider, SliderClamping, TextEdit, Ui};

/// Of a field with one number.
const WIDE: f32 = 110.0;
/// Of the label in front of three fields in a row, which share what is left.
const LABEL: f32 = 52.0;
/// Between three fields in a row.
const GAP: f32 = 3.0;
/// Of the reason below a field, so that the panel does not grow.
const REASON: f32 = 140.0;

pub(super) fn show(ui: &mut Ui, studio: &mut Studio) {
    CollapsingHeader::new("Picture").default_open(true).show(ui, |ui| {
        Grid::new("picture").num_columns(2).show(ui, |ui| {
            for field in [Field::Width, Field::Height, Field::Samples, Field::Bounces, Field::File] {
                row(ui, studio, field, field.label());
            }
            file(ui, &mut studio.kept.knobs);
        });
        exposure(ui, studio);
    });
    CollapsingHeader::new("Camera").default_open(true).show(ui, |ui| camera(ui, studio));
    CollapsingHeader::new("Render").default_open(true).show(ui, |ui| {
        Grid::new("render").num_columns(2).show(ui, |ui| {
            row(ui, studio, Field::Noise, Field::Noise.label());
            row(ui, studio, Field::Time, Field::Time.label());
            choices(ui, studio);
        });
    });
}

/// A label and a field.
fn row(ui: &mut Ui, studio: &mut Studio, field: Field, label: &str) {
    let label = ui.label(label);
    ui.vertical(|ui| {
        ui.set_max_width(REASON);
        input(ui, studio, field, WIDE).labelled_by(label.id);
        studio.form.show_error(ui, field, &studio.kept.knobs);
    });
    ui.end_row();
}

/// A field. Enter starts the final render.
fn input(ui: &mut Ui, studio: &mut Studio, field: Field, width: f32) -> eframe::egui::Response {
    let Some(mut camera) = studio.editable.as_ref().map(|editable| editable.camera.clone()) else {
        let mut empty = String::new();
        return ui.add_enabled(false, TextEdit::singleline(&mut empty).desired_width(width));
    };
    let (response, is_changed) = studio.form.show(ui, field, width, &mut studio.kept.knobs, &mut camera);
    if is_changed {
        studio.edit(|editable| editable.camera = camera);
    }
    if response.lost_focus() && ui.ctx().input(|input| input.key_pressed(Key::Enter)) {
        studio.render();
    }
    response
}

/// What the picture's file holds.
fn file(ui: &mut Ui, knobs: &mut Knobs) {
    let format = knobs.format();
    let depths = format.map_or(&[][..], Format::depths);
    let default = depths.first().map_or("as the file", |depth| depth.name());
    // One that this format does not have waits for one that does.
    let mut depth = knobs.depth.filter(|depth| depths.contains(depth));
    let before = depth;
    let others = depths.iter().skip(1).copied().map(Some);
    choice(ui, "Depth", &mut depth, [None].into_iter().chain(others), |depth| {
        depth.map_or(default, Depth::name).into()
    });
    if depth != before {
        knobs.depth = depth;
    }
    let label = ui.label("Channels");
    let is_exr = format == Some(Format::Exr);
    let chosen = if is_exr { knobs.aov.len() } else { 0 };
    let title = if chosen == 0 { "light".to_owned() } else { format!("light and {chosen} more") };
    let menu = ui.add_enabled_ui(is_exr, |ui| {
        ui.menu_button(title, |ui| {
            for aov in Aov::ALL {
                let mut is_on = knobs.aov.contains(&aov);
                if ui.checkbox(&mut is_on, aov.name()).changed() {
                    knobs.aov = Aov::ALL
                        .into_iter()
                        .filter(|one| if *one == aov { is_on } else { knobs.aov.contains(one) })
                        .collect();
                }
            }
        })
        .response
    });
    menu.inner.labelled_by(label.id).on_disabled_hover_text("An .exr holds more than the light");
    ui.end_row();
    let label = ui.label("Denoise");
    let help = "By Open Image Denoise; the noisy picture is kept beside, as NAME.noisy";
    ui.checkbox(&mut knobs.denoise, "").labelled_by(label.id).on_hover_text(help);
    ui.end_row();
}

fn exposure(ui: &mut Ui, studio: &mut Studio) {
    let exposure = &mut studio.kept.knobs.exposure;
    ui.spacing_mut().slider_width = 90.0;
    let help = "Brightness of what is shown, and of pictures that are not linear";
    let row = ui.horizontal(|ui| {
        let label = ui.label("Exposure").on_hover_text(help);
        ranged(ui, Id::unique("exposure"), exposure, -100.0..=100.0, |ui, shown| {
            let slider = Slider::new(shown, -10.0..=10.0).clamping(SliderClamping::Never);
            ui.add(slider.fixed_decimals(1).suffix(" EV")).labelled_by(label.id)
        })
    });
    reason(ui, row.inner);
}

fn camera(ui: &mut Ui, studio: &mut Studio) {
    let is_radius = studio
        .editable
        .as_ref()
        .is_some_and(|editable| matches!(editable.camera.aperture, ApertureDesc::Radius(_)));
    let lens = if is_radius { "Aperture radius" } else { Field::Lens.label() };
    Grid::new("camera").num_columns(2).show(ui, |ui| {
        row(ui, studio, Field::Fov, Field::Fov.label());
        row(ui, studio, Field::Lens, lens);
        row(ui, studio, Field::Focus, Field::Focus.label());
        row(ui, studio, Field::Roll, Field::Roll.label());
    });
    triple(ui, studio, "Position", Field::Position);
    triple(ui, studio, "Look at", Field::LookingAt);
    if ui.button("Reset camera").on_hover_text("As in the file (R)").clicked() {
        studio.reset_camera();
    }
}

/// Three fields in a row, as wide as the panel allows.
fn triple(ui: &mut Ui, studio: &mut Studio, label: &str, field: fn(usize) -> Field) {
    let width = (ui.available_width() - LABEL) / 3.0 - GAP;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = GAP;
        let start = ui.cursor().left();
        let label = ui.label(label);
        ui.add_space((LABEL - (label.rect.right() - start)).max(0.0));
        for axis in 0..3 {
            input(ui, studio, field(axis), width).labelled_by(label.id);
        }
    });
    (0..3).for_each(|axis| studio.form.show_error(ui, field(axis), &studio.kept.knobs));
}

fn choices(ui: &mut Ui, studio: &mut Studio) {
    let knobs = &mut studio.kept.knobs;
    let accels = AccelKind::BUILT.iter().copied();
    choice(ui, "Accelerator", &mut knobs.accel, accels, |accel| accel.name().into());
    choice(ui, "Precision", &mut knobs.precision, Precision::ALL, |precision| precision.name().into());
    choice(ui, "Sampler", &mut knobs.sampler, SamplerKind::ALL, |sampler| sampler.name().into());
    choice(ui, "Preview size", &mut knobs.preview, PreviewSize::ALL, |size| size.name().into());
}

fn choice<T: Copy + PartialEq>(
    ui: &mut Ui,
    label: &str,
    value: &mut T,
    all: impl IntoIterator<Item = T>,
    name: impl Fn(T) -> String,
) {
    let text = ui.label(label);
    let list = ComboBox::from_id_salt(label).selected_text(name(*value)).width(WIDE).show_ui(ui, |ui| {
        for one in all {
            ui.selectable_value(value, one, name(one));
        }
    });
    list.response.labelled_by(text.id);
    ui.end_row();
}
