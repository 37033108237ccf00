mod bench;
mod budget;
mod check;
mod compare;
mod diff;
mod farm;
mod faults;
mod features;
mod findings;
mod information;
mod interrupt;
mod json;
mod manual;
mod parts;
mod pictures;
mod provenance;
mod saved;
mod tradeoff;
mod usage;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// A ball in front of the camera, lit by the sky.
const BALL: &str = "\
Camera:
  Position: [0, 0, 0]
  LookingAt: [5, 0, 0]
  Fov: 0.33
  FocusDistance: 5
  DepthOfField: 30
Objects:
  - Object:
      Type: Ball
      Position: [5, 0, 0]
      Radius: 1
      Material:
        Name: RED DIFFUSE
        Type: Diffuse
        Color: [0.8, 0.1, 0.1]
";

/// A folder in which the program runs.
struct Folder(TempDir);

/// How the program ended.
struct Ended {
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

impl Folder {
    /// A folder with `BALL` as `ball.yaml`.
    fn new() -> Folder {
        let folder = Folder(tempfile::tempdir().expect("a temporary folder"));
        folder.write("ball.yaml", BALL);
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("a file in a temporary folder");
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).expect("a file")
    }

    fn has(&self, name: &str) -> bool {
        self.path(name).exists()
    }

    /// The names of all files, sorted.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("a folder");
        let mut names: Vec<String> =
            entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into()).collect();
        names.sort();
        names
    }

    /// The program with these arguments, separated by spaces.
    fn command(&self, arguments: &str) -> Command {
        let mut command = program(self.0.path());
        command.args(arguments.split_whitespace());
        command
    }

    /// Runs the program to its end.
    fn run(&self, arguments: &str) -> Ended {
        Ended::from(self.command(arguments).output().expect("the program starts"))
    }
}

impl From<Output> for Ended {
    fn from(output: Output) -> Ended {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
        Ended { code: output.status.code(), stdout: text(output.stdout), stderr: text(output.stderr) }
    }
}

impl Ended {
    /// Asserts the exit code and that stderr says `part`.
    #[track_caller]
    fn fails(&self, code: i32, part: &str) {
        assert_eq!(self.code, Some(code), "{}", self.stderr);
        assert!(self.stderr.contains(part), "{}", self.stderr);
    }

    /// Asserts that all went well.
    #[track_caller]
    fn succeeds(&self) {
        assert_eq!(self.code, Some(0), "{}", self.stderr);
    }
}

fn program(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pathtracer"));
    command.current_dir(folder);
    command
}
