//! Disks that fail and signals: the render is not lost, and no half file is left.
#![cfg(unix)]

use super::Folder;
use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::fs::PermissionsExt;
use std::process::{Command, Stdio};

/// Runs a render and changes its folder once it is under way; how it ended.
fn change_while_rendering(folder: &Folder, arguments: &str, change: impl FnOnce()) -> super::Ended {
    let mut command = folder.command(arguments);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("a child");
    let mut reader = BufReader::new(child.stdout.take().expect("a pipe"));
    let mut line = String::new();
    while reader.read_line(&mut line).expect("a line") > 0 && !line.contains("\"start\"") {
        line.clear();
    }
    change();
    super::Ended::from(child.wait_with_output().expect("an end"))
}

#[test]
fn a_folder_that_vanishes_does_not_cost_the_film() {
    let folder = Folder::new();
    fs::create_dir(folder.path("out")).expect("a folder");
    let render = "ball.yaml 64 48 3000 4";
    let ended = change_while_rendering(&folder, &format!("{render} out/a.exr --json"), || {
        fs::remove_dir_all(folder.path("out")).expect("no folder");
    });
    ended.fails(1, "the finished film is kept: `pathtracer merge a.exr.film out/a.exr`");
    folder.run("merge a.exr.film b.exr -q").succeeds();
    folder.run(&format!("{render} c.exr -q")).succeeds();
    assert!(folder.read("b.exr") == folder.read("c.exr"));
}

#[test]
fn the_command_for_a_kept_film_has_the_options_of_the_picture() {
    let folder = Folder::new();
    fs::create_dir(folder.path("out")).expect("a folder");
    let render = "ball.yaml 64 48 3000 4 out/a.png --exposure 1 --depth 16 --json";
    let ended = change_while_rendering(&folder, render, || {
        fs::remove_dir_all(folder.path("out")).expect("no folder");
    });
    ended.fails(1, "`pathtracer merge a.png.film out/a.png --exposure 1 --depth 16` makes the picture");
}

#[test]
fn a_part_that_cannot_be_written_is_kept_as_it_is() {
    let folder = Folder::new();
    fs::create_dir(folder.path("out")).expect("a folder");
    let render = "ball.yaml 64 48 3200 4";
    let ended =
        change_while_rendering(&folder, &format!("{render} out/b.film --chunks 0..100 --json"), || {
            fs::remove_dir_all(folder.path("out")).expect("no folder");
        });
    ended.fails(1, "the finished part is kept as b.film.film: move it to out/b.film");
    folder.run(&format!("{render} c.film --chunks 100..200 -q")).succeeds();
    folder.run("merge b.film.film c.film a.exr -q").succeeds();
    folder.run(&format!("{render} whole.exr -q")).succeeds();
    assert!(folder.read("a.exr") == folder.read("whole.exr"));
}

#[test]
fn what_stands_in_the_way_is_found_before_the_render() {
    let folder = Folder::new();
    fs::create_dir(folder.path("a.png")).expect("a folder");
    folder.run("ball.yaml 8 6 1 3 a.png").fails(1, "a.png");
    folder.run("ball.yaml 8 6 1 3 missing/a.png").fails(1, "missing/a.png");
    fs::create_dir(folder.path("closed")).expect("a folder");
    let closed = fs::Permissions::from_mode(0o555);
    fs::set_permissions(folder.path("closed"), closed).expect("permissions");
    // To root every folder is open.
    if fs::write(folder.path("closed/test"), "").is_err() {
        folder.run("ball.yaml 8 6 1 3 closed/a.png").fails(1, "closed/a.png");
    }
    assert!(!folder.has("closed/a.png"));
}

#[test]
fn a_second_signal_ends_at_once_and_leaves_no_half_file() {
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let folder = Folder::new();
        let render = "ball.yaml 64 48 4294967296 3 a.png --json --checkpoint a.film -q";
        let mut child = folder.command(render).stdout(Stdio::piped()).spawn().expect("a child");
        let mut reader = BufReader::new(child.stdout.take().expect("a pipe"));
        let mut line = String::new();
        while reader.read_line(&mut line).expect("a line") > 0 && !line.contains("\"progress\"") {
            line.clear();
        }
        let words = format!("kill -s {signal} {0}; kill -s {signal} {0}", child.id());
        assert!(Command::new("sh").args(["-c", &words]).status().expect("a shell").success());
        assert_eq!(child.wait().expect("an end").code(), Some(code));
        // The picture may have been written before the second one came; half of one never.
        if folder.has("a.png") {
            image::open(folder.path("a.png")).expect("a whole picture");
        }
        assert!(folder.names().iter().all(|name| !name.ends_with(".part")), "{:?}", folder.names());
    }
}

/// A task that was given to two machines: what the faster one has finished stays, even if the slower one is killed.
#[test]
fn a_checkpoint_does_not_replace_the_part_that_another_task_has_finished() {
    let folder = Folder::new();
    folder.run("ball.yaml 64 48 16 4 done.film --part 0/1 -q").succeeds();
    let done = folder.read("done.film");
    let render = "ball.yaml 64 48 4294967296 4 a.film --part 0/1 --every 100ms --json -q";
    let mut child =
        folder.command(render).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("a child");
    let mut reader = BufReader::new(child.stdout.take().expect("a pipe"));
    let mut progress = |wanted: usize| {
        let mut line = String::new();
        let mut seen = 0;
        while seen < wanted && reader.read_line(&mut line).expect("a line") > 0 {
            seen += usize::from(line.contains("\"progress\""));
            line.clear();
        }
    };
    progress(1);
    fs::rename(folder.path("done.film"), folder.path("a.film")).expect("a finished part");
    // One event a second: time for many checkpoints.
    progress(2);
    child.kill().expect("a kill");
    child.wait().expect("an end");
    assert!(folder.read("a.film") == done);
}

#[test]
fn an_interrupted_part_goes_on_where_it_was() {
    let folder = Folder::new();
    let render = "ball.yaml 64 48 3000 4";
    let command = format!("{render} a.film --part 0/1 --json");
    let mut child =
        folder.command(&command).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("a child");
    let mut reader = BufReader::new(child.stdout.take().expect("a pipe"));
    let mut line = String::new();
    while reader.read_line(&mut line).expect("a line") > 0 && !line.contains("\"progress\"") {
        line.clear();
    }
    // It may have ended already.
    let words = format!("kill -s TERM {}", child.id());
    let _ = Command::new("sh").args(["-c", &words]).stderr(Stdio::null()).status();
    let code = child.wait().expect("an end").code();
    if code == Some(143) && folder.has("a.film") {
        folder.run("merge a.film a.exr").fails(1, "is an unfinished render, not a part");
    }
    folder.run(&format!("{render} a.film --part 0/1 -q")).succeeds();
    folder.run("merge a.film a.exr -q").succeeds();
    folder.run(&format!("{render} b.exr -q")).succeeds();
    assert!(folder.read("a.exr") == folder.read("b.exr"));
}

#[test]
fn a_mesh_that_memory_cannot_hold_is_refused_before_it_is_read() {
    let folder = Folder::new();
    let scene = fs::read_to_string(folder.path("ball.yaml")).expect("a scene");
    let mesh =
        "  - Object: {Type: TriangleMesh, Filepath: a.obj, Position: [5, 0, 0], Material: {Type: Diffuse}}\n";
    folder.write("mesh.yaml", &format!("{scene}{mesh}"));
    // A file with a hole takes no room on the disk.
    let file = fs::File::create(folder.path("a.obj")).expect("a file");
    file.set_len(1 << 42).expect("a hole");
    folder.run("mesh.yaml 8 6 1 3 a.png").fails(3, "a mesh of 4398.0 GB");
}

/// Whatever the machine has: the process may not have more.
#[cfg(target_os = "linux")]
#[test]
fn what_is_over_the_limit_of_the_process_is_refused_before_it_is_allocated() {
    let folder = Folder::new();
    let scene = fs::read_to_string(folder.path("ball.yaml")).expect("a scene");
    let mesh =
        "  - Object: {Type: TriangleMesh, Filepath: a.obj, Position: [5, 0, 0], Material: {Type: Diffuse}}\n";
    folder.write("mesh.yaml", &format!("{scene}{mesh}"));
    fs::File::create(folder.path("a.obj")).and_then(|file| file.set_len(2 << 30)).expect("a hole");
    let limited = |arguments: &str| {
        // In kilobytes, most of which the libraries and their threads do not need.
        let mut shell = Command::new("sh");
        shell.args(["-c", r#"ulimit -v 1500000; exec "$0" "$@""#, env!("CARGO_BIN_EXE_pathtracer")]);
        shell.args(arguments.split_whitespace()).current_dir(folder.path("."));
        super::Ended::from(shell.output().expect("a shell"))
    };
    // 24 million pixels, each of which takes more than 100 bytes.
    let film = limited("ball.yaml 6000 4000 64 4 a.exr");
    film.fails(2, "the film of a picture of 6000 x 4000 pixels");
    let mesh = limited("mesh.yaml 8 6 1 3 a.png");
    mesh.fails(3, "a mesh of 2.1 GB that takes about 4.3 GB to read");
    for (what, ended) in [("the film", film), ("the mesh", mesh)] {
        let free = ["0.", "1."].iter().any(|start| ended.stderr.contains(&format!("and {start}")));
        assert!(free, "{what}: {}", ended.stderr);
    }
    limited("ball.yaml 8 6 1 3 a.png --threads 1").succeeds();
}
