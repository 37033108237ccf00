//! The scene file: read beside the window's thread, watched, and kept with its text.

pub use crate::output::{same_file, whole_path};

use super::coming;
use crate::error::{Diagnostic, Error, Severity};
use crate::output::TextFile;
use crate::scene::edit::Editable;
use crate::scene::{self, Scene};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

/// How often the files are looked at.
const WATCH_EVERY: Duration = Duration::from_millis(300);

/// A scene that was read without an error.
#[derive(Debug)]
pub struct Loaded {
    /// The file, as it was named.
    pub path: PathBuf,
    /// Its text, without a byte-order mark.
    pub text: String,
    /// What it says.
    pub scene: Scene,
    /// What can be edited of it.
    pub editable: Editable,
}

/// Reads a scene from text.
///
/// # Errors
/// As [`scene::parse`].
pub fn read_text(text: String, path: &Path) -> Result<Loaded, Error> {
    let scene = scene::parse(&text, path)?;
    let editable = Editable::read(&text, &scene.desc);
    Ok(Loaded { path: path.to_path_buf(), text, scene, editable })
}

/// Reads a scene file.
///
/// # Errors
/// As [`scene::load`].
pub fn read(path: &Path) -> Result<Loaded, Error> {
    // What is no text, or too large for one, gets the message that `load` has for it.
    let is_small = fs::metadata(path).is_ok_and(|found| found.is_file() && found.len() <= LARGEST_TEXT);
    let text = if is_small { fs::read_to_string(path).ok() } else { None };
    match text {
        Some(text) => read_text(text.strip_prefix(MARK).unwrap_or(&text).to_owned(), path),
        None => {
            let scene = scene::load(path)?;
            let text = String::new();
            let editable = Editable::read(&text, &scene.desc);
            Ok(Loaded { path: path.to_path_buf(), text, scene, editable })
        }
    }
}

/// The largest file that is read as a text, in bytes; of larger ones `load` says that they are.
const LARGEST_TEXT: u64 = 1 << 28;

/// The byte-order mark that a file may begin with.
const MARK: &str = "\u{feff}";

/// Writes a scene's text: whole or not at all, and with the byte-order mark that the file had.
///
/// # Errors
/// [`Error::Io`].
pub fn write(path: &Path, text: &str) -> Result<(), Error> {
    let file = TextFile::new(path)?;
    let had_mark = fs::read(path).is_ok_and(|bytes| bytes.starts_with(MARK.as_bytes()));
    let mark = if had_mark { MARK } else { "" };
    file.write(&format!("{mark}{text}"))
}

/// Whether a file still holds the text that was read from it; one of another name may hold anything.
///
/// # Errors
/// It holds something else, which is not to be lost.
pub fn check_unchanged(loaded: &Loaded, path: &Path) -> Result<(), Error> {
    let is_own = same_file(path, &loaded.path);
    match fs::read_to_string(path) {
        Ok(text) if is_own && text.strip_prefix(MARK).unwrap_or(&text) != loaded.text => {
            let path = path.display();
            Err(Error::Usage(format!(
                "{path} has changed since it was read, so it was not overwritten: mend it, or save the scene as another file"
            )))
        }
        _ => Ok(()),
    }
}

/// Writes an edited text to a file.
///
/// # Errors
/// As [`read_text`] and [`write()`].
pub fn save(text: String, path: &Path) -> Result<(Loaded, Files), Error> {
    let loaded = read_text(text, path)?;
    write(path, &loaded.text)?;
    let files = Files::of(path).with_named(&loaded.scene);
    Ok((loaded, files))
}

/// When a file was changed, and its size; `None` if it is not there.
type Stamp = Option<(SystemTime, u64)>;

fn stamp(path: &Path) -> Stamp {
    let found = fs::metadata(path).ok()?;
    Some((found.modified().ok()?, found.len()))
}

/// What a scene is read from, and when that was changed.
#[derive(Debug, Default)]
pub struct Files(Vec<(PathBuf, Stamp)>);

impl Files {
    /// The scene file alone.
    fn of(path: &Path) -> Files {
        Files(vec![(path.to_path_buf(), stamp(path))])
    }

    /// The scene file with all that it names. The scene file's stamp is from before it was read.
    fn with_named(mut self, scene: &Scene) -> Files {
        self.0.extend(scene.files.iter().map(|path| (path.clone(), stamp(path))));
        self
    }

    /// Also those that were watched before, as they are now.
    fn with_those_of(mut self, before: &Files) -> Files {
        let others = before.0.iter().filter(|(path, _)| *path != self.0[0].0);
        let others: Vec<(PathBuf, Stamp)> = others.map(|(path, _)| (path.clone(), stamp(path))).collect();
        self.0.extend(others);
        self
    }

    fn have_changed(&self) -> bool {
        self.0.iter().any(|(path, before)| stamp(path) != *before)
    }
}

/// What a read ended with.
pub type Outcome = Result<Arc<Loaded>, Error>;

/// The scene file of the window.
#[derive(Default)]
pub struct Document {
    /// The file that is open, or that could not be opened.
    pub path: Option<PathBuf>,
    /// The newest scene without an error.
    pub loaded: Option<Arc<Loaded>>,
    /// What is wrong with the newest file, or what its user should know.
    pub diagnostics: Vec<Diagnostic>,
    reading: Option<Receiver<(Files, Outcome)>>,
    files: Arc<Files>,
    /// A look whether files have changed: those files, and whether they have.
    looking: Option<Receiver<(Arc<Files>, bool)>>,
    looked: Option<Instant>,
}

/// What happened to the document.
#[derive(Debug, PartialEq, Eq)]
pub enum Event {
    /// There is another scene.
    Loaded,
    /// The newest file has errors.
    Failed,
}

impl Document {
    /// Begins to read a file; `wake` is called when it is done.
    pub fn open(&mut self, path: &Path, wake: impl FnOnce() + Send + 'static) {
        let is_same = self.path.as_deref().is_some_and(|before| same_file(before, path));
        self.path = Some(path.to_path_buf());
        let before = std::mem::take(&mut self.files);
        let before = if is_same { before } else { Arc::default() };
        let (sender, receiver) = channel();
        let path = path.to_path_buf();
        self.reading = Some(receiver);
        thread::spawn(move || {
            let files = Files::of(&path);
            let outcome = read(&path).map(Arc::new);
            let files = match &outcome {
                Ok(loaded) => files.with_named(&loaded.scene),
                // A mesh that is half written now may be whole later.
                Err(_) => files.with_those_of(&before),
            };
            // Nobody waits for a file that was left for another one.
            let _ = sender.send((files, outcome));
            wake();
        });
    }

    /// Whether a file is being read.
    pub fn is_reading(&self) -> bool {
        self.reading.is_some()
    }

    /// Looks whether a read has ended.
    pub fn poll(&mut self) -> Option<Event> {
        let Some((files, outcome)) = coming::take(&mut self.reading)? else {
            self.diagnostics = vec![plain("the scene could not be read".into())];
            return Some(Event::Failed);
        };
        self.files = Arc::new(files);
        Some(self.take(outcome))
    }

    /// Takes what a read ended with.
    pub fn take(&mut self, outcome: Outcome) -> Event {
        match outcome {
            Ok(loaded) => {
                self.diagnostics = loaded.scene.warnings.clone();
                self.path = Some(loaded.path.clone());
                self.loaded = Some(loaded);
                Event::Loaded
            }
            Err(Error::Scene(diagnostics)) => {
                self.diagnostics = diagnostics;
                Event::Failed
            }
            Err(other) => {
                self.diagnostics = vec![plain(other.to_string())];
                Event::Failed
            }
        }
    }

    /// Goes on with a scene that was just written to its file, whose changed date means nothing.
    pub fn take_saved(&mut self, loaded: Loaded, files: Files) {
        self.files = Arc::new(files);
        self.take(Ok(Arc::new(loaded)));
    }

    /// Whether a file has changed since it was read. Looks only now and then, and on a thread of its own, since a folder may be
    /// far away; `wake` is called when that thread has found a change.
    pub fn has_changed(&mut self, wake: impl FnOnce() + Send + 'static) -> bool {
        if self.looking.is_some() {
            let Some(found) = coming::take(&mut self.looking) else { return false };
            self.looked = Some(Instant::now());
            // What was read again in the meantime is not what was looked at.
            let is_present = |files: &Arc<Files>| Arc::ptr_eq(files, &self.files) && self.reading.is_none();
            return found.is_some_and(|(files, has_changed)| has_changed && is_present(&files));
        }
        let is_due = self.looked.is_none_or(|looked| looked.elapsed() >= WATCH_EVERY);
        if is_due && self.path.is_some() && self.reading.is_none() {
            let (sender, receiver) = channel();
            let files = Arc::clone(&self.files);
            self.looking = Some(receiver);
            thread::spawn(move || {
                let has_changed = files.have_changed();
                // A window that was closed does not want to know.
                let _ = sender.send((files, has_changed));
                if has_changed {
                    wake();
                }
            });
        }
        false
    }
}

/// What the file says by now, with what was changed in the window since it was read before.
pub(super) fn merge(old: &Editable, edited: &Editable, new: &Editable) -> Editable {
    let mut merged = new.clone();
    if edited.camera != old.camera {
        merged.camera = edited.camera.clone();
    }
    if edited.environment != old.environment {
        merged.environment = edited.environment.clone();
    }
    if edited.rotation != old.rotation && new.rotation.is_some() {
        merged.rotation = edited.rotation;
    }
    if old.surfaces.len() == new.surfaces.len() {
        let all = merged.surfaces.iter_mut().zip(old.surfaces.iter().zip(&edited.surfaces));
        for (merged, (old, edited)) in all {
            if old != edited && merged.is_some() {
                *merged = edited.clone();
            }
        }
    }
    merged
}

fn plain(message: String) -> Diagnostic {
    Diagnostic { severity: Severity::Error, message, location: None, source_line: None, help: None }
}
