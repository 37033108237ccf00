use super::Desk;
use super::studio::{opened, until};
use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use pathtracer::gui::display::View;
use pathtracer::gui::panels;
use pathtracer::gui::pick::Tool;
use pathtracer::gui::studio::Studio;
use std::time::{Duration, Instant};

/// The widgets of a window without a display.
pub(super) type Window<'w> = Harness<'w, (Studio, panels::Desk)>;

pub(super) fn window<'w>(desk: &Desk) -> Window<'w> {
    window_of(opened(desk), 1.0)
}

/// One whose points have so many pixels.
pub(super) fn window_of<'w>(studio: Studio, scale: f32) -> Window<'w> {
    sized_window_of(studio, [1280.0, 800.0], scale)
}

/// One of so many points.
pub(super) fn sized_window_of<'w>(studio: Studio, size: [f32; 2], scale: f32) -> Window<'w> {
    let builder = Harness::builder().with_size(size).with_pixels_per_point(scale);
    let mut window = builder.build_ui_state(
        |ui, (studio, desk): &mut (Studio, panels::Desk)| desk.show(ui, studio),
        (studio, panels::Desk::default()),
    );
    window.run_steps(3);
    window
}

/// Goes on until a widget with this label is there.
#[track_caller]
pub(super) fn wait_for_label(window: &mut Window<'_>, label: &str) {
    let start = Instant::now();
    while window.query_by_label(label).is_none() {
        assert!(start.elapsed() < Duration::from_secs(60), "waited in vain for {label}");
        window.step();
    }
}

pub(super) fn press(window: &mut Window<'_>, key: Key) {
    window.key_press(key);
    window.run_steps(2);
}

/// Puts a text in the place of what is in a field.
pub(super) fn fill(window: &mut Window<'_>, label: &str, text: &str) {
    window.get_by_role_and_label(Role::TextInput, label).click();
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::A);
    window.run_steps(1);
    window.get_by_role_and_label(Role::TextInput, label).type_text(text);
    window.run_steps(2);
}

fn value(window: &Window<'_>, label: &str) -> String {
    window.get_by_role_and_label(Role::TextInput, label).value().unwrap_or_default()
}

#[test]
fn the_fields_are_filled_from_the_scene() {
    let desk = Desk::new();
    let window = window(&desk);
    assert_eq!(value(&window, "Width"), "48");
    assert_eq!(value(&window, "Field of view (°)"), "45");
    assert_eq!(value(&window, "Depth of field"), "8");
    assert_eq!(value(&window, "Focus distance"), "6");
    assert_eq!(value(&window, "File"), "balls.png");
}

#[test]
fn a_typed_number_changes_the_scene() {
    let desk = Desk::new();
    let mut window = window(&desk);
    fill(&mut window, "Field of view (°)", "90");
    let (studio, _) = window.state();
    assert_eq!(studio.editable.as_ref().expect("a scene").camera.fov, 0.5);
    assert!(studio.is_edited());
}

#[test]
fn a_wrong_value_is_marked_at_its_field_with_the_reason() {
    let desk = Desk::new();
    let mut window = window(&desk);
    fill(&mut window, "Bounces", "none");
    window.get_by_label("expected a whole number from 1 to 65536");
    assert_eq!(window.state().0.kept.knobs.bounces, 8);
    fill(&mut window, "Bounces", "5");
    assert!(window.query_by_label("expected a whole number from 1 to 65536").is_none());
    assert_eq!(window.state().0.kept.knobs.bounces, 5);
}

#[test]
fn a_bad_name_of_the_picture_and_no_end_of_the_samples_are_marked_at_their_fields() {
    let desk = Desk::new();
    let mut window = window(&desk);
    fill(&mut window, "File", "picture.gif");
    window.get_by_label_contains("expected a name that ends in .png");
    assert_eq!(window.state().0.kept.knobs.image, "balls.png");
    fill(&mut window, "File", "picture.png");
    fill(&mut window, "Samples", "0");
    window.get_by_label("0 needs a noise target or a time budget");
    press(&mut window, Key::Enter);
    assert!(!window.state().0.is_final());
    fill(&mut window, "Noise target", "0.05");
    assert!(window.query_by_label("0 needs a noise target or a time budget").is_none());
    let knobs = &window.state().0.kept.knobs;
    assert_eq!((knobs.image.as_str(), knobs.samples, knobs.noise), ("picture.png", 0, Some(0.05)));
}

#[test]
fn enter_in_a_field_starts_the_final_render() {
    let desk = Desk::new();
    let mut window = window(&desk);
    window.state_mut().0.kept.knobs.image = desk.path("window.png").to_string_lossy().into_owned();
    window.run_steps(1);
    fill(&mut window, "Samples", "8");
    press(&mut window, Key::Enter);
    assert!(window.state().0.is_final());
    let studio = &mut window.state_mut().0;
    until(studio, "a file", |studio| studio.session.status().written.is_some());
    desk.command(&"balls.yaml 48 27 8 8 line.png --accel native".split(' ').collect::<Vec<_>>());
    assert!(desk.read("window.png") == desk.read("line.png"));
}

#[test]
fn escape_leaves_a_field() {
    let desk = Desk::new();
    let mut window = window(&desk);
    window.get_by_role_and_label(Role::TextInput, "Width").click();
    window.run_steps(2);
    assert!(window.get_by_role_and_label(Role::TextInput, "Width").is_focused());
    press(&mut window, Key::Escape);
    assert!(!window.get_by_role_and_label(Role::TextInput, "Width").is_focused());
}

#[test]
fn keys_choose_tools_and_views_but_not_while_a_field_has_the_keyboard() {
    let desk = Desk::new();
    let mut window = window(&desk);
    press(&mut window, Key::F);
    assert_eq!(window.state().0.tool, Tool::Focus);
    press(&mut window, Key::Escape);
    assert_eq!(window.state().0.tool, Tool::Select);
    press(&mut window, Key::Num3);
    assert_eq!(window.state().0.view, View::Normals);
    window.get_by_role_and_label(Role::TextInput, "Width").click();
    window.run_steps(2);
    press(&mut window, Key::Num1);
    assert_eq!(window.state().0.view, View::Normals);
}

#[test]
fn the_list_of_keys_opens_and_closes() {
    let desk = Desk::new();
    let mut window = window(&desk);
    press(&mut window, Key::F1);
    window.get_by_label("F, then click; Ctrl + click");
    press(&mut window, Key::Escape);
    assert!(window.query_by_label("F, then click; Ctrl + click").is_none());
}

#[test]
fn a_selected_object_shows_its_material_and_a_slider_changes_it() {
    let desk = Desk::new();
    let mut window = window(&desk);
    window.get_by_label("2 Ball: ball").click();
    window.run_steps(3);
    assert_eq!(window.state().0.selected, Some(1));
    assert_eq!(window.get_all_by_label("Coat").count(), 2);
    let of = |window: &Window<'_>| {
        let editable = window.state().0.editable.clone().expect("a scene");
        editable.surfaces[1].clone().expect("a material of its own")
    };
    assert_eq!(of(&window).coat, 0.5);
    window.get_all_by_role(Role::Slider).last().expect("a slider").set_value_accesskit(0.25);
    window.run_steps(2);
    assert_eq!(of(&window).specularity, 0.25);
}

#[test]
fn the_picture_keeps_its_place_when_an_object_is_selected_and_when_a_field_is_wrong() {
    let desk = Desk::new();
    let mut window = window(&desk);
    let place = |window: &Window<'_>| window.state().1.canvas.place.expect("a place");
    let before = place(&window);
    for object in 0..3 {
        window.state_mut().0.selected = Some(object);
        window.run_steps(3);
        assert_eq!(place(&window), before, "object {object}");
    }
    fill(&mut window, "File", "picture.gif");
    fill(&mut window, "Samples", "many");
    window.run_steps(2);
    assert_eq!(place(&window), before);
}

#[test]
fn errors_of_the_scene_are_shown_with_their_lines() {
    let desk = Desk::new();
    let mut window = window(&desk);
    desk.write("balls.yaml", &super::BALLS.replace("Radius: 1\n", "Radius: -1\n"));
    until(&mut window.state_mut().0, "errors", |studio| !studio.document.diagnostics.is_empty());
    window.run_steps(2);
    window.get_by_label_contains("balls.yaml:23:");
}

#[test]
fn the_buttons_preview_pause_and_stop() {
    let desk = Desk::new();
    let mut window = window(&desk);
    window.state_mut().0.kept.knobs.samples = 1 << 20;
    window.get_by_label("Preview").click();
    window.run_steps(3);
    window.get_by_label("Pause").click();
    window.run_steps(2);
    assert!(window.state().0.session.is_paused());
    window.get_by_label("Go on").click();
    window.run_steps(2);
    assert!(!window.state().0.session.is_paused());
    window.get_by_label("Stop").click();
    window.run_steps(2);
    assert!(!window.state().0.session.wait().is_busy());
}

#[test]
fn an_open_dialog_lists_scenes_and_opens_one() {
    let desk = Desk::new();
    desk.write("other.yaml", super::BALLS);
    let mut window = window(&desk);
    window.key_press_modifiers(Modifiers::COMMAND, Key::O);
    window.run_steps(3);
    wait_for_label(&mut window, "other.yaml");
    window.get_by_label("other.yaml").click();
    window.run_steps(2);
    window.get_by_label("Open").click();
    window.run_steps(2);
    let path = desk.path("other.yaml");
    let studio = &mut window.state_mut().0;
    until(studio, "the other scene", |studio| {
        studio.document.loaded.as_ref().is_some_and(|loaded| loaded.path.file_name() == path.file_name())
    });
}
