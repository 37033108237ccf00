//! Keys, and files that are dropped on the window.

use super::{Desk, Side};
use crate::gui::display::View;
use crate::gui::pick::Tool;
use crate::gui::studio::Studio;
use eframe::egui::{Context, Key, Modifiers, Ui};

/// The shortcuts: keys, and what they do.
pub(super) const HELP: [(&str, &str); 28] = [
    ("Drag", "orbit about the point that the camera looks at"),
    ("Shift + drag, middle drag", "move the camera sideways"),
    ("Wheel, right drag", "move the camera nearer or away"),
    ("Alt + drag", "roll the camera"),
    ("Click", "select the object"),
    ("F, then click; Ctrl + click", "make that point sharp"),
    ("T, then click", "look at that point"),
    ("R", "camera as in the file"),
    ("Enter", "final render"),
    ("P", "preview once more"),
    ("Space", "pause, go on"),
    ("Esc", "leave the field; else the tool or the dialog"),
    ("S", "stop the render, its picture stays"),
    ("1 to 6", "picture, albedo, normals, depth, error map, samples map"),
    ("[ and ]", "half a stop darker, brighter"),
    ("\\", "exposure 0"),
    ("Ctrl + wheel, + and -", "zoom to pixels"),
    ("Ctrl + drag", "move the zoomed picture; of a final picture also a plain drag"),
    ("0", "whole picture"),
    ("A", "store the picture as A"),
    ("W", "wipe between A and the picture"),
    ("L, O", "fold the fields away, the objects; or unfold them"),
    ("Ctrl + O", "open a scene"),
    ("Ctrl + S", "save the scene"),
    ("Ctrl + E", "save the picture"),
    ("Ctrl + Z, Ctrl + Y", "undo, redo"),
    ("F1", "this list"),
    ("Ctrl + Q", "close the window"),
];

/// Fold the panels away, in the order of [`Side::ALL`].
pub(super) const SIDE_KEYS: [Key; 2] = [Key::L, Key::O];

/// Opens what is dropped.
pub(super) fn drop_files(ui: &Ui, studio: &mut Studio) {
    let dropped = ui.ctx().input(|input| input.raw.dropped_files.clone());
    if let Some(file) = dropped.first() {
        studio.open(file.path());
    }
}

/// Obeys the keys.
pub(super) fn keys(ui: &Ui, studio: &mut Studio, desk: &mut Desk) {
    let ctx = ui.ctx();
    let pressed = |modifiers, key| ctx.input_mut(|input| input.consume_key(modifiers, key));
    if pressed(Modifiers::NONE, Key::F1) {
        desk.dialogs.is_help_open ^= true;
    }
    // Also while a field has the keyboard: it does nothing with these.
    if pressed(Modifiers::COMMAND, Key::O) {
        desk.dialogs.open_scene(studio, ctx);
    }
    if pressed(Modifiers::COMMAND, Key::S) {
        studio.save_scene(None);
    }
    if pressed(Modifiers::COMMAND, Key::E) {
        desk.dialogs.save_picture(studio, ctx);
    }
    if pressed(Modifiers::COMMAND, Key::Q) {
        ctx.send_viewport_cmd(eframe::egui::ViewportCommand::Close);
    }
    if !ctx.egui_wants_keyboard_input() && !desk.dialogs.is_any_open() {
        plain_keys(ctx, studio, desk);
    }
}

fn plain_keys(ctx: &Context, studio: &mut Studio, desk: &mut Desk) {
    let pressed = |modifiers, key| ctx.input_mut(|input| input.consume_key(modifiers, key));
    let key = |key| pressed(Modifiers::NONE, key);
    if pressed(Modifiers::COMMAND, Key::Y) || pressed(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z) {
        studio.undo(false);
    }
    if pressed(Modifiers::COMMAND, Key::Z) {
        studio.undo(true);
    }
    if key(Key::Enter) {
        studio.render();
    }
    if key(Key::P) && !studio.is_rendering_final() {
        studio.preview();
    }
    if key(Key::Space) {
        studio.session.pause(!studio.session.is_paused());
    }
    if key(Key::S) {
        studio.session.stop();
    }
    if key(Key::Escape) {
        studio.tool = Tool::Select;
    }
    if key(Key::F) {
        studio.tool = Tool::Focus;
    }
    if key(Key::T) {
        studio.tool = Tool::LookAt;
    }
    if key(Key::R) {
        studio.reset_camera();
    }
    view_keys(ctx, studio, desk);
}

fn view_keys(ctx: &Context, studio: &mut Studio, desk: &mut Desk) {
    let key = |key| ctx.input_mut(|input| input.consume_key(Modifiers::NONE, key));
    if key(Key::A) {
        studio.store();
    }
    if key(Key::W) && studio.stored.is_some() {
        studio.wipe = if studio.wipe.is_some() { None } else { Some(0.5) };
    }
    for (side, number) in Side::ALL.into_iter().zip(SIDE_KEYS) {
        if key(number) {
            desk.sides.toggle(side, &mut studio.kept);
        }
    }
    let views = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6];
    for (view, number) in View::ALL.into_iter().zip(views) {
        if key(number) {
            studio.view = view;
        }
    }
    for (bracket, stops) in [(Key::OpenBracket, -0.5), (Key::CloseBracket, 0.5)] {
        if key(bracket) {
            studio.kept.knobs.exposure = (studio.kept.knobs.exposure + stops).clamp(-100.0, 100.0);
        }
    }
    if key(Key::Backslash) {
        studio.kept.knobs.exposure = 0.0;
    }
    if key(Key::Num0) {
        desk.canvas.zoom.fit();
    }
    for (sign, factor) in [(Key::Plus, 2.0), (Key::Equals, 2.0), (Key::Minus, 0.5)] {
        if key(sign) {
            desk.canvas.zoom.scale_about_centre(factor);
        }
    }
}
