//! Meshes: whatever a file holds, it is refused with a message or all that the mesh promises holds.

use pathtracer::scene;
use std::fs;
use std::path::Path;

/// Panics where the promise is broken.
pub(crate) fn check(folder: &Path, bytes: &[u8]) {
    let path = folder.join("mesh.obj");
    fs::write(&path, bytes).expect("a temporary file");
    match scene::load_mesh(&path) {
        Ok(mesh) => {
            assert!(mesh.positions.iter().flatten().all(|x| x.is_finite()));
            let positions = mesh.positions.len() as u32;
            assert!(mesh.triangles.iter().flatten().all(|&index| index < positions));
            let within = |index: u32, count: usize| index == u32::MAX || (index as usize) < count;
            assert!(mesh.normal_indices.iter().flatten().all(|&i| within(i, mesh.normals.len())));
            assert!(mesh.texcoord_indices.iter().flatten().all(|&i| within(i, mesh.texcoords.len())));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}
