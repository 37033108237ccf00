//! The files of the window beside the scene's own: scenes and pictures that are saved, pictures that are compared with.

use super::Studio;
use crate::gui::coming;
use crate::gui::saving::{self, SavedScene};
use crate::gui::session::Frame;
use crate::output::Wanted;
use crate::picture::Depth;
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl Studio {
    /// Begins to write the scene with its changes, to its file or another one.
    pub fn save_scene(&mut self, path: Option<&Path>) {
        self.finish_saving();
        let (Some(loaded), Some(editable)) = (self.document.loaded.clone(), self.editable.clone()) else {
            return;
        };
        let path = path.unwrap_or(&loaded.path).to_path_buf();
        self.saving_scene = Some(saving::start_scene(loaded, editable, path, self.waker()));
    }

    /// Waits until the scene is saved, if that was begun.
    pub fn finish_saving(&mut self) {
        if let Some(saving) = self.saving_scene.take() {
            self.take_saved_scene(saving.recv().ok());
        }
    }

    /// Goes on with the scene that was saved. The picture is the same, so it stays.
    fn take_saved_scene(&mut self, saved: Option<SavedScene>) {
        let (loaded, files, editable) = match saved {
            Some(Ok(saved)) => saved,
            Some(Err(error)) => return self.say_error(error.to_string()),
            None => return self.say_error("the scene could not be saved".into()),
        };
        self.kept.remember(&loaded.path);
        self.say(format!("{} is saved", loaded.path.display()));
        let saved = Arc::new(loaded.editable.clone());
        self.document.take_saved(loaded, files);
        // What was changed in the meantime is still to be saved.
        if self.editable.as_ref().is_some_and(|now| **now == *editable) {
            self.editable = Some(saved);
        }
    }

    /// Writes the picture that is shown to a file, in a depth of its format or its default.
    pub fn save_picture(&mut self, path: &Path, depth: Option<Depth>) {
        let Some(frame) = self.session.frame() else {
            return self.say_error("there is no picture to save yet".into());
        };
        let exposure = self.kept.knobs.exposure;
        let wanted = Wanted { image: path.to_path_buf(), depth, exposure, ..Wanted::default() };
        self.saving = Some(saving::start(frame, wanted, self.waker()));
    }

    /// Takes what the threads that read and write files have sent.
    pub(super) fn take_files(&mut self) {
        if let Some(saved) = coming::take(&mut self.saving_scene) {
            self.take_saved_scene(saved);
        }
        if let Some(saved) = coming::take(&mut self.saving) {
            self.take_saved_picture(saved);
        }
        match coming::take(&mut self.reading_stored) {
            Some(Some(Ok((path, frame)))) => self.take_stored(path, frame),
            Some(Some(Err(why))) => self.say_error(why),
            Some(None) => self.say_error("the picture could not be read".into()),
            None => {}
        }
    }

    fn take_saved_picture(&mut self, saved: Option<Result<PathBuf, String>>) {
        match saved {
            Some(Ok(path)) => self.say(format!("{} is written", path.display())),
            Some(Err(error)) => self.say_error(error),
            None => self.say_error("the picture could not be written".into()),
        }
    }

    /// Ends what is under way, with its results written. Whether they are; else the notice says why not.
    pub fn close(&mut self) -> bool {
        self.notice = None;
        if self.is_rendering_final() {
            self.session.stop();
            self.session.wait();
            self.tell_end();
        }
        let of_render = self.take_error();
        self.finish_saving();
        let of_scene = self.take_error();
        if let Some(saving) = self.saving.take() {
            self.take_saved_picture(saving.recv().ok());
        }
        let of_picture = self.take_error();
        let errors: Vec<String> = [of_render, of_scene, of_picture].into_iter().flatten().collect();
        if !errors.is_empty() {
            self.say_error(errors.join("\n"));
        }
        errors.is_empty()
    }

    fn take_error(&mut self) -> Option<String> {
        self.notice.take_if(|notice| notice.is_error).map(|notice| notice.text)
    }

    /// Stores the picture to compare others with.
    pub fn store(&mut self) {
        self.stored = self.session.frame();
        self.stored_file = None;
        self.wipe = self.stored.as_ref().map(|_| 0.5);
    }

    /// Begins to read the picture to compare others with.
    pub fn store_file(&mut self, path: &Path) {
        let Some(like) = self.session.frame() else {
            return self
                .say_error("there is no picture yet to compare with another: open a scene first".into());
        };
        self.reading_stored = Some(saving::start_reading(like, path.to_path_buf(), self.waker()));
    }

    /// Goes on with a picture of a file, if it is one of the same thing.
    fn take_stored(&mut self, path: PathBuf, frame: Frame) {
        let [width, height] = frame.size();
        let knobs = &self.kept.knobs;
        let of_scene = [knobs.width as usize, knobs.height as usize];
        let is_shown = self.session.frame().is_some_and(|shown| shown.size() == [width, height]);
        if !is_shown && of_scene != [width, height] {
            let [wanted_width, wanted_height] = of_scene;
            return self.say_error(format!(
                "{} has {width} x {height} pixels, so it can't be compared with a picture of {wanted_width} x \
                 {wanted_height}: set Width and Height to its size",
                path.display()
            ));
        }
        self.stored = Some(Arc::new(frame));
        self.stored_file = Some(path);
        self.wipe = Some(0.5);
    }
}
