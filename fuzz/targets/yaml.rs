//! Scene files: whatever they hold, they are refused with a message or make a world.
#![no_main]

mod support;

use libfuzzer_sys::fuzz_target;
use pathtracer::scene;
use pathtracer::world::World;

fuzz_target!(|bytes: &[u8]| {
    match scene::load(&support::file("scene.yaml", bytes)) {
        Ok(scene) => match World::compile(&scene.desc) {
            Ok(world) => drop(world.guards(&scene.desc, 64)),
            Err(error) => assert!(!error.to_string().is_empty()),
        },
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
