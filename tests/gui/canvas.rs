//! The picture's place, and the mouse on it.

use super::Desk;
use super::panels::{Window, window, window_of};
use super::studio::{opened, until};
use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, Vec2, vec2};
use pathtracer::gui::camera_control as control;
use pathtracer::gui::settings::PreviewSize;
use pathtracer::scene::desc::CameraDesc;
use std::time::{Duration, Instant};

/// Where the picture of 48 x 27 pixels lies: as large as its place allows.
fn picture(window: &Window<'_>) -> Rect {
    let place = window.state().1.canvas.place.expect("a place");
    let scale = (place.width() / 48.0).min(place.height() / 27.0);
    Rect::from_center_size(place.center(), vec2(48.0, 27.0) * scale)
}

fn drag(window: &mut Window<'_>, from: Pos2, by: Vec2, button: PointerButton, modifiers: Modifiers) {
    let press = |pos, pressed| Event::PointerButton { pos, button, pressed, modifiers };
    for event in [
        Event::ModifiersChanged(modifiers),
        Event::PointerMoved(from),
        press(from, true),
        Event::PointerMoved(from + by),
        press(from + by, false),
        Event::ModifiersChanged(Modifiers::NONE),
    ] {
        window.event(event);
        window.step();
    }
    window.run_steps(2);
}

/// The camera before and after a drag from the middle of the picture, and the drag in shares of the picture's sides.
fn dragged(by: Vec2, button: PointerButton, modifiers: Modifiers) -> (CameraDesc, CameraDesc, [f64; 2]) {
    let desk = Desk::new();
    let mut window = window(&desk);
    let camera = |window: &Window<'_>| window.state().0.editable.as_ref().expect("a scene").camera.clone();
    let (before, rect) = (camera(&window), picture(&window));
    drag(&mut window, rect.center(), by, button, modifiers);
    let shares = [by.x / rect.width(), by.y / rect.height()].map(f64::from);
    (before, camera(&window), shares)
}

/// Whether two cameras differ by the rounding of the screen's numbers at most.
fn is_near(a: &CameraDesc, b: &CameraDesc) -> bool {
    let apart = [a.position - b.position, a.looking_at - b.looking_at].map(|by| by.length());
    apart.into_iter().chain([(a.angle - b.angle).abs() / 180.0]).all(|apart| apart < 1e-4)
}

#[test]
fn a_drag_orbits() {
    let (mut camera, after, shares) = dragged(vec2(60.0, 20.0), PointerButton::Primary, Modifiers::NONE);
    control::orbit(&mut camera, shares);
    assert!(is_near(&camera, &after), "{after:?}");
}

#[test]
fn a_drag_with_shift_or_the_middle_button_moves_sideways() {
    for (button, modifiers) in
        [(PointerButton::Primary, Modifiers::SHIFT), (PointerButton::Middle, Modifiers::NONE)]
    {
        let (mut camera, after, shares) = dragged(vec2(-50.0, 30.0), button, modifiers);
        control::pan(&mut camera, shares, 27.0 / 48.0);
        assert!(is_near(&camera, &after), "{button:?}: {after:?}");
    }
}

#[test]
fn a_drag_with_alt_rolls() {
    let (camera, after, [share, _]) = dragged(vec2(80.0, 0.0), PointerButton::Primary, Modifiers::ALT);
    assert!(is_near(&CameraDesc { angle: camera.angle + 180.0 * share, ..camera }, &after), "{after:?}");
    assert_ne!(after.angle, 0.0);
}

#[test]
fn a_drag_with_the_right_button_goes_away() {
    let (mut camera, after, shares) = dragged(vec2(0.0, 40.0), PointerButton::Secondary, Modifiers::NONE);
    control::dolly(&mut camera, libm::exp(2.0 * shares[1]));
    assert!(is_near(&camera, &after), "{after:?}");
}

#[test]
fn the_wipe_between_two_pictures_follows_the_mouse_and_leaves_the_camera() {
    let desk = Desk::new();
    let mut window = window(&desk);
    window.key_press(Key::A);
    window.run_steps(3);
    assert_eq!(window.state().0.wipe, Some(0.5));
    let rect = picture(&window);
    drag(&mut window, rect.center(), vec2(100.0, 0.0), PointerButton::Primary, Modifiers::NONE);
    let (studio, _) = window.state();
    let share = studio.wipe.expect("a wipe");
    assert!((share - 0.5 - 100.0 / rect.width()).abs() < 1e-3, "{share}");
    assert!(!studio.is_edited());
    window.key_press(Key::W);
    window.run_steps(2);
    assert_eq!(window.state().0.wipe, None);
}

#[test]
fn both_pictures_of_a_wipe_are_shown() {
    let desk = Desk::new();
    let mut window = window(&desk);
    window.key_press(Key::A);
    window.run_steps(2);
    let stored = window.state().0.stored.clone().expect("a stored picture");
    window.state_mut().0.edit(|editable| editable.camera.fov = 0.5);
    until(&mut window.state_mut().0, "the new view", |studio| {
        studio.session.frame().is_some_and(|frame| frame.editable.camera.fov == 0.5)
    });
    window.run_steps(2);
    until(&mut window.state_mut().0, "both", |studio| {
        let fov = |display: &pathtracer::gui::display::Display| {
            display.shown().map(|shown| shown.request.frame.editable.camera.fov)
        };
        (fov(&studio.stored_display), fov(&studio.display)) == (Some(stored.editable.camera.fov), Some(0.5))
    });
}

#[test]
fn at_twice_the_scale_a_preview_has_twice_the_sides_and_a_click_finds_the_same() {
    let desk = Desk::new();
    let mut widths = Vec::new();
    for scale in [1.0, 2.0] {
        let mut studio = opened(&desk);
        (studio.kept.knobs.width, studio.kept.knobs.height) = (4800, 2700);
        let mut window = window_of(studio, scale);
        let mut frames = 0;
        while window.state().0.is_settling() || frames < 3 {
            window.step();
            frames += 1;
        }
        let (studio, desk) = window.state();
        let place = desk.canvas.place.expect("a place");
        assert!(place.width() < 1280.0);
        widths.push(studio.preview_settings().width);
        // The ball is in the middle.
        let at = place.center();
        let press = |pressed| Event::PointerButton {
            pos: at,
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        for event in [Event::PointerMoved(at), press(true), press(false)] {
            window.event(event);
        }
        window.step();
        until(&mut window.state_mut().0, "a selection", |studio| studio.selected == Some(1));
    }
    // Sides are rounded to whole pixels.
    assert!(widths[1].abs_diff(2 * widths[0]) <= 2, "{widths:?}");
}

#[test]
fn a_picture_that_is_larger_than_the_graphics_driver_takes_is_shown_smaller() {
    let desk = Desk::new();
    let mut studio = opened(&desk);
    let knobs = &mut studio.kept.knobs;
    (knobs.width, knobs.height, knobs.samples, knobs.preview) = (3000, 2, 1, PreviewSize::Full);
    let mut window = window_of(studio, 1.0);
    window.input_mut().max_texture_side = Some(1024);
    window.step();
    until(&mut window.state_mut().0, "the picture", |studio| {
        studio.session.frame().is_some_and(|frame| frame.size() == [3000, 2])
    });
    // An image that is too large makes egui panic.
    let (start, mut size) = (Instant::now(), [0; 2]);
    while size != [1000, 1] && start.elapsed() < Duration::from_secs(60) {
        window.step();
        size = window.state().1.canvas.shown().map_or(size, |shown| shown.image.size);
    }
    assert_eq!(size, [1000, 1]);
}
