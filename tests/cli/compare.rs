//! `pathtracer compare`.

use super::Folder;
#[cfg(feature = "embree")]
use serde_json::Value;

const SMALL: &str = "--size 16x12 --rays 200 --rounds 1 --threads 2 --quiet";

/// The ball on a mesh.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nf 1 2 3 4\n");
    let mesh = "  - Object:
      Type: TriangleMesh
      Filepath: square.obj
      Position: [4, -2, -1]
      Scale: 4
      Material: {Type: Diffuse}
";
    folder.write("scene.yaml", &format!("{}{mesh}", super::BALL));
    folder
}

#[cfg(feature = "embree")]
#[test]
fn exact_accelerators_agree() {
    let ended = folder().run(&format!("compare scene.yaml {SMALL}"));
    ended.succeeds();
    let lines: Vec<&str> = ended.stdout.lines().collect();
    assert_eq!(lines[0], "scene.yaml: 2 triangles, 1 solid; both at exact");
    assert!(ended.stdout.contains("hits"), "{}", ended.stdout);
    let last = lines.last().expect("a line");
    assert_eq!(*last, "pictures of 16 x 12 pixels with 4 samples: equal to the last bit");
    assert!(!ended.stdout.contains("the worst differences"));
    assert_eq!(ended.stderr, "");
}

#[cfg(feature = "embree")]
#[test]
fn json_lines_add_up_and_end_with_done() {
    let ended = folder().run(&format!("compare scene.yaml {SMALL} --json --precision robust"));
    ended.succeeds();
    let events: Vec<Value> =
        ended.stdout.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(events[0]["event"], "start");
    assert_eq!(events[0]["precision"], "robust");
    assert!(events[0]["machine"]["isa"].is_string());
    let hits: Vec<&Value> = events.iter().filter(|event| event["event"] == "hits").collect();
    let kinds: Vec<&str> = hits.iter().filter_map(|hits| hits["kind"].as_str()).collect();
    assert_eq!(kinds, ["primary", "bounce", "shadow", "random"]);
    for hits in hits {
        let sum: u64 = ["same", "tie", "edge", "other"].iter().filter_map(|key| hits[key].as_u64()).sum();
        assert_eq!(Some(sum), hits["rays"].as_u64());
        assert_eq!((hits["embree_differs"].as_u64(), hits["native_differs"].as_u64()), (Some(0), Some(0)));
    }
    let figures = events.iter().filter(|event| event["event"] == "figure");
    assert!(figures.clone().count() > 10);
    assert!(figures.clone().all(|figure| figure["median"].is_number()));
    let last = events.last().expect("an event");
    assert_eq!((last["event"].as_str(), last["code"].as_u64()), (Some("done"), Some(0)));
}

#[cfg(feature = "embree")]
#[test]
fn figures_are_written_as_csv() {
    let folder = folder();
    folder.run(&format!("compare scene.yaml {SMALL} --csv a.csv")).succeeds();
    let text = String::from_utf8(folder.read("a.csv")).expect("UTF-8");
    let mut lines = text.lines();
    assert_eq!(
        lines.next(),
        Some("mesh,triangles,accelerator,precision,measure,threads,unit,median,min,max")
    );
    assert!(lines.clone().count() > 10);
    assert!(lines.all(|line| line.starts_with("scene.yaml,2,") && line.split(',').count() == 10));
    assert_eq!(folder.names(), ["a.csv", "ball.yaml", "scene.yaml", "square.obj"]);
}

#[cfg(not(feature = "embree"))]
#[test]
fn without_embree_it_says_how_to_get_it() {
    folder().run(&format!("compare scene.yaml {SMALL}")).fails(2, "--features embree");
}

#[test]
fn a_bad_scene_is_refused() {
    Folder::new()
        .run(&format!("compare missing.yaml {SMALL}"))
        .fails(3, "cannot read the scene missing.yaml");
}

#[test]
fn options_out_of_range_are_refused_with_advice() {
    let folder = Folder::new();
    folder.run("compare").fails(2, "<SCENE>");
    for size in ["16", "0x9", "16x", "99999x9", "axb"] {
        let message = "expected a width and a height from 1 to 4096, such as 320x180";
        folder.run(&format!("compare ball.yaml --size {size}")).fails(2, message);
    }
    folder.run("compare ball.yaml --rays 0").fails(2, "such as 5000, 50k or 1M");
    folder.run("compare ball.yaml --rounds 0").fails(2, "expected a whole number from 1 to 1000");
    folder.run("compare ball.yaml --precison fast").fails(2, "'--precision'");
}

#[test]
fn a_csv_that_cannot_be_written_fails_before_the_work() {
    let folder = Folder::new();
    folder.run("compare missing.yaml --csv no/such/a.csv").fails(1, "cannot write no/such/a.csv");
}

#[test]
fn a_misspelt_command_is_suggested() {
    Folder::new().run("comapre ball.yaml").fails(2, "did you mean the command 'compare'?");
}
