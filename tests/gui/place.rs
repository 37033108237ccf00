//! The place of the picture: the same whatever is said beside it, and large enough in a small window.

use super::panels::{Window, press, sized_window_of};
use super::studio::{opened, until};
use super::{BALLS, Desk};
use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Rect};
use egui_kittest::kittest::Queryable;
use pathtracer::gui::panels::{NARROW, Side};
use pathtracer::gui::session::{Frame, Stage};
use pathtracer::gui::studio::Notice;
use pathtracer::render::Ended;
use std::time::{Duration, Instant};

/// Points on the left and right together that the tests' frame around the widgets takes from the window.
const MARGINS: f32 = 16.0;

fn place(window: &Window<'_>) -> Rect {
    window.state().1.canvas.place.expect("a place")
}

/// A window of this size with a picture that is as high as its place.
fn tall<'w>(desk: &Desk, size: [f32; 2]) -> Window<'w> {
    let mut studio = opened(desk);
    (studio.kept.knobs.width, studio.kept.knobs.height) = (300, 1200);
    sized_window_of(studio, size, 1.0)
}

#[test]
fn the_place_of_a_tall_picture_is_the_same_whatever_is_told() {
    let desk = Desk::new();
    for size in [[880.0, 800.0], [1280.0, 800.0]] {
        let mut window = tall(&desk, size);
        let before = place(&window);
        let mut check = |what: &str, change: &dyn Fn(&mut Window<'_>)| {
            change(&mut window);
            window.run_steps(3);
            assert_eq!(place(&window), before, "{what} in {size:?}");
        };
        check("a notice", &|window| window.state_mut().0.say("a picture is written".into()));
        check("a long notice", &|window| window.state_mut().0.say("many words ".repeat(100)));
        check("an error", &|window| window.state_mut().0.say_error("went wrong\n".repeat(300)));
        check("a long status", &|window| {
            let knobs = &mut window.state_mut().0.kept.knobs;
            (knobs.noise, knobs.time) = (Some(0.012_345), Some(98_765.4));
        });
        check("errors of the scene", &|window| {
            desk.write("balls.yaml", &BALLS.replace("Radius: ", "Radius: -"));
            until(&mut window.state_mut().0, "errors", |studio| !studio.document.diagnostics.is_empty());
        });
        check("nothing", &|window| window.state_mut().0.put_messages_away());
        desk.write("balls.yaml", BALLS);
    }
}

/// Draws until something holds.
#[track_caller]
fn draw_until(window: &mut Window<'_>, what: &str, holds: impl Fn(&Window<'_>) -> bool) {
    let start = Instant::now();
    while !holds(window) {
        assert!(start.elapsed() < Duration::from_secs(60), "{what}");
        window.step();
    }
}

#[test]
fn a_preview_that_is_as_high_as_its_place_ends_and_is_not_started_anew_by_words() {
    let desk = Desk::new();
    let mut window = tall(&desk, [880.0, 800.0]);
    window.state_mut().0.kept.knobs.samples = 8;
    draw_until(&mut window, "a preview that fills its place", |window| {
        let studio = &window.state().0;
        let height = place(window).height() as u32;
        let is_whole = |frame: &Frame| (frame.samples, frame.settings.height) == (8, height);
        studio.session.status().stage == Stage::Done(Ended::Complete)
            && studio.session.frame().is_some_and(|frame| is_whole(&frame))
    });
    let job = window.state().0.session.status().job;
    for is_error in [false, true] {
        let text = "many words ".repeat(200);
        window.state_mut().0.notice = Some(Notice { text, is_error });
        let start = Instant::now();
        // Longer than a preview waits for a place to keep its size.
        draw_until(&mut window, "time", |_| start.elapsed() > Duration::from_millis(300));
        assert_eq!(window.state().0.session.status().job, job);
    }
}

#[test]
fn a_long_error_covers_less_than_half_of_the_picture_and_can_be_put_away() {
    let desk = Desk::new();
    let mut window = tall(&desk, [1280.0, 800.0]);
    window.state_mut().0.say_error("went wrong\n".repeat(300));
    window.run_steps(3);
    let close = window.get_by_role_and_label(Role::Button, "x").rect();
    let place = place(&window);
    assert!(close.top() > place.center().y && close.bottom() < place.bottom(), "{close} in {place}");
    window.get_by_role_and_label(Role::Button, "x").click();
    window.run_steps(3);
    assert_eq!(window.state().0.notice, None);
}

#[test]
fn a_narrow_window_folds_its_panels_away_and_keys_unfold_one() {
    let desk = Desk::new();
    let mut window = sized_window_of(opened(&desk), [640.0, 400.0], 2.0);
    let has_field = |window: &Window<'_>| window.query_all_by_label("Focus distance").count() > 0;
    let has_list = |window: &Window<'_>| window.query_all_by_label("2 Ball: ball").count() > 0;
    assert!(!has_field(&window) && !has_list(&window));
    assert!(
        place(&window).width() == 640.0 - MARGINS && place(&window).height() > 280.0,
        "{}",
        place(&window)
    );
    press(&mut window, Key::L);
    assert!(has_field(&window) && !has_list(&window));
    assert!(place(&window).width() > 320.0, "{}", place(&window));
    press(&mut window, Key::O);
    assert!(!has_field(&window) && has_list(&window));
    assert!(place(&window).width() > 320.0, "{}", place(&window));
    press(&mut window, Key::O);
    assert!(!has_field(&window) && !has_list(&window));
    // What a narrow window shows is not kept.
    assert_eq!(window.state().0.kept.folded, [false; 2]);
}

#[test]
fn a_wide_window_keeps_which_panels_are_folded_away() {
    let desk = Desk::new();
    let mut window = sized_window_of(opened(&desk), [1280.0, 800.0], 1.0);
    let before = place(&window);
    for (side, key) in Side::ALL.into_iter().zip([Key::L, Key::O]) {
        press(&mut window, key);
        assert!(!window.state().1.sides.is_shown(side, &window.state().0.kept));
    }
    assert_eq!((window.state().0.kept.folded, place(&window).width()), ([true; 2], 1280.0 - MARGINS));
    press(&mut window, Key::L);
    press(&mut window, Key::O);
    assert_eq!((window.state().0.kept.folded, place(&window)), ([false; 2], before));
}

#[test]
fn everything_in_the_bar_lies_in_the_window_also_where_it_is_narrow() {
    let desk = Desk::new();
    for width in [640.0, NARROW - 1.0, NARROW] {
        let window = sized_window_of(opened(&desk), [width, 400.0], 1.0);
        for label in ["File", "Edit", "Look", "Help", "Preview", "Pause", "Stop", "Fields", "Objects"] {
            let rect = window.get_by_role_and_label(Role::Button, label).rect();
            assert!(rect.right() <= width, "{label} of {width}: {rect}");
        }
        let lists = window.get_all_by_role(Role::ComboBox).map(|node| node.rect());
        assert!(
            lists.max_by(|a, b| a.right().total_cmp(&b.right())).is_some_and(|rect| rect.right() <= width)
        );
    }
}
