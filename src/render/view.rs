//! What a picture's file says about its camera.

use crate::math::DVec3;
use crate::scene::desc::CameraDesc;
use crate::world::World;
use serde::{Deserialize, Serialize};

/// A camera as picture files tell it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct View {
    /// The matrix that OpenEXR's standard describes: from the scene to x to the right, y up and z forward, for row vectors.
    pub world_to_camera: [f64; 16],
    /// The horizontal field of view, in half turns.
    pub fov: f64,
}

impl View {
    /// Of a camera of a scene, for pictures of `width` x `height` pixels.
    pub fn new(world: &World, desc: &CameraDesc, width: u32, height: u32) -> View {
        let camera = world.camera(desc, width, height);
        let axes = [camera.right, camera.up, camera.forward];
        let position = camera.position + world.origin;
        let row = |of: fn(DVec3) -> f64| axes.map(of);
        let moved = axes.map(|axis| -axis.dot(position));
        let [x, y, z] = [row(|a| a.x), row(|a| a.y), row(|a| a.z)];
        let mut matrix = [0.0; 16];
        for (to, from) in matrix.chunks_exact_mut(4).zip([x, y, z, moved]) {
            // Adding zero turns -0 into 0.
            to[..3].copy_from_slice(&from.map(|value| value + 0.0));
        }
        matrix[15] = 1.0;
        View { world_to_camera: matrix, fov: desc.fov }
    }
}
