//! Meshes: whatever a file holds, it is refused with a message or all that the mesh promises holds.
#![no_main]

mod support;

use libfuzzer_sys::fuzz_target;
use pathtracer::scene;

fuzz_target!(|bytes: &[u8]| {
    match scene::load_mesh(&support::file("mesh.obj", bytes)) {
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
});
