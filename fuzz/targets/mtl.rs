//! Material files, by a scene whose mesh names one.
#![no_main]

mod support;

use libfuzzer_sys::fuzz_target;
use pathtracer::scene;
use pathtracer::world::World;
use std::path::PathBuf;
use std::sync::LazyLock;

const MESH: &[u8] = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 3/1 2/1 1/1\n";
const SCENE: &[u8] = b"Camera: {Position: [0, 0, 0], LookingAt: [5, 0, 0], Fov: 0.3, FocusDistance: 5, DepthOfField: 0}
Objects:
  - Object: {Type: TriangleMesh, Filepath: mesh.obj, Position: [5, 0, 0], Material: FromFile}
";

static FILE: LazyLock<PathBuf> = LazyLock::new(|| {
    support::file("mesh.obj", MESH);
    support::file("scene.yaml", SCENE)
});

fuzz_target!(|bytes: &[u8]| {
    support::file("a.mtl", bytes);
    match scene::load(&FILE) {
        Ok(scene) => drop(World::compile(&scene.desc).expect("a world of a good scene")),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
