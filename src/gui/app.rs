//! The window on the desktop.

use super::forecast::share;
use super::panels::Desk;
use super::settings::Kept;
use super::studio::{Studio, Wake};
use crate::cli::console::say;
use crate::error::{Error, Result};
use eframe::egui::{Context, Ui, ViewportBuilder, ViewportCommand};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::env;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// How often the scene file is looked at while nothing happens.
const LOOK_EVERY: Duration = Duration::from_millis(500);

/// Opens the window, maybe with a scene, and comes back when it is closed.
///
/// # Errors
/// [`Error::Unavailable`] without a display or its libraries.
pub fn open(scene: Option<&Path>) -> Result<()> {
    let displays = ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"];
    if !displays.iter().any(|name| env::var_os(name).is_some_and(|value| !value.is_empty())) {
        return Err(unavailable("there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)"));
    }
    let kept = Kept::load();
    let viewport = ViewportBuilder::default()
        .with_title("pathtracer")
        .with_app_id("pathtracer")
        .with_inner_size(kept.size)
        .with_min_inner_size([640.0, 400.0])
        .with_drag_and_drop(true);
    let options = eframe::NativeOptions { viewport, ..eframe::NativeOptions::default() };
    let scene = scene.map(Path::to_path_buf);
    eframe::run_native(
        "pathtracer",
        options,
        Box::new(move |creation| {
            let mut app = App::new(&creation.egui_ctx, kept)?;
            if let Some(scene) = scene {
                app.studio.open(&scene);
            }
            Ok(Box::new(app))
        }),
    )
    .map_err(|error| unavailable(&error.to_string()))
}

fn unavailable(why: &str) -> Error {
    Error::Unavailable(format!("the window can't be opened: {why}"))
}

/// The window.
struct App {
    studio: Studio,
    desk: Desk,
    shown_title: String,
    /// The scenes that were kept last.
    recent: Vec<PathBuf>,
    is_signalled: Arc<AtomicBool>,
}

impl App {
    fn new(ctx: &Context, kept: Kept) -> std::io::Result<App> {
        let repaint = ctx.clone();
        let wake: Wake = Arc::new(move || repaint.request_repaint());
        let is_signalled = Arc::new(AtomicBool::new(false));
        let mut signals = Signals::new([SIGINT, SIGTERM])?;
        let (flag, waker) = (Arc::clone(&is_signalled), Arc::clone(&wake));
        thread::Builder::new().name("signals".into()).spawn(move || {
            for _ in signals.forever() {
                flag.store(true, Ordering::Relaxed);
                waker();
            }
        })?;
        let recent = kept.recent.clone();
        let studio = Studio::new(kept, wake);
        Ok(App { studio, desk: Desk::default(), shown_title: String::new(), recent, is_signalled })
    }

    /// Follows the title and the size.
    fn follow(&mut self, ctx: &Context) {
        let title = self.title();
        if title != self.shown_title {
            ctx.send_viewport_cmd(ViewportCommand::Title(title.clone()));
            self.shown_title = title;
        }
        let size = ctx.content_rect().size();
        self.studio.kept.size = [size.x, size.y];
        if self.recent != self.studio.kept.recent {
            self.recent = self.studio.kept.recent.clone();
            self.studio.kept.save();
        }
    }

    /// The name of the scene, whether it has changes, and how far its final render is once there is a picture of it.
    fn title(&self) -> String {
        let name = self.studio.document.loaded.as_ref().and_then(|loaded| loaded.path.file_name());
        let Some(name) = name else { return "pathtracer".into() };
        let mark = if self.studio.is_edited() { " *" } else { "" };
        let status = self.studio.session.status();
        let has_picture = self.studio.session.frame().is_some_and(|frame| frame.job == status.job);
        let progress = if self.studio.is_rendering_final() && has_picture {
            format!("{:.0} % – ", 100.0 * share(&status))
        } else {
            String::new()
        };
        format!("{progress}{}{mark} – pathtracer", name.to_string_lossy())
    }

    /// Closes, but for changes that are not saved. A signal does not ask.
    fn close(&mut self, ctx: &Context) {
        if self.is_signalled.load(Ordering::Relaxed) {
            self.desk.dialogs.may_close = true;
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
        if !ctx.input(|input| input.viewport().close_requested()) {
            return;
        }
        if self.studio.is_edited() && !self.desk.dialogs.may_close {
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
            self.desk.dialogs.is_closing = true;
            return;
        }
        let is_well = self.studio.close();
        self.studio.kept.save();
        if is_well {
            return;
        }
        if self.is_signalled.load(Ordering::Relaxed) {
            self.studio.notice.iter().for_each(|notice| say(&notice.text));
        } else {
            // The window stays to say what could not be written.
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        }
    }
}

impl eframe::App for App {
    fn ui(&mut self, ui: &mut Ui, _: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        self.close(&ctx);
        self.desk.show(ui, &mut self.studio);
        self.follow(&ctx);
        ctx.request_repaint_after(LOOK_EVERY);
    }
}
