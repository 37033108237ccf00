//! Finding the files that a scene names.

use super::diagnostic::{Report, quote};
use super::yaml::value::Value;
use std::path::{Path, PathBuf};

/// What a file should be, in the words of messages.
pub(crate) struct Kind {
    /// Such as `an OBJ file`.
    file: &'static str,
    /// Such as `a mesh`.
    content: &'static str,
}

/// A mesh.
pub(crate) const MESH: Kind = Kind { file: "an OBJ file", content: "a mesh" };
/// A picture.
pub(crate) const PICTURE: Kind = Kind { file: "a picture", content: "a picture" };

/// Where the file called `name` is looked for, in this order.
pub(crate) fn places(folder: &Path, name: &str) -> Vec<PathBuf> {
    let mut places = vec![folder.join(name)];
    if !places.contains(&PathBuf::from(name)) {
        places.push(PathBuf::from(name));
    }
    places
}

/// The file called `name`: in the scene's folder, else in the working directory.
pub(crate) fn find(
    folder: &Path,
    name: &str,
    kind: &Kind,
    value: Value<'_>,
    report: &mut Report,
) -> Option<PathBuf> {
    let places = places(folder, name);
    if let Some(found) = places.iter().find(|path| path.is_file()) {
        return Some(found.clone());
    }
    let shown = |path: &Path| quote(&path.display().to_string());
    if let Some(other) = places.iter().find(|path| path.exists()) {
        let what = if other.is_dir() { "a folder" } else { "no regular file" };
        value.error(&format!("must be {}, but {} is {what}", kind.file, shown(other)), None, report);
        return None;
    }
    let tried: Vec<String> = places.iter().map(|path| shown(path)).collect();
    let help = format!("{} is looked for beside the scene file, then in the working directory", kind.content);
    value.error(&format!("names no file: tried {}", tried.join(" and ")), Some(help), report);
    None
}
