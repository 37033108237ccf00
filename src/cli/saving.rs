//! Where the sums of a render go, and where they come from: checkpoints, parts, and the last resort.

use super::arguments::Job;
use super::console::say;
use super::farm;
use crate::error::{Error, Result};
use crate::film::file::{FilePlace, Reader};
use crate::output::{FILM_EXTENSION, Rescue};
use crate::render::{FileKind, FilmFile, OF_A_TASK, Origin, Rendered, State};
use std::fs;
use std::path::PathBuf;

/// Whether the job makes a part of a picture, not a picture.
pub(super) fn is_part(job: &Job) -> bool {
    job.settings.region.option().is_some() || job.settings.chunks.is_some()
}

/// The place of the part that a job makes.
pub(super) fn part_place(job: &Job) -> Result<FilePlace> {
    if job.image.extension().is_none_or(|extension| extension != FILM_EXTENSION) {
        let why = format!(
            "a part of a picture needs a name that ends in .{FILM_EXTENSION}, not {}",
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

/// What there is of a render before it begins.
pub(super) enum Found {
    /// Nothing that helps.
    Nothing,
    /// All of it.
    Done(Box<Rendered>),
    /// A checkpoint of it.
    Begun(Box<State>),
}

/// What a job is told to go on with, else what an earlier task left of its part.
///
/// # Errors
/// A file of another render; one to go on with that can't be read.
pub(super) fn found(job: &Job, part: Option<&FilePlace>, origin: &Origin) -> Result<Found> {
    match (&job.resume, part) {
        (Some(path), _) => resumed(job, path, origin),
        (None, Some(place)) => existing_part(job, place, origin),
        (None, None) => Ok(Found::Nothing),
    }
}

/// Looks for the part, or for what an interrupted task left of it.
///
/// # Errors
/// Anything but a damaged film file, which helps nobody: a part of another render, any other file.
fn existing_part(job: &Job, place: &FilePlace, origin: &Origin) -> Result<Found> {
    if !place.path().exists() {
        return Ok(Found::Nothing);
    }
    let file = match FilmFile::open(place.path()) {
        Ok(file) => file,
        Err(error) if Reader::is_damaged(place.path()) => {
            say(format_args!("warning: {error}; it will be replaced"));
            return Ok(Found::Nothing);
        }
        Err(error) => {
            return Err(Error::Film(format!("{error}; remove it, or choose another name")));
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

/// Where the render of a job goes on that is to be resumed.
fn resumed(job: &Job, path: &PathBuf, origin: &Origin) -> Result<Found> {
    // A task that is started for the first time has the same command line as one that is started again.
    if !path.exists() && job.checkpoint.as_ref() == Some(path) {
        return Ok(Found::Nothing);
    }
    let state = FilmFile::open(path)?.state(&job.settings, &origin.recipe)?;
    Ok(Found::Begun(Box::new(state)))
}

/// Keeps the film of a picture that could not be written, in the first place that takes it. Says where, and how the picture
/// can be made of it.
pub(super) fn rescue(job: &Job, origin: &Origin, rendered: &Rendered, why: Error) -> Error {
    let options = (!is_part(job)).then(|| farm::picture_options(job));
    Rescue { image: &job.image, beside: job.checkpoint.as_deref(), options }.keep(origin, rendered, why)
}
