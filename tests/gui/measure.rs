//! What the window costs: prints, and asserts nothing.

use super::panels::{Window, window_of};
use super::studio::until;
use super::{load, preview, sample, session};
use pathtracer::gui::camera_control;
use pathtracer::gui::session::Session;
use pathtracer::gui::settings::{Kept, Knobs};
use pathtracer::gui::studio::Studio;
use pathtracer::math::Rgb;
use pathtracer::render::Settings;
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// The scenes that are measured.
const ALL: [&str; 7] =
    ["bigBalls", "cornellBox", "glassBalls", "mirrorRoom", "legacyBalls", "objectScene", "gallery"];

fn print(what: &str, scene: &str, mut times: Vec<Duration>) {
    times.sort();
    println!("{scene}: {what} {:.1?} (most {:.1?})", times[times.len() / 2], times[times.len() - 1]);
}

/// Of a preview in a window of 1280 x 800.
fn settings() -> Settings {
    Settings { samples: 1 << 20, error_estimate: true, ..Settings::new(736, 414, 1, 20) }
}

#[test]
#[ignore = "a measurement"]
fn from_a_change_to_the_first_picture_and_from_a_stop_to_the_end() {
    for name in ALL {
        let loaded = load(&sample(name));
        let session = session();
        let settings = settings();
        let mut editable = loaded.editable.clone();
        session.order(preview(&loaded, &editable, &settings));
        session.wait_for(2);
        let (mut first, mut ends) = (Vec::new(), Vec::new());
        for _ in 0..20 {
            camera_control::orbit(&mut editable.camera, [0.01, 0.0]);
            let start = Instant::now();
            let job = session.order(preview(&loaded, &editable, &settings));
            wait_for_frame(&session, job);
            first.push(start.elapsed());
            session.wait_for(1);
            let start = Instant::now();
            session.stop();
            session.wait();
            ends.push(start.elapsed());
        }
        print("first picture after a move", name, first);
        print("end after a stop", name, ends);
    }
}

/// Waits for the first frame of an order.
fn wait_for_frame(session: &Session, job: u64) {
    while session.frame().is_none_or(|frame| frame.job != job) {
        std::thread::yield_now();
    }
}

#[test]
#[ignore = "a measurement"]
fn from_opening_a_scene_and_from_a_change_of_a_material_to_the_first_picture() {
    for name in ALL {
        let (mut opened, mut changed) = (Vec::new(), Vec::new());
        for _ in 0..10 {
            let session = session();
            let settings = settings();
            let start = Instant::now();
            let loaded = load(&sample(name));
            wait_for_frame(&session, session.order(preview(&loaded, &loaded.editable, &settings)));
            opened.push(start.elapsed());
            let mut editable = loaded.editable.clone();
            let surface = editable.surfaces.iter_mut().flatten().next().expect("a material of its own");
            surface.color = Rgb::splat(0.25);
            let start = Instant::now();
            wait_for_frame(&session, session.order(preview(&loaded, &editable, &settings)));
            changed.push(start.elapsed());
        }
        print("first picture after opening", name, opened);
        print("first picture after a change of a material", name, changed);
    }
}

#[test]
#[ignore = "a measurement"]
fn from_opening_a_scene_to_its_first_painted_picture() {
    for name in ALL {
        let mut painted = Vec::new();
        for _ in 0..20 {
            let (waker, woken) = channel();
            let wake = move || {
                // A window that is gone wants no frames.
                let _ = waker.send(());
            };
            let studio = Studio::new(Kept::default(), Arc::new(wake));
            let mut window = window_of(studio, 1.0);
            let start = Instant::now();
            window.state_mut().0.open(&sample(name));
            // The window draws a frame when there is something new, as on the desktop.
            while window.state().1.canvas.shown().is_none() {
                woken.recv().expect("a frame to draw");
                woken.try_iter().count();
                draw(&mut window);
            }
            painted.push(start.elapsed());
        }
        print("first painted picture after opening", name, painted);
    }
}

/// A frame, with what the real window does before the graphics driver has its turn.
fn draw(window: &mut Window<'_>) {
    window.step();
    let output = window.output();
    let meshes = window.ctx.tessellate(output.shapes.clone(), output.pixels_per_point);
    assert!(!meshes.is_empty());
}

#[test]
#[ignore = "a measurement"]
fn a_frame_of_the_window_while_all_cores_render() {
    for name in ["glassBalls", "legacyBalls", "gallery"] {
        let kept = Kept { knobs: Knobs { samples: 1 << 20, ..Knobs::default() }, ..Kept::default() };
        let mut studio = Studio::new(kept, Arc::new(|| {}));
        studio.open(&sample(name));
        until(&mut studio, "a picture", |studio| {
            studio.session.frame().is_some_and(|frame| !frame.is_coarse)
        });
        let mut window = window_of(studio, 1.0);
        let times: Vec<Duration> = (0..200)
            .map(|_| {
                let start = Instant::now();
                draw(&mut window);
                start.elapsed()
            })
            .collect();
        print("a frame with its triangles", name, times);
    }
}
