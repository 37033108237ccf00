mod canvas;
mod edit;
mod examples;
mod measure;
mod menus;
mod numbers;
mod panels;
mod place;
mod previews;
mod settings;
mod studio;
mod views;
mod window;

use pathtracer::gui::document::{self, Loaded};
use pathtracer::gui::session::{Order, Purpose, Session};
use pathtracer::render::{AccelKind, Settings};
use pathtracer::scene::edit::Editable;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Arc;
use tempfile::TempDir;

/// The sample scenes that are quick to read.
const SCENES: [&str; 5] = ["bigBalls", "cornellBox", "glassBalls", "mirrorRoom", "legacyBalls"];

/// A ball on another one, with comments, lit by a lamp and the sky.
const BALLS: &str = "\
# A ball on the ground.
Camera:
  Position: [-6, 0, 2]   # where it stands
  LookingAt: [0, 0, 1]
  Fov: 0.25
  FocusDistance: 6       # the ball
  DepthOfField: 8

Objects:
  - Object:
      Type: Ball
      Name: ground
      Position: [0, 0, -100]
      Radius: 100
      Material:
        Type: Diffuse    # matt
        Color: [0.5, 0.6, 0.4]
  # The one to look at.
  - Object:
      Type: Ball
      Name: ball
      Position: [0, 0, 1]
      Radius: 1
      Material:
        Name: clear
        Type: ClearCoat
        Color: [0.8, 0.1, 0.1]
  - Object:
      Type: Ball
      Position: [0, 3, 4]
      Radius: 0.5
      Material:
        Type: Diffuse
        EmissionStrength: 20
";

/// A folder with a scene.
struct Desk {
    folder: TempDir,
}

impl Desk {
    fn new() -> Desk {
        let desk = Desk { folder: tempfile::tempdir().expect("a temporary folder") };
        desk.write("balls.yaml", BALLS);
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("a file in a temporary folder");
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// What the command line makes of these arguments.
    fn command(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pathtracer"));
        let output = command.current_dir(self.folder.path()).args(arguments).output();
        let output = output.expect("the program starts");
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
        output
    }

    /// The picture that the command line makes with these settings.
    fn by_command_line(&self, scene: &str, settings: &Settings, samples: u64, name: &str) -> Vec<u8> {
        let numbers =
            [u64::from(settings.width), u64::from(settings.height), samples, u64::from(settings.bounces)];
        let numbers = numbers.map(|number| number.to_string());
        let mut arguments = vec![scene];
        arguments.extend(numbers.iter().map(String::as_str));
        arguments.extend([name, "--accel", settings.accel.name(), "--precision", settings.precision.name()]);
        self.command(&arguments);
        self.read(name)
    }
}

/// A sample scene's file.
fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{name}.yaml"))
}

fn load(path: &Path) -> Arc<Loaded> {
    Arc::new(document::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())))
}

fn session() -> Session {
    Session::new(|| {})
}

/// A small picture, by the accelerator of every build.
fn small() -> Settings {
    Settings { accel: AccelKind::Native, ..Settings::new(48, 27, 64, 8) }
}

fn preview(loaded: &Arc<Loaded>, editable: &Editable, settings: &Settings) -> Order {
    Order {
        loaded: Arc::clone(loaded),
        editable: Arc::new(editable.clone()),
        settings: settings.clone(),
        purpose: Purpose::Preview,
    }
}
