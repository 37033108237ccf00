use super::{BALL, Folder};
use serde_json::Value;

/// The ball over a floor: paths between the two are cut.
fn folder() -> Folder {
    let folder = Folder::new();
    let floor =
        "  - Object: { Type: Ball, Position: [5, 0, -101], Radius: 100, Material: { Type: Diffuse } }\n";
    folder.write("floor.yaml", &format!("{BALL}{floor}"));
    folder
}

#[test]
fn counts_are_in_the_last_event() {
    let ended = folder().run("floor.yaml 16 12 16 1 a.exr --json --clamp 0.01");
    ended.succeeds();
    let last = ended.stdout.lines().last().expect("a line");
    let last: Value = serde_json::from_str(last).expect("JSON");
    for key in ["dropped_samples", "refused_rays", "self_hits", "fireflies"] {
        assert_eq!(last[key].as_u64(), Some(0), "{key}");
    }
    // Of paths of one segment, each that meets a surface is cut with all its throughput.
    let cut = last["cut_paths"].as_u64().expect("a number");
    assert!(cut > 0);
    assert_eq!(last["cut_throughput"].as_f64(), Some(cut as f64 / (16.0 * 12.0 * 16.0)));
    // One segment does not tell what a surface reflects.
    assert!(last["cut_light"].is_null());
    // The rest sees the sky, which is brighter than the limit everywhere.
    assert_eq!(last["clamped_samples"].as_u64(), Some(16 * 12 * 16 - cut));
    assert_eq!(last["clamp"].as_f64(), Some(0.01));
    assert!(last["clamp_removed"].as_f64() > Some(0.0));
    assert!(last["clamp_bias"].as_f64() > Some(0.5));
}

#[test]
fn without_a_limit_there_is_no_bias() {
    let ended = folder().run("floor.yaml 8 6 16 3 a.exr --json");
    let last: Value = serde_json::from_str(ended.stdout.lines().last().expect("a line")).expect("JSON");
    assert_eq!(last["clamped_samples"].as_u64(), Some(0));
    assert!(last["cut_light"].as_f64() > Some(0.0));
    assert!(["clamp", "clamp_removed", "clamp_bias"].iter().all(|key| last[key].is_null()));
}

#[test]
fn what_is_not_zero_is_said_unless_quiet() {
    let folder = folder();
    let ended = folder.run("floor.yaml 16 12 16 1 a.exr --clamp 0.01");
    assert!(ended.stderr.contains("note: the limit of bounces cut "), "{}", ended.stderr);
    assert!(ended.stderr.contains(" samples were clamped to 0.01, which took "), "{}", ended.stderr);
    assert!(!ended.stderr.contains("warning"), "{}", ended.stderr);
    assert_eq!(folder.run("floor.yaml 16 12 16 1 a.exr --clamp 0.01 --quiet").stderr, "");
    assert!(!folder.run("ball.yaml 16 12 16 2 a.exr").stderr.contains("note"));
}

#[test]
fn a_limit_above_all_light_does_not_change_the_picture() {
    let folder = folder();
    let picture = |options: &str| {
        folder.run(&format!("floor.yaml 16 12 20 4 a.exr {options}")).succeeds();
        folder.read("a.exr")
    };
    assert!(picture("") == picture("--clamp 1e9"));
    assert!(picture("") != picture("--clamp 0.5"));
}

#[test]
fn a_limit_that_is_no_positive_number_is_refused() {
    for limit in ["0", "-1", "nan", "inf", "much"] {
        folder().run(&format!("floor.yaml 8 6 1 3 a.png --clamp {limit}")).fails(2, "a finite number > 0");
    }
}

/// A light that fills the picture, of this strength.
fn bright(strength: &str) -> Folder {
    let folder = Folder::new();
    let lamp = BALL.replace("Type: Diffuse", &format!("Type: Diffuse\n        EmissionStrength: {strength}"));
    folder.write("bright.yaml", &lamp.replace("Radius: 1", "Radius: 8"));
    folder
}

#[test]
fn light_beyond_the_numbers_of_a_picture_is_said() {
    let said = "192 components of pixels are brighter than the picture's numbers can say";
    for (strength, image, cut) in [
        ("1e39", "a.exr", 192),
        ("1e38", "a.exr", 0),
        ("65600", "a.exr --depth half", 192),
        ("65504", "a.exr --depth half", 0),
        // Where all that is brighter than white is white, nothing is lost that was asked for.
        ("1e39", "a.png", 0),
    ] {
        let folder = bright(strength);
        let ended = folder.run(&format!("bright.yaml 8 8 1 1 {image} --json"));
        ended.succeeds();
        let last: Value = serde_json::from_str(ended.stdout.lines().last().expect("a line")).expect("JSON");
        assert_eq!(last["cut_components"].as_u64(), Some(cut), "{strength} {image}");
        assert_eq!(ended.stderr.matches(said).count(), usize::from(cut > 0), "{}", ended.stderr);
    }
}

/// Two balls on one place.
fn doubled() -> Folder {
    let folder = Folder::new();
    let object = &BALL[BALL.find("  - Object:").expect("an object")..];
    folder.write("doubled.yaml", &format!("{BALL}{object}"));
    folder
}

#[test]
fn warnings_of_a_scene_are_in_the_first_event() {
    let ended = doubled().run("doubled.yaml 8 6 1 1 a.exr --json");
    ended.succeeds();
    let first: Value = serde_json::from_str(ended.stdout.lines().next().expect("a line")).expect("JSON");
    let warnings = first["warnings"].as_array().expect("a list");
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert_eq!(warnings[0]["severity"], "warning");
    assert!(warnings[0]["message"].as_str().is_some_and(|text| text.contains("lies on the one at")));
    assert!(warnings[0]["line"].as_u64().is_some());
    let ended = folder().run("floor.yaml 8 6 1 1 a.exr --json");
    let first: Value = serde_json::from_str(ended.stdout.lines().next().expect("a line")).expect("JSON");
    assert_eq!(first["warnings"].as_array().map(Vec::len), Some(0));
}

/// A camera whose direction drowns in its digits makes no picture, and no study.
#[test]
fn studies_refuse_what_a_render_refuses_and_say_what_it_warns_of() {
    let folder = doubled();
    let lost = BALL.replace("[0, 0, 0]", "[1e16, 0, 0]").replace("[5, 0, 0]\n  Fov", "[1e16, 0, 2]\n  Fov");
    folder.write("lost.yaml", &lost);
    folder.run("lost.yaml 8 6 1 1 a.exr").fails(3, "the camera's direction is known to within");
    for study in [
        "tradeoff SCENE --size 8x6 --seeds 2 --samples 1,2 --bounces 2 --accel native --threads 1",
        "compare SCENE --size 8x6 --samples 1 --rays 100 --rounds 1 --threads 1",
        "bench SCENE --rays 1000 --rounds 1 --threads 1",
    ] {
        if cfg!(not(feature = "embree")) && study.starts_with("compare") {
            continue;
        }
        let lost = folder.run(&study.replace("SCENE", "lost.yaml"));
        lost.fails(3, "the camera's direction is known to within");
        let doubled = folder.run(&study.replace("SCENE", "doubled.yaml"));
        doubled.succeeds();
        assert!(doubled.stderr.contains("lies on the one at"), "{study}: {}", doubled.stderr);
    }
}
