use super::{Desk, load, preview, sample, session, small};
use crate::support::random::Random;
use eframe::egui::{Rect, Vec2, pos2};
use pathtracer::gui::camera_control as control;
use pathtracer::gui::display::{Request, View, ramp, show};
use pathtracer::gui::forecast::{forecasts, samples_to};
use pathtracer::gui::panels::{Zoom, pixel_at};
use pathtracer::gui::pick;
use pathtracer::gui::session::{BlockErrors, Frame, Status};
use pathtracer::gui::settings::Knobs;
use pathtracer::gui::tone;
use pathtracer::math::DVec3;
use pathtracer::output::{quantize, srgb_encode};
use pathtracer::render::{NOISE_AFTER, Outlook, Settings};
use pathtracer::scene::desc::CameraDesc;
use std::sync::Arc;

fn frame() -> Arc<Frame> {
    let desk = Desk::new();
    let loaded = load(&desk.path("balls.yaml"));
    let session = session();
    session.order(preview(&loaded, &loaded.editable, &Settings { samples: 4, ..small() }));
    session.wait();
    session.frame().expect("a picture")
}

#[test]
fn light_has_the_bytes_of_a_picture_file() {
    let mut random = Random::new(1);
    let edges = [0.0, -1.0, 1.0, 1e9, f64::NAN, 0.003_130_8, f64::MIN_POSITIVE, 1.0 - f64::EPSILON];
    let lights = (0..200_000).map(|_| random.unit().powi(3) * 1.2).chain(edges);
    for light in lights {
        assert_eq!(tone::byte(light), quantize(srgb_encode(light)), "{light}");
    }
}

#[test]
fn the_picture_is_shown_in_the_bytes_of_its_file() {
    let frame = frame();
    let shown = show(Request { frame: Arc::clone(&frame), view: View::Picture, exposure: 1.0, most: 8192 });
    for (pixel, light) in shown.image.pixels.iter().zip(&frame.light) {
        let bytes = light.to_array().map(|value| quantize(srgb_encode(value * 2.0)));
        assert_eq!(pixel.to_array()[..3], bytes);
    }
    let total: u32 = shown.histogram.iter().flatten().sum();
    assert_eq!(total as usize, 3 * frame.light.len());
}

#[test]
fn every_view_has_a_colour_for_every_pixel_and_they_differ() {
    let frame = frame();
    let mut images = Vec::new();
    for view in View::ALL {
        let shown = show(Request { frame: Arc::clone(&frame), view, exposure: 0.0, most: 8192 });
        assert_eq!(shown.image.size, frame.size(), "{view:?}");
        images.push(shown.image);
    }
    for (i, a) in images.iter().enumerate() {
        assert!(images[i + 1..].iter().all(|b| a != b), "{:?}", View::ALL[i]);
    }
}

#[test]
fn an_image_is_never_larger_than_the_graphics_driver_takes() {
    let frame = frame();
    let shown =
        |most: usize| show(Request { frame: Arc::clone(&frame), view: View::Picture, exposure: 0.0, most });
    let (whole, part) = (shown(48), shown(20));
    assert_eq!((whole.image.size, part.image.size), ([48, 27], [16, 9]));
    // Of every three pixels the first.
    assert!((0..9).all(|y| (0..16).all(|x| part.image[(x, y)] == whole.image[(3 * x, 3 * y)])));
    assert_eq!(shown(1).image.size, [1, 1]);
}

#[test]
fn a_ramp_grows_brighter_all_the_way() {
    let brightness = |share: f64| {
        let [r, g, b] = ramp(share).map(f64::from);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    assert!((0..100).all(|i| brightness(f64::from(i) / 100.0) <= brightness(f64::from(i + 1) / 100.0)));
}

#[test]
fn a_click_finds_the_object_and_the_distance_of_the_sharp_plane() {
    let frame = frame();
    let (object, point) = pick::seen(&frame, 24.0, 13.5).expect("the ball is in the middle");
    assert_eq!(object, 1);
    let mut camera = frame.editable.camera.clone();
    control::focus(&mut camera, point);
    // The ball's surface on the way from (-6, 0, 2) to its centre (0, 0, 1), where the camera looks at.
    let expected = 37.0f64.sqrt() - 1.0;
    assert!((camera.focus_distance - expected).abs() < 1e-12, "{}", camera.focus_distance);
    assert_eq!(pick::seen(&frame, 24.0, 0.1), None);
}

#[test]
fn what_is_under_the_mouse_is_what_a_click_finds() {
    let frame = frame();
    let look = frame.look.as_ref().expect("features");
    let [width, height] = frame.size();
    let differ = (0..width * height).filter(|&pixel| {
        let (x, y) = (pixel % width, pixel / width);
        let found = pick::seen(&frame, x as f64 + 0.5, y as f64 + 0.5).map(|(object, _)| object);
        found != look.object_at(pixel)
    });
    // Only pixels on an edge may differ, as one looks at their centre and the other at a point of theirs: the outlines of a
    // ball and a horizon cross fewer than four pixels a column.
    assert!(differ.count() < 4 * width);
}

fn camera() -> CameraDesc {
    frame().editable.camera.clone()
}

#[test]
fn orbiting_keeps_the_distance_and_stays_off_the_poles() {
    let mut camera = camera();
    let distance = camera.position.distance(camera.looking_at);
    for _ in 0..50 {
        control::orbit(&mut camera, [0.03, 0.1]);
        assert!((camera.position.distance(camera.looking_at) / distance - 1.0).abs() < 1e-12);
    }
    let [_, up, forward] = control::axes(&camera);
    assert!(forward.z < -0.99 && up.is_finite());
    control::orbit(&mut camera, [0.0, -2.0]);
    assert!(control::axes(&camera)[2].z > 0.99);
}

#[test]
fn moving_sideways_keeps_direction_and_distance() {
    let mut camera = camera();
    let arm = camera.looking_at - camera.position;
    control::pan(&mut camera, [0.25, -0.5], 0.5625);
    assert!((camera.looking_at - camera.position - arm).length() < 1e-12);
    assert_ne!(camera.looking_at, DVec3::new(0.0, 0.0, 1.0));
}

#[test]
fn a_dolly_never_reaches_the_point_that_is_looked_at() {
    let mut camera = camera();
    let distance = camera.position.distance(camera.looking_at);
    control::dolly(&mut camera, 0.5);
    assert!((camera.position.distance(camera.looking_at) / distance - 0.5).abs() < 1e-12);
    (0..1000).for_each(|_| control::dolly(&mut camera, 0.0));
    assert_ne!(camera.position, camera.looking_at);
}

#[test]
fn a_roll_stays_within_half_a_turn() {
    let mut camera = camera();
    (0..100).for_each(|_| control::roll(&mut camera, 50.0));
    assert!(camera.angle.abs() <= 180.0);
    assert!((camera.angle - (5000.0 - 14.0 * 360.0)).abs() < 1e-9);
}

#[test]
fn the_axes_are_those_of_the_render() {
    let frame = frame();
    let camera = frame.world.camera(&frame.editable.camera, 48, 27);
    let axes = control::axes(&frame.editable.camera);
    for (a, b) in axes.into_iter().zip([camera.right, camera.up, camera.forward]) {
        assert!((a - b).length() < 1e-12, "{a} {b}");
    }
}

#[test]
fn the_whole_picture_lies_in_its_place() {
    let place = Rect::from_min_max(pos2(100.0, 50.0), pos2(500.0, 450.0));
    let mut zoom = Zoom::default();
    let rect = zoom.layout(place, [200, 100], 2.0);
    assert_eq!((rect, zoom.scale()), (Rect::from_min_max(pos2(100.0, 150.0), pos2(500.0, 350.0)), 4.0));
    assert_eq!(pixel_at(rect, [200, 100], pos2(300.0, 250.0)), Some([100.0, 50.0]));
    assert_eq!(pixel_at(rect, [200, 100], pos2(300.0, 149.0)), None);
}

#[test]
fn zooming_keeps_what_is_under_the_mouse() {
    let place = Rect::from_min_max(pos2(0.0, 0.0), pos2(400.0, 400.0));
    let (size, mouse) = ([200, 200], pos2(90.0, 310.0));
    let mut zoom = Zoom::default();
    let rect = zoom.layout(place, size, 1.0);
    let before = pixel_at(rect, size, mouse).expect("inside");
    zoom.scale_about(place, mouse, 3.0);
    let rect = zoom.layout(place, size, 1.0);
    let after = pixel_at(rect, size, mouse).expect("inside");
    // The picture lies on whole pixels of the screen, of which six are one of its own.
    assert!((0..2).all(|i| (before[i] - after[i]).abs() <= 0.1), "{before:?} {after:?}");
    zoom.shift(Vec2::new(6.0, 0.0));
    let moved = pixel_at(zoom.layout(place, size, 1.0), size, mouse).expect("inside");
    assert!((after[0] - moved[0] - 1.0).abs() <= 0.1);
    zoom.fit();
    assert_eq!(zoom.layout(place, size, 1.0), place);
}

#[test]
fn a_preview_tells_what_the_final_render_will_take() {
    let status = Status {
        samples: 48 * 27 * 4,
        rays: 1000,
        seconds: 2.0,
        outlook: Outlook { error: Some(0.1), ..Outlook::default() },
        ..Status::default()
    };
    // Ten times the sides: 100 times the pixels.
    let knobs = Knobs { width: 480, height: 270, samples: 16, ..Knobs::default() };
    // One block of 4 % and one of 10 %, of as many pixels.
    let blocks = BlockErrors { samples: 64, squares: vec![(0.0016, 648.0), (0.01, 648.0)] };
    let told = |knobs: &Knobs| forecasts(&status, &small(), Some(&blocks), knobs);
    assert_eq!(told(&knobs), ["final: about 13 min 20 s"]);
    let target = Knobs { noise: Some(0.05), ..knobs.clone() };
    // No block takes more than the 16 samples, and none stops before 64.
    assert_eq!(told(&target), ["final: 5 % not in every block with 16 samples, after 13 min 20 s"]);
    // The second block takes four times its samples, 256, where errors fall with the root, else 64 * 4^(2/3), 161.3; the
    // first 64. A sample of all pixels takes 50 s.
    let enough = Knobs { samples: 256, ..target.clone() };
    assert_eq!(told(&enough), ["final: 5 % in every block after 1 h 33 min to 2 h 13 min"]);
    let few = Knobs { samples: 200, ..target };
    assert_eq!(told(&few), ["final: 5 % perhaps in every block after 1 h 33 min to 1 h 50 min"]);
    let budget = Knobs { time: Some(50.0), ..knobs };
    assert_eq!(told(&budget), ["final: 20 % after 50 s"]);
}

#[test]
fn a_target_takes_more_samples_in_some_blocks_and_no_block_fewer_than_the_first_look() {
    let blocks = BlockErrors { samples: 256, squares: vec![(0.0001, 100.0), (0.04, 300.0)] };
    let [least, most] = samples_to(&blocks, 0.1, 0);
    // The second block needs four times its samples where errors fall with the root, and the first has 64 at least.
    assert!((most - (64.0 + 3.0 * 1024.0) / 4.0).abs() < 1e-9, "{most}");
    assert!((least - (64.0 + 3.0 * 256.0 * 4.0f64.powf(2.0 / 3.0)) / 4.0).abs() < 1e-9, "{least}");
    assert_eq!(samples_to(&blocks, 0.1, 512)[1], (64.0 + 3.0 * 512.0) / 4.0);
}

/// A render of a sample scene in 96 x 54 pixels.
fn small_render(name: &str, settings: &Settings) -> (Status, Arc<Frame>) {
    let loaded = load(&sample(name));
    let session = session();
    session.order(preview(&loaded, &loaded.editable, settings));
    let status = session.wait();
    (status, session.frame().expect("a picture"))
}

#[test]
fn a_noise_target_takes_about_as_many_samples_as_the_preview_foretells() {
    for (name, target) in [("bigBalls", 0.03), ("cornellBox", 0.03), ("glassBalls", 0.04)] {
        let seen = Settings { error_estimate: true, ..Settings::new(96, 54, 128, 8) };
        let blocks = small_render(name, &seen).1.blocks.clone().expect("errors of blocks");
        let real = Settings { noise: Some(target), samples: 1 << 14, ..seen };
        let frame = small_render(name, &real).1;
        let pixels = frame.light.len();
        let real = (0..pixels).map(|pixel| frame.count(pixel)).sum::<u64>() as f64 / pixels as f64;
        let [least, most] = samples_to(&blocks, target, 1 << 14);
        assert!(least > 1.5 * NOISE_AFTER as f64, "{name}: {least} is mostly the least that a block takes");
        // A block of 256 pixels, each with one squared difference, knows its squared error to a part in sqrt(2 / 256), 9 %, where
        // the pixels are alike; where a tenth of them carry it, to 28 %. In the mean of 24 blocks that is 6 %, and a render stops
        // at whole chunks of 16 samples, some 8 % of these numbers. Both twice.
        assert!((0.75 * least..1.33 * most).contains(&real), "{name}: {real} of {least} to {most}");
    }
}

#[test]
fn a_time_budget_leaves_about_the_error_that_the_preview_foretells() {
    for name in ["bigBalls", "cornellBox", "glassBalls"] {
        let seen = Settings { error_estimate: true, ..Settings::new(96, 54, 32, 8) };
        let (status, frame) = small_render(name, &seen);
        // Four times the samples take four times as long.
        let knobs = Knobs { width: 96, height: 54, time: Some(4.0 * status.seconds), ..Knobs::default() };
        let told = forecasts(&status, &frame.settings, None, &knobs);
        let told =
            told.iter().find_map(|text| text.strip_prefix("final: ")?.split_once(" %")?.0.parse().ok());
        let told: f64 = told.expect("a forecast of the error");
        let real =
            100.0 * small_render(name, &Settings { samples: 128, ..seen }).0.outlook.error.expect("an error");
        // Half of the error now, where errors fall with the root; with Sobol's points they fall to 1 / 4^0.75 of it at best, and
        // the estimates of the two errors, of 64 pixels, are each known to some 20 %.
        assert!((0.5 * told..1.4 * told).contains(&real), "{name}: {real} % instead of {told} %");
    }
}
