//! Every bad input meets its exact message.

/// The corpus of bad files.
mod corpus;
/// Inputs that would cost time or memory.
mod hostile;
/// Random damage to good files.
mod mutations;
/// The place of every value in every style.
mod places;

use pathtracer::error::{Diagnostic, Error};
use pathtracer::scene;
use std::path::Path;

/// A camera without mistakes.
const CAMERA: &str = "Camera: {Position: [0, -5, 1], LookingAt: [0, 0, 1], Fov: 0.3, FocusDistance: 5}\n";

/// An item of `Objects` with a mesh.
fn mesh_object(file: &str) -> String {
    format!(
        "  - Object: {{Type: TriangleMesh, Filepath: {file}, Position: [0, 0, 0], Material: {{Type: Diffuse}}}}\n"
    )
}

/// The errors and warnings of a scene that can't be rendered.
fn diagnostics_of(text: &str) -> Vec<Diagnostic> {
    match scene::parse(text, Path::new("scene.yaml")) {
        Err(Error::Scene(diagnostics)) => diagnostics,
        other => panic!("expected errors, got {other:?}"),
    }
}
