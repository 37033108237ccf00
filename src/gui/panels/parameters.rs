//! The fields on the left: the picture, the render, the camera.

use crate::gui::form::Field;
use crate::gui::settings::{ACCELS, PRECISIONS, PreviewSize, SAMPLERS};
use crate::gui::studio::Studio;
use crate::render::AccelKind;
use crate::scene::desc::ApertureDesc;
use eframe::egui::{CollapsingHeader, ComboBox, Grid, Key, Slider, TextEdit, Ui};

/// Of a field with one number, and of each of three in a row.
const WIDE: f32 = 110.0;
const NARROW: f32 = 42.0;

pub(super) fn show(ui: &mut Ui, studio: &mut Studio) {
    CollapsingHeader::new("Picture").default_open(true).show(ui, |ui| {
        Grid::new("picture").num_columns(2).show(ui, |ui| {
            for field in [Field::Width, Field::Height, Field::Samples, Field::Bounces] {
                row(ui, studio, field, field.label());
            }
            image(ui, studio);
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
        input(ui, studio, field, WIDE).labelled_by(label.id);
        studio.form.show_error(ui, field);
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

/// The picture's file.
fn image(ui: &mut Ui, studio: &mut Studio) {
    let label = ui.label("File");
    let edit = TextEdit::singleline(&mut studio.kept.knobs.image).id_salt("image").desired_width(WIDE);
    let help = "The final picture is written there: .png, .exr (linear), with OpenImageIO .tif, .hdr, .jpg";
    let response = ui.add(edit).labelled_by(label.id).on_hover_text(help);
    if response.lost_focus() && ui.ctx().input(|input| input.key_pressed(Key::Enter)) {
        studio.render();
    }
    ui.end_row();
}

fn exposure(ui: &mut Ui, studio: &mut Studio) {
    let exposure = &mut studio.kept.knobs.exposure;
    ui.spacing_mut().slider_width = 90.0;
    let slider = Slider::new(exposure, -10.0..=10.0).clamping(eframe::egui::SliderClamping::Never);
    ui.horizontal(|ui| {
        let label = ui.label("Exposure").on_hover_text(Field::Exposure.help());
        ui.add(slider.fixed_decimals(1).suffix(" EV")).labelled_by(label.id);
    });
    *exposure = exposure.clamp(-100.0, 100.0);
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
        triple(ui, studio, "Position", Field::Position);
        triple(ui, studio, "Look at", Field::LookingAt);
    });
    if ui.button("Reset camera").on_hover_text("As in the file (R)").clicked() {
        studio.reset_camera();
    }
}

/// Three fields in a row.
fn triple(ui: &mut Ui, studio: &mut Studio, label: &str, field: fn(usize) -> Field) {
    let label = ui.label(label);
    ui.vertical(|ui| {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 3.0;
            for axis in 0..3 {
                input(ui, studio, field(axis), NARROW).labelled_by(label.id);
            }
        });
        (0..3).for_each(|axis| studio.form.show_error(ui, field(axis)));
    });
    ui.end_row();
}

fn choices(ui: &mut Ui, studio: &mut Studio) {
    let knobs = &mut studio.kept.knobs;
    let accels = ACCELS.into_iter().filter(|&accel| accel != AccelKind::Embree || cfg!(feature = "embree"));
    choice(ui, "Accelerator", &mut knobs.accel, accels, |accel| accel.name().into());
    choice(ui, "Precision", &mut knobs.precision, PRECISIONS, |precision| precision.name().into());
    choice(ui, "Sampler", &mut knobs.sampler, SAMPLERS, |sampler| sampler.to_string());
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
