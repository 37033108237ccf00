//! What went wrong, over the foot of the picture: beside it, it would take place from the picture, whose preview would start
//! anew.

use crate::error::{Diagnostic, Severity};
use crate::gui::form::wrong_color;
use crate::gui::studio::Studio;
use eframe::egui::{Align2, Area, Context, Frame, Id, Label, Rect, RichText, ScrollArea, Ui, vec2};

/// The share of the picture's place that messages may cover, and the most points of their height.
const SHARE: f32 = 0.4;
const HEIGHT: f32 = 170.0;
/// The most messages that are shown.
const MOST: usize = 100;

/// Draws the notice of an error, and the errors and warnings of the scene with their lines.
pub(super) fn show(ctx: &Context, place: Rect, studio: &mut Studio) {
    let error = studio.notice.as_ref().filter(|notice| notice.is_error).map(|notice| notice.text.clone());
    let mut diagnostics = studio.document.diagnostics.clone();
    diagnostics
        .extend(studio.session.status().guards.into_iter().filter(|one| !studio.known_guards.contains(one)));
    if error.is_none() && diagnostics.is_empty() {
        return;
    }
    let corner = place.left_bottom() + vec2(6.0, -6.0);
    let area = Area::new(Id::unique("messages")).pivot(Align2::LEFT_BOTTOM).fixed_pos(corner);
    area.default_width(place.width()).show(ctx, |ui| {
        Frame::popup(ui.style()).show(ui, |ui| {
            let margins = 32.0;
            ui.set_max_width((place.width() - margins).max(100.0));
            if ui.small_button("x").on_hover_text("Put away").clicked() {
                studio.put_messages_away();
            }
            let height = (SHARE * place.height() - margins).clamp(20.0, HEIGHT);
            ScrollArea::vertical().id_salt("messages").max_height(height).show(ui, |ui| {
                if let Some(error) = error {
                    ui.add(Label::new(RichText::new(error).color(wrong_color(ui.visuals()))).wrap());
                }
                show_all(ui, &diagnostics);
            });
        });
    });
}

fn show_all(ui: &mut Ui, diagnostics: &[Diagnostic]) {
    for diagnostic in diagnostics.iter().take(MOST) {
        let text = RichText::new(diagnostic.to_string()).monospace();
        let is_error = diagnostic.severity == Severity::Error;
        let text = if is_error { text.color(wrong_color(ui.visuals())) } else { text };
        ui.add(Label::new(text).wrap());
    }
}
