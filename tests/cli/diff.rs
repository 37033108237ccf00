//! `pathtracer diff`.

use super::Folder;
use image::{Rgb, RgbImage};
use serde_json::Value;

/// Grey pictures of 40 x 30 pixels; one pixel of `b.png` is white.
fn folder() -> Folder {
    let folder = Folder::new();
    let mut picture = RgbImage::from_pixel(40, 30, Rgb([128; 3]));
    picture.save(folder.path("a.png")).expect("a picture");
    picture.put_pixel(7, 11, Rgb([255; 3]));
    picture.save(folder.path("b.png")).expect("a picture");
    RgbImage::new(40, 31).save(folder.path("c.png")).expect("a picture");
    folder
}

fn metrics(folder: &Folder, pictures: &str) -> Value {
    let ended = folder.run(&format!("diff {pictures} --json"));
    ended.succeeds();
    serde_json::from_str(&ended.stdout).expect("JSON")
}

#[test]
fn equal_pictures_have_no_difference() {
    let metrics = metrics(&folder(), "a.png a.png");
    for name in ["rmse", "relmse", "trelmse", "bias", "flip", "max"] {
        assert_eq!(metrics[name], 0.0, "{name}");
    }
    assert_eq!(metrics["differing"], 0);
}

#[test]
fn the_metrics_are_those_of_linear_light() {
    let metrics = metrics(&folder(), "b.png a.png");
    // The curve's value at 128 / 255; one of 1200 pixels is 1 instead. f32 keeps seven digits.
    let grey = ((128.0f64 / 255.0 + 0.055) / 1.055).powf(2.4);
    let square = (1.0 - grey) * (1.0 - grey);
    let near = |name: &str, expected: f64| {
        let value = metrics[name].as_f64().expect("a number");
        assert!((value - expected).abs() <= 1e-6 * expected, "{name}: {value} instead of {expected}");
    };
    near("rmse", (square / 1200.0).sqrt());
    near("relmse", square / 1200.0 / (grey * grey + 0.01));
    near("bias", (1.0 - grey) / 1200.0 / grey);
    near("max", 1.0 - grey);
    assert_eq!(metrics["differing"], 1);
    assert_eq!((&metrics["worst"][0]["x"], &metrics["worst"][0]["y"]), (&7.into(), &11.into()));
}

#[test]
fn formats_may_differ() {
    let folder = Folder::new();
    for name in ["a.png", "a.exr"] {
        folder.run(&format!("ball.yaml 16 12 4 3 {name}")).succeeds();
    }
    // A byte is off by at most half a step of the curve, whose slope is below 2.4 / 1.055: 0.5 / 255 x 2.28.
    folder.run("diff a.png a.exr --fail-above max=0.0046").succeeds();
}

#[test]
fn a_metric_above_its_limit_ends_with_code_4() {
    let folder = folder();
    folder.run("diff b.png a.png --fail-above max=1 --fail-above flip=1").succeeds();
    let ended = folder.run("diff b.png a.png --fail-above rmse=0.001 --fail-above max=1");
    ended.fails(4, "error: rmse is 0.02");
    assert!(!ended.stderr.contains("max"));
}

#[test]
fn a_picture_with_nan_is_above_every_limit() {
    let folder = folder();
    let mut picture = image::Rgb32FImage::from_pixel(4, 3, Rgb([0.5; 3]));
    picture.save(folder.path("a.exr")).expect("a picture");
    picture.put_pixel(1, 1, Rgb([f32::NAN, 0.5, 0.5]));
    picture.save(folder.path("nan.exr")).expect("a picture");
    for metric in ["rmse", "relmse", "max"] {
        folder.run(&format!("diff nan.exr a.exr --fail-above {metric}=1e30")).fails(4, metric);
    }
}

#[test]
fn what_cannot_be_compared_ends_with_code_1() {
    let folder = folder();
    folder.run("diff a.png c.png").fails(1, "the sizes differ: 40 x 30 and 40 x 31 pixels");
    folder.run("diff a.png missing.png").fails(1, "cannot read the picture missing.png: ");
    folder.run("diff ball.yaml a.png").fails(1, "cannot read the picture ball.yaml: ");
    folder.run("diff a.png a.png --fail-above noise=1").fails(2, "unknown metric");
    folder.run("diff a.png a.png --fail-above flip=-1").fails(2, "expected a number >= 0");
}

#[test]
fn the_difference_is_written_as_a_picture() {
    let folder = folder();
    for name in ["d.png", "d.exr"] {
        folder.run(&format!("diff b.png a.png -o {name}")).succeeds();
        let picture = image::open(folder.path(name)).expect("a picture").into_rgb32f();
        assert_eq!((picture.width(), picture.height()), (40, 30));
        assert_eq!(picture.get_pixel(39, 29).0, [0.0; 3]);
        assert!(picture.get_pixel(7, 11).0[0] > 0.5);
    }
}
