//! The state of the window and what its commands do, apart from how it is drawn.

mod files;

use super::camera_control;
use super::coming;
use super::display::{Display, View};
use super::document::{self, Document, Event, Loaded};
use super::examples::{Example, Examples};
use super::form::Form;
use super::history::History;
use super::pick::{self, Pick, Tool};
use super::saving::SavedScene;
use super::session::{Frame, Order, Purpose, Session, Stage, Status};
use super::settings::{Kept, own_folder};
use crate::error::Diagnostic;
use crate::render::{AccelKind, Settings};
use crate::scene::edit::Editable;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

/// How long the place of the picture must keep its size before the preview follows.
const SETTLED: Duration = Duration::from_millis(200);

/// Called, from any thread, when there is something new to draw.
pub type Wake = Arc<dyn Fn() + Send + Sync>;

/// Something to be read at the foot of the window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Notice {
    /// What.
    pub text: String,
    /// Whether something went wrong.
    pub is_error: bool,
}

/// What a preview depends on, but for its size. Every scene that is read, and every change, has a version of its own.
#[derive(Clone, Debug, PartialEq)]
struct Key {
    version: u64,
    settings: (u64, u32, AccelKind, crate::accel::Precision, crate::sampling::SamplerKind),
}

/// Everything behind the window.
pub struct Studio {
    /// What is kept between runs.
    pub kept: Kept,
    /// The scene file.
    pub document: Document,
    /// What the scene says by now.
    pub editable: Option<Arc<Editable>>,
    /// The example scenes.
    pub examples: Examples,
    /// The renders.
    pub session: Session,
    /// What is shown.
    pub display: Display,
    /// What is shown of the stored picture.
    pub stored_display: Display,
    /// The picture that others are compared with.
    pub stored: Option<Arc<Frame>>,
    /// The file that the stored picture was read from, if it was.
    pub stored_file: Option<PathBuf>,
    /// Where the stored picture ends and the other begins, as a share of the width; `None` if it is not shown.
    pub wipe: Option<f32>,
    /// The fields.
    pub form: Form,
    /// The selected object.
    pub selected: Option<usize>,
    /// What of the picture is shown.
    pub view: View,
    /// What a click does.
    pub tool: Tool,
    /// What is to be read.
    pub notice: Option<Notice>,
    /// What the guards of the scene said and has been put away.
    pub known_guards: Vec<Diagnostic>,
    wake: Wake,
    history: History,
    version: u64,
    place: [u32; 2],
    next_place: ([u32; 2], Instant),
    ordered: Option<(Key, [u32; 2])>,
    is_final: bool,
    told: u64,
    picking: Option<Receiver<Pick>>,
    saving: Option<Receiver<Result<PathBuf, String>>>,
    saving_scene: Option<Receiver<SavedScene>>,
    reading_stored: Option<Receiver<Result<(PathBuf, Frame), String>>>,
    /// A scene that was not opened, since there were changes.
    refused: Option<PathBuf>,
}

impl Studio {
    /// A window without a scene.
    pub fn new(kept: Kept, wake: Wake) -> Studio {
        let notify = |wake: &Wake| {
            let wake = Arc::clone(wake);
            move || wake()
        };
        Studio {
            kept,
            document: Document::default(),
            editable: None,
            examples: Examples::look(notify(&wake)),
            session: Session::new(notify(&wake)),
            display: Display::new(notify(&wake)),
            stored_display: Display::new(notify(&wake)),
            stored: None,
            stored_file: None,
            wipe: None,
            form: Form::default(),
            selected: None,
            view: View::default(),
            tool: Tool::default(),
            notice: None,
            known_guards: Vec::new(),
            history: History::default(),
            version: 0,
            place: [640, 360],
            next_place: ([640, 360], Instant::now()),
            ordered: None,
            is_final: false,
            told: 0,
            picking: None,
            saving: None,
            saving_scene: None,
            reading_stored: None,
            refused: None,
            wake,
        }
    }

    fn waker(&self) -> impl Fn() + Send + 'static {
        let wake = Arc::clone(&self.wake);
        move || wake()
    }

    /// Begins to open a scene.
    ///
    /// Changes that are not saved are not lost at once: another scene has to be asked for twice.
    pub fn open(&mut self, path: &Path) {
        let loaded = self.document.loaded.as_ref();
        let is_other = loaded.is_some_and(|loaded| !document::same_file(&loaded.path, path));
        if is_other && self.is_edited() && self.refused.as_deref() != Some(path) {
            self.refused = Some(path.to_path_buf());
            let why = "the scene has changes that are not saved: save it, or open the other one once more to drop them";
            return self.say_error(why.into());
        }
        self.refused = None;
        let wake = self.waker();
        self.document.open(path, wake);
    }

    /// Begins to open an example.
    pub fn open_example(&mut self, example: &Example) {
        // Without a home there are still the folders for temporary files.
        let data = own_folder("XDG_DATA_HOME", ".local/share").unwrap_or_else(std::env::temp_dir);
        match example.file(&data) {
            Ok(path) => self.open(&path),
            Err(error) => self.say_error(error.to_string()),
        }
    }

    /// Takes what has happened since the last look, and renders what has changed.
    pub fn update(&mut self) {
        let before = self.document.loaded.clone();
        match self.document.poll() {
            Some(Event::Loaded) => self.take_loaded(before),
            Some(Event::Failed) => {
                let picture = "; the picture is that of the last good one";
                let picture = if before.is_some() { picture } else { "" };
                self.say_error(format!("the scene has errors{picture}"));
            }
            None => {}
        }
        let wake = self.waker();
        if self.document.has_changed(wake)
            && let Some(path) = self.document.path.clone()
        {
            self.open(&path);
        }
        self.take_pick();
        self.take_files();
        self.tell_end();
        self.refresh();
    }

    /// Goes on with a scene that was read.
    fn take_loaded(&mut self, before: Option<Arc<Loaded>>) {
        let Some(loaded) = self.document.loaded.clone() else { return };
        let is_reloaded =
            before.as_ref().is_some_and(|before| document::same_file(&before.path, &loaded.path));
        let merged = match (&before, &self.editable) {
            (Some(before), Some(editable)) if is_reloaded => {
                document::merge(&before.editable, editable, &loaded.editable)
            }
            _ => loaded.editable.clone(),
        };
        let count = |editable: &Editable| editable.surfaces.len();
        let is_same_list =
            before.as_ref().is_none_or(|before| count(&before.editable) == count(&loaded.editable));
        if is_reloaded && self.is_edited() && !is_same_list {
            self.say(
                "the scene was read again; its objects are others, so changes of materials were dropped"
                    .into(),
            );
        } else if is_reloaded {
            self.say("the scene was read again".into());
        } else {
            let stem = loaded.path.file_stem().unwrap_or_default().to_string_lossy();
            self.kept.knobs.image = format!("{stem}.png");
            self.form.clear();
            self.kept.remember(&loaded.path);
            self.selected = None;
            self.notice = None;
        }
        // What was before belongs to another text.
        self.history = History::default();
        self.form.clear_camera();
        self.selected = self.selected.filter(|&object| object < loaded.scene.desc.objects.len());
        self.editable = Some(Arc::new(merged));
        self.version += 1;
    }

    /// Whether the scene differs from its file.
    pub fn is_edited(&self) -> bool {
        match (&self.document.loaded, &self.editable) {
            (Some(loaded), Some(editable)) => loaded.editable != **editable,
            _ => false,
        }
    }

    /// Changes the scene, so that it can be undone.
    pub fn edit(&mut self, change: impl FnOnce(&mut Editable)) {
        let Some(editable) = &mut self.editable else { return };
        let before = Arc::clone(editable);
        change(Arc::make_mut(editable));
        if before != *editable {
            self.history.push(before);
            self.version += 1;
        }
    }

    /// Goes back one change, or forth.
    pub fn undo(&mut self, is_back: bool) {
        let Some(editable) = &mut self.editable else { return };
        if let Some(other) = self.history.step(Arc::clone(editable), is_back) {
            *editable = other;
            self.version += 1;
            self.form.clear_camera();
        }
    }

    /// The camera as it is in the file.
    pub fn reset_camera(&mut self) {
        if let Some(loaded) = self.document.loaded.clone() {
            self.edit(|editable| editable.camera = loaded.editable.camera.clone());
            self.form.clear_camera();
        }
    }

    /// Says how many pixels there are for the picture.
    pub fn set_place(&mut self, place: [u32; 2]) {
        if self.next_place.0 != place {
            self.next_place = (place, Instant::now());
        }
        if self.ordered.is_none() || self.next_place.1.elapsed() >= SETTLED {
            self.place = place;
        }
    }

    /// Whether the place of the picture is changing its size, so that one more look is needed.
    pub fn is_settling(&self) -> bool {
        self.place != self.next_place.0
    }

    /// Of the preview.
    pub fn preview_settings(&self) -> Settings {
        self.kept.knobs.preview_settings(self.place)
    }

    fn key(&self) -> Option<(Key, [u32; 2])> {
        self.document.loaded.as_ref()?;
        let settings = self.preview_settings();
        let of = (settings.samples, settings.bounces, settings.accel, settings.precision, settings.sampler);
        Some((Key { version: self.version, settings: of }, [settings.width, settings.height]))
    }

    /// Renders a preview if it would differ from what was ordered last. A final render is left alone, and its picture stays
    /// until something other than the window's size changes.
    fn refresh(&mut self) {
        let Some(key) = self.key() else { return };
        let is_same = match &self.ordered {
            Some(ordered) if self.is_final => ordered.0 == key.0,
            Some(ordered) => *ordered == key,
            None => false,
        };
        if !is_same && !self.is_rendering_final() {
            self.preview();
        }
    }

    fn order(&self, settings: Settings, purpose: Purpose) -> Option<Order> {
        let (loaded, editable) = (self.document.loaded.clone()?, self.editable.clone()?);
        Some(Order { loaded, editable, settings, purpose })
    }

    /// Starts a preview.
    pub fn preview(&mut self) {
        if let Some(order) = self.order(self.preview_settings(), Purpose::Preview) {
            self.ordered = self.key();
            self.is_final = false;
            self.session.order(order);
        }
    }

    /// Starts the final render, which ends with a file.
    pub fn render(&mut self) {
        if self.is_rendering_final() {
            return;
        }
        if let Some((field, error)) = self.form.wrong(&self.kept.knobs) {
            return self.say_error(format!("{}: {error}", field.label()));
        }
        if let Err(error) = self.kept.knobs.check() {
            return self.say_error(error.to_string());
        }
        self.form.set_refusal(None);
        let knobs = &self.kept.knobs;
        if let Some(order) = self.order(knobs.settings(), Purpose::Final(knobs.wanted())) {
            self.notice = None;
            self.ordered = self.key();
            self.is_final = true;
            self.session.order(order);
        }
    }

    /// Whether a final render is under way.
    pub fn is_rendering_final(&self) -> bool {
        self.is_final && self.session.status().is_busy()
    }

    /// Whether the picture is that of a final render.
    pub fn is_final(&self) -> bool {
        self.is_final
    }

    /// Says how a final render has ended, once.
    fn tell_end(&mut self) {
        let status = self.session.status();
        if status.is_busy() || self.told == status.job {
            return;
        }
        self.told = status.job;
        match status {
            Status { stage: Stage::Failed(why), is_file_refused, .. } => {
                self.form.set_refusal(is_file_refused.then(|| why.clone()));
                self.say_error(why);
            }
            Status { written: Some(path), .. } => self.say(format!("{} is written", path.display())),
            _ => {}
        }
    }

    /// Looks what is at a point of the picture, for a click.
    pub fn click(&mut self, frame: Arc<Frame>, at: [f64; 2], tool: Tool) {
        let wake = self.waker();
        self.picking = Some(pick::start(frame, at, tool, wake));
    }

    fn take_pick(&mut self) {
        let Some(pick) = coming::take(&mut self.picking) else { return };
        match pick {
            Some(Pick { tool: Tool::Select, found }) => self.selected = found.map(|(object, _)| object),
            Some(Pick { tool, found: Some((_, point)) }) => {
                self.edit(|editable| match tool {
                    Tool::Focus => camera_control::focus(&mut editable.camera, point),
                    _ => camera_control::look_at(&mut editable.camera, point),
                });
                self.form.clear_camera();
            }
            _ => self.say("there is only sky".into()),
        }
        self.tool = Tool::Select;
    }

    /// Says something.
    pub fn say(&mut self, text: String) {
        self.notice = Some(Notice { text, is_error: false });
    }

    /// Forgets what went wrong, and what the scene's user should know; they may come back with the next file.
    pub fn put_messages_away(&mut self) {
        self.notice = None;
        self.document.diagnostics.clear();
        self.known_guards = self.session.status().guards;
    }

    /// Says that something went wrong.
    pub fn say_error(&mut self, text: String) {
        self.notice = Some(Notice { text, is_error: true });
    }
}
