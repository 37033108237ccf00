//! Inputs made to cost time or memory, and files that can't be read.

use super::{CAMERA, diagnostics_of};
use pathtracer::error::{Diagnostic, Error};
use pathtracer::scene;
use std::fmt::Write;
use std::fs::{self, File};
use std::path::Path;

/// The message of the only diagnostic of `text`.
fn only_message(text: &str) -> String {
    match diagnostics_of(text).as_slice() {
        [only] => only.message.clone(),
        several => panic!("{} diagnostics", several.len()),
    }
}

#[test]
fn brackets_nested_a_hundred_thousand_deep() {
    assert_eq!(only_message(&"[".repeat(100_000)), "more than 1000 brackets are open");
    assert_eq!(only_message(&"{a: ".repeat(100_000)), "more than 1000 brackets are open");
}

#[test]
fn lists_nested_a_hundred_thousand_deep() {
    assert_eq!(only_message(&"- ".repeat(100_000)), "the values are nested too deeply");
}

#[test]
fn a_hundred_thousand_directives() {
    let text: String = (0..100_000).map(|i| format!("%TAG !a{i}! x\n")).collect();
    assert_eq!(only_message(&text), "the scene has more than 100 directives");
}

#[test]
fn an_alias_of_a_long_list_repeated() {
    let mut text = format!("a: &a [{}]\nb: [", "1,".repeat(20_000));
    for _ in 0..1000 {
        text.push_str("*a,");
    }
    text.push_str("]\n");
    let message = "the scene has more than 10000000 values, those behind aliases included";
    assert_eq!(only_message(&text), message);
}

#[test]
fn more_values_than_the_parser_may_see() {
    assert_eq!(only_message(&"-\n".repeat(10_000_001)), "the scene has more than 10000000 values");
}

#[test]
fn more_errors_than_are_kept() {
    let mut text = CAMERA.to_owned();
    for i in 0..12_000 {
        writeln!(text, "key{i}: 1").unwrap();
    }
    text.push_str("Objects: []\n");
    let diagnostics = diagnostics_of(&text);
    // 10,000 errors, the warning about the empty list, and the count of the rest.
    assert_eq!(diagnostics.len(), 10_002);
    assert_eq!(diagnostics.last().unwrap().message, "2000 more errors and warnings are not shown");
}

#[test]
fn a_hundred_thousand_errors_in_one_line() {
    let item = "{Object: {Type: Ball, Position: [0, 0, 0], Radius: -1, Material: {Type: Diffuse}}}";
    let text = format!("{CAMERA}Objects: [{}{item}]\n", format!("{item}, ").repeat(99_999));
    let diagnostics = diagnostics_of(&text);
    let column = |object: usize| 11 + object * (item.len() + 2) + item.find("-1").unwrap();
    for (object, diagnostic) in diagnostics.iter().take(10_000).enumerate() {
        assert_eq!(diagnostic.location.as_ref().unwrap().column, column(object));
        assert!(diagnostic.source_line.as_ref().unwrap().chars().count() <= 122);
    }
}

#[test]
fn a_scene_of_gigabytes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.yaml");
    File::create(&path).unwrap().set_len(3 << 30).unwrap();
    let Err(Error::Scene(diagnostics)) = scene::load(&path) else { panic!("expected an error") };
    assert_eq!(diagnostics[0].message, "the scene file is larger than 256 MiB");
}

#[test]
fn meshes_of_gigabytes_and_endless_lines() {
    let folder = tempfile::tempdir().unwrap();
    for (name, size, reason) in [
        ("large.obj", 5 << 30, "it is larger than 4 GiB"),
        ("line.obj", 65 << 20, "a line is longer than 64 MiB"),
    ] {
        let path = folder.path().join(name);
        File::create(&path).unwrap().set_len(size).unwrap();
        let text = format!("{CAMERA}Objects:\n{}", super::mesh_object(name));
        let Err(Error::Scene(diagnostics)) = scene::parse(&text, &folder.path().join("scene.yaml")) else {
            panic!("expected an error")
        };
        let message = &diagnostics[0].message;
        assert!(message.ends_with(&format!("which cannot be read: {reason}")), "{message}");
    }
}

/// The diagnostics of a scene with the mesh file `obj`.
fn mesh_diagnostics(obj: &str) -> Vec<Diagnostic> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mesh.obj"), obj).unwrap();
    let text = format!("{CAMERA}Objects:\n{}", super::mesh_object("mesh.obj"));
    match scene::parse(&text, &folder.path().join("scene.yaml")) {
        Err(Error::Scene(diagnostics)) => diagnostics,
        other => panic!("expected errors, got {other:?}"),
    }
}

#[test]
fn a_line_continued_without_end() {
    let diagnostics = mesh_diagnostics(&"\\\n".repeat(33 << 20));
    let message = &diagnostics[0].message;
    assert!(message.ends_with("which cannot be read: a line is longer than 64 MiB"), "{message}");
}

#[test]
fn mistakes_far_into_a_mesh_have_their_places_and_counts() {
    let count = 300_000;
    let mut mesh = String::new();
    for i in 0..count {
        writeln!(mesh, "v {i} {} 0", i % 2).unwrap();
    }
    writeln!(mesh, "f 1 2 3\nf -1 \\\n -300001 1\nf 1 2 300001\nv 1 nan 0\nv 0 0 1").unwrap();
    // More than three pieces.
    assert!(mesh.len() > 3 << 20);
    let found: Vec<(String, usize, usize)> = mesh_diagnostics(&mesh)
        .into_iter()
        .map(|diagnostic| {
            let place = diagnostic.location.unwrap();
            (diagnostic.message, place.line, place.column)
        })
        .collect();
    let text = |message: &str, line, column| (message.to_owned(), line, column);
    // The vertex with the mistake counts, so that its neighbours' mistakes are not two. The face may name it.
    let expected = [
        text("vertex -300001 does not exist: the number of vertices before this line is 300000", 300_003, 2),
        text("a vertex is made of finite numbers, found \"nan\"", 300_005, 5),
    ];
    assert_eq!(found, expected);
    let mesh = mesh.replace("v 1 nan 0\nv 0 0 1\n", "");
    let found = mesh_diagnostics(&mesh);
    let message = "vertex 300001 does not exist: the number of vertices in the file is 300000";
    assert_eq!(found[1].message, message);
    assert_eq!(found[1].location.as_ref().unwrap().line, 300_004);
}

#[test]
fn a_scene_that_is_missing_or_a_folder() {
    let folder = tempfile::tempdir().unwrap();
    for path in [folder.path().join("missing.yaml"), folder.path().to_path_buf()] {
        let Err(error @ Error::Scene(_)) = scene::load(&path) else { panic!("expected an error") };
        assert!(error.to_string().starts_with(&format!("error: cannot read the scene {}: ", path.display())));
    }
}

#[test]
fn a_concave_face_with_too_many_corners_is_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let mut mesh = String::new();
    let mut face = "f".to_owned();
    // A saw: teeth above, a straight line below.
    for i in 0..5000 {
        writeln!(mesh, "v {i} {} 0", i % 2).unwrap();
        write!(face, " {}", i + 1).unwrap();
    }
    writeln!(mesh, "v 4999 -9 0\nv 0 -9 0\n{face} 5001 5002").unwrap();
    fs::write(folder.path().join("saw.obj"), mesh).unwrap();
    let text = format!("{CAMERA}Objects:\n{}", super::mesh_object("saw.obj"));
    let scene = scene::parse(&text, &folder.path().join("scene.yaml")).unwrap();
    let [warning] = scene.warnings.as_slice() else { panic!("expected one warning") };
    assert!(warning.message.ends_with("have too many corners to be split properly"), "{}", warning.message);
}

#[test]
fn a_text_that_was_decoded_may_start_with_a_byte_order_mark() {
    let text = format!("\u{FEFF}{CAMERA}Objects: []\n");
    assert!(scene::parse(&text, Path::new("scene.yaml")).is_ok());
}
