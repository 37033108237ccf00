use pathtracer::accel::Precision;
use pathtracer::gui::form::{Field, Form};
use pathtracer::gui::settings::{Kept, Knobs, PreviewSize, Theme};
use pathtracer::output::Aov;
use pathtracer::picture::Depth;
use pathtracer::render::{AccelKind, FeatureKind, MAX_SIDE};
use pathtracer::sampling::SamplerKind;
use pathtracer::scene::desc::CameraDesc;
use serde_json::json;
use std::path::Path;

fn camera() -> CameraDesc {
    let scene = pathtracer::scene::parse(super::BALLS, Path::new("balls.yaml"));
    scene.expect("a scene without errors").desc.camera
}

#[test]
fn what_is_kept_between_runs_comes_back() {
    let knobs = Knobs {
        width: 640,
        samples: 0,
        noise: Some(0.02),
        time: Some(12.5),
        exposure: -1.5,
        accel: AccelKind::Native,
        precision: Precision::Robust,
        sampler: SamplerKind::Independent,
        preview: PreviewSize::Half,
        depth: Some(Depth::Sixteen),
        aov: vec![Aov::Feature(FeatureKind::Depth), Aov::Error],
        denoise: true,
        ..Knobs::default()
    };
    let recent = vec!["/a/b.yaml".into(), "/c.yaml".into()];
    let kept = Kept { knobs, recent, theme: Theme::Light, size: [900.0, 700.0], folded: [true, false] };
    assert_eq!(Kept::of(&kept.value()), kept);
}

#[test]
fn what_makes_no_sense_has_its_default() {
    let kept = Kept::of(&json!({
        "width": -5, "samples": "many", "bounces": 0, "time": -1, "exposure": 1e9, "precision": 3, "theme": "Pink",
        "window": [1, 2], "recent": [7, "/a.yaml"],
    }));
    assert_eq!(kept, Kept { recent: vec!["/a.yaml".into()], ..Kept::default() });
    assert_eq!(Kept::of(&json!([1, 2])), Kept::default());
}

#[test]
fn ten_files_are_remembered_the_newest_first_and_each_once() {
    let mut kept = Kept::default();
    for number in 0..12 {
        kept.remember(Path::new(&format!("/nowhere/{number}.yaml")));
    }
    kept.remember(Path::new("/nowhere/5.yaml"));
    let names: Vec<String> =
        kept.recent.iter().map(|path| path.file_stem().expect("a name").to_string_lossy().into()).collect();
    assert_eq!(names, ["5", "11", "10", "9", "8", "7", "6", "4", "3", "2"]);
}

#[test]
fn a_preview_fits_its_place_and_is_never_larger_than_the_picture() {
    let size = |knobs: &Knobs, place| {
        let settings = knobs.preview_settings(place);
        (settings.width, settings.height)
    };
    let knobs = Knobs { width: 1920, height: 1080, ..Knobs::default() };
    assert_eq!(size(&knobs, [960, 2000]), (960, 540));
    assert_eq!(size(&knobs, [4000, 4000]), (1920, 1080));
    assert_eq!(size(&Knobs { preview: PreviewSize::Half, ..knobs.clone() }, [960, 2000]), (480, 270));
    assert_eq!(size(&Knobs { preview: PreviewSize::Full, ..knobs }, [10, 10]), (1920, 1080));
    assert_eq!(size(&Knobs { width: MAX_SIDE, height: 1, ..Knobs::default() }, [100, 100]), (100, 1));
}

#[test]
fn the_fields_show_what_the_scene_says() {
    let (knobs, camera) = (Knobs::default(), camera());
    let shown = |field: Field| field.read(&knobs, &camera);
    assert_eq!(shown(Field::Width), "1280");
    assert_eq!(shown(Field::Fov), "45");
    assert_eq!(shown(Field::Lens), "8");
    assert_eq!(shown(Field::Focus), "6");
    assert_eq!(shown(Field::Position(0)), "-6");
    assert_eq!(shown(Field::LookingAt(2)), "1");
    assert_eq!(shown(Field::Noise), "");
}

#[test]
fn what_is_typed_is_taken_or_marked_with_the_reason() {
    let (mut knobs, mut camera, mut form) = (Knobs::default(), camera(), Form::default());
    assert!(form.type_text(Field::Fov, "90", &mut knobs, &mut camera));
    assert_eq!(camera.fov, 0.5);
    for (field, text, reason) in [
        (Field::Width, "0", "expected a whole number from 1 to 65536"),
        (Field::Height, "1e3", "expected a whole number from 1 to 65536"),
        (Field::Samples, "-1", "expected a whole number from 0 to 4294967296"),
        (Field::Bounces, "-3", "expected a whole number from 1 to 65536"),
        (Field::Noise, "0", "expected a number > 0"),
        (Field::Time, "0.01", "expected a number of at least 0.1"),
        (Field::File, "picture.gif", NAMES),
        (Field::File, ".png", NAMES),
        (Field::File, "", NAMES),
        (Field::Fov, "180", "expected a number > 0 and < 180"),
        (Field::Lens, "-1", "expected a number >= 0"),
        (Field::Focus, "nan", "expected a number > 0"),
        (Field::Roll, "left", "expected a number"),
    ] {
        let before = (knobs.clone(), camera.clone());
        assert!(!form.type_text(field, text, &mut knobs, &mut camera), "{field:?}");
        assert_eq!(form.error(field, &knobs).as_deref(), Some(reason), "{field:?}");
        assert_eq!((knobs.clone(), camera.clone()), before, "{field:?}");
    }
    assert!(form.type_text(Field::Noise, "", &mut knobs, &mut camera));
    assert!(form.type_text(Field::Time, "30", &mut knobs, &mut camera));
    assert!(form.type_text(Field::Samples, "0", &mut knobs, &mut camera), "a time budget needs no limit");
    assert_eq!((knobs.noise, knobs.time, knobs.samples), (None, Some(30.0), 0));
}

/// What the name of a picture is told to be.
const NAMES: &str = "expected a name that ends in .png, .exr, .tif, .tiff, .hdr, .jpg, .jpeg";

#[test]
fn numbers_that_cannot_be_together_are_marked_with_the_reason() {
    let (mut knobs, mut camera, mut form) = (Knobs::default(), camera(), Form::default());
    assert!(form.type_text(Field::Samples, "0", &mut knobs, &mut camera));
    let error = form.error(Field::Samples, &knobs);
    assert_eq!(error.as_deref(), Some("0 needs a noise target or a time budget"));
    assert_eq!(form.wrong(&knobs).map(|(field, _)| field), Some(Field::Samples));
    assert!(form.type_text(Field::Noise, "0.05", &mut knobs, &mut camera));
    assert_eq!((form.error(Field::Samples, &knobs), form.wrong(&knobs)), (None, None));
    // The target goes again, the limit is still missing.
    assert!(form.type_text(Field::Noise, "", &mut knobs, &mut camera));
    assert!(form.wrong(&knobs).is_some());
    let mut large = Knobs { width: MAX_SIDE, height: MAX_SIDE, ..Knobs::default() };
    assert_eq!(form.error(Field::Height, &large).as_deref(), Some("more than 1073741824 pixels in all"));
    large.height = 1 << 14;
    assert_eq!(Form::default().wrong(&large), None);
}

#[test]
fn a_camera_does_not_come_to_look_at_itself() {
    let (mut knobs, mut camera, mut form) = (Knobs::default(), camera(), Form::default());
    for (field, text) in [(Field::LookingAt(0), "-6"), (Field::LookingAt(2), "2")] {
        form.type_text(field, text, &mut knobs, &mut camera);
    }
    let error = form.error(Field::LookingAt(2), &knobs);
    assert_eq!(error.as_deref(), Some("the camera must not look at itself"));
    assert_ne!(camera.position, camera.looking_at);
}

#[test]
fn the_command_line_of_the_window_says_what_differs_from_its_defaults() {
    let knobs = Knobs {
        noise: Some(0.05),
        sampler: SamplerKind::Independent,
        image: "a b.png".into(),
        ..Knobs::default()
    };
    let command = knobs.command(Path::new("scene.yaml"));
    assert_eq!(command, "pathtracer scene.yaml 1280 720 256 20 'a b.png' --sampler independent --noise 0.05");
    let knobs = Knobs {
        exposure: 1.5,
        depth: Some(Depth::Sixteen),
        denoise: true,
        time: Some(90.0),
        ..Knobs::default()
    };
    let command = knobs.command(Path::new("scene.yaml"));
    let options = "--time 90 --exposure 1.5 --depth 16 --denoise";
    assert_eq!(command, format!("pathtracer scene.yaml 1280 720 256 20 picture.png {options}"));
}

#[test]
fn a_picture_gets_what_its_format_can_have() {
    let knobs = Knobs { depth: Some(Depth::Sixteen), aov: vec![Aov::Samples], ..Knobs::default() };
    let of = |name: &str| Knobs { image: name.into(), ..knobs.clone() }.wanted();
    assert_eq!((of("a.png").depth, of("a.png").aov), (Some(Depth::Sixteen), vec![]));
    assert_eq!((of("a.exr").depth, of("a.exr").aov), (None, vec![Aov::Samples]));
}

#[test]
fn a_limit_of_samples_comes_back_where_nothing_else_ends_the_render() {
    let kept = Kept::of(&json!({ "samples": 0, "width": 320 }));
    assert_eq!((kept.knobs.samples, kept.knobs.width), (Knobs::default().samples, 320));
    assert_eq!(Kept::of(&json!({ "samples": 0, "noise": 0.1 })).knobs.samples, 0);
}
