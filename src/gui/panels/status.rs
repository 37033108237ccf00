//! The foot of the window: what is done, what it costs, where it leads, what there is to say.

use crate::error::Diagnostic;
use crate::gui::forecast::{costs, forecasts, share};
use crate::gui::form::wrong_color;
use crate::gui::session::{Stage, Status};
use crate::gui::studio::Studio;
use crate::render::Ended;
use eframe::egui::{ProgressBar, RichText, ScrollArea, Ui};

pub(super) fn show(ui: &mut Ui, studio: &mut Studio) {
    let status = studio.session.status();
    problems(ui, studio, &status);
    ui.horizontal_wrapped(|ui| {
        ui.label(stage(&status));
        if status.is_busy() && status.total > 0 {
            ui.add(ProgressBar::new(share(&status) as f32).desired_width(110.0).show_percentage());
        }
        let settings = studio.session.frame().map(|frame| (frame.settings.clone(), frame.samples));
        if let Some((settings, samples)) = settings {
            ui.label(format!("{} x {}, {} samples", settings.width, settings.height, samples));
            for text in costs(&status).into_iter().chain(forecasts(&status, &settings, &studio.kept.knobs)) {
                ui.separator();
                ui.label(text);
            }
        }
    });
    if let Some(notice) = studio.notice.clone() {
        ui.horizontal(|ui| {
            if ui.small_button("x").on_hover_text("Put away").clicked() {
                studio.notice = None;
            }
            let text = RichText::new(&notice.text);
            ui.label(if notice.is_error { text.color(wrong_color(ui.visuals())) } else { text });
        });
    }
}

/// Errors and warnings of the scene, with their lines.
fn problems(ui: &mut Ui, studio: &Studio, status: &Status) {
    let diagnostics: Vec<&Diagnostic> = studio.document.diagnostics.iter().chain(&status.guards).collect();
    if diagnostics.is_empty() {
        return;
    }
    let has_error = diagnostics.iter().any(|one| one.severity == crate::error::Severity::Error);
    let height = if has_error { 160.0 } else { 70.0 };
    ScrollArea::vertical().id_salt("problems").max_height(height).show(ui, |ui| {
        for diagnostic in diagnostics.iter().take(100) {
            let text = RichText::new(diagnostic.to_string()).monospace();
            let is_error = diagnostic.severity == crate::error::Severity::Error;
            ui.label(if is_error { text.color(wrong_color(ui.visuals())) } else { text });
        }
    });
    ui.separator();
}

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
