//! Signals to a render that would take for ever.
#![cfg(unix)]

use super::Folder;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};

const ENDLESS: &str = "ball.yaml 8 6 4294967296 3 a.png --json";

/// Sends `signal` once the render has taken three chunks; the exit code and the last event.
fn interrupt(folder: &Folder, signal: &str) -> (Option<i32>, Value) {
    let mut command = folder.command(ENDLESS);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("a child");
    let mut reader = BufReader::new(child.stdout.take().expect("a pipe"));
    let mut line = String::new();
    while reader.read_line(&mut line).expect("a line") > 0 {
        let event: Value = serde_json::from_str(&line).expect("JSON");
        if event["event"] == "progress" && event["samples"].as_u64() > Some(8 * 6 * 16 * 3) {
            break;
        }
        line.clear();
    }
    send(&child, signal);
    let mut rest = String::new();
    reader.read_to_string(&mut rest).expect("the rest");
    let last = rest.lines().last().expect("a last event");
    (child.wait().expect("an end").code(), serde_json::from_str(last).expect("JSON"))
}

fn send(child: &Child, signal: &str) {
    // The shell has this word; the program of that name is missing on small systems.
    let words = ["-c", "kill -s \"$0\" \"$1\"", signal, &child.id().to_string()];
    assert!(Command::new("sh").args(words).status().expect("a shell").success());
}

#[test]
fn ctrl_c_writes_the_picture_so_far() {
    let folder = Folder::new();
    let (code, last) = interrupt(&folder, "INT");
    assert_eq!(code, Some(130));
    assert_eq!(last["event"], "interrupted");
    let samples = last["samples_taken"].as_u64().expect("a number");
    assert!(samples >= 2 * 16, "{samples}");
    assert_eq!(image::open(folder.path("a.png")).expect("a picture").width(), 8);
    assert_eq!(folder.names(), ["a.png", "ball.yaml"]);
}

#[test]
fn a_request_to_terminate_writes_the_picture_so_far() {
    let folder = Folder::new();
    let (code, last) = interrupt(&folder, "TERM");
    assert_eq!(code, Some(143));
    assert_eq!(last["event"], "interrupted");
    assert!(folder.has("a.png"));
}

#[test]
fn the_first_signal_ends_a_program_that_still_reads_its_scene() {
    let folder = Folder::new();
    let pipe = folder.path("endless.yaml");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo").success());
    let mut child =
        folder.command("endless.yaml 8 6 1 3 a.png").stderr(Stdio::null()).spawn().expect("a child");
    // Waits until the program reads; then it waits for a text that does not come.
    let _writer = std::fs::File::options().write(true).open(&pipe).expect("a pipe");
    send(&child, "TERM");
    assert_eq!(child.wait().expect("an end").code(), Some(143));
    assert_eq!(folder.names(), ["ball.yaml", "endless.yaml"]);
}
