//! The objects and their materials.

use super::number::{ranged, reason};
use super::sky::{radiance, reflectance, strength};
use crate::cli::console::{number, printable};
use crate::gui::studio::Studio;
use crate::math::Rgb;
use crate::scene::desc::{ObjectDesc, ShapeDesc};
use crate::scene::edit::{Surface, SurfaceKind};
use eframe::egui::{
    CollapsingHeader, ComboBox, DragValue, Grid, Id, ScrollArea, Slider, SliderClamping, TextStyle, Ui,
};

pub(super) fn show(ui: &mut Ui, studio: &mut Studio) {
    let Some(loaded) = studio.document.loaded.clone() else { return };
    let objects = &loaded.scene.desc.objects;
    let title = format!("Objects ({})", objects.len());
    CollapsingHeader::new(title).id_salt("objects").default_open(true).show(ui, |ui| {
        let height = ui.text_style_height(&TextStyle::Body) + 2.0 * ui.spacing().button_padding.y;
        ScrollArea::vertical().id_salt("list").max_height(150.0).auto_shrink([false, true]).show_rows(
            ui,
            height,
            objects.len(),
            |ui, rows| {
                for index in rows {
                    let is_selected = studio.selected == Some(index);
                    if ui.selectable_label(is_selected, name(index, &objects[index])).clicked() {
                        studio.selected = (!is_selected).then_some(index);
                    }
                }
            },
        );
    });
    let Some((index, object)) = studio.selected.and_then(|index| Some((index, objects.get(index)?))) else {
        ui.weak("A click on the picture selects an object.");
        return;
    };
    CollapsingHeader::new("Material").default_open(true).show(ui, |ui| {
        ui.label(name(index, object));
        ui.weak(format!("{}; line {}", shape(object), object.location.line));
        material(ui, studio, index);
    });
}

/// What an object is called.
pub(super) fn name(index: usize, object: &ObjectDesc) -> String {
    let kind = match object.shape {
        ShapeDesc::Ball { .. } => "Ball",
        ShapeDesc::Box { .. } => "Box",
        ShapeDesc::Rectangle { .. } => "Rectangle",
        ShapeDesc::TriangleMesh { .. } => "Mesh",
    };
    let name = object.name.as_ref().or(object.material.name.as_ref());
    match name {
        Some(name) => format!("{} {kind}: {}", index + 1, printable(name)),
        None => format!("{} {kind}", index + 1),
    }
}

fn shape(object: &ObjectDesc) -> String {
    match &object.shape {
        ShapeDesc::Ball { radius, .. } => format!("radius {}", number(*radius)),
        ShapeDesc::Box { size, .. } => size.to_array().map(number).join(" x "),
        ShapeDesc::Rectangle { width, height, .. } => format!("{} x {}", number(*width), number(*height)),
        ShapeDesc::TriangleMesh { mesh, file, .. } => {
            let file = file.file_name().unwrap_or_default().to_string_lossy();
            format!("{}, {} triangles", printable(&file), mesh.triangles.len())
        }
    }
}

fn material(ui: &mut Ui, studio: &mut Studio, index: usize) {
    let surface = studio.editable.as_ref().and_then(|editable| editable.surfaces.get(index)?.clone());
    let Some(mut surface) = surface else {
        ui.weak("Its materials come from the mesh's file.");
        return;
    };
    let id = Id::unique(("material", index));
    Grid::new("material").num_columns(2).show(ui, |ui| fields(ui, id, &mut surface));
    studio.edit(|editable| {
        if let Some(place) = editable.surfaces.get_mut(index) {
            *place = Some(surface);
        }
    });
}

fn fields(ui: &mut Ui, id: Id, surface: &mut Surface) {
    let label = ui.label("Type");
    let list = ComboBox::from_id_salt("type").selected_text(surface.kind.name()).show_ui(ui, |ui| {
        for kind in SurfaceKind::ALL {
            ui.selectable_value(&mut surface.kind, kind, kind.name());
        }
    });
    list.response.labelled_by(label.id);
    ui.end_row();
    color(ui, id, "Colour", &mut surface.color, surface.has_color_picture);
    match surface.kind {
        SurfaceKind::Diffuse => emission(ui, id, surface),
        SurfaceKind::Reflective => share(ui, id, "Specularity", &mut surface.specularity),
        SurfaceKind::ClearCoat => {
            share(ui, id, "Coat", &mut surface.coat);
            color(ui, id, "Coat colour", &mut surface.coat_color, surface.has_coat_picture);
            share(ui, id, "Specularity", &mut surface.specularity);
        }
        SurfaceKind::Refractive => ratio(ui, id, &mut surface.ratio),
    }
}

fn emission(ui: &mut Ui, id: Id, surface: &mut Surface) {
    let label = ui.label("Emission").id;
    strength(ui, id.with("emission"), label, &mut surface.emission_strength);
    ui.end_row();
    if surface.emission_strength > 0.0 {
        let label = ui.label("Light").id;
        ui.vertical(|ui| radiance(ui, id.with("light"), label, &mut surface.emission_color));
        ui.end_row();
    }
}

fn ratio(ui: &mut Ui, id: Id, ratio: &mut f64) {
    let label = ui.label("n out / n in").id;
    let help = "n outside / n inside: about 0.67 for glass, 0.42 for diamond";
    ui.vertical(|ui| {
        let why = ranged(ui, id.with("ratio"), ratio, 0.01..=100.0, |ui, shown| {
            ui.add(DragValue::new(shown).speed(0.005)).labelled_by(label).on_hover_text(help)
        });
        reason(ui, why);
    });
    ui.end_row();
}

fn color(ui: &mut Ui, id: Id, name: &str, color: &mut Rgb, is_picture: bool) {
    let label = ui.label(name).id;
    if is_picture {
        ui.weak("a picture");
    } else {
        reflectance(ui, id.with(name), label, color);
    }
    ui.end_row();
}

fn share(ui: &mut Ui, id: Id, name: &str, value: &mut f64) {
    let label = ui.label(name).id;
    ui.spacing_mut().slider_width = 80.0;
    ui.vertical(|ui| {
        let why = ranged(ui, id.with(name), value, 0.0..=1.0, |ui, shown| {
            let slider = Slider::new(shown, 0.0..=1.0).clamping(SliderClamping::Never);
            ui.add(slider.max_decimals(3)).labelled_by(label)
        });
        reason(ui, why);
    });
    ui.end_row();
}
