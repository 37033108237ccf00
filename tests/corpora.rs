//! What the fuzzers kept because it reached more of the readers than others, and what once failed: none of it may fail again.

#[path = "../fuzz/checks/film.rs"]
mod film;
#[cfg(feature = "embree")]
#[path = "../fuzz/checks/geometry.rs"]
mod geometry;
#[path = "../fuzz/checks/mtl.rs"]
mod mtl;
#[path = "../fuzz/checks/obj.rs"]
mod obj;
#[path = "../fuzz/checks/yaml.rs"]
mod yaml;

use std::fs;
use std::path::Path;

/// Gives all kept inputs of a target to its check.
fn replay(target: &str, check: impl Fn(&Path, &[u8])) {
    let folder = tempfile::tempdir().expect("a folder");
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let mut paths: Vec<_> =
        fs::read_dir(&corpus).expect("a corpus").map(|entry| entry.expect("an entry").path()).collect();
    paths.sort();
    assert!(paths.len() >= 20, "{} holds {} inputs", corpus.display(), paths.len());
    for path in paths {
        // Shown where the check panics.
        println!("{}", path.display());
        check(folder.path(), &fs::read(&path).expect("a file"));
    }
}

#[test]
fn kept_scenes_are_refused_or_make_a_world() {
    replay("yaml", yaml::check);
}

#[test]
fn kept_meshes_are_refused_or_hold_what_they_promise() {
    replay("obj", obj::check);
}

#[test]
fn kept_materials_are_refused_or_make_a_world() {
    replay("mtl", mtl::check);
}

#[test]
fn kept_film_files_are_refused_or_taken_over() {
    replay("film", film::check);
}

#[cfg(feature = "embree")]
#[test]
fn both_accelerators_find_what_brute_force_finds_in_kept_geometry() {
    replay("geometry", geometry::check);
}
