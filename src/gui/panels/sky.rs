//! The sky's colours, and how colours are edited.

use super::number::{ranged, reason};
use crate::gui::studio::Studio;
use crate::math::Rgb;
use eframe::egui::{CollapsingHeader, DragValue, Grid, Id, Ui};

/// The brightest that light can be made here.
pub(super) const MOST: f64 = 1e6;

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
                for (name, color) in
                    [("Above", &mut sky.sky), ("Horizon", &mut sky.horizon), ("Below", &mut sky.ground)]
                {
                    let label = ui.label(name).id;
                    ui.vertical(|ui| radiance(ui, Id::unique(name), label, color));
                    ui.end_row();
                }
            }
            let label = ui.label("Strength").id;
            strength(ui, Id::unique("sky strength"), label, &mut sky.strength);
            ui.end_row();
        });
        studio.edit(|editable| {
            editable.environment = sky;
            editable.rotation = rotation;
        });
    });
}

/// A factor of light.
pub(super) fn strength(ui: &mut Ui, id: Id, label: Id, value: &mut f64) {
    let speed = 0.01 * value.max(1.0);
    ui.vertical(|ui| {
        let why = ranged(ui, id, value, 0.0..=MOST, |ui, shown| {
            ui.add(DragValue::new(shown).speed(speed)).labelled_by(label)
        });
        reason(ui, why);
    });
}

/// A colour whose components may exceed 1: numbers, a picker for its hue, and where it is brighter than a screen, how bright
/// it is.
pub(super) fn radiance(ui: &mut Ui, id: Id, label: Id, color: &mut Rgb) {
    components(ui, id, label, color, MOST);
    let brightest = color.max_element();
    if brightest > 1.0 {
        let mut wanted = brightest;
        ui.horizontal(|ui| {
            let label = ui.weak("brightest").id;
            strength(ui, id.with("brightest"), label, &mut wanted);
        });
        if wanted != brightest {
            *color *= wanted / brightest;
        }
    }
}

/// A colour whose components are at most 1.
pub(super) fn reflectance(ui: &mut Ui, id: Id, label: Id, color: &mut Rgb) {
    components(ui, id, label, color, 1.0);
}

fn picker(ui: &mut Ui, label: Id, color: &mut Rgb) {
    let brightest = color.max_element().max(1.0);
    let mut shown = (*color * (1.0 / brightest)).to_array().map(|component| component as f32);
    if ui.color_edit_button_rgb(&mut shown).labelled_by(label).changed() {
        *color = picked(shown, brightest);
    }
}

/// What a picked colour makes of one whose brightest component was so bright: above 1 the picker chooses only the hue.
fn picked(shown: [f32; 3], brightest: f64) -> Rgb {
    // Three digits are more than a screen shows, and are what one would write.
    let component = |x: f32| ((f64::from(x) * 1000.0).round() / 1000.0).clamp(0.0, 1.0);
    let color = Rgb::from_array(shown.map(component));
    let most = color.max_element();
    if brightest <= 1.0 || most == 0.0 { color } else { color * (brightest / most) }
}

/// A picker and three numbers.
fn components(ui: &mut Ui, id: Id, label: Id, color: &mut Rgb, most: f64) {
    ui.vertical(|ui| {
        let row = ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            ui.spacing_mut().interact_size.x = 34.0;
            picker(ui, label, color);
            let mut values = color.to_array();
            let mut why = None;
            for (axis, value) in values.iter_mut().enumerate() {
                let wrong = ranged(ui, id.with(axis), value, 0.0..=most, |ui, shown| {
                    ui.add(DragValue::new(shown).speed(0.005).max_decimals(3)).labelled_by(label)
                });
                why = why.or(wrong);
            }
            if values != color.to_array() {
                *color = Rgb::from_array(values);
            }
            why
        });
        reason(ui, row.inner);
    });
}
