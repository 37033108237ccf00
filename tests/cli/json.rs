use super::{BALL, Ended, Folder};
use serde_json::Value;
use std::process::Stdio;

fn events(ended: &Ended) -> Vec<Value> {
    ended.stdout.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect()
}

#[test]
fn a_render_starts_and_is_done() {
    let ended = Folder::new()
        .run("ball.yaml 8 6 20 3 a.exr --json --seed 7 --accel native --bvh quality --threads 1");
    ended.succeeds();
    let events = events(&ended);
    let (first, last) = (&events[0], &events[events.len() - 1]);
    assert_eq!(first["event"], "start");
    assert_eq!(last["event"], "done");
    for event in [first, last] {
        assert_eq!(event["scene"], "ball.yaml");
        assert_eq!(event["image"], "a.exr");
        assert_eq!((event["width"].as_u64(), event["height"].as_u64()), (Some(8), Some(6)));
        assert_eq!((event["samples"].as_u64(), event["bounces"].as_u64()), (Some(20), Some(3)));
        assert_eq!((event["accel"].as_str(), event["precision"].as_str()), (Some("native"), Some("exact")));
        assert_eq!((event["seed"].as_u64(), event["threads"].as_u64()), (Some(7), Some(1)));
        assert_eq!(
            (event["sampler"].as_str(), event["light_sampling"].as_bool()),
            (Some("sobol"), Some(true))
        );
        assert!(event["isa"].is_null());
        assert_eq!(event["bvh"], "quality");
        assert!(event["requires"].is_object());
    }
    assert_eq!((last["samples_taken"].as_u64(), last["dropped_samples"].as_u64()), (Some(20), Some(0)));
    // At least the camera's rays.
    assert!(last["rays"].as_u64() >= Some(8 * 6 * 20));
    for key in ["load_seconds", "build_seconds", "render_seconds", "write_seconds"] {
        assert!(last[key].as_f64() >= Some(0.0), "{key}");
    }
    assert!(last["samples_per_second"].as_f64() > Some(0.0));
}

#[test]
fn a_bad_scene_is_an_event_with_all_mistakes() {
    let folder = Folder::new();
    folder.write("bad.yaml", &BALL.replace("Radius: 1", "Radius: -1"));
    let ended = folder.run("bad.yaml 8 6 1 3 a.png --json");
    assert_eq!(ended.code, Some(3));
    let events = events(&ended);
    assert_eq!(events.len(), 1);
    assert_eq!((events[0]["event"].as_str(), events[0]["code"].as_u64()), (Some("error"), Some(3)));
    let diagnostic = &events[0]["diagnostics"][0];
    assert_eq!(
        (diagnostic["severity"].as_str(), diagnostic["file"].as_str()),
        (Some("error"), Some("bad.yaml"))
    );
    assert!(diagnostic["message"].as_str().is_some_and(|message| message.contains("Radius")));
}

#[test]
fn a_usage_error_is_an_event() {
    let ended = Folder::new().run("ball.yaml 0 6 1 3 a.png --json");
    assert_eq!(ended.code, Some(2));
    let events = events(&ended);
    assert_eq!((events[0]["event"].as_str(), events[0]["code"].as_u64()), (Some("error"), Some(2)));
    assert!(events[0]["message"].as_str().is_some_and(|message| message.starts_with("invalid value '0'")));
}

#[test]
fn a_reader_that_goes_away_does_not_stop_the_render() {
    let folder = Folder::new();
    let mut command = folder.command("ball.yaml 8 6 4 3 a.png --json");
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("a child");
    drop(child.stdout.take());
    let ended = Ended::from(child.wait_with_output().expect("an end"));
    ended.succeeds();
    assert!(!ended.stderr.contains("panicked"));
    assert!(folder.has("a.png"));
}
