//! The sky's colours.

use crate::gui::studio::Studio;
use crate::math::Rgb;
use eframe::egui::{CollapsingHeader, DragValue, Grid, Ui};

pub(super) fn show(ui: &mut Ui, studio: &mut Studio) {
    CollapsingHeader::new("Sky").default_open(true).show(ui, |ui| {
        let Some(editable) = &studio.editable else { return };
        let (mut sky, mut rotation) = (editable.environment.clone(), editable.rotation);
        Grid::new("sky").num_columns(2).show(ui, |ui| {
            if let Some(degrees) = &mut rotation {
                ui.label("Rotation");
                ui.add(DragValue::new(degrees).speed(1.0).suffix("°"));
                ui.end_row();
            } else {
                for (label, color) in
                    [("Above", &mut sky.sky), ("Horizon", &mut sky.horizon), ("Below", &mut sky.ground)]
                {
                    ui.label(label);
                    radiance(ui, color);
                    ui.end_row();
                }
            }
            ui.label("Strength");
            ui.add(
                DragValue::new(&mut sky.strength).speed(0.01).range(0.0..=1e6).clamp_existing_to_range(false),
            );
            ui.end_row();
        });
        studio.edit(|editable| {
            editable.environment = sky;
            editable.rotation = rotation;
        });
    });
}

/// A colour whose components may exceed 1: numbers, and a picker for what a screen can show.
pub(super) fn radiance(ui: &mut Ui, color: &mut Rgb) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().interact_size.x = 34.0;
        if color.max_element() <= 1.0 {
            picker(ui, color);
        }
        components(ui, color, 1e6);
    });
}

/// A colour whose components are at most 1.
pub(super) fn reflectance(ui: &mut Ui, color: &mut Rgb) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().interact_size.x = 34.0;
        picker(ui, color);
        components(ui, color, 1.0);
    });
}

fn picker(ui: &mut Ui, color: &mut Rgb) {
    let mut shown = color.to_array().map(|component| component as f32);
    if ui.color_edit_button_rgb(&mut shown).changed() {
        // Three digits are more than a screen shows, and are what one would write.
        let component = |x: f32| (f64::from(x) * 1000.0).round() / 1000.0;
        *color = Rgb::from_array(shown.map(|x| component(x).clamp(0.0, 1.0)));
    }
}

fn components(ui: &mut Ui, color: &mut Rgb, most: f64) {
    let mut values = color.to_array();
    for value in &mut values {
        ui.add(
            DragValue::new(value)
                .speed(0.005)
                .range(0.0..=most)
                .clamp_existing_to_range(false)
                .max_decimals(3),
        );
    }
    if values != color.to_array() {
        *color = Rgb::from_array(values);
    }
}
