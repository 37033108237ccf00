//! Material files, by a scene whose mesh names one.

use pathtracer::scene;
use pathtracer::world::World;
use std::fs;
use std::path::Path;

const MESH: &[u8] =
    b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 3/1 2/1 1/1\n";
const SCENE: &[u8] =
    b"Camera: {Position: [0, 0, 0], LookingAt: [5, 0, 0], Fov: 0.3, FocusDistance: 5, DepthOfField: 0}
Objects:
  - Object: {Type: TriangleMesh, Filepath: mesh.obj, Position: [5, 0, 0], Material: FromFile}
";

/// Panics where the promise is broken.
pub(crate) fn check(folder: &Path, bytes: &[u8]) {
    let scene = folder.join("scene.yaml");
    for (path, content) in [("mesh.obj", MESH), ("scene.yaml", SCENE), ("a.mtl", bytes)] {
        fs::write(folder.join(path), content).expect("a temporary file");
    }
    match scene::load(&scene) {
        Ok(scene) => drop(World::compile(&scene.desc).expect("a world of a good scene")),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
