//! Where the sums of a render go, and where they come from: checkpoints, parts, and the last resort.

use super::arguments::Job;
use super::console::say;
use super::farm;
use crate::error::{Error, Result};
use crate::film::file::FilePlace;
use crate::render::{FileKind, FilmFile, OF_A_TASK, Origin, Rendered, State};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// What a film file's name ends in.
const EXTENSION: &str = "film";

/// Whether the job makes a part of a picture, not a picture.
pub(super) fn is_part(job: &Job) -> bool {
    job.settings.region.option().is_some() || job.settings.chunks.is_some()
}

/// The place of the part that a job makes.
pub(super) fn part_place(job: &Job) -> Result<FilePlace> {
    if job.image.extension().is_none_or(|extension| extension != EXTENSION) {
        let why = format!(
            "a part of a picture needs a name that ends in .{EXTENSION}, not {}",
            job.image.display()
        );
        return Err(Error::Usage(why));
    }
    if job.error_bars.is_some() {
        let why = "--error-bars can't be with a part of a picture: give it to `pathtracer merge`";
        return Err(Error::Usage(why.into()));
    }
    // A farm's tasks begin in any order, the first one makes the folder.
    if let Some(folder) = job.image.parent() {
        fs::create_dir_all(folder).map_err(|source| Error::Io {
            action: "make the folder".into(),
            path: folder.into(),
            source,
        })?;
    }
    FilePlace::new(&job.image)
}

/// The place of checkpoints: as asked; of a part also its own file, until it is complete.
pub(super) fn checkpoint_place(job: &Job, part: Option<&FilePlace>) -> Result<Option<FilePlace>> {
    let Some(path) = &job.checkpoint else { return Ok(part.cloned()) };
    if path.is_file() && job.resume.as_ref() != Some(path) {
        let path = path.display();
        return Err(Error::Usage(format!(
            "the checkpoint {path} is there already: --resume {path} goes on with it; remove it to begin anew"
        )));
    }
    FilePlace::new(path).map(Some)
}

/// What is there of a part that a task makes.
pub(super) enum Found {
    /// Nothing that helps.
    Nothing,
    /// All of it.
    Done(Box<Rendered>),
    /// A checkpoint of it.
    Begun(Box<State>),
}

/// Looks for the part, or for what an interrupted task left of it.
///
/// # Errors
/// A whole file of another render, which is not to be lost; a damaged one is.
pub(super) fn existing_part(job: &Job, place: &FilePlace, origin: &Origin) -> Result<Found> {
    if !place.path().exists() {
        return Ok(Found::Nothing);
    }
    let file = match FilmFile::open(place.path()) {
        Ok(file) => file,
        Err(error) => {
            say(format_args!("warning: {error}; it will be replaced"));
            return Ok(Found::Nothing);
        }
    };
    if file.kind() == FileKind::Checkpoint {
        return Ok(Found::Begun(Box::new(file.state(&job.settings, &origin.recipe)?)));
    }
    let differences = file.origin().recipe.differences(&origin.recipe, &OF_A_TASK);
    match differences.is_empty() {
        true => Ok(Found::Done(Box::new(file.rendered()?))),
        false => {
            let differences = differences.join(", ");
            let why =
                format!("is another part: it differs in {differences}; remove it, or choose another name");
            Err(file.refuse(&why))
        }
    }
}

/// Where the render of a job goes on, if it is to be resumed.
pub(super) fn resumed(job: &Job, origin: &Origin) -> Result<Option<State>> {
    let Some(path) = &job.resume else { return Ok(None) };
    // A task that is started for the first time has the same command line as one that is started again.
    if !path.exists() && job.checkpoint.as_ref() == Some(path) {
        return Ok(None);
    }
    FilmFile::open(path)?.state(&job.settings, &origin.recipe).map(Some)
}

/// Keeps the film of a picture that could not be written, in the first place that takes it. Says where, and how the picture
/// can be made of it.
pub(super) fn rescue(job: &Job, origin: &Origin, rendered: &Rendered, why: Error) -> Error {
    let mut origin = origin.clone();
    let is_part = is_part(job);
    if !is_part {
        origin.recipe.samples = rendered.film.samples();
    }
    let kept = candidates(job).into_iter().find_map(|path| {
        let place = FilePlace::new(&path).ok()?;
        rendered.write_part(&place, &origin).ok()?;
        Some(path)
    });
    match kept {
        Some(path) if is_part => {
            let (kept, wanted) = (path.display(), job.image.display());
            Error::Film(format!("{why}\nthe finished part is kept as {kept}: move it to {wanted}"))
        }
        Some(path) => {
            let files = [&path, &job.image].map(|file| file.to_string_lossy().into_owned());
            let words: Vec<String> =
                files.into_iter().chain(farm::picture_options(job)).map(|word| farm::shell(&word)).collect();
            let words = words.join(" ");
            Error::Film(format!(
                "{why}\nthe finished film is kept: `pathtracer merge {words}` makes the picture"
            ))
        }
        None => why,
    }
}

/// Beside the picture, in the working directory, beside the checkpoint, in the folders for temporary files; nothing that
/// exists.
fn candidates(job: &Job) -> Vec<PathBuf> {
    let name = job.image.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let beside = |path: &Path| path.parent().map(Path::to_path_buf);
    let folders = [
        beside(&job.image),
        Some(PathBuf::new()),
        job.checkpoint.as_deref().and_then(beside),
        Some(env::temp_dir()),
        Some(PathBuf::from("/var/tmp")),
        env::var_os("HOME").map(PathBuf::from),
    ];
    let names = move |folder: PathBuf| {
        let numbered = (1..100).map(|number| format!("{name}-{number}.{EXTENSION}"));
        let mut all = [format!("{name}.{EXTENSION}")].into_iter().chain(numbered);
        all.find_map(|name| Some(folder.join(name)).filter(|path| !path.exists()))
    };
    folders.into_iter().flatten().filter_map(names).collect()
}
