//! `pathtracer tradeoff`.

use super::{BALL, Folder};
use serde_json::Value;
use std::env;
use std::path::PathBuf;
use std::process::Command;

const SMALL: &str = "--size 12x8 --seeds 2 --samples 1,2 --bounces 4,2 --accel native --threads 2 --quiet";

#[test]
fn a_table_ends_with_a_recommendation() {
    let ended = Folder::new().run(&format!("tradeoff ball.yaml {SMALL}"));
    ended.succeeds();
    assert_eq!(ended.stderr, "");
    // A scene under a sky that is sampled, without meshes.
    for label in ["default ", "independent ", "lights off ", "2 bounces "] {
        assert_eq!(
            ended.stdout.lines().filter(|line| line.starts_with(label)).count(),
            3,
            "{}",
            ended.stdout
        );
    }
    for label in ["fast", "robust", "rays, 1 thread"] {
        assert!(!ended.stdout.contains(label), "{label} in {}", ended.stdout);
    }
    let last = ended.stdout.lines().last().expect("a line");
    assert!(last.starts_with("for relMSE 0.01: native exact, "), "{last}");
}

#[test]
fn json_and_csv_hold_the_same_figures() {
    let folder = Folder::new();
    let ended = folder.run(&format!("tradeoff ball.yaml {SMALL} --json --csv a.csv --target 0.5"));
    ended.succeeds();
    let events: Vec<Value> =
        ended.stdout.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(events[0]["event"], "start");
    assert_eq!(events[0]["seeds"], 2);
    let figures: Vec<&Value> = events.iter().filter(|event| event["event"] == "figure").collect();
    let csv = String::from_utf8(folder.read("a.csv")).expect("UTF-8");
    assert_eq!(csv.lines().count(), figures.len() + 1);
    assert!(csv.lines().all(|line| line.split(',').count() == 15));
    // Five variants with two numbers of samples each.
    for measure in ["seconds", "mse", "rel_mse", "trimmed_rel_mse", "flip", "relative_efficiency"] {
        assert_eq!(figures.iter().filter(|figure| figure["measure"] == measure).count(), 10, "{measure}");
    }
    let last = events.last().expect("an event");
    assert_eq!(last["event"], "done");
    assert!(last["command"].as_str().expect("a command").starts_with("pathtracer ball.yaml 12 8 "));
}

#[test]
fn scenes_with_meshes_tell_what_rays_cost_and_where_they_leak() {
    let folder = Folder::new();
    folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
    let mesh = "  - Object:\n      Type: TriangleMesh\n      Filepath: square.obj\n      Position: [5, 0, 0]\n      \
                Material: { Type: Diffuse }\n";
    folder.write("mesh.yaml", &format!("{BALL}{mesh}"));
    let ended = folder.run(&format!("tradeoff mesh.yaml {SMALL} --rays 50 --leak-rays 100 --plot a.svg"));
    ended.succeeds();
    assert!(ended.stdout.contains("lost at edges of 100"), "{}", ended.stdout);
    assert!(ended.stdout.lines().any(|line| line.starts_with("native exact ")), "{}", ended.stdout);
    let svg = String::from_utf8(folder.read("a.svg")).expect("UTF-8");
    for title in ["Error against time", "Energy against bounces", "Cost of a ray against leaks"] {
        assert!(svg.contains(title), "{title}");
    }
}

#[test]
fn a_picture_can_be_the_reference() {
    let folder = Folder::new();
    folder.run("ball.yaml 12 8 256 4 a.exr --quiet").succeeds();
    let ended = folder.run(&format!("tradeoff ball.yaml {SMALL} --reference a.exr --plot a.png"));
    ended.succeeds();
    assert!(ended.stdout.contains("errors: the reference"), "{}", ended.stdout);
    assert!(image::open(folder.path("a.png")).expect("a picture").width() > 400);
    folder
        .run("tradeoff ball.yaml --quick --size 6x4 --reference a.exr")
        .fails(2, "has 12 x 8 pixels: render with --size 12x8");
    folder.run("tradeoff ball.yaml --quick --reference a.png").fails(2, "is not an .exr");
}

#[test]
fn what_can_not_be_is_refused_before_the_work() {
    let folder = Folder::new();
    folder.run("tradeoff").fails(2, "SCENE");
    folder.run("tradeoff missing.yaml").fails(3, "cannot read the scene missing.yaml");
    folder.run("tradeoff ball.yaml --seeds 1").fails(2, "2..=1000");
    folder.run("tradeoff ball.yaml --samples 4,0").fails(2, "expected a whole number from 1");
    folder.run("tradeoff ball.yaml --precision exact,perfect").fails(2, "exact, robust, fast");
    folder.run("tradeoff ball.yaml --plot a.pdf").fails(2, "known are .svg, .png");
    folder.run("tradeoff ball.yaml --report a.pdf").fails(2, "must end in .html");
    folder.run("tradeoff ball.yaml --target 0").fails(2, "expected a finite number > 0");
}

/// A browser: `PATHTRACER_CHROMIUM`, or one on the path.
fn chromium() -> Option<PathBuf> {
    if let Some(path) = env::var_os("PATHTRACER_CHROMIUM") {
        return Some(path.into());
    }
    let folders = env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    env::split_paths(&folders)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|path| path.is_file())
}

/// Chromium on a page of the folder, without a window and with nothing kept.
fn browse(chromium: &PathBuf, folder: &Folder, action: &str) -> std::process::Output {
    let page = format!("file://{}", folder.path("a.html").display());
    let profile = tempfile::tempdir().expect("a temporary folder");
    let quiet =
        ["--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
    Command::new(chromium)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--window-size=1000,900"])
        .args(quiet)
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args([action, &page])
        .output()
        .expect("the browser starts")
}

#[test]
fn a_report_opens_in_a_browser() {
    let folder = Folder::new();
    folder.run(&format!("tradeoff ball.yaml {SMALL} --report a.html")).succeeds();
    let Some(chromium) = chromium() else {
        eprintln!("skipped: no chromium on the path, and PATHTRACER_CHROMIUM is not set");
        return;
    };
    let page = String::from_utf8(browse(&chromium, &folder, "--dump-dom").stdout).expect("UTF-8");
    // The script has filled both lists and shown a picture on each side.
    assert_eq!(page.matches("<option").count(), 2 * (5 * 2 + 1), "{page}");
    assert_eq!(page.matches("<img alt=\"").count(), 2);
    assert!(page.contains("alt=\"default, 2 samples\""), "{page}");
    assert!(page.contains("alt=\"the mean of all that are right\""));
    browse(&chromium, &folder, &format!("--screenshot={}", folder.path("a.png").display()));
    let shot = image::open(folder.path("a.png")).expect("a screenshot").into_rgb8();
    // The ball is red, and nothing else on the page is as red.
    let red = shot.pixels().filter(|pixel| {
        let [red, green, blue] = pixel.0.map(u32::from);
        red > 80 && red > 2 * green && red > 2 * blue
    });
    assert!(red.count() > 1000, "the pictures are not shown");
}
