//! The foot of the window: what is done, what it costs, where it leads, and what was told last. It is two lines high whatever
//! they say: another height would be another place of the picture, and the preview would start anew.

use super::NARROW;
use crate::gui::forecast::{costs, forecasts, share};
use crate::gui::session::{Stage, Status};
use crate::gui::studio::Studio;
use crate::render::Ended;
use eframe::egui::{Label, ProgressBar, Ui};

/// Points of the foot's height in this style, with its margins.
pub(super) fn height(ui: &Ui) -> f32 {
    let spacing = ui.spacing();
    2.0 * spacing.interact_size.y + spacing.item_spacing.y + 8.0
}

pub(super) fn show(ui: &mut Ui, studio: &mut Studio) {
    let status = studio.session.status();
    let is_narrow = ui.available_width() < NARROW;
    let (mut facts, mut ahead) = (Vec::new(), Vec::new());
    if let Some(frame) = studio.session.frame() {
        let settings = &frame.settings;
        facts.push(format!("{} x {}, {} samples", settings.width, settings.height, frame.samples));
        facts.extend(costs(&status));
        ahead = forecasts(&status, settings, frame.blocks.as_deref(), &studio.kept.knobs);
    }
    // Where one line has no place for all, the other has, unless something is told.
    let told = studio.notice.as_ref().filter(|notice| !notice.is_error).map(|notice| notice.text.clone());
    let below = if is_narrow && told.is_none() { std::mem::take(&mut ahead) } else { Vec::new() };
    facts.append(&mut ahead);
    ui.horizontal(|ui| {
        let is_reading = studio.document.is_reading();
        ui.label(if is_reading { "reading the scene".into() } else { stage(&status) });
        if status.is_busy() && status.total > 0 {
            ui.add(ProgressBar::new(share(&status) as f32).desired_width(110.0).show_percentage());
        }
        ui.add(Label::new(facts.join(BETWEEN)).truncate());
    });
    ui.horizontal(|ui| {
        let Some(text) = told else {
            ui.add(Label::new(below.join(BETWEEN)).truncate());
            return;
        };
        if ui.small_button("x").on_hover_text("Put away").clicked() {
            studio.notice = None;
        }
        ui.add(Label::new(text).truncate());
    });
}

/// Between the parts of a line.
const BETWEEN: &str = "   |   ";

fn stage(status: &Status) -> String {
    let what = if status.is_final { "final" } else { "preview" };
    match &status.stage {
        Stage::Idle => "ready".into(),
        Stage::Building => format!("{what}: building"),
        Stage::Rendering => format!("{what}: rendering"),
        Stage::Paused => format!("{what}: paused"),
        Stage::Done(Ended::Complete) => format!("{what}: done"),
        Stage::Done(Ended::OutOfSamples) => {
            format!("{what}: done, the noise target was not reached everywhere")
        }
        Stage::Done(Ended::OutOfTime) => format!("{what}: the time is up"),
        Stage::Done(Ended::Cancelled) => format!("{what}: stopped"),
        Stage::Failed(_) => format!("{what}: failed"),
    }
}
