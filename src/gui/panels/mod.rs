//! The widgets of the window.

mod bar;
mod canvas;
mod commands;
mod dialogs;
mod inspector;
mod messages;
mod number;
mod objects;
mod parameters;
mod sides;
mod sky;
mod status;
mod zoom;

pub use canvas::Canvas;
pub use dialogs::Dialogs;
pub use sides::{NARROW, Side, Sides};
pub use zoom::{Zoom, pixel_at};

use super::settings::Theme;
use super::studio::Studio;
use eframe::egui::{CentralPanel, Color32, Context, Frame, Panel, ScrollArea, ThemePreference, Ui};

/// What is drawn, beside what [`Studio`] holds.
#[derive(Default)]
pub struct Desk {
    /// The picture's place.
    pub canvas: Canvas,
    /// Windows in the window.
    pub dialogs: Dialogs,
    /// The panels beside the picture.
    pub sides: Sides,
    theme: Option<Theme>,
}

impl Desk {
    /// Draws everything.
    pub fn show(&mut self, ui: &mut Ui, studio: &mut Studio) {
        studio.update();
        commands::drop_files(ui, studio);
        commands::keys(ui, studio, self);
        self.sides.follow(ui.ctx().content_rect().width());
        Panel::top("bar").show(ui, |ui| bar::show(ui, studio, self));
        let height = status::height(ui);
        let foot = Panel::bottom("status").resizable(false).exact_size(height);
        foot.show(ui, |ui| status::show(ui, studio));
        if self.sides.is_shown(Side::Fields, &studio.kept) {
            Panel::left("parameters").default_size(280.0).size_range(260.0..=420.0).show(ui, |ui| {
                ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                    parameters::show(ui, studio);
                    sky::show(ui, studio);
                });
            });
        }
        // Every material fits: a panel that grows takes place from the picture, whose preview would start anew.
        if self.sides.is_shown(Side::Objects, &studio.kept) {
            Panel::right("inspector").default_size(300.0).size_range(280.0..=420.0).show(ui, |ui| {
                ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
                    inspector::show(ui, studio, self);
                    objects::show(ui, studio);
                });
            });
        }
        // Neither black nor white, so that the picture's own can be told from it.
        let gray = if ui.visuals().dark_mode { 24 } else { 170 };
        let frame = Frame::NONE.fill(Color32::from_gray(gray));
        CentralPanel::default().frame(frame).show(ui, |ui| self.canvas.show(ui, studio));
        if let Some(place) = self.canvas.place {
            messages::show(ui.ctx(), place, studio);
        }
        self.dialogs.show(ui.ctx(), studio);
        self.follow_theme(ui.ctx(), studio.kept.theme);
    }

    fn follow_theme(&mut self, ctx: &Context, theme: Theme) {
        if self.theme.replace(theme) != Some(theme) {
            ctx.set_theme(match theme {
                Theme::System => ThemePreference::System,
                Theme::Dark => ThemePreference::Dark,
                Theme::Light => ThemePreference::Light,
            });
        }
    }
}
