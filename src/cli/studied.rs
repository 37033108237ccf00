//! A scene as the commands take it that measure.

use super::console::say;
use crate::error::Result;
use crate::scene::{self, Scene};
use crate::world::World;
use std::path::Path;

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
