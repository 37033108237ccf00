use super::{BALLS, Desk, sample};
use pathtracer::gui::form::Field;
use pathtracer::gui::pick::Tool;
use pathtracer::gui::session::Stage;
use pathtracer::gui::settings::{Kept, Knobs};
use pathtracer::gui::studio::Studio;
use pathtracer::math::Rgb;
use pathtracer::output::Aov;
use pathtracer::picture::Depth;
use pathtracer::render::{AccelKind, Ended, FeatureKind};
use pathtracer::scene::desc::MaterialKind;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

/// A window without widgets, with a small picture.
pub(super) fn studio() -> Studio {
    let knobs = Knobs {
        width: 48,
        height: 27,
        samples: 16,
        bounces: 8,
        accel: AccelKind::Native,
        ..Knobs::default()
    };
    Studio::new(Kept { knobs, ..Kept::default() }, Arc::new(|| {}))
}

/// Goes on until something holds.
#[track_caller]
pub(super) fn until(studio: &mut Studio, what: &str, mut holds: impl FnMut(&mut Studio) -> bool) {
    let start = Instant::now();
    loop {
        studio.update();
        if holds(studio) {
            return;
        }
        assert!(start.elapsed() < Duration::from_secs(60), "{what}: {:?}", studio.session.status());
        thread::yield_now();
    }
}

/// A scene is open and its preview has ended.
pub(super) fn opened(desk: &Desk) -> Studio {
    let mut studio = studio();
    studio.open(&desk.path("balls.yaml"));
    until(&mut studio, "a preview", |studio| studio.session.status().stage == Stage::Done(Ended::Complete));
    studio
}

fn line_of(studio: &Studio) -> Vec<usize> {
    studio.document.diagnostics.iter().filter_map(|one| Some(one.location.as_ref()?.line)).collect()
}

#[test]
fn a_file_that_changes_is_read_again() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    let first = studio.session.frame().expect("a picture").job;
    desk.write("balls.yaml", &BALLS.replace("FocusDistance: 6 ", "FocusDistance: 3.5 "));
    until(&mut studio, "another preview", |studio| {
        let status = studio.session.status();
        status.job > first && status.stage == Stage::Done(Ended::Complete)
    });
    assert_eq!(studio.editable.as_ref().expect("a scene").camera.focus_distance, 3.5);
}

#[test]
fn a_file_with_errors_shows_their_lines_and_keeps_the_last_good_picture() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    let before = studio.session.frame().expect("a picture");
    desk.write("balls.yaml", &BALLS.replace("Radius: 1\n", "Radius: -1\n").replace("Fov: 0.25", "Fov: 45"));
    until(&mut studio, "errors", |studio| studio.document.diagnostics.len() == 2);
    assert_eq!(line_of(&studio), [5, 23]);
    let after = studio.session.frame().expect("still a picture");
    assert!(Arc::ptr_eq(&before, &after));
    desk.write("balls.yaml", BALLS);
    until(&mut studio, "no errors", |studio| studio.document.diagnostics.is_empty());
}

#[test]
fn a_file_that_was_changed_elsewhere_is_not_overwritten() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.edit(|editable| editable.camera.fov = 0.5);
    let mistaken = BALLS.replace("Radius: 1\n", "Radius: -1\n");
    desk.write("balls.yaml", &mistaken);
    studio.save_scene(None);
    studio.finish_saving();
    let notice = studio.notice.clone().expect("a notice");
    assert!(notice.is_error && notice.text.contains("has changed since it was read"), "{notice:?}");
    assert_eq!(fs::read_to_string(desk.path("balls.yaml")).expect("a file"), mistaken);
    // Elsewhere it may go.
    studio.save_scene(Some(&desk.path("other.yaml")));
    studio.finish_saving();
    assert!(desk.path("other.yaml").exists());
}

#[test]
fn another_scene_has_to_be_asked_for_twice_if_there_are_changes() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    let other = desk.path("other.yaml");
    desk.write("other.yaml", BALLS);
    studio.edit(|editable| editable.camera.fov = 0.5);
    studio.open(&other);
    assert!(!studio.document.is_reading() && studio.is_edited());
    studio.open(&other);
    until(&mut studio, "the other scene", |studio| studio.document.path.as_ref() == Some(&other));
    until(&mut studio, "its own camera", |studio| !studio.is_edited());
}

#[test]
fn a_file_that_is_missing_is_told() {
    let desk = Desk::new();
    let mut studio = studio();
    studio.open(&desk.path("missing.yaml"));
    until(&mut studio, "a message", |studio| !studio.document.diagnostics.is_empty());
    assert!(studio.document.diagnostics[0].message.starts_with("cannot read the scene"));
}

#[test]
fn changes_in_the_window_survive_changes_of_the_file_elsewhere() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.edit(|editable| editable.camera.fov = 0.5);
    desk.write("balls.yaml", &BALLS.replace("[0.8, 0.1, 0.1]", "[0.1, 0.1, 0.8]"));
    until(&mut studio, "the new colour", |studio| {
        let editable = studio.editable.as_ref().expect("a scene");
        editable.surfaces[1].as_ref().is_some_and(|surface| surface.color.z == 0.8)
    });
    assert_eq!(studio.editable.as_ref().expect("a scene").camera.fov, 0.5);
    assert!(studio.is_edited());
}

#[test]
fn a_change_starts_a_preview_that_shows_it() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.edit(|editable| editable.camera.fov = 0.5);
    until(&mut studio, "the new view", |studio| {
        studio.session.frame().is_some_and(|frame| frame.editable.camera.fov == 0.5)
    });
}

#[test]
fn enter_renders_the_file_of_the_command_line() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.kept.knobs.image = desk.path("window.png").to_string_lossy().into_owned();
    studio.kept.knobs.exposure = 0.5;
    studio.kept.knobs.noise = Some(0.2);
    studio.kept.knobs.samples = 64;
    studio.render();
    until(&mut studio, "a word of the file", |studio| {
        studio.notice.as_ref().is_some_and(|notice| notice.text.ends_with("window.png is written"))
    });
    let arguments = "balls.yaml 48 27 64 8 line.png --accel native --exposure 0.5 --noise 0.2";
    desk.command(&arguments.split(' ').collect::<Vec<_>>());
    assert!(desk.read("window.png") == desk.read("line.png"));
    assert!(studio.is_final());
}

#[test]
fn the_picture_of_a_final_render_survives_another_size_of_the_window_but_no_change() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.kept.knobs.image = desk.path("window.png").to_string_lossy().into_owned();
    studio.render();
    let job = studio.session.status().job;
    studio.set_place([30, 20]);
    until(&mut studio, "a file", |studio| studio.session.status().written.is_some());
    until(&mut studio, "the new size", |studio| {
        studio.set_place([30, 20]);
        !studio.is_settling()
    });
    assert_eq!(studio.preview_settings().width, 30);
    studio.update();
    assert_eq!(studio.session.status().job, job);
    studio.edit(|editable| editable.camera.fov = 0.5);
    studio.update();
    assert_eq!(studio.session.status().job, job + 1);
    assert!(!studio.is_final());
}

#[test]
fn a_final_render_that_cannot_be_written_says_why() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.kept.knobs.image = desk.path("picture.gif").to_string_lossy().into_owned();
    studio.render();
    until(&mut studio, "a message", |studio| studio.notice.as_ref().is_some_and(|notice| notice.is_error));
    let text = studio.notice.clone().expect("a message").text;
    assert!(text.contains("has no known extension"), "{text}");
    assert_eq!(studio.form.error(Field::File, &studio.kept.knobs), Some(text));
}

#[test]
fn a_file_that_cannot_be_written_is_marked_until_it_can() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.kept.knobs.image = desk.path("out/picture.png").to_string_lossy().into_owned();
    studio.render();
    until(&mut studio, "a message", |studio| studio.notice.as_ref().is_some_and(|notice| notice.is_error));
    assert!(
        studio.form.error(Field::File, &studio.kept.knobs).is_some_and(|why| why.starts_with("cannot write"))
    );
    fs::create_dir(desk.path("out")).expect("a folder");
    studio.render();
    until(&mut studio, "a file", |studio| studio.session.status().written.is_some());
    assert_eq!(studio.form.error(Field::File, &studio.kept.knobs), None);
}

#[test]
fn a_picture_that_cannot_be_written_when_the_window_closes_is_kept_as_a_film() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.kept.knobs.image = desk.path("window.png").to_string_lossy().into_owned();
    studio.kept.knobs.samples = 1 << 20;
    studio.render();
    studio.session.wait_for(2);
    // What comes in its way stands there as a folder.
    fs::create_dir(desk.path("window.png")).expect("a folder");
    assert!(!studio.close(), "the window must not close");
    let samples = studio.session.frame().expect("a picture").samples;
    let notice = studio.notice.clone().expect("a message");
    assert!(notice.is_error && notice.text.contains("`pathtracer merge"), "{notice:?}");
    desk.command(&["merge", "window.png.film", "merged.png"]);
    let arguments = format!("balls.yaml 48 27 {samples} 8 line.png --accel native");
    desk.command(&arguments.split(' ').collect::<Vec<_>>());
    assert!(desk.read("merged.png") == desk.read("line.png"));
    assert!(studio.close(), "there is nothing left to be lost");
}

#[test]
fn a_scene_that_cannot_be_saved_when_the_window_closes_keeps_it_open() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.edit(|editable| editable.camera.fov = 0.5);
    studio.save_scene(Some(&desk.path("nowhere/balls.yaml")));
    assert!(!studio.close());
    assert!(studio.notice.as_ref().is_some_and(|notice| notice.is_error), "{:?}", studio.notice);
}

#[test]
fn a_picture_with_channels_has_the_bytes_of_its_command_line() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    let knobs = &mut studio.kept.knobs;
    knobs.image = desk.path("window.exr").to_string_lossy().into_owned();
    knobs.depth = Some(Depth::Half);
    knobs.aov = vec![Aov::Feature(FeatureKind::Normal), Aov::Samples, Aov::Error];
    let command = Knobs { image: "line.exr".into(), ..knobs.clone() }.command(Path::new("balls.yaml"));
    studio.render();
    until(&mut studio, "a file", |studio| studio.session.status().written.is_some());
    desk.command(&command.split(' ').skip(1).collect::<Vec<_>>());
    assert!(desk.read("window.exr") == desk.read("line.exr"), "{command}");
}

/// Tests where the denoiser is found.
#[test]
fn a_denoised_picture_and_the_noisy_one_have_the_bytes_of_their_command_line() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    let knobs = &mut studio.kept.knobs;
    knobs.image = desk.path("window.png").to_string_lossy().into_owned();
    knobs.denoise = true;
    let command = Knobs { image: "line.png".into(), ..knobs.clone() }.command(Path::new("balls.yaml"));
    studio.render();
    until(&mut studio, "an end", |studio| !studio.is_rendering_final());
    if let Stage::Failed(why) = studio.session.status().stage {
        assert!(why.contains("pip install pyoidn"), "{why}");
        println!("no denoiser here: nothing is tested");
        return;
    }
    desk.command(&command.split(' ').skip(1).collect::<Vec<_>>());
    assert!(desk.read("window.png") == desk.read("line.png"), "{command}");
    assert!(desk.read("window.noisy.png") == desk.read("line.noisy.png"));
    assert!(desk.read("window.png") != desk.read("window.noisy.png"));
}

#[test]
fn a_material_file_of_a_mesh_is_watched() {
    let desk = Desk::new();
    let color = |red: &str| format!("newmtl wall\nKd {red} 0 0\n");
    desk.write("wall.mtl", &color("0.5"));
    desk.write("wall.obj", "mtllib wall.mtl\nv 0 -1 0\nv 0 1 0\nv 0 0 2\nusemtl wall\nf 1 2 3\n");
    let mesh = "  - Object:\n      Type: TriangleMesh\n      Filepath: wall.obj\n      Position: [0, 0, 0]\n      \
                Material: FromFile\n";
    desk.write("balls.yaml", &format!("{BALLS}{mesh}"));
    let mut studio = opened(&desk);
    let first = studio.session.frame().expect("a picture").job;
    desk.write("wall.mtl", &color("0.125"));
    until(&mut studio, "another preview", |studio| studio.session.status().job > first);
    let loaded = studio.document.loaded.clone().expect("a scene");
    let kind = &loaded.scene.desc.objects[3].material.kind;
    assert!(matches!(kind, MaterialKind::Diffuse { color, .. } if color.x == 0.125), "{kind:?}");
}

#[test]
fn a_wrong_field_stops_the_final_render() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    let mut camera = studio.editable.as_ref().expect("a scene").camera.clone();
    studio.form.type_text(Field::Width, "many", &mut studio.kept.knobs, &mut camera);
    studio.render();
    let notice = studio.notice.clone().expect("a message");
    assert_eq!(notice.text, "Width: expected a whole number from 1 to 65536");
    assert!(!studio.is_final());
}

#[test]
fn closing_during_a_final_render_writes_its_picture_so_far() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.kept.knobs.image = desk.path("window.png").to_string_lossy().into_owned();
    studio.kept.knobs.samples = 1 << 20;
    studio.render();
    studio.session.wait_for(2);
    assert!(studio.close());
    let samples = studio.session.frame().expect("a picture").samples;
    let arguments = format!("balls.yaml 48 27 {samples} 8 line.png --accel native");
    desk.command(&arguments.split(' ').collect::<Vec<_>>());
    assert!(desk.read("window.png") == desk.read("line.png"));
}

#[test]
fn a_saved_scene_is_the_file_and_no_longer_edited() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.edit(|editable| editable.camera.focus_distance = 5.5);
    assert!(studio.is_edited());
    studio.save_scene(None);
    studio.finish_saving();
    assert!(!studio.is_edited());
    let expected = BALLS.replace("FocusDistance: 6 ", "FocusDistance: 5.5 ");
    assert_eq!(String::from_utf8(desk.read("balls.yaml")).expect("UTF-8"), expected);
    studio.edit(|editable| editable.camera.focus_distance = 6.0);
    studio.save_scene(Some(&desk.path("other.yaml")));
    studio.finish_saving();
    assert_eq!(String::from_utf8(desk.read("other.yaml")).expect("UTF-8"), BALLS);
    assert_eq!(studio.document.path, Some(desk.path("other.yaml")));
}

#[test]
fn changes_are_undone_and_done_again() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.edit(|editable| editable.camera.fov = 0.5);
    studio.undo(true);
    assert!(!studio.is_edited());
    studio.undo(false);
    assert_eq!(studio.editable.as_ref().expect("a scene").camera.fov, 0.5);
    studio.reset_camera();
    assert!(!studio.is_edited());
}

#[test]
fn a_click_selects_focuses_and_looks() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    let frame = studio.session.frame().expect("a picture");
    studio.click(Arc::clone(&frame), [24.0, 13.5], Tool::Select);
    until(&mut studio, "a selection", |studio| studio.selected == Some(1));
    studio.click(Arc::clone(&frame), [24.0, 13.5], Tool::Focus);
    until(&mut studio, "a focus", |studio| studio.is_edited());
    let distance = studio.editable.as_ref().expect("a scene").camera.focus_distance;
    assert!((distance - (37.0f64.sqrt() - 1.0)).abs() < 1e-12, "{distance}");
    studio.click(frame, [24.0, 0.5], Tool::LookAt);
    until(&mut studio, "a message", |studio| studio.notice.is_some());
    assert_eq!(studio.notice.clone().expect("a message").text, "there is only sky");
}

#[test]
fn a_saved_preview_is_the_picture_of_the_command_line() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.edit(|editable| editable.camera.fov = 0.5);
    until(&mut studio, "the new view", |studio| {
        let is_new = studio.session.frame().is_some_and(|frame| frame.editable.camera.fov == 0.5);
        is_new && studio.session.status().stage == Stage::Done(Ended::Complete)
    });
    studio.save_picture(&desk.path("window.exr"), None);
    until(&mut studio, "a file", |studio| studio.notice.is_some());
    studio.save_scene(None);
    studio.finish_saving();
    desk.command(&"balls.yaml 48 27 16 8 line.exr --accel native".split(' ').collect::<Vec<_>>());
    assert!(desk.read("window.exr") == desk.read("line.exr"));
}

#[test]
fn a_preview_is_saved_in_the_depth_that_is_asked_for() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    studio.save_picture(&desk.path("window.png"), Some(Depth::Sixteen));
    until(&mut studio, "a file", |studio| studio.notice.is_some());
    desk.command(&"balls.yaml 48 27 16 8 line.png --accel native --depth 16".split(' ').collect::<Vec<_>>());
    assert!(desk.read("window.png") == desk.read("line.png"));
}

#[test]
fn a_picture_of_a_file_is_compared_with_if_it_has_the_size() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    for (size, name) in [("48 27", "same.exr"), ("16 9", "small.exr")] {
        let arguments = format!("balls.yaml {size} 16 8 {name} --accel native");
        desk.command(&arguments.split(' ').collect::<Vec<_>>());
    }
    studio.store_file(&desk.path("same.exr"));
    until(&mut studio, "the picture", |studio| studio.stored_file == Some(desk.path("same.exr")));
    let (stored, shown) =
        (studio.stored.clone().expect("a picture"), studio.session.frame().expect("a picture"));
    // The file holds floats.
    let is_same = |(a, b): (&Rgb, &Rgb)| a.to_array() == b.to_array().map(|value| f64::from(value as f32));
    assert!(stored.light.iter().zip(&shown.light).all(is_same));
    assert_eq!((stored.size(), studio.wipe), (shown.size(), Some(0.5)));
    studio.store_file(&desk.path("small.exr"));
    until(&mut studio, "a message", |studio| studio.notice.is_some());
    let notice = studio.notice.clone().expect("a message");
    assert!(
        notice.is_error && notice.text.contains("16 x 9 pixels") && notice.text.contains("48 x 27"),
        "{notice:?}"
    );
    assert_eq!(studio.stored_file, Some(desk.path("same.exr")));
}

#[test]
fn a_scene_that_names_files_is_saved_in_another_folder() {
    let desk = Desk::new();
    let mut studio = studio();
    studio.open(&sample("gallery"));
    until(&mut studio, "the scene", |studio| studio.document.loaded.is_some());
    studio.edit(|editable| editable.camera.fov = 0.25);
    studio.save_scene(Some(&desk.path("gallery.yaml")));
    studio.finish_saving();
    let notice = studio.notice.clone().expect("a message");
    assert!(!notice.is_error && notice.text.ends_with("gallery.yaml is saved"), "{notice:?}");
    assert!(!studio.is_edited());
    desk.command(&["check", "gallery.yaml"]);
}
