//! Checkpoints: killed and resumed renders, and what is refused.
#![cfg(unix)]

use super::{BALL, Ended, Folder};
use std::fs;
use std::process::Stdio;
use xxhash_rust::xxh3::xxh3_128;

const RENDER: &str = "ball.yaml 40 24 70 4";
const CHECKPOINT: &str = "--checkpoint a.film --resume a.film --every 100ms -q";

/// Kills a render again and again, each time after it has written one more checkpoint, until it ends.
fn render_with_kills(folder: &Folder, arguments: &str) -> usize {
    let mut kills = 0;
    loop {
        let before = fs::read(folder.path("a.film")).ok();
        let mut child = folder.command(arguments).stderr(Stdio::null()).spawn().expect("a child");
        loop {
            if let Some(status) = child.try_wait().expect("a state") {
                assert!(status.success());
                return kills;
            }
            if kills < 3 && fs::read(folder.path("a.film")).ok() != before {
                break;
            }
            std::thread::yield_now();
        }
        child.kill().expect("a kill");
        child.wait().expect("an end");
        kills += 1;
    }
}

#[test]
fn a_killed_render_that_is_resumed_makes_the_same_file() {
    for options in
        ["", "--noise 0.05", "--error-bars b.exr", "--aov albedo,depth", "--sampler independent --clamp 0.5"]
    {
        let (folder, other) = (Folder::new(), Folder::new());
        other.run(&format!("{RENDER} a.exr {options}")).succeeds();
        render_with_kills(&folder, &format!("{RENDER} a.exr {options} {CHECKPOINT}"));
        for name in other.names() {
            assert!(folder.read(&name) == other.read(&name), "{name} {options}");
        }
    }
}

/// Renders with a checkpoint at its end.
fn finished(folder: &Folder, samples: u64, options: &str) {
    folder.run(&format!("ball.yaml 40 24 {samples} 4 a.exr --checkpoint a.film {options} -q")).succeeds();
}

/// The counts of a render, which its last event tells.
fn counts(ended: &Ended) -> Vec<serde_json::Value> {
    let last = ended.stdout.lines().last().expect("an event");
    let event: serde_json::Value = serde_json::from_str(last).expect("JSON");
    assert_eq!(event["event"], "done");
    [
        "samples_taken",
        "all_samples",
        "rays",
        "cut_paths",
        "cut_throughput",
        "fireflies",
        "clamped_samples",
        "error",
    ]
    .map(|name| event[name].clone())
    .to_vec()
}

#[test]
fn more_samples_can_follow_later() {
    for (first, options) in [
        (16, ""),
        (20, ""),
        (27, ""),
        (9, "--noise 0.01"),
        (70, "--noise 0.01"),
        (70, "--noise 0.01 --scramble-length 20"),
        (18, "--scramble-length 2"),
    ] {
        let (folder, other) = (Folder::new(), Folder::new());
        let all = format!("ball.yaml 40 24 150 4 a.exr {options} --clamp 0.9 --json");
        let expected = other.run(&all);
        finished(&folder, first, &format!("{options} --clamp 0.9"));
        let ended = folder.run(&format!("{all} --resume a.film"));
        ended.succeeds();
        assert!(folder.read("a.exr") == other.read("a.exr"), "{first} {options}");
        assert_eq!(counts(&ended), counts(&expected), "{first} {options}");
    }
}

#[test]
fn a_checkpoint_of_anything_else_is_refused_and_the_difference_named() {
    let folder = Folder::new();
    finished(&folder, 16, "");
    let resumed = |scene: &str, numbers: &str, options: &str| {
        folder.run(&format!("{scene} {numbers} b.exr --resume a.film {options}"))
    };
    resumed("ball.yaml", "40 24 32 5", "").fails(1, "differs in bounces (4, not 5)");
    resumed("ball.yaml", "40 25 32 4", "").fails(1, "differs in height (24, not 25)");
    resumed("ball.yaml", "40 24 32 4", "--seed 7").fails(1, "differs in seed (0, not 7)");
    resumed("ball.yaml", "40 24 32 4", "--precision fast").fails(1, "precision (exact, not fast)");
    resumed("ball.yaml", "40 24 32 4", "--noise 0.1").fails(1, "noise (none, not 0.1)");
    resumed("ball.yaml", "40 24 8 4", "").fails(1, "has 16 samples already, more than 8");
    folder.write("other.yaml", &BALL.replace("0.8", "0.7"));
    resumed("other.yaml", "40 24 32 4", "").fails(1, "differs in scene and meshes");
    assert!(!folder.has("b.exr"));
}

#[test]
fn a_checkpoint_of_another_version_is_refused_and_both_are_named() {
    let folder = Folder::new();
    finished(&folder, 16, "");
    let mut bytes = folder.read("a.film");
    let own = env!("CARGO_PKG_VERSION");
    let words = format!("\"version\":\"{own}\"");
    let at = bytes.windows(words.len()).position(|window| window == words.as_bytes()).expect("a version");
    bytes[at + words.len() - 2] = b'x';
    let checksum = bytes.len() - 16;
    let (sums, end) = bytes.split_at_mut(checksum);
    end.copy_from_slice(&xxh3_128(sums).to_le_bytes());
    fs::write(folder.path("a.film"), bytes).expect("a file");
    let other = &own[..own.len() - 1];
    let why = format!("is of version {other}x, not {own}");
    folder.run(&format!("{RENDER} b.exr --resume a.film")).fails(1, &why);
}

#[test]
fn a_checkpoint_is_overwritten_only_by_what_goes_on_with_it() {
    let folder = Folder::new();
    finished(&folder, 16, "");
    folder.write("b.film", "of another render");
    let render = format!("{RENDER} b.exr -q --checkpoint b.film");
    folder.run(&render).fails(2, "the checkpoint b.film is there already");
    folder.run(&format!("{render} --resume a.film")).fails(2, "the checkpoint b.film is there already");
    assert!(folder.read("b.film") == b"of another render");
}

#[test]
fn what_is_no_checkpoint_is_refused() {
    let folder = Folder::new();
    let resume = || folder.run(&format!("{RENDER} b.exr --resume a.film"));
    resume().fails(1, "cannot read a.film");
    folder.write("a.film", "no checkpoint, but long enough to be one");
    resume().fails(1, "is neither a checkpoint nor a part of a picture");
    fs::remove_file(folder.path("a.film")).expect("a file");
    finished(&folder, 16, "");
    let good = folder.read("a.film");
    for at in [9, 20, good.len() / 2, good.len() - 1] {
        let mut bad = good.clone();
        bad[at] ^= 1;
        fs::write(folder.path("a.film"), bad).expect("a file");
        assert_eq!(resume().code, Some(1), "byte {at}");
    }
    fs::write(folder.path("a.film"), &good[..good.len() - 8]).expect("a file");
    resume().fails(1, "is damaged");
}

#[test]
fn a_checkpoint_that_is_there_is_not_overwritten() {
    let folder = Folder::new();
    finished(&folder, 16, "");
    let before = folder.read("a.film");
    folder.run(&format!("{RENDER} a.exr --checkpoint a.film")).fails(2, "--resume a.film goes on with it");
    assert!(folder.read("a.film") == before);
}

#[test]
fn a_checkpoint_in_a_folder_that_is_missing_is_refused_before_the_render() {
    let folder = Folder::new();
    folder.run(&format!("{RENDER} a.exr --checkpoint missing/a.film")).fails(1, "missing/a.film");
    fs::create_dir(folder.path("folder")).expect("a folder");
    folder.run(&format!("{RENDER} a.exr --checkpoint folder")).fails(1, "folder");
    assert_eq!(folder.names(), ["ball.yaml", "folder"]);
}
