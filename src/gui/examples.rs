//! The example scenes that came with the program.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

/// Where a package installs the examples, below the folder that holds its `bin`.
const INSTALLED: &str = "share/doc/pathtracer/examples/scenes";

/// The scenes of the first folder `scenes` in the working directory, or beside the program or above it, or where a package
/// installs them.
pub fn find() -> Vec<PathBuf> {
    let here = env::current_dir().ok();
    let program = env::current_exe().ok();
    let folders =
        here.iter().map(PathBuf::as_path).chain(program.iter().flat_map(|program| program.ancestors()));
    folders
        .flat_map(|folder| ["scenes", INSTALLED].map(|below| scenes_in(&folder.join(below))))
        .find(|scenes| !scenes.is_empty())
        .unwrap_or_default()
}

/// The scene files of a folder, by name.
pub fn scenes_in(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut scenes: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|path| is_scene(path)).collect();
    scenes.sort();
    scenes
}

/// Whether a file is named like a scene.
pub fn is_scene(path: &Path) -> bool {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    extension == "yaml" || extension == "yml"
}
