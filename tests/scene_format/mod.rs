//! Scenes and meshes as they should be.

/// Every key, its default and what it becomes.
mod keys;
/// How the reader takes a mesh file apart and together.
mod mesh_files;
/// What an OBJ file may hold.
mod meshes;
/// How a scene may be written, and where it finds its meshes.
mod styles;

use pathtracer::scene::desc::{MeshDesc, ObjectDesc, ShapeDesc};
use pathtracer::scene::{self, Scene};
use std::path::Path;
use std::sync::Arc;

/// A camera without mistakes.
const CAMERA: &str = "Camera: {Position: [0, -5, 1], LookingAt: [0, 0, 1], Fov: 0.3, FocusDistance: 5}\n";

/// A scene that can be rendered, as if it stood in `scene.yaml` of the working directory.
fn parse(text: &str) -> Scene {
    scene::parse(text, Path::new("scene.yaml")).unwrap_or_else(|error| panic!("{error}"))
}

/// The only object of a scene with the keys `object`, which must not give warnings.
fn object(object: &str) -> ObjectDesc {
    let scene = parse(&format!("{CAMERA}Objects:\n  - Object: {object}\n"));
    assert_eq!(scene.warnings, []);
    let mut objects = scene.desc.objects;
    assert_eq!(objects.len(), 1);
    objects.remove(0)
}

/// The mesh of an object.
fn mesh_of(object: &ObjectDesc) -> &Arc<MeshDesc> {
    match &object.shape {
        ShapeDesc::TriangleMesh { mesh, .. } => mesh,
        other => panic!("{other:?} is no mesh"),
    }
}
