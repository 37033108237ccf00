//! `pathtracer info FILE`: how a picture, part or checkpoint was made, and the command that makes it again.

use super::console::printable;
use crate::output::{self, shell_line};
use crate::picture::Info;
use crate::render::{FileKind, FilmFile};
use crate::study::table::counted;
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::Path;

/// Prints what a file says about itself; returns the exit code.
pub(super) fn run(picture: &Path) -> anyhow::Result<u8> {
    if FilmFile::kind_of(picture).is_some() {
        // A reader that has gone away does not change the answer.
        let _ = writeln!(io::stdout(), "{}", printable(&film(&FilmFile::open(picture)?, picture)));
        return Ok(0);
    }
    let info = Info::read(picture)?;
    let shown = printable(&picture.to_string_lossy());
    let mut text = format!("{shown}: {}, {} x {} pixels\n", info.format, info.width, info.height);
    if !info.channels.is_empty() {
        let _ = writeln!(text, "channels: {}", printable(&info.channels.join(", ")));
    }
    let width = info.metadata.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, value) in info.metadata.iter() {
        let _ = writeln!(text, "{:width$}  {}", printable(name), printable(&value.to_string()));
    }
    let command = match output::arguments(&info.metadata, picture) {
        Some(words) => format!("made again by: pathtracer {}", printable(&shell_line(words))),
        None => "the picture does not say how this program would make it".to_owned(),
    };
    // A reader that has gone away does not change the answer.
    let _ = writeln!(io::stdout(), "{text}{command}");
    Ok(0)
}

/// What a checkpoint or part is, and what can be done with it.
fn film(file: &FilmFile, path: &Path) -> String {
    let recipe = &file.origin().recipe;
    let (path, scene) = (path.to_string_lossy(), &recipe.scene);
    let of_what = format!(
        "of {scene}, {} x {} pixels, {}",
        recipe.width,
        recipe.height,
        counted(recipe.samples, "sample")
    );
    let mut words = recipe.arguments(&path);
    match file.kind() {
        FileKind::Part => {
            let region = recipe.region();
            let chunks =
                recipe.chunks().map_or(String::new(), |[start, end]| format!(", chunks {start}..{end}"));
            format!(
                "{path}: {region}{chunks} {of_what}; `pathtracer merge PART... IMAGE` makes the picture; made again by: pathtracer {}",
                shell_line(words)
            )
        }
        FileKind::Checkpoint => {
            words[5] = "IMAGE".to_owned();
            words.extend(["--resume".to_owned(), path.clone().into_owned()]);
            format!("{path}: a checkpoint {of_what}; goes on by: pathtracer {}", shell_line(words))
        }
    }
}
