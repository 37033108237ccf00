//! Windows in the window: files, help, closing with changes.

use super::commands::HELP;
use crate::gui::coming;
use crate::gui::examples::is_scene;
use crate::gui::studio::Studio;
use crate::picture::{Depth, Format};
use eframe::egui::{
    Align2, Button, ComboBox, Context, Grid, Id, Key, Label, Modal, ScrollArea, TextEdit, Ui,
    ViewportCommand, Window,
};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::thread;

/// What a file is chosen for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Purpose {
    Open,
    SaveScene,
    SavePicture,
    StorePicture,
}

impl Purpose {
    const fn title(self) -> &'static str {
        match self {
            Purpose::Open => "Open scene",
            Purpose::SaveScene => "Save scene as",
            Purpose::SavePicture => "Save picture",
            Purpose::StorePicture => "Picture to compare with",
        }
    }

    const fn verb(self) -> &'static str {
        if matches!(self, Purpose::Open | Purpose::StorePicture) { "Open" } else { "Save" }
    }
}

/// What is in a folder.
#[derive(Default)]
struct Listing {
    folder: PathBuf,
    folders: Vec<PathBuf>,
    files: Vec<PathBuf>,
}

impl Listing {
    /// Of the first of some paths that is a folder.
    fn new(purpose: Purpose, paths: &[PathBuf]) -> Listing {
        let folder = paths.iter().find(|path| path.is_dir()).cloned().unwrap_or_else(|| "/".into());
        let entries = fs::read_dir(&folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let is_hidden =
            |path: &Path| path.file_name().is_none_or(|name| name.to_string_lossy().starts_with('.'));
        let mut all: Vec<PathBuf> = entries.filter(|path| !is_hidden(path)).collect();
        all.sort();
        let is_wanted = |path: &PathBuf| match purpose {
            Purpose::SavePicture | Purpose::StorePicture => Format::of(path).is_ok(),
            Purpose::Open | Purpose::SaveScene => is_scene(path),
        };
        let folders = all.iter().filter(|path| path.is_dir()).cloned().collect();
        let files = all.into_iter().filter(|path| path.is_file() && is_wanted(path)).collect();
        Listing { folder, folders, files }
    }
}

/// A file that is being chosen.
struct Choice {
    purpose: Purpose,
    name: String,
    /// Of a picture that is saved; `None` as its format has it.
    depth: Option<Depth>,
    listing: Listing,
    /// The listing on its way: a folder may be far away.
    coming: Option<Receiver<Listing>>,
    is_new: bool,
}

impl Choice {
    /// In the first of some folders that is there.
    fn new(purpose: Purpose, folders: Vec<PathBuf>, name: String, ctx: &Context) -> Choice {
        let listing = Listing::default();
        let mut choice = Choice { purpose, name, depth: None, listing, coming: None, is_new: true };
        choice.enter(folders, ctx);
        choice
    }

    /// Beside a file, with its name.
    fn beside(purpose: Purpose, path: &Path, ctx: &Context) -> Choice {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
        let folder = path.parent().unwrap_or(Path::new("/")).to_path_buf();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let here = env::current_dir().unwrap_or_else(|_| "/".into());
        Choice::new(purpose, vec![folder, here], name, ctx)
    }

    /// Begins to look into the first of some paths that is a folder.
    fn enter(&mut self, paths: Vec<PathBuf>, ctx: &Context) {
        let (sender, receiver) = channel();
        let (purpose, ctx) = (self.purpose, ctx.clone());
        self.coming = Some(receiver);
        thread::spawn(move || {
            // A dialog that was closed does not want to know.
            let _ = sender.send(Listing::new(purpose, &paths));
            ctx.request_repaint();
        });
    }

    /// Draws it; the file that was chosen.
    fn show(&mut self, ui: &mut Ui) -> Option<PathBuf> {
        if let Some(listing) = coming::take(&mut self.coming) {
            self.listing = listing.unwrap_or_default();
        }
        let (mut chosen, mut entered) = (None, None);
        ui.horizontal(|ui| {
            if ui.button("Up").clicked() {
                entered = self.listing.folder.parent().map(Path::to_path_buf);
            }
            if self.coming.is_some() {
                ui.spinner();
            }
            ui.add(Label::new(self.listing.folder.display().to_string()).truncate());
        });
        ScrollArea::vertical().max_height(260.0).auto_shrink([false, false]).show(ui, |ui| {
            self.show_listing(ui, &mut chosen, &mut entered);
        });
        ui.horizontal(|ui| self.show_name(ui, &mut chosen, &mut entered));
        if self.purpose == Purpose::SavePicture {
            self.depths(ui);
        }
        if let Some(folder) = entered {
            self.enter(vec![folder], ui.ctx());
        }
        chosen
    }

    /// Draws the folders and files that there are.
    fn show_listing(&mut self, ui: &mut Ui, chosen: &mut Option<PathBuf>, entered: &mut Option<PathBuf>) {
        for folder in &self.listing.folders {
            let name = folder.file_name().unwrap_or_default().to_string_lossy();
            if ui.selectable_label(false, format!("{name}/")).clicked() {
                *entered = Some(folder.clone());
            }
        }
        for file in &self.listing.files {
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let label = ui.selectable_label(self.name == name, &name);
            if label.clicked() {
                self.name = name;
            }
            if label.double_clicked() {
                *chosen = Some(file.clone());
            }
        }
    }

    /// Draws the field for the name, and the button.
    fn show_name(&mut self, ui: &mut Ui, chosen: &mut Option<PathBuf>, entered: &mut Option<PathBuf>) {
        let label = ui.label("Name");
        let edit = TextEdit::singleline(&mut self.name).id_salt("name").desired_width(280.0);
        let edit = ui.add(edit).labelled_by(label.id);
        if std::mem::take(&mut self.is_new) {
            edit.request_focus();
        }
        let is_entered = edit.lost_focus() && ui.ctx().input(|input| input.key_pressed(Key::Enter));
        let is_there = !self.listing.folder.as_os_str().is_empty();
        let is_pressed = ui.add_enabled(is_there, Button::new(self.purpose.verb())).clicked();
        if (is_pressed || is_entered && is_there) && !self.name.is_empty() {
            let path = self.listing.folder.join(&self.name);
            if path.is_dir() {
                self.name.clear();
                *entered = Some(path);
            } else {
                *chosen = Some(path);
            }
        }
    }
}

impl Choice {
    /// The depths of the format that the name tells.
    fn depths(&mut self, ui: &mut Ui) {
        let format = Format::of(Path::new(&self.name)).ok();
        let depths = format.map_or(&[][..], Format::depths);
        self.depth = self.depth.filter(|depth| depths.contains(depth));
        ui.horizontal(|ui| {
            let label = ui.label("Depth");
            let default = depths.first().copied();
            let shown = self.depth.or(default).map_or("as the file", Depth::name);
            let list = ComboBox::from_id_salt("depth of the file").selected_text(shown).show_ui(ui, |ui| {
                for &depth in depths {
                    let wanted = Some(depth).filter(|_| Some(depth) != default);
                    ui.selectable_value(&mut self.depth, wanted, depth.name());
                }
            });
            list.response.labelled_by(label.id);
            if format == Some(Format::Exr) {
                ui.weak("channels beside the light: by Render");
            }
        });
    }
}

/// The windows that may be open.
#[derive(Default)]
pub struct Dialogs {
    /// Whether the list of shortcuts is shown.
    pub is_help_open: bool,
    /// Whether it is asked what to do with changes before the window closes.
    pub is_closing: bool,
    /// Whether the window closes whatever has changed.
    pub may_close: bool,
    choice: Option<Choice>,
}

impl Dialogs {
    /// Whether one of them has the keyboard.
    pub fn is_any_open(&self) -> bool {
        self.choice.is_some() || self.is_closing || self.is_help_open
    }

    /// Asks for a scene.
    pub fn open_scene(&mut self, studio: &Studio, ctx: &Context) {
        let near = studio.document.path.iter().chain(&studio.kept.recent);
        let near = near.filter_map(|path| std::path::absolute(path).ok()?.parent().map(Path::to_path_buf));
        let here = env::current_dir().unwrap_or_else(|_| "/".into());
        let folders = near.chain([here.join("scenes"), here]).collect();
        self.choice = Some(Choice::new(Purpose::Open, folders, String::new(), ctx));
    }

    /// Asks where the scene goes.
    pub fn save_scene(&mut self, studio: &Studio, ctx: &Context) {
        let loaded = studio.document.loaded.as_ref();
        let path = loaded.map_or_else(|| "scene.yaml".into(), |loaded| loaded.path.clone());
        self.choice = Some(Choice::beside(Purpose::SaveScene, &path, ctx));
    }

    /// Asks where the picture goes.
    pub fn save_picture(&mut self, studio: &Studio, ctx: &Context) {
        let path = Path::new(&studio.kept.knobs.image);
        self.choice = Some(Choice::beside(Purpose::SavePicture, path, ctx));
    }

    /// Asks for a picture to compare with.
    pub fn store_picture(&mut self, studio: &Studio, ctx: &Context) {
        let path = Path::new(&studio.kept.knobs.image);
        self.choice = Some(Choice::beside(Purpose::StorePicture, path, ctx));
    }

    pub(super) fn show(&mut self, ctx: &Context, studio: &mut Studio) {
        self.show_help(ctx);
        self.show_choice(ctx, studio);
        self.show_closing(ctx, studio);
    }

    fn show_choice(&mut self, ctx: &Context, studio: &mut Studio) {
        let Some(choice) = &mut self.choice else { return };
        let mut is_open = true;
        let (purpose, was_new) = (choice.purpose, choice.is_new);
        let shown = Window::new(purpose.title())
            .open(&mut is_open)
            .collapsible(false)
            .default_width(420.0)
            .pivot(Align2::CENTER_CENTER)
            .default_pos(ctx.content_rect().center())
            .show(ctx, |ui| choice.show(ui));
        let chosen = shown.and_then(|shown| shown.inner.flatten());
        let depth = choice.depth;
        // Pressed before the dialog was there, it was for something else.
        let is_left = !was_new && ctx.input(|input| input.key_pressed(Key::Escape));
        if let Some(path) = &chosen {
            match purpose {
                Purpose::Open => studio.open(path),
                Purpose::SaveScene => studio.save_scene(Some(path)),
                Purpose::SavePicture => studio.save_picture(path, depth),
                Purpose::StorePicture => studio.store_file(path),
            }
        }
        if chosen.is_some() || !is_open || is_left {
            self.choice = None;
        }
    }

    fn show_help(&mut self, ctx: &Context) {
        if self.is_help_open && ctx.input(|input| input.key_pressed(Key::Escape)) {
            self.is_help_open = false;
        }
        let room = ctx.content_rect();
        let window = Window::new("Mouse and keys").open(&mut self.is_help_open).collapsible(false);
        // All of it where there is place, without what is around it.
        let window = window.default_height((room.height() - 80.0).max(100.0));
        window.pivot(Align2::CENTER_CENTER).default_pos(room.center()).show(ctx, |ui| {
            ScrollArea::vertical().show(ui, |ui| {
                Grid::new("help").num_columns(2).striped(true).show(ui, |ui| {
                    for (keys, meaning) in HELP {
                        ui.strong(keys);
                        ui.label(meaning);
                        ui.end_row();
                    }
                });
            });
        });
    }

    fn show_closing(&mut self, ctx: &Context, studio: &mut Studio) {
        if !self.is_closing {
            return;
        }
        let modal = Modal::new(Id::unique("closing")).show(ctx, |ui| {
            ui.heading("The scene has changes that are not saved");
            ui.horizontal(|ui| {
                if ui.button("Save and close").clicked() {
                    studio.save_scene(None);
                    studio.finish_saving();
                    self.may_close = !studio.is_edited();
                    self.is_closing = false;
                }
                if ui.button("Close without saving").clicked() {
                    self.may_close = true;
                    self.is_closing = false;
                }
                if ui.button("Cancel").clicked() {
                    self.is_closing = false;
                }
            });
        });
        self.is_closing &= !modal.should_close();
        if self.may_close {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
    }
}
