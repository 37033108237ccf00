//! `tests/data/bad_scenes/NAME.yaml` and `tests/data/bad_meshes/NAME.obj` each give what `NAME.txt` beside them says.
//! `MAKE_REF=1 cargo test corpus` writes those texts anew; read the difference before committing it.

use pathtracer::error::{Error, Severity};
use pathtracer::scene;
use std::fs;
use std::path::{Path, PathBuf};

/// Inputs that hold several mistakes on purpose.
const SEVERAL: [&str; 9] = [
    "several",
    "many",
    "several_in_camera",
    "several_in_misspelled_shape",
    "several_objects",
    "several_sections",
    "several_behind_one_anchor",
    "warnings_beside_an_error",
    "duplicate_section",
];

/// The files of a folder with the given extension, sorted. Paths are relative, as in the texts.
fn inputs(folder: &str, extension: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut paths: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|e| e == extension)).collect();
    paths.sort();
    paths
}

/// Compares the error of one input with the text beside it.
fn check(path: &Path, outcome: Result<scene::Scene, Error>) -> Result<(), String> {
    let name = path.file_stem().unwrap().to_string_lossy();
    let Err(Error::Scene(diagnostics)) = &outcome else {
        return Err(format!("{}: expected errors, got {outcome:?}", path.display()));
    };
    let errors = diagnostics.iter().filter(|d| d.severity == Severity::Error).count();
    if errors != 1 && !SEVERAL.contains(&&*name) {
        return Err(format!("{}: {errors} errors instead of one", path.display()));
    }
    let found = format!("{}\n", outcome.unwrap_err());
    let text = path.with_extension("txt");
    if std::env::var_os("MAKE_REF").is_some() {
        fs::write(&text, &found).unwrap();
    }
    let expected = fs::read_to_string(&text).unwrap_or_default();
    if found == expected { Ok(()) } else { Err(format!("expected:\n{expected}\nfound:\n{found}")) }
}

fn assert_all(outcomes: Vec<Result<(), String>>) {
    assert!(outcomes.len() >= 40);
    let failures: Vec<String> = outcomes.into_iter().filter_map(Result::err).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
}

#[test]
fn bad_scenes_give_their_messages() {
    let paths = inputs("tests/data/bad_scenes", "yaml");
    assert_all(paths.iter().map(|path| check(path, scene::load(path))).collect());
}

#[test]
fn bad_meshes_give_their_messages() {
    let paths = inputs("tests/data/bad_meshes", "obj");
    let outcomes = paths.iter().map(|path| {
        let file = path.file_name().unwrap().to_string_lossy();
        let text = format!(
            "Camera: {{Position: [0, -5, 1], LookingAt: [0, 0, 1], Fov: 0.3, FocusDistance: 5}}\n\
             Objects:\n  - Object:\n      Type: TriangleMesh\n      Filepath: {file}\n      Position: [0, 0, 0]\n      \
             Material: {{Type: Diffuse}}\n"
        );
        check(path, scene::parse(&text, Path::new("tests/data/bad_meshes/scene.yaml")))
    });
    assert_all(outcomes.collect());
}
