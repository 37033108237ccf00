//! The last resort: the film of a picture that could not be written.

use super::{Wanted, shell_line};
use crate::error::Error;
use crate::film::file::FilePlace;
use crate::render::{Origin, Rendered};
use std::env;
use std::path::{Path, PathBuf};

/// What a film file's name ends in.
pub const FILM_EXTENSION: &str = "film";

/// A film that goes wherever there is room.
pub struct Rescue<'r> {
    /// The file that could not be written.
    pub image: &'r Path,
    /// Another file beside which it may go.
    pub beside: Option<&'r Path>,
    /// The options by which `pathtracer merge` makes the picture of it; `None` if the file was to be the film of a part.
    pub options: Option<Vec<String>>,
}

impl Rescue<'_> {
    /// Keeps the film in the first place that takes it. Says where, after `why`, and how the picture can be made of it.
    pub fn keep(&self, origin: &Origin, rendered: &Rendered, why: Error) -> Error {
        let mut origin = origin.clone();
        if self.options.is_some() {
            origin.recipe.samples = rendered.film.samples();
        }
        let kept = self.candidates().into_iter().find_map(|path| {
            let place = FilePlace::new(&path).ok()?;
            rendered.write_part(&place, &origin).ok()?;
            Some(path)
        });
        let Some(kept) = kept else { return why };
        let Some(options) = &self.options else {
            let (kept, wanted) = (kept.display(), self.image.display());
            return Error::Film(format!("{why}\nthe finished part is kept as {kept}: move it to {wanted}"));
        };
        let files = [&kept, self.image].map(|file| file.to_string_lossy());
        let words = shell_line(files.iter().map(AsRef::as_ref).chain(options.iter().map(String::as_str)));
        Error::Film(format!("{why}\nthe finished film is kept: `pathtracer merge {words}` makes the picture"))
    }

    /// Beside the picture, in the working directory, beside the other file, in the folders for temporary files; nothing that
    /// exists.
    fn candidates(&self) -> Vec<PathBuf> {
        let name = self.image.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let folder_of = |path: &Path| path.parent().map(Path::to_path_buf);
        let folders = [
            folder_of(self.image),
            Some(PathBuf::new()),
            self.beside.and_then(folder_of),
            Some(env::temp_dir()),
            Some(PathBuf::from("/var/tmp")),
            env::var_os("HOME").map(PathBuf::from),
        ];
        let names = move |folder: PathBuf| {
            let numbered = (1..100).map(|number| format!("{name}-{number}.{FILM_EXTENSION}"));
            let mut all = [format!("{name}.{FILM_EXTENSION}")].into_iter().chain(numbered);
            all.find_map(|name| Some(folder.join(name)).filter(|path| !path.exists()))
        };
        folders.into_iter().flatten().filter_map(names).collect()
    }
}

impl Wanted {
    /// The options of the command line that ask for the same.
    pub fn options(&self) -> Vec<String> {
        let channels: Vec<&str> = self.aov.iter().map(|aov| aov.name()).collect();
        let all = [
            ("--exposure", (self.exposure != 0.0).then(|| self.exposure.to_string())),
            ("--depth", self.depth.map(|depth| depth.name().to_owned())),
            ("--aov", (!channels.is_empty()).then(|| channels.join(","))),
        ];
        let given = all.into_iter().filter_map(|(option, value)| Some([option.to_owned(), value?]));
        given.flatten().chain(self.denoise.then(|| "--denoise".to_owned())).collect()
    }
}
