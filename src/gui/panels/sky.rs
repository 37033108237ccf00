//! The sky's colours.

use crate::gui::studio::Studio;
use crate::math::Rgb;
use eframe::egui::{CollapsingHeader, DragValue, Grid, Id, Ui};

pub(super) fn show(ui: &mut Ui, studio: &mut Studio) {
    CollapsingHeader::new("Sky").default_open(true).show(ui, |ui| {
        let Some(editable) = &studio.editable else { return };
        let (mut sky, mut rotation) = (editable.environment.clone(), editable.rotation);
        Grid::new("sky").num_columns(2).show(ui, |ui| {
            if let Some(degrees) = &mut rotation {
                let label = ui.label("Rotation");
                ui.add(DragValue::new(degrees).speed(1.0).suffix("°")).labelled_by(label.id);
                ui.end_row();
            } else {
                for (label, color) in
                    [("Above", &mut sky.sky), ("Horizon", &mut sky.horizon), ("Below", &mut sky.ground)]
                {
                    let label = ui.label(label).id;
                    radiance(ui, label, color);
                    ui.end_row();
                }
            }
            let label = ui.label("Strength");
            let strength = DragValue::new(&mut sky.strength).speed(0.01).range(0.0..=1e6);
            ui.add(strength.clamp_existing_to_range(false)).labelled_by(label.id);
            ui.end_row();
        });
        studio.edit(|editable| {
            editable.environment = sky;
            editable.rotation = rotation;
        });
    });
}

/// A colour whose components may exceed 1: numbers, and a picker for what a screen can show.
pub(super) fn radiance(ui: &mut Ui, label: Id, color: &mut Rgb) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().interact_size.x = 34.0;
        if color.max_element() <= 1.0 {
            picker(ui, label, color);
        }
        components(ui, label, color, 1e6);
    });
}

/// A colour whose components are at most 1.
pub(super) fn reflectance(ui: &mut Ui, label: Id, color: &mut Rgb) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().interact_size.x = 34.0;
        picker(ui, label, color);
        components(ui, label, color, 1.0);
    });
}

fn picker(ui: &mut Ui, label: Id, color: &mut Rgb) {
    let mut shown = color.to_array().map(|component| component as f32);
    if ui.color_edit_button_rgb(&mut shown).labelled_by(label).changed() {
        // Three digits are more than a screen shows, and are what one would write.
        let component = |x: f32| (f64::from(x) * 1000.0).round() / 1000.0;
        *color = Rgb::from_array(shown.map(|x| component(x).clamp(0.0, 1.0)));
    }
}

fn components(ui: &mut Ui, label: Id, color: &mut Rgb, most: f64) {
    let mut values = color.to_array();
    for value in &mut values {
        ui.add(
            DragValue::new(value)
                .speed(0.005)
                .range(0.0..=most)
                .clamp_existing_to_range(false)
                .max_decimals(3),
        )
        .labelled_by(label);
    }
    if values != color.to_array() {
        *color = Rgb::from_array(values);
    }
}
