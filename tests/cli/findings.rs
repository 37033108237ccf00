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
