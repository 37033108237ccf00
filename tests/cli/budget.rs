//! `--noise`, `--time` and what is said about the error.

use super::Folder;
use serde_json::Value;

fn last_event(stdout: &str) -> Value {
    serde_json::from_str(stdout.lines().last().expect("an event")).expect("JSON")
}

#[test]
fn the_final_line_says_the_error() {
    let ended = Folder::new().run("ball.yaml 32 24 4 3 a.png");
    ended.succeeds();
    let last = ended.stderr.lines().last().expect("a line");
    assert!(last.contains("; estimated relative error ") && last.contains(", mean "), "{last}");
}

#[test]
fn error_bars_need_a_file_of_their_own() {
    let folder = Folder::new();
    folder.run("ball.yaml 32 24 16 3 a.exr --error-bars a.exr").fails(2, "a file of its own");
    assert!(!folder.has("a.exr"));
}

#[test]
fn the_error_can_be_switched_off() {
    let ended = Folder::new().run("ball.yaml 32 24 4 3 a.png --error-estimate off --json");
    ended.succeeds();
    assert!(!ended.stderr.contains("estimated relative error"));
    assert!(last_event(&ended.stdout)["error"].is_null());
}

#[test]
fn the_last_event_has_the_error_with_its_interval() {
    let ended = Folder::new().run("ball.yaml 32 24 4 3 a.png --json");
    ended.succeeds();
    let error = &last_event(&ended.stdout)["error"];
    let relative = error["relative"].as_f64().expect("a number");
    let interval = [&error["relative_interval"][0], &error["relative_interval"][1]].map(Value::as_f64);
    assert!(interval[0] < Some(relative) && Some(relative) < interval[1], "{error}");
    assert!(error["mean_standard_error"].as_f64() > Some(0.0));
}

#[test]
fn a_target_that_is_reached_is_a_success() {
    let ended = Folder::new().run("ball.yaml 32 24 0 3 a.png --noise 0.2 --json");
    ended.succeeds();
    let last = last_event(&ended.stdout);
    assert_eq!((last["event"].as_str(), last["noise_missed"].as_bool()), (Some("done"), Some(false)));
    assert!(last["samples_taken"].as_u64() >= Some(64));
}

#[test]
fn a_target_that_the_time_does_not_allow_has_its_exit_code() {
    let folder = Folder::new();
    let ended = folder.run("ball.yaml 32 24 0 3 a.png --noise 1e-9 --time 100ms --json");
    assert_eq!(ended.code, Some(5));
    assert!(folder.has("a.png"));
    let last = last_event(&ended.stdout);
    assert_eq!((last["event"].as_str(), last["noise_missed"].as_bool()), (Some("done"), Some(true)));
    assert!(ended.stderr.contains("the time was up before the error was"), "{}", ended.stderr);
}

#[test]
fn a_target_that_the_samples_do_not_allow_is_said() {
    let ended = Folder::new().run("ball.yaml 32 24 70 3 a.png --noise 1e-9");
    ended.succeeds();
    assert!(ended.stderr.contains("70 samples did not bring the error below the target"), "{}", ended.stderr);
}

#[test]
fn a_time_says_which_samples_make_the_same_file() {
    let folder = Folder::new();
    let ended = folder.run("ball.yaml 32 24 0 3 a.exr --time 0.1 --json");
    ended.succeeds();
    let samples = last_event(&ended.stdout)["samples_taken"].as_u64().expect("a number");
    assert!(ended.stderr.contains(&format!("SAMPLES = {samples} without --time makes the same picture")));
    folder.run(&format!("ball.yaml 32 24 {samples} 3 b.exr")).succeeds();
    assert!(folder.read("a.exr") == folder.read("b.exr"));
}

#[test]
fn no_limit_needs_another_end() {
    let ended = Folder::new().run("ball.yaml 32 24 0 3 a.png");
    assert_eq!(ended.code, Some(2));
    assert!(ended.stderr.contains("can only be given with --noise or --time"), "{}", ended.stderr);
}

#[test]
fn times_and_targets_that_cannot_be_are_usage_errors() {
    for option in
        ["--time 0.05", "--time 99ms", "--time -1", "--time soon", "--time inf", "--noise 0", "--noise x"]
    {
        let ended = Folder::new().run(&format!("ball.yaml 32 24 4 3 a.png {option}"));
        assert_eq!(ended.code, Some(2), "{option}");
    }
}

#[test]
fn times_may_have_units() {
    for time in ["3600", "3600s", "1h", "60m", "3600000ms"] {
        let ended = Folder::new().run(&format!("ball.yaml 4 3 1 3 a.png --json --time {time}"));
        ended.succeeds();
        assert_eq!(last_event(&ended.stdout)["time_seconds"].as_f64(), Some(3600.0), "{time}");
    }
}

#[test]
fn error_bars_are_written_beside_the_picture() {
    let folder = Folder::new();
    folder.run("ball.yaml 16 12 16 3 a.png --error-bars bars.exr").succeeds();
    let bars = image::open(folder.path("bars.exr")).expect("a picture").into_rgb32f();
    assert_eq!(bars.dimensions(), (16, 12));
    // The interval of 7 degrees of freedom is 2.365 standard errors to each side; the sky behind the ball varies.
    assert!(
        bars.pixels()
            .all(|bar| bar[0] > 0.0 && bar[1] >= 0.0 && (bar[2] - 2.365 * bar[1]).abs() <= 0.002 * bar[2])
    );
    assert!(bars.pixels().any(|bar| bar[1] > 0.0));
}

#[test]
fn error_bars_need_floats_and_samples() {
    let folder = Folder::new();
    folder.run("ball.yaml 16 12 16 3 a.png --error-bars bars.png").fails(2, "error bars need an .exr");
    let ended = folder.run("ball.yaml 16 12 4 3 a.png --error-bars bars.exr");
    ended.succeeds();
    assert!(ended.stderr.contains("no errors of the pixels were written"), "{}", ended.stderr);
    assert!(!folder.has("bars.exr"));
}
