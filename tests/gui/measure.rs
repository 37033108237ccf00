//! What the window costs: prints, and asserts nothing.

use super::panels::window_of;
use super::studio::until;
use super::{SCENES, load, preview, sample, session};
use pathtracer::gui::camera_control;
use pathtracer::gui::settings::{Kept, Knobs};
use pathtracer::gui::studio::Studio;
use pathtracer::render::Settings;
use std::sync::Arc;
use std::time::{Duration, Instant};

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort();
    times[times.len() / 2]
}

#[test]
#[ignore = "a measurement"]
fn from_a_change_to_the_first_picture_and_from_a_stop_to_the_end() {
    for name in SCENES.into_iter().chain(["objectScene", "gallery"]) {
        let loaded = load(&sample(name));
        let session = session();
        let settings = Settings { samples: 1 << 20, error_estimate: true, ..Settings::new(736, 414, 1, 20) };
        let mut editable = loaded.editable.clone();
        session.order(preview(&loaded, &editable, &settings));
        session.wait_for(2);
        let (mut first, mut ends) = (Vec::new(), Vec::new());
        for _ in 0..20 {
            camera_control::orbit(&mut editable.camera, [0.01, 0.0]);
            let start = Instant::now();
            let job = session.order(preview(&loaded, &editable, &settings));
            while session.frame().is_none_or(|frame| frame.job != job) {
                std::thread::yield_now();
            }
            first.push(start.elapsed());
            session.wait_for(1);
            let start = Instant::now();
            session.stop();
            session.wait();
            ends.push(start.elapsed());
        }
        let most = |times: &[Duration]| times.iter().max().copied().unwrap_or_default();
        let (first_most, ends_most) = (most(&first), most(&ends));
        println!(
            "{name}: first picture {:.1?} (most {first_most:.1?}), end {:.1?} (most {ends_most:.1?})",
            median(first),
            median(ends)
        );
    }
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
                window.step();
                start.elapsed()
            })
            .collect();
        let most = times.iter().max().copied().unwrap_or_default();
        println!("{name}: a frame {:.2?} (most {most:.2?})", median(times));
    }
}
