//! A scene as the commands take it that measure.

use super::console::say;
use crate::error::{Error, Result};
use crate::output::same_file;
use crate::scene::{self, Scene};
use crate::world::World;
use std::path::{Path, PathBuf};

/// Reads and compiles a scene. Its warnings, for pictures of `width` pixels a row, are said unless `quiet`.
///
/// # Errors
/// As a render's: what can't be rendered right is not measured either.
pub(super) fn load(path: &Path, width: u32, quiet: bool) -> Result<(Scene, World)> {
    let scene = scene::load(path)?;
    let world = World::compile(&scene.desc)?;
    let guards = world.guards(&scene.desc, width)?;
    if !quiet {
        scene.warnings.iter().chain(&guards).for_each(say);
    }
    Ok((scene, world))
}

/// Refuses to write over what is read.
///
/// # Errors
/// [`Error::Usage`] names the file.
pub(super) fn keep<'p>(
    read: impl IntoIterator<Item = &'p PathBuf>,
    written: impl IntoIterator<Item = &'p PathBuf> + Clone,
) -> Result<()> {
    let replaced = |path: &&PathBuf| written.clone().into_iter().any(|written| same_file(written, path));
    match read.into_iter().find(replaced) {
        Some(path) => {
            let path = path.display();
            Err(Error::Usage(format!("{path} is read: choose another name for what is written")))
        }
        None => Ok(()),
    }
}
