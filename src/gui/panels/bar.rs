//! The menus and buttons at the top.

use super::commands::SIDE_KEYS;
use super::{Desk, Side};
use crate::gui::display::View;
use crate::gui::examples::Example;
use crate::gui::pick::Tool;
use crate::gui::settings::Theme;
use crate::gui::studio::Studio;
use eframe::egui::{Button, ComboBox, MenuBar, Response, Ui, ViewportCommand};
use std::path::Path;

pub(super) fn show(ui: &mut Ui, studio: &mut Studio, desk: &mut Desk) {
    MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| file_menu(ui, studio, desk));
        ui.menu_button("Edit", |ui| edit_menu(ui, studio));
        ui.menu_button("Look", |ui| view_menu(ui, studio, desk));
        if ui.button("Help").clicked() {
            desk.dialogs.is_help_open ^= true;
        }
        ui.separator();
        render_buttons(ui, studio);
        if !desk.sides.is_narrow() {
            ui.separator();
            choices(ui, studio, desk);
        }
    });
    if desk.sides.is_narrow() {
        ui.horizontal(|ui| choices(ui, studio, desk));
    }
}

/// What is in a row of its own where the window is narrow.
fn choices(ui: &mut Ui, studio: &mut Studio, desk: &mut Desk) {
    tools(ui, studio);
    ui.separator();
    views(ui, studio);
    ui.separator();
    for (side, key) in Side::ALL.into_iter().zip(SIDE_KEYS) {
        let label = ui.selectable_label(desk.sides.is_shown(side, &studio.kept), side.name());
        if label.on_hover_text(format!("Fold the panel away, or unfold it ({})", key.name())).clicked() {
            desk.sides.toggle(side, &mut studio.kept);
        }
    }
}

fn file_menu(ui: &mut Ui, studio: &mut Studio, desk: &mut Desk) {
    if item(ui, "Open…", "Ctrl+O").clicked() {
        desk.dialogs.open_scene(studio, ui.ctx());
    }
    ui.menu_button("Recent files", |ui| {
        let chosen =
            entries(ui, &studio.kept.recent, |path| file_name(path), |path| path.display().to_string());
        if let Some(path) = chosen {
            studio.open(&path);
        }
    });
    ui.menu_button("Examples", |ui| {
        let chosen =
            entries(ui, studio.examples.get().unwrap_or_default(), Example::name, |example| match example {
                Example::File(path) => path.display().to_string(),
                Example::Inside(..) => "goes to your folder for data".into(),
            });
        if let Some(example) = chosen {
            studio.open_example(&example);
        }
    });
    ui.separator();
    let has_scene = studio.document.loaded.is_some();
    if ui.add_enabled(has_scene, Button::new("Save scene").shortcut_text("Ctrl+S")).clicked() {
        studio.save_scene(None);
    }
    if ui.add_enabled(has_scene, Button::new("Save scene as…")).clicked() {
        desk.dialogs.save_scene(studio, ui.ctx());
    }
    if ui.add_enabled(has_scene, Button::new("Save picture…").shortcut_text("Ctrl+E")).clicked() {
        desk.dialogs.save_picture(studio, ui.ctx());
    }
    let copy = ui.add_enabled(has_scene, Button::new("Copy as command line"));
    if copy.clicked()
        && let Some(loaded) = &studio.document.loaded
    {
        ui.ctx().copy_text(studio.kept.knobs.command(&loaded.path));
    }
    ui.separator();
    if item(ui, "Close", "Ctrl+Q").clicked() {
        ui.ctx().send_viewport_cmd(ViewportCommand::Close);
    }
}

/// An entry of a menu, and its keys.
fn item(ui: &mut Ui, text: &str, keys: &str) -> Response {
    ui.add(Button::new(text).shortcut_text(keys))
}

/// The one that was clicked.
fn entries<T: Clone>(
    ui: &mut Ui,
    all: &[T],
    name: impl Fn(&T) -> String,
    about: impl Fn(&T) -> String,
) -> Option<T> {
    if all.is_empty() {
        ui.weak("none");
    }
    let mut chosen = None;
    for one in all {
        if ui.button(name(one)).on_hover_text(about(one)).clicked() {
            chosen = Some(one.clone());
        }
    }
    chosen
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn edit_menu(ui: &mut Ui, studio: &mut Studio) {
    if item(ui, "Undo", "Ctrl+Z").clicked() {
        studio.undo(true);
    }
    if item(ui, "Redo", "Ctrl+Y").clicked() {
        studio.undo(false);
    }
    if item(ui, "Reset camera", "R").clicked() {
        studio.reset_camera();
    }
}

fn view_menu(ui: &mut Ui, studio: &mut Studio, desk: &mut Desk) {
    if item(ui, "Whole picture", "0").clicked() {
        desk.canvas.zoom.fit();
    }
    if item(ui, "Store as A", "A").clicked() {
        studio.store();
    }
    ui.separator();
    for theme in Theme::ALL {
        if ui.radio(studio.kept.theme == theme, theme.name()).clicked() {
            studio.kept.theme = theme;
        }
    }
}

fn render_buttons(ui: &mut Ui, studio: &mut Studio) {
    let is_busy = studio.session.status().is_busy();
    let can_start = studio.document.loaded.is_some() && !studio.is_rendering_final();
    if button(ui, can_start, "Preview", "Render a preview once more (P)") {
        studio.preview();
    }
    if button(ui, can_start, "Render", "Render the picture and write it to its file (Enter)") {
        studio.render();
    }
    let is_paused = studio.session.is_paused();
    let label = if is_paused { "Go on" } else { "Pause" };
    if button(ui, is_busy, label, "Space; the time of a time budget runs on") {
        studio.session.pause(!is_paused);
    }
    if button(ui, is_busy, "Stop", "S; a final render writes its picture so far") {
        studio.session.stop();
    }
}

/// A button that looks like one, unlike those of a menu; whether it was clicked.
fn button(ui: &mut Ui, is_enabled: bool, label: &str, help: &str) -> bool {
    let fill = ui.visuals().widgets.inactive.bg_fill;
    ui.add_enabled(is_enabled, Button::new(label).fill(fill)).on_hover_text(help).clicked()
}

fn tools(ui: &mut Ui, studio: &mut Studio) {
    for (tool, key) in [(Tool::Select, "Esc"), (Tool::Focus, "F"), (Tool::LookAt, "T")] {
        let help = match tool {
            Tool::Select => "A click selects an object",
            Tool::Focus => "A click makes that point sharp",
            Tool::LookAt => "A click looks at that point",
        };
        let label = ui.selectable_label(studio.tool == tool, tool.name());
        if label.on_hover_text(format!("{help} ({key})")).clicked() {
            studio.tool = tool;
        }
    }
}

fn views(ui: &mut Ui, studio: &mut Studio) {
    let label = ui.label("View");
    let list =
        ComboBox::from_id_salt("view").selected_text(studio.view.name()).width(100.0).show_ui(ui, |ui| {
            for view in View::ALL {
                ui.selectable_value(&mut studio.view, view, view.name());
            }
        });
    list.response.labelled_by(label.id);
}
