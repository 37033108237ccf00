//! Writing pictures and scenes, beside the window's thread.

use super::document::{self, Files, Loaded};
use super::session::Frame;
use crate::error::{Error, Result};
use crate::output::{Provenance, Target, Wanted};
use crate::picture;
use crate::render;
use crate::scene::edit::Editable;
use crate::scene::{self, edit};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::thread;

/// Writes on a thread of its own; `wake` is called when it is done.
pub fn start(
    frame: Arc<Frame>,
    wanted: Wanted,
    wake: impl FnOnce() + Send + 'static,
) -> Receiver<std::result::Result<PathBuf, String>> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let path = wanted.image.clone();
        let written = write(&frame, wanted).map(|()| path).map_err(|error| error.to_string());
        // A window that is gone has waited, or does not want to know.
        let _ = sender.send(written);
        wake();
    });
    receiver
}

/// Writes what the command line would write for as many samples of the scene as it is by now, saved. There is nothing but
/// light: channels beside it and a denoiser are for final renders.
///
/// # Errors
/// As [`Target::new`] and [`Target::write_light`], and those of [`edit::save`].
pub fn write(frame: &Frame, wanted: Wanted) -> Result<()> {
    let exposure = wanted.exposure;
    let target = Target::new(wanted)?;
    let loaded = &frame.loaded;
    let digest = if *frame.editable == loaded.editable {
        loaded.scene.digest
    } else {
        let text = edit::save(&loaded.text, &loaded.scene.desc, &frame.editable)?;
        scene::parse(&text, &loaded.path)?.digest
    };
    let (width, height) = (frame.settings.width, frame.settings.height);
    let view = render::View::new(&frame.world, &frame.editable.camera, width, height);
    let provenance = Provenance {
        scene: &loaded.path,
        digest,
        view: &view,
        settings: &frame.settings,
        samples: frame.samples,
        is_clamped: false,
        exposure,
    };
    let light: Vec<f64> = frame.light.iter().flat_map(|light| light.to_array()).collect();
    target.write_light(&provenance, &light)
}

/// A scene that was saved: as it is read from its file, what that is, and what it says.
pub type SavedScene = Result<(Loaded, Files, Arc<Editable>)>;

/// Writes a scene with its changes on a thread of its own; `wake` is called when it is done.
pub fn start_scene(
    loaded: Arc<Loaded>,
    editable: Arc<Editable>,
    path: PathBuf,
    wake: impl FnOnce() + Send + 'static,
) -> Receiver<SavedScene> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let saved = save_scene(&loaded, &editable, &path).map(|(loaded, files)| (loaded, files, editable));
        // As above.
        let _ = sender.send(saved);
        wake();
    });
    receiver
}

/// Writes a scene with its changes; in another folder it names the same files by other names.
fn save_scene(loaded: &Loaded, editable: &Editable, path: &Path) -> Result<(Loaded, Files)> {
    document::check_unchanged(loaded, path)?;
    let text = edit::save(&loaded.text, &loaded.scene.desc, editable)?;
    let text = edit::moved(&text, &loaded.path, path)?;
    document::save(text, path).map_err(|error| match error {
        Error::Io { .. } if document::same_file(&loaded.path, path) => {
            Error::Usage(format!("{error}; \"Save scene as…\" in the menu File puts it elsewhere"))
        }
        error => error,
    })
}

/// Reads a picture to compare others with, on a thread of its own; `wake` is called when it is done.
pub fn start_reading(
    like: Arc<Frame>,
    path: PathBuf,
    wake: impl FnOnce() + Send + 'static,
) -> Receiver<std::result::Result<(PathBuf, Frame), String>> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        let read = picture::read(&path).map_err(|error| error.to_string());
        // As above.
        let _ = sender.send(read.map(|picture| (path, Frame::of_picture(&picture, &like))));
        wake();
    });
    receiver
}
