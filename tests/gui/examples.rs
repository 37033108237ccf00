use super::Desk;
use pathtracer::gui::examples::{Example, find, folders};
use pathtracer::scene;
use std::fs;
use std::path::Path;

#[test]
fn examples_are_looked_for_here_then_beside_the_program_and_where_packages_put_them() {
    let found = folders(Some(Path::new("/home/me")), Some(Path::new("/usr/bin/pathtracer")));
    let packaged = Path::new("/usr/share/doc/pathtracer/examples/scenes");
    assert_eq!(found.first().map(AsRef::as_ref), Some(Path::new("/home/me/scenes")));
    assert!(found.iter().any(|folder| folder == Path::new("/usr/bin/scenes")));
    assert!(found.iter().any(|folder| folder == packaged), "{found:?}");
}

#[test]
fn the_scenes_of_the_first_folder_that_has_any_are_offered() {
    let desk = Desk::new();
    for folder in ["empty", "scenes"] {
        fs::create_dir(desk.path(folder)).expect("a folder");
    }
    desk.write("scenes/b.yaml", super::BALLS);
    desk.write("scenes/a.yml", super::BALLS);
    desk.write("scenes/readme.txt", "no scene");
    let found = find(&["missing", "empty", "scenes"].map(|folder| desk.path(folder)));
    assert_eq!(found.iter().map(Example::name).collect::<Vec<_>>(), ["a.yml", "b.yaml"]);
    assert_eq!(found[0].file(&desk.path("data")).expect("a file"), desk.path("scenes/a.yml"));
}

#[test]
fn a_program_without_its_examples_has_some_inside_that_need_no_other_file() {
    let desk = Desk::new();
    let found = find(&[desk.path("missing")]);
    assert_eq!(found.len(), 5);
    for example in &found {
        let file = example.file(&desk.path("data")).expect("a folder that can be written");
        let scene = scene::load(&file).unwrap_or_else(|error| panic!("{}: {error}", example.name()));
        assert!(scene.files.is_empty(), "{}", example.name());
    }
    // What was changed of one stays.
    let file = found[0].file(&desk.path("data")).expect("a file");
    fs::write(&file, "mine").expect("a file that can be written");
    assert_eq!(fs::read(found[0].file(&desk.path("data")).expect("a file")).expect("a file"), b"mine");
}
