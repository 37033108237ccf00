//! `pathtracer bench`.

use super::Folder;
use serde_json::Value;

const SMALL: &str = "--quick --rays 200 --rounds 1 --threads 2 --quiet";

fn contenders() -> usize {
    if cfg!(feature = "embree") { 6 } else { 3 }
}

#[test]
fn a_ladder_ends_with_how_the_times_grow() {
    let ended = Folder::new().run(&format!("bench --mesh cube --triangles 100..2k {SMALL}"));
    ended.succeeds();
    for line in ["cube, 108 triangles", "cube, 972 triangles", "cube, 2,028 triangles"] {
        assert!(ended.stdout.lines().any(|other| other == line), "{line} in {}", ended.stdout);
    }
    assert!(ended.stdout.contains("time grows as triangles ^"));
    assert_eq!(ended.stderr, "");
}

#[test]
fn json_and_csv_hold_the_same_figures() {
    let folder = Folder::new();
    let ended = folder.run(&format!("bench --mesh soup,scan --triangles 500 {SMALL} --json --csv a.csv"));
    ended.succeeds();
    let events: Vec<Value> =
        ended.stdout.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(events[0]["event"], "start");
    let figures = events.iter().filter(|event| event["event"] == "figure").count();
    // On one thread and on two: build, four kinds of rays, mean, relative; and memory.
    assert_eq!(figures, 2 * contenders() * (2 * 7 + 1));
    let last = events.last().expect("an event");
    assert_eq!((last["event"].as_str(), last["figures"].as_u64()), (Some("done"), Some(figures as u64)));
    let csv = String::from_utf8(folder.read("a.csv")).expect("UTF-8");
    assert_eq!(csv.lines().count(), figures + 1);
    assert!(csv.lines().all(|line| line.split(',').count() == 10));
}

#[test]
fn leaks_are_counted_in_closed_meshes() {
    let ended =
        Folder::new().run(&format!("bench --mesh cube --triangles 300 --leaks --leak-rays 300 {SMALL}"));
    ended.succeeds();
    assert!(ended.stdout.contains("lost rays"), "{}", ended.stdout);
    assert!(ended.stdout.contains("vertices of 300"), "{}", ended.stdout);
}

#[test]
fn plots_are_pictures() {
    let folder = Folder::new();
    let ended =
        folder.run(&format!("bench --mesh cube --triangles 100..1k {SMALL} --plot a.svg --plot a.png"));
    ended.succeeds();
    assert!(String::from_utf8(folder.read("a.svg")).expect("UTF-8").trim_end().ends_with("</svg>"));
    assert!(image::open(folder.path("a.png")).expect("a picture").width() > 400);
    assert_eq!(folder.names(), ["a.png", "a.svg", "ball.yaml"]);
}

#[test]
fn a_scene_and_a_mesh_can_be_measured() {
    let folder = Folder::new();
    folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    let ended = folder.run(&format!("bench square.obj {SMALL}"));
    ended.succeeds();
    assert!(ended.stdout.contains("square.obj, 2 triangles"), "{}", ended.stdout);
    let ended = folder.run(&format!("bench ball.yaml {SMALL}"));
    ended.succeeds();
    assert!(ended.stdout.contains("ball.yaml, 0 triangles"), "{}", ended.stdout);
}

#[test]
fn mistakes_in_a_mesh_have_a_place() {
    let folder = Folder::new();
    folder.write("bad.obj", "v 0 0 0\nv 1 0 x\nf 1 2 3\n");
    folder.run(&format!("bench bad.obj {SMALL}")).fails(3, "bad.obj:2:7");
    folder.run(&format!("bench missing.obj {SMALL}")).fails(3, "cannot read the mesh missing.obj");
}

#[test]
fn sizes_out_of_range_are_refused_with_advice() {
    let folder = Folder::new();
    for sizes in ["1", "x", "1k..", "..1k", "1k..1G", "+1k", "1k..2k..3k"] {
        folder.run(&format!("bench --triangles {sizes}")).fails(2, "or a range such as 1k..10M");
    }
    folder.run("bench --triangles 10k..1k").fails(2, "did you mean 1000..10000?");
    folder.run("bench --mesh ball").fails(2, "sphere, scan, building");
}

#[test]
fn options_for_generated_meshes_do_not_go_with_a_file() {
    let folder = Folder::new();
    for option in ["--triangles 1k", "--mesh cube", "--leaks"] {
        let name = option.split(' ').next().expect("a word");
        folder.run(&format!("bench ball.yaml {option}")).fails(2, &format!("{name} is for generated meshes"));
    }
    folder.run("bench --leak-rays 5").fails(2, "--leaks");
}

#[test]
fn an_unknown_plot_is_refused_before_the_work() {
    Folder::new().run("bench --plot a.pdf").fails(2, "known are .svg, .png");
}

#[test]
fn scaling_tells_how_the_cost_of_a_sample_grows() {
    let folder = Folder::new();
    let ended = folder.run("bench --scaling --quick --rounds 2 --threads 2 --quiet --plot a.svg --csv a.csv");
    ended.succeeds();
    for line in ["2 threads are ", "a sample costs triangles ^ ", "a sample costs shining balls ^ "] {
        assert!(ended.stdout.lines().any(|other| other.starts_with(line)), "{line} in {}", ended.stdout);
    }
    assert_eq!(folder.names(), ["a.csv", "a.svg", "ball.yaml"]);
    folder.run("bench --scaling --mesh cube").fails(2, "cannot be used with");
    folder.run("bench --scaling ball.yaml").fails(2, "cannot be used with");
}
