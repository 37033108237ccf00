use super::{BALL, Ended, Folder, program};
use std::fs;

#[test]
fn a_picture_has_the_size_asked_for() {
    let folder = Folder::new();
    for name in ["a.png", "a.exr"] {
        folder.run(&format!("ball.yaml 8 6 1 3 {name}")).succeeds();
        let picture = image::open(folder.path(name)).expect("a picture");
        assert_eq!((picture.width(), picture.height()), (8, 6));
    }
    assert_eq!(folder.names(), ["a.exr", "a.png", "ball.yaml"]);
}

/// The bytes of the picture that a render with these options makes.
fn picture(folder: &Folder, name: &str, options: &str) -> Vec<u8> {
    folder.run(&format!("ball.yaml 40 30 20 4 {name} {options}")).succeeds();
    folder.read(name)
}

#[test]
fn equal_renders_make_equal_bytes_for_all_threads_and_tiles() {
    let folder = Folder::new();
    for name in ["a.png", "a.exr"] {
        let expected = picture(&folder, name, "--threads 1 --tile 8");
        for options in ["--threads 1 --tile 8", "--threads 2 --tile 64", "--threads 8 --tile 8", ""] {
            assert!(picture(&folder, name, options) == expected, "{name} {options}");
        }
    }
}

#[test]
fn the_seed_and_the_sampler_change_the_picture() {
    let folder = Folder::new();
    let expected = picture(&folder, "a.exr", "");
    assert!(picture(&folder, "a.exr", "--seed 1") != expected);
    assert!(picture(&folder, "a.exr", "--sampler independent") != expected);
}

#[test]
fn exposure_changes_a_png_but_not_an_exr() {
    let folder = Folder::new();
    assert!(picture(&folder, "a.png", "--exposure -1") != picture(&folder, "a.png", ""));
    assert!(picture(&folder, "a.exr", "--exposure -1") == picture(&folder, "a.exr", ""));
}

#[test]
fn a_place_that_cannot_be_written_is_met_before_rendering() {
    let folder = Folder::new();
    fs::create_dir(folder.path("b.png")).expect("a folder");
    for name in ["missing/a.png", "b.png", "ball.yaml/a.png"] {
        let ended = folder.run(&format!("ball.yaml 8 6 1 3 {name}"));
        ended.fails(1, &format!("cannot write the picture {name}: "));
        assert!(!ended.stderr.contains("SCENE INFORMATION"));
    }
    assert_eq!(folder.names(), ["b.png", "ball.yaml"]);
}

#[test]
fn a_bad_scene_leaves_no_picture() {
    let folder = Folder::new();
    folder.write("bad.yaml", &BALL.replace("Radius: 1", "Radius: -1"));
    folder.run("bad.yaml 8 6 1 3 a.png").fails(3, "--> bad.yaml:");
    assert_eq!(folder.names(), ["bad.yaml", "ball.yaml"]);
}

#[cfg(unix)]
#[test]
fn a_full_disk_leaves_the_old_picture_and_no_other_file() {
    let folder = Folder::new();
    folder.write("a.exr", "before");
    // Files may have 512 bytes; with the signal ignored, writing more is an error as on a full disk.
    let mut shell = std::process::Command::new("sh");
    shell.current_dir(folder.path(".")).arg("-c").arg(r#"trap "" XFSZ; ulimit -f 1; exec "$0" "$@""#);
    shell.arg(program(&folder.path(".")).get_program()).args("ball.yaml 64 64 1 3 a.exr".split(' '));
    let ended = Ended::from(shell.output().expect("a shell"));
    ended.fails(1, "cannot write the picture ");
    assert!(ended.stderr.contains("a.exr"));
    assert_eq!(folder.names(), ["a.exr", "ball.yaml"]);
    assert_eq!(folder.read("a.exr"), b"before");
}
