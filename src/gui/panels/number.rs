//! Numbers that are dragged or typed. What is out of range is not taken, and marked until it is mended.

use crate::cli::console::digits;
use crate::gui::form::wrong_color;
use eframe::egui::{Id, Label, Response, RichText, Stroke, StrokeKind, Ui};
use std::ops::RangeInclusive;

/// A number that was typed and can't be taken.
#[derive(Clone, Copy)]
struct Wrong {
    typed: f64,
    /// What it should have replaced; once that changes, it is forgotten.
    instead_of: f64,
}

/// Draws a number by a widget that does not care about the range; the reason why what was typed can't be taken.
pub(super) fn ranged(
    ui: &mut Ui,
    id: Id,
    value: &mut f64,
    range: RangeInclusive<f64>,
    draw: impl FnOnce(&mut Ui, &mut f64) -> Response,
) -> Option<String> {
    let wrong: Option<Wrong> = ui.ctx().data(|data| data.get_temp(id));
    let mut wrong = wrong.filter(|wrong| wrong.instead_of == *value);
    let before = wrong.map_or(*value, |wrong| wrong.typed);
    let mut shown = before;
    let response = draw(ui, &mut shown);
    if shown != before {
        // The mouse stops at the ends.
        let taken = if response.dragged() { shown.clamp(*range.start(), *range.end()) } else { shown };
        wrong = None;
        if range.contains(&taken) {
            *value = taken;
        } else {
            wrong = Some(Wrong { typed: taken, instead_of: *value });
        }
    }
    let Some(wrong) = wrong else {
        ui.ctx().data_mut(|data| data.remove::<Wrong>(id));
        return None;
    };
    ui.ctx().data_mut(|data| data.insert_temp(id, wrong));
    let stroke = Stroke::new(1.0, wrong_color(ui.visuals()));
    ui.painter().rect_stroke(response.rect, 2.0, stroke, StrokeKind::Outside);
    let [least, most] = [*range.start(), *range.end()].map(|end| digits(end, 7));
    Some(format!("expected a number from {least} to {most}"))
}

/// Draws the reason, if there is one.
pub(super) fn reason(ui: &mut Ui, why: Option<String>) {
    if let Some(why) = why {
        let text = RichText::new(why).small().color(wrong_color(ui.visuals()));
        ui.add(Label::new(text).wrap());
    }
}
