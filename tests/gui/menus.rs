//! Ways to open a scene, and how the window looks.

use super::Desk;
use super::panels::{Window, wait_for_label, window};
use super::studio::until;
use eframe::egui::accesskit::Role;
use eframe::egui::{self, Color32, DroppedFile, Visuals};
use egui_kittest::kittest::Queryable;
use pathtracer::gui::form::wrong_color;
use pathtracer::gui::settings::Theme;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

/// Opens a menu of the bar, and one in it.
fn open_menu(window: &mut Window<'_>, menu: &str, within: Option<&str>) {
    window.get_by_role_and_label(Role::Button, menu).click();
    window.run_steps(3);
    if let Some(within) = within {
        window.get_by_label_contains(within).click();
        window.run_steps(3);
    }
}

/// Waits until a scene is open whose file has this name.
#[track_caller]
fn wait_for_scene(window: &mut Window<'_>, name: &str) {
    until(&mut window.state_mut().0, name, |studio| {
        let loaded = studio.document.loaded.as_ref();
        loaded.is_some_and(|loaded| loaded.path.file_name() == Some(name.as_ref()))
    });
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

#[test]
fn a_file_that_is_dropped_is_opened() {
    let desk = Desk::new();
    desk.write("other.yaml", super::BALLS);
    let mut window = window(&desk);
    window.input_mut().dropped_files.push(Arc::new(Dropped(desk.path("other.yaml"))));
    window.run_steps(2);
    wait_for_scene(&mut window, "other.yaml");
}

#[test]
fn a_scene_that_takes_long_is_said_to_be_read() {
    let desk = Desk::new();
    let mut window = window(&desk);
    // Reading it takes until somebody writes.
    let pipe = desk.path("pipe.yaml");
    let made = Command::new("mkfifo").arg(&pipe).status().expect("mkfifo starts");
    assert!(made.success());
    window.state_mut().0.open(&pipe);
    window.run_steps(2);
    window.get_by_label("reading the scene");
    std::fs::write(&pipe, super::BALLS).expect("somebody who reads");
    wait_for_scene(&mut window, "pipe.yaml");
}

#[test]
fn a_recent_file_is_opened_by_its_menu() {
    let desk = Desk::new();
    desk.write("other.yaml", super::BALLS);
    let mut window = window(&desk);
    window.state_mut().0.kept.remember(&desk.path("other.yaml"));
    open_menu(&mut window, "File", Some("Recent files"));
    // The one that is open is among them too.
    window.get_by_role_and_label(Role::Button, "balls.yaml");
    window.get_by_role_and_label(Role::Button, "other.yaml").click();
    window.run_steps(2);
    wait_for_scene(&mut window, "other.yaml");
}

#[test]
fn an_example_is_opened_by_its_menu() {
    let desk = Desk::new();
    let mut window = window(&desk);
    until(&mut window.state_mut().0, "the examples", |studio| studio.examples.get().is_some());
    open_menu(&mut window, "File", Some("Examples"));
    wait_for_label(&mut window, "cornellBox.yaml");
    window.get_by_role_and_label(Role::Button, "cornellBox.yaml").click();
    window.run_steps(2);
    wait_for_scene(&mut window, "cornellBox.yaml");
}

#[test]
fn the_menu_makes_the_window_light_and_dark() {
    let desk = Desk::new();
    let mut window = window(&desk);
    for (theme, expected) in [(Theme::Light, egui::Theme::Light), (Theme::Dark, egui::Theme::Dark)] {
        open_menu(&mut window, "Look", None);
        window.get_by_label(theme.name()).click();
        window.run_steps(3);
        assert_eq!((window.state().0.kept.theme, window.ctx.theme()), (theme, expected));
        window.key_press(egui::Key::Escape);
        window.run_steps(2);
    }
}

/// The contrast of two colours as WCAG 2.2 defines it: 1 to 21.
fn contrast(a: Color32, b: Color32) -> f32 {
    let luminance = |color: Color32| {
        let [r, g, b, _] = egui::Rgba::from(color).to_array();
        0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05
    };
    let (a, b) = (luminance(a), luminance(b));
    a.max(b) / a.min(b)
}

#[test]
fn mistakes_can_be_read_light_and_dark() {
    for visuals in [Visuals::light(), Visuals::dark()] {
        for ground in [visuals.panel_fill, visuals.extreme_bg_color] {
            // What WCAG asks of small text.
            let contrast = contrast(wrong_color(&visuals), ground);
            assert!(contrast >= 4.5, "{contrast}");
        }
    }
}
