//! Parts of a picture: whatever the split and the order, the merged file is that of one render.

use super::Folder;
use std::fs;

const RENDER: &str = "ball.yaml 40 36 40 4";

/// Renders parts with these options, as 0.film, 1.film ...; their names.
fn parts(folder: &Folder, common: &str, options: &[&str]) -> Vec<String> {
    let render = |(number, option): (usize, &&str)| {
        let name = format!("{number}.film");
        folder.run(&format!("{RENDER} {name} {common} {option} -q")).succeeds();
        name
    };
    options.iter().enumerate().map(render).collect()
}

#[test]
fn merged_parts_are_the_picture_of_one_render() {
    let splits: [&[&str]; 5] = [
        &["--part 0/1"],
        &["--part 2/4", "--part 0/4", "--part 3/4", "--part 1/4"],
        &["--chunks 1..2", "--chunks 2..3", "--chunks 0..1"],
        &["--crop 0,0,17,36", "--crop 17,5,40,36", "--crop 17,0,40,5"],
        &["--part 0/2", "--part 1/2 --chunks 2..3", "--part 1/2 --chunks 0..2"],
    ];
    for split in splits {
        let folder = Folder::new();
        folder.run(&format!("{RENDER} whole.exr --aov normal,object --error-bars bars.exr -q")).succeeds();
        let names = parts(&folder, "--aov normal,object --scramble-length 2", split);
        folder
            .run(&format!("merge {} a.exr --aov normal,object --error-bars b.exr -q", names.join(" ")))
            .succeeds();
        assert!(folder.read("a.exr") == folder.read("whole.exr"), "{split:?}");
        assert!(folder.read("b.exr") == folder.read("bars.exr"), "{split:?}");
    }
}

#[test]
fn a_merge_that_was_asked_for_errors_that_its_parts_do_not_hold_makes_the_picture_and_fails() {
    let folder = Folder::new();
    let names = parts(&folder, "", &["--part 0/2", "--part 1/2"]).join(" ");
    for option in ["--error-bars b.exr", "--aov error"] {
        let what = "no errors of the pixels were written";
        folder.run(&format!("merge {names} a.exr {option} -q")).fails(1, what);
        image::open(folder.path("a.exr")).expect("a picture");
        assert!(!folder.has("b.exr"));
    }
}

#[test]
fn merged_parts_with_a_noise_target_are_the_picture_of_one_render() {
    for split in [&["--part 1/3", "--part 0/3", "--part 2/3"][..], &["--crop 0,0,16,36", "--crop 16,0,40,36"]]
    {
        let folder = Folder::new();
        let render = "ball.yaml 40 36 400 4";
        folder.run(&format!("{render} whole.png --noise 0.03 --clamp 2 -q")).succeeds();
        for (number, option) in split.iter().enumerate() {
            folder.run(&format!("{render} {number}.film --noise 0.03 --clamp 2 {option} -q")).succeeds();
        }
        let names: Vec<String> = (0..split.len()).map(|number| format!("{number}.film")).collect();
        folder.run(&format!("merge {} a.png -q", names.join(" "))).succeeds();
        assert!(folder.read("a.png") == folder.read("whole.png"), "{split:?}");
    }
}

/// Parts whose blocks stop early look at what is seen as often as the whole picture does there.
#[test]
fn merged_features_with_a_noise_target_are_those_of_one_render() {
    let folder = Folder::new();
    let (render, options) = ("ball.yaml 40 36 400 4", "--noise 0.01 --aov albedo,depth -q");
    folder.run(&format!("{render} whole.exr {options}")).succeeds();
    for part in 0..3 {
        folder.run(&format!("{render} {part}.film {options} --part {part}/3")).succeeds();
    }
    folder.run("merge 0.film 1.film 2.film a.exr --aov albedo,depth -q").succeeds();
    assert!(folder.read("a.exr") == folder.read("whole.exr"));
}

#[test]
fn a_part_of_another_render_is_not_replaced() {
    let folder = Folder::new();
    parts(&folder, "", &["--part 0/2"]);
    let before = folder.read("0.film");
    let ended = folder.run(&format!("{RENDER} 0.film --part 1/2"));
    ended.fails(1, "is another part: it differs in region");
    assert!(folder.read("0.film") == before);
}

#[test]
fn a_damaged_part_is_replaced_and_no_other_file() {
    let folder = Folder::new();
    let render = format!("{RENDER} 0.film --part 0/2");
    folder.run(&render).succeeds();
    let whole = folder.read("0.film");
    let mut damaged = whole.clone();
    damaged[whole.len() / 2] ^= 1;
    for damaged in [&[], &whole[..20], &whole[..whole.len() - 1], &damaged[..]] {
        fs::write(folder.path("0.film"), damaged).expect("a file");
        folder.run(&render).succeeds();
        assert!(folder.read("0.film") == whole);
    }
    folder.write("0.film", "v 0 0 0");
    folder.run(&render).fails(1, "remove it, or choose another name");
    assert_eq!(folder.read("0.film"), b"v 0 0 0");
}

#[test]
fn what_a_render_reads_or_writes_elsewhere_is_not_overwritten() {
    let folder = Folder::new();
    folder
        .run(&format!("{RENDER} a.png --checkpoint ./a.png"))
        .fails(2, "--checkpoint needs a file of its own");
    folder.run(&format!("{RENDER} a.png")).succeeds();
    folder.run("diff a.png a.png -o ./a.png").fails(2, "choose another name for -o");
}

#[test]
fn a_part_that_is_there_is_not_made_again() {
    let folder = Folder::new();
    parts(&folder, "", &["--part 0/2"]);
    let before = fs::metadata(folder.path("0.film")).expect("a file").modified().expect("a time");
    folder.run(&format!("{RENDER} 0.film --part 0/2")).succeeds();
    assert_eq!(fs::metadata(folder.path("0.film")).expect("a file").modified().expect("a time"), before);
}

#[test]
fn a_part_that_is_there_is_told_as_done() {
    let folder = Folder::new();
    let command = format!("{RENDER} 0.film --part 0/2 --noise 0.001 --clamp 0.5 --json");
    let last = |ended: super::Ended| -> serde_json::Value {
        ended.succeeds();
        serde_json::from_str(ended.stdout.lines().last().expect("an event")).expect("JSON")
    };
    let made = last(folder.run(&command));
    let again = folder.run(&command);
    assert!(again.stdout.lines().next().is_some_and(|line| line.contains("\"start\"")), "{}", again.stdout);
    let found = last(again);
    assert_eq!((&made["event"], &found["event"]), (&"done".into(), &"done".into()));
    for name in
        ["samples_taken", "all_samples", "noise_missed", "rays", "cut_light", "clamped_samples", "clamp_bias"]
    {
        assert_eq!(made[name], found[name], "{name}");
    }
}

/// The notes of a render about what its film holds.
fn notes(ended: &super::Ended) -> Vec<String> {
    ended.stderr.lines().filter(|line| line.starts_with("note: ")).map(str::to_owned).collect()
}

#[test]
fn a_merge_says_of_the_picture_what_one_render_says() {
    for splits in [&["--part 0/2", "--part 1/2"][..], &["--crop 0,0,16,36", "--crop 16,0,40,36"]] {
        let folder = Folder::new();
        let options = "--noise 0.001 --clamp 0.5";
        let whole = folder.run(&format!("ball.yaml 40 36 70 1 whole.exr {options}"));
        for (number, split) in splits.iter().enumerate() {
            folder.run(&format!("ball.yaml 40 36 70 1 {number}.film {options} {split} -q")).succeeds();
        }
        let merged = folder.run("merge 1.film 0.film a.exr");
        assert_eq!(notes(&merged), notes(&whole));
        let expected = ["cut paths", "were clamped", "did not bring the error below"];
        let has = |words: &&str| notes(&merged).iter().any(|note| note.contains(words));
        assert!(expected.iter().all(has), "{}", merged.stderr);
    }
}

/// However many parts there are, few files are open at once.
#[cfg(unix)]
#[test]
fn parts_are_read_one_after_the_other() {
    let folder = Folder::new();
    let render = "ball.yaml 128 80 1 2";
    for part in 0..40 {
        folder.run(&format!("{render} {part:02}.film --part {part}/40 -q")).succeeds();
    }
    let program = env!("CARGO_BIN_EXE_pathtracer");
    let words = format!("ulimit -n 24; exec {program} merge *.film a.png -q");
    let mut command = std::process::Command::new("sh");
    command.args(["-c", &words]).current_dir(folder.path(""));
    super::Ended::from(command.output().expect("a shell")).succeeds();
    folder.run(&format!("{render} whole.png -q")).succeeds();
    assert!(folder.read("a.png") == folder.read("whole.png"));
}

#[test]
fn a_missing_part_is_named_with_the_command_that_makes_it() {
    for (split, missing) in [
        (&["--part 0/3", "--part 2/3"][..], "--part 1/3"),
        (&["--chunks 0..1", "--chunks 2..3"], "--chunks 1..2"),
        (&["--crop 0,0,20,36"], "--crop 20,0,40,36"),
        (&["--part 0/2", "--part 1/2 --chunks 0..1"], "--part 1/2 --chunks 1..3"),
    ] {
        let folder = Folder::new();
        folder.run(&format!("{RENDER} whole.exr --seed 3 -q")).succeeds();
        let names = parts(&folder, "--seed 3", split).join(" ");
        let ended = folder.run(&format!("merge {names} a.exr"));
        ended.fails(1, missing);
        let line = ended.stderr.lines().find(|line| line.contains("made by")).expect("a line");
        let (_, command) = line.split_once("pathtracer ").expect("a command");
        folder.run(&format!("{command} -q")).succeeds();
        let made = command.split(' ').nth(5).expect("a file");
        folder.run(&format!("merge {names} {made} a.exr -q")).succeeds();
        assert!(folder.read("a.exr") == folder.read("whole.exr"), "{split:?}");
    }
}

#[test]
fn duplicated_foreign_and_damaged_parts_are_named() {
    let folder = Folder::new();
    let names = parts(&folder, "", &["--part 0/3", "--part 1/3", "--part 2/3"]).join(" ");
    fs::copy(folder.path("1.film"), folder.path("again.film")).expect("a copy");
    folder
        .run(&format!("merge {names} again.film a.exr"))
        .fails(1, "1.film and again.film both hold part 1/3");
    folder.run(&format!("{RENDER} seed.film --part 1/3 --seed 5 -q")).succeeds();
    folder
        .run("merge 0.film seed.film 2.film a.exr")
        .fails(1, "seed.film is of another render than most parts: it differs in seed (5, not 0)");
    let mut bytes = folder.read("1.film");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(folder.path("1.film"), bytes).expect("a file");
    let ended = folder.run(&format!("merge {names} a.exr"));
    ended.fails(1, "1.film is damaged");
    assert!(ended.stderr.contains("--part 1/3"), "{}", ended.stderr);
    assert!(!folder.has("a.exr"));
}

#[cfg(feature = "embree")]
#[test]
fn parts_of_different_instruction_sets_are_refused_unless_told() {
    let folder = Folder::new();
    for (number, isa) in ["sse2", "avx2"].into_iter().enumerate() {
        let options = format!("--part {number}/2 --precision robust --accel embree --isa {isa} -q");
        let ended = folder.run(&format!("{RENDER} {number}.film {options}"));
        if ended.code == Some(2) {
            // This machine has no AVX2.
            return;
        }
    }
    folder.run("merge 0.film 1.film a.exr").fails(1, "instruction set (");
    folder.run("merge 0.film 1.film a.exr --mix-instruction-sets").succeeds();
}

#[test]
fn parts_that_cannot_be_are_refused() {
    let folder = Folder::new();
    for (options, why) in [
        ("a.film --part 9/9", "from 0 to N - 1"),
        ("a.film --part 0/1000", "make as many parts at most"),
        ("a.film --crop 5,5,5,9", "a crop has X0 < X1"),
        ("a.film --crop 0,0,41,9", "X1 <= 40"),
        ("a.film --crop 0,0,8,8 --noise 0.1", "can't cut blocks"),
        ("a.film --chunks 1..4", "make 3 chunks of 16"),
        ("a.film --chunks 0..1 --noise 0.1", "--chunks can't be with --noise"),
        ("a.film --part 0/2 --time 1", "can't have a --time"),
        ("a.exr --part 0/2", "ends in .film"),
    ] {
        folder.run(&format!("{RENDER} {options}")).fails(2, why);
    }
    folder.run("merge a.film").fails(2, "merge needs part files");
    assert_eq!(folder.names(), ["ball.yaml"]);
}

/// Names with blanks and quotes; the missing one's name is like those of the others.
#[cfg(unix)]
#[test]
fn the_command_for_a_missing_part_can_be_pasted_into_a_shell_and_completes_the_same_merge() {
    let folder = Folder::new();
    fs::create_dir(folder.path("my part's")).expect("a folder");
    fs::copy(folder.path("ball.yaml"), folder.path("my ball's.yaml")).expect("a copy");
    let pathtracer = format!("'{}'", env!("CARGO_BIN_EXE_pathtracer"));
    let shell = |words: &str| {
        let mut command = std::process::Command::new("sh");
        command.args(["-c", words]).current_dir(folder.path(""));
        super::Ended::from(command.output().expect("a shell"))
    };
    let render = format!("{pathtracer} \"my ball's.yaml\" 40 36 2 1");
    for part in [0, 2] {
        shell(&format!("{render} \"my part's/room-0{part}.film\" --part {part}/3 -q")).succeeds();
    }
    let merge = format!("{pathtracer} merge \"my part's\"/room-*.film a.exr -q");
    let ended = shell(&merge);
    let (_, command) = ended.stderr.split_once("made by: pathtracer ").expect("a command");
    shell(&format!("{pathtracer} {}", command.trim())).succeeds();
    shell(&merge).succeeds();
    shell(&format!("{render} whole.exr -q")).succeeds();
    assert!(folder.read("a.exr") == folder.read("whole.exr"));
}
