//! Scene files: whatever they hold, they are refused with a message or make a world.

use pathtracer::scene;
use pathtracer::world::World;
use std::fs;
use std::path::Path;

/// Panics where the promise is broken.
pub(crate) fn check(folder: &Path, bytes: &[u8]) {
    let path = folder.join("scene.yaml");
    fs::write(&path, bytes).expect("a temporary file");
    match scene::load(&path) {
        Ok(scene) => match World::compile(&scene.desc) {
            Ok(world) => drop(world.guards(&scene.desc, 64)),
            Err(error) => assert!(!error.to_string().is_empty()),
        },
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
