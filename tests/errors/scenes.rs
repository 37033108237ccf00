//! Scenes whose errors are judged.

use crate::support::watch::Unwatched;
use pathtracer::render::{Rendered, Settings, render};
use pathtracer::scene::{self, desc::CameraDesc};
use pathtracer::world::World;
use std::path::Path;
use tempfile::TempDir;

/// The sample scenes; a Cornell box without glass; balls under the sky.
pub(super) const NAMES: [&str; 8] =
    ["bigBalls", "glassBalls", "legacyBalls", "mirrorRoom", "objectScene", "cornellBox", "A", "sky"];

const SKY: &str = "\
Camera: { Position: [-6, 0, 2], LookingAt: [0, 0, 1], Fov: 0.25, FocusDistance: 6 }
Environment: { SkyColor: [0.2, 0.5, 1], HorizonColor: [0.7, 0.8, 0.8], GroundColor: [0.1, 0.1, 0.1] }
Objects:
  - Object: { Type: Ball, Position: [0, 0, 1], Radius: 1, Material: { Type: Diffuse, Color: [0.8, 0.3, 0.2] } }
  - Object: { Type: Ball, Position: [0, 0, -1000], Radius: 1000, Material: { Type: Diffuse, Color: [0.5, 0.5, 0.5] } }
";

pub(super) struct Subject {
    world: World,
    camera: CameraDesc,
}

impl Subject {
    pub(super) fn new(name: &str) -> Subject {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        match name {
            "sky" => Subject::of_text(SKY),
            "A" => Subject::load(&root.join("tests/golden/A.yaml")),
            _ => Subject::load(&root.join("scenes").join(format!("{name}.yaml"))),
        }
    }

    pub(super) fn of_text(text: &str) -> Subject {
        let folder = TempDir::new().expect("a folder");
        let path = folder.path().join("scene.yaml");
        std::fs::write(&path, text).expect("a scene in a temporary folder");
        Subject::load(&path)
    }

    fn load(path: &Path) -> Subject {
        let desc = scene::load(path).expect("a valid scene").desc;
        let world = World::compile(&desc).expect("a valid scene");
        Subject { world, camera: desc.camera }
    }

    pub(super) fn render(&self, settings: &Settings) -> Rendered {
        render(&self.world, &self.camera, settings, &Unwatched).expect("a render")
    }
}
