use super::{BALLS, Desk, SCENES, load, preview, sample, session, small};
use crate::support::random::Random;
use pathtracer::accel::BvhQuality;
use pathtracer::gui::camera_control;
use pathtracer::gui::document::Loaded;
use pathtracer::gui::saving;
use pathtracer::gui::session::{Frame, Order, Purpose, Session, Stage};
use pathtracer::math::Rgb;
use pathtracer::output::Wanted;
use pathtracer::render::{AccelKind, Ended, SCRAMBLE_LENGTH, Settings, Unwatched, render};
use pathtracer::sampling::SamplerKind;
use pathtracer::scene::edit::{self, Editable, SurfaceKind};
use std::ffi::OsStr;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant};

/// Moves the camera, or changes a colour or the light, where there is one of its own.
fn change(editable: &mut Editable, random: &mut Random) {
    let surfaces = editable.surfaces.len();
    let index = (random.unit() * surfaces as f64) as usize;
    match ((random.unit() * 4.0) as u32, editable.surfaces.get_mut(index).and_then(Option::as_mut)) {
        (2, Some(surface)) if !surface.has_color_picture => {
            surface.color = Rgb::new(random.unit(), random.unit(), random.unit());
        }
        (3, Some(surface)) if surface.kind == SurfaceKind::Diffuse => {
            surface.emission_strength = if random.unit() < 0.2 { 0.0 } else { random.between(1.0, 30.0) };
        }
        (1, _) => camera_control::dolly(&mut editable.camera, random.between(0.9, 1.1)),
        _ => camera_control::orbit(
            &mut editable.camera,
            [random.between(-0.2, 0.2), random.between(-0.1, 0.1)],
        ),
    }
}

/// One of some.
fn any<T: Copy>(all: &[T], random: &mut Random) -> T {
    all[(random.unit() * all.len() as f64) as usize]
}

/// A picture without anything beside its light.
fn wanted(desk: &Desk, name: &str) -> Wanted {
    Wanted { image: desk.path(name), ..Wanted::default() }
}

/// Accelerators of this build.
fn accels() -> Vec<AccelKind> {
    let is_built = |accel: &AccelKind| *accel != AccelKind::Embree || cfg!(feature = "embree");
    AccelKind::ALL.into_iter().filter(is_built).collect()
}

/// The sizes of the pictures: usual ones, and those whose sides are no multiples of tiles and blocks.
const SIZES: [[u32; 2]; 4] = [[48, 27], [33, 50], [97, 7], [17, 17]];

#[test]
fn two_hundred_previews_with_changes_in_between_have_the_bytes_of_the_command_line() {
    let desk = Desk::new();
    let scenes: Vec<Arc<Loaded>> = SCENES.iter().map(|name| load(&sample(name))).collect();
    let scenes: Vec<Arc<Loaded>> = scenes.into_iter().chain([load(&desk.path("balls.yaml"))]).collect();
    let (session, mut random) = (session(), Random::new(1));
    let (mut loaded, mut editable) = (&scenes[0], scenes[0].editable.clone());
    let (accels, mut settings) = (accels(), Settings { samples: 1 << 20, ..small() });
    for round in 0..200 {
        // Some orders are left before they have a picture.
        for _ in 0..(random.unit() * 3.0) as u32 {
            change(&mut editable, &mut random);
            session.order(preview(loaded, &editable, &settings));
        }
        if random.unit() < 0.3 {
            loaded = &scenes[(random.unit() * scenes.len() as f64) as usize];
            editable = loaded.editable.clone();
        }
        [settings.width, settings.height] = any(&SIZES, &mut random);
        settings.accel = any(&accels, &mut random);
        change(&mut editable, &mut random);
        let job = session.order(preview(loaded, &editable, &settings));
        session.wait_for(1 + (random.unit() * 20.0) as u64);
        session.stop();
        let what = format!("round {round}: {}, {settings:?}", loaded.path.display());
        assert_eq!(session.wait().stage, Stage::Done(Ended::Cancelled), "{what}");
        let frame = session.frame().expect("a picture");
        assert_eq!((frame.job, frame.is_coarse), (job, false), "{what}");
        saving::write(&frame, wanted(&desk, "window.png")).expect("a picture that can be written");
        let text =
            edit::save(&loaded.text, &loaded.scene.desc, &editable).expect("a scene that can be saved");
        let name = loaded.path.file_name().and_then(OsStr::to_str).expect("a name");
        desk.write(name, &text);
        let expected = desk.by_command_line(name, &frame.settings, frame.samples, "line.png");
        assert!(desk.read("window.png") == expected, "{what}, {} samples", frame.samples);
    }
}

/// A session with all that it hands over. It stays until the tests end, since its own thread looks at it.
fn recorded() -> (&'static Session, Arc<Mutex<Vec<Arc<Frame>>>>) {
    let frames: Arc<Mutex<Vec<Arc<Frame>>>> = Arc::default();
    let place: Arc<OnceLock<&'static Session>> = Arc::default();
    let (to, from) = (Arc::clone(&frames), Arc::clone(&place));
    let session = Session::new(move || {
        let mut frames = to.lock().expect("no panic");
        let Some(newest) = from.get().and_then(|session| session.frame()) else { return };
        if frames.last().is_none_or(|last| !Arc::ptr_eq(last, &newest)) {
            frames.push(newest);
        }
    });
    (place.get_or_init(|| Box::leak(Box::new(session))), frames)
}

#[test]
fn a_preview_of_large_meshes_begins_with_a_tree_that_is_there_soon_and_ends_with_the_command_lines_bytes() {
    let loaded = load(&sample("objectScene"));
    let (session, frames) = recorded();
    let settings = Settings::new(320, 180, 2, 4);
    session.order(preview(&loaded, &loaded.editable, &settings));
    assert_eq!(session.wait().stage, Stage::Done(Ended::Complete));
    let frames = frames.lock().expect("no panic");
    let made = |frame: &Frame| (frame.is_coarse, frame.settings.accel, frame.settings.bvh);
    let (first, last) = (&frames[0], &frames[frames.len() - 1]);
    assert_eq!(made(first), (true, AccelKind::Native, BvhQuality::Fast));
    assert_eq!(made(last), (false, AccelKind::default(), BvhQuality::Default));
    // The tree can't be seen in the picture.
    let plain = Settings { accel: last.settings.accel, bvh: last.settings.bvh, ..first.settings.clone() };
    let by_other = render(&first.world, &first.editable.camera, &plain, &Unwatched).expect("a picture");
    assert!(by_other.film.means().eq(first.light.iter().copied()));
    let desk = Desk::new();
    saving::write(last, wanted(&desk, "last.png")).expect("a picture that can be written");
    let scene = loaded.path.to_string_lossy();
    assert!(desk.read("last.png") == desk.by_command_line(&scene, &last.settings, 2, "line.png"));
}

#[test]
fn a_frame_of_an_older_order_never_follows_one_of_a_newer() {
    let desk = Desk::new();
    let loaded = load(&desk.path("balls.yaml"));
    let (session, mut random) = (session(), Random::new(2));
    let mut editable = loaded.editable.clone();
    let settings = Settings { samples: 1 << 20, ..small() };
    let mut newest = 0;
    for _ in 0..100 {
        change(&mut editable, &mut random);
        let job = session.order(preview(&loaded, &editable, &settings));
        session.wait_for(1);
        for _ in 0..3 {
            let frame = session.frame().expect("a picture");
            assert!(frame.job >= newest, "{} after {newest}", frame.job);
            assert_eq!(*frame.editable, editable);
            newest = frame.job;
        }
        assert_eq!(newest, job);
    }
}

#[test]
fn a_final_render_writes_the_file_of_the_command_line_also_of_a_scene_that_is_not_saved() {
    let desk = Desk::new();
    let loaded = load(&desk.path("balls.yaml"));
    let (session, mut random) = (session(), Random::new(3));
    let mut editable = loaded.editable.clone();
    for image in ["final.png", "final.exr"] {
        let wanted = wanted(&desk, image);
        let order = preview(&loaded, &editable, &small());
        session.order(Order { purpose: Purpose::Final(wanted), ..order });
        let status = session.wait();
        assert_eq!(status.stage, Stage::Done(Ended::Complete));
        assert_eq!(status.written.as_deref(), Some(desk.path(image).as_path()));
        let written = desk.read(image);
        let text = edit::save(BALLS, &loaded.scene.desc, &editable).expect("a scene that can be saved");
        desk.write("balls.yaml", &text);
        assert!(written == desk.by_command_line("balls.yaml", &small(), 64, image), "{image}");
        change(&mut editable, &mut random);
    }
}

#[test]
fn a_stopped_final_render_writes_its_picture_so_far() {
    let desk = Desk::new();
    let loaded = load(&desk.path("balls.yaml"));
    let session = session();
    let settings = Settings { samples: 1 << 20, ..small() };
    let wanted = wanted(&desk, "so_far.png");
    let order = preview(&loaded, &loaded.editable, &settings);
    session.order(Order { purpose: Purpose::Final(wanted), ..order });
    session.wait_for(4);
    session.stop();
    assert_eq!(session.wait().stage, Stage::Done(Ended::Cancelled));
    let samples = session.frame().expect("a picture").samples;
    let expected = desk.by_command_line("balls.yaml", &settings, samples, "line.png");
    assert!(desk.read("so_far.png") == expected, "{samples} samples");
}

#[test]
fn a_pause_holds_a_render_and_changes_nothing() {
    let desk = Desk::new();
    let loaded = load(&desk.path("balls.yaml"));
    let session = session();
    // With one thread nothing goes on once the pause is told.
    let settings = Settings { threads: Some(1), samples: 1 << 20, ..small() };
    session.order(preview(&loaded, &loaded.editable, &settings));
    session.wait_for(2);
    session.pause(true);
    let (status, frame) = (session.wait_for_pause(), session.frame().expect("a picture"));
    assert_eq!(status.stage, Stage::Paused);
    assert!(session.is_paused() && status.is_busy());
    saving::write(&frame, wanted(&desk, "window.png")).expect("a picture that can be written");
    // This takes longer than many passes.
    let expected = desk.by_command_line("balls.yaml", &settings, frame.samples, "line.png");
    assert!(desk.read("window.png") == expected, "{} samples", frame.samples);
    assert_eq!(session.status(), status);
    assert!(Arc::ptr_eq(&session.frame().expect("a picture"), &frame));
    session.pause(false);
    session.wait_for(2 * frame.samples);
    session.stop();
    assert_eq!(session.wait().stage, Stage::Done(Ended::Cancelled));
    let frame = session.frame().expect("a picture");
    saving::write(&frame, wanted(&desk, "window.png")).expect("a picture that can be written");
    let expected = desk.by_command_line("balls.yaml", &settings, frame.samples, "line.png");
    assert!(desk.read("window.png") == expected, "{} samples", frame.samples);
}

#[test]
fn the_time_of_every_pause_is_left_out() {
    let desk = Desk::new();
    let loaded = load(&desk.path("balls.yaml"));
    let session = session();
    let settings = Settings { threads: Some(1), samples: 1 << 20, ..small() };
    let start = Instant::now();
    session.order(preview(&loaded, &loaded.editable, &settings));
    let mut held = Duration::ZERO;
    for _ in 0..3 {
        session.wait_for(1);
        session.pause(true);
        assert_eq!(session.wait_for_pause().stage, Stage::Paused);
        let since = Instant::now();
        desk.command(&["check", "balls.yaml"]);
        held += since.elapsed();
        session.pause(false);
    }
    session.stop();
    let (status, all) = (session.wait(), start.elapsed());
    assert!(status.seconds > 0.0);
    let most = (all - held).as_secs_f64();
    assert!(status.seconds <= most, "{} s of {all:?}, {held:?} held", status.seconds);
}

#[test]
fn a_pause_without_a_render_is_none() {
    let session = session();
    session.pause(true);
    assert!(!session.is_paused());
}

#[test]
fn a_paused_render_ends_with_its_session() {
    let desk = Desk::new();
    let loaded = load(&desk.path("balls.yaml"));
    let session = session();
    session.order(preview(&loaded, &loaded.editable, &Settings { samples: 1 << 20, ..small() }));
    session.wait_for(1);
    session.pause(true);
    drop(session);
}

#[test]
fn an_order_that_cannot_be_says_why_and_the_next_one_is_taken() {
    let desk = Desk::new();
    let loaded = load(&desk.path("balls.yaml"));
    let session = session();
    session.order(preview(&loaded, &loaded.editable, &Settings { bounces: 0, ..small() }));
    assert_eq!(session.wait().stage, Stage::Failed("bounces must be from 1 to 65536, not 0".into()));
    session.order(preview(&loaded, &loaded.editable, &small()));
    assert_eq!(session.wait().stage, Stage::Done(Ended::Complete));
}

/// The mean square of the relative errors that many small pictures show by that of those that they have, and the standard
/// error of this ratio. Their scrambles are too long to tell it, so halves of the samples do.
fn told_by_true(sampler: SamplerKind) -> [f64; 2] {
    const PICTURES: u64 = 24;
    let loaded = load(&sample("cornellBox"));
    let session = session();
    let frames: Vec<Arc<Frame>> = (0..PICTURES)
        .map(|seed| {
            let settings =
                Settings { samples: 32, seed, sampler, scramble_length: Some(SCRAMBLE_LENGTH), ..small() };
            session.order(preview(&loaded, &loaded.editable, &settings));
            session.wait();
            session.frame().expect("a picture")
        })
        .collect();
    let pixels = frames[0].light.len();
    let grey = |frame: &Frame, pixel: usize| frame.light[pixel].element_sum() / 3.0;
    let means: Vec<f64> = (0..pixels)
        .map(|pixel| frames.iter().map(|frame| grey(frame, pixel)).sum::<f64>() / PICTURES as f64)
        .collect();
    let (mut told, mut real) = ([0.0; 2], [0.0; 2]);
    for frame in &frames {
        for (pixel, mean) in means.iter().enumerate() {
            let error = f64::from(frame.error(pixel).expect("an error"));
            // The mean of all pictures holds a share of this one.
            let square = (grey(frame, pixel) - mean).powi(2) * PICTURES as f64 / (PICTURES - 1) as f64;
            // As the map weighs them, so that the edge of the lamp does not outweigh everything.
            let weight = 1.0 / (mean * mean + 0.01);
            for (sums, square) in [(&mut told, weight * error * error), (&mut real, weight * square)] {
                sums[0] += square;
                sums[1] += square * square;
            }
        }
    }
    let ratio = told[0] / real[0];
    // The variance of a sum of independent squares is at most the expected sum of their squares.
    let relative = |[sum, squares]: [f64; 2]| squares / (sum * sum);
    [ratio, ratio * (relative(told) + relative(real)).sqrt()]
}

#[test]
fn the_error_that_is_shown_is_the_error_where_samples_are_independent() {
    // Half of the difference of two halves has then exactly the variance of their mean.
    let [ratio, error] = told_by_true(SamplerKind::Independent);
    assert!(error < 0.1 && (ratio - 1.0).abs() < 4.0 * error, "{ratio} +- {error}");
}

#[test]
fn the_error_that_is_shown_is_not_below_the_error_where_points_spread_well() {
    // The halves of a Sobol sequence make up for each other's gaps: the error falls faster than with the root of the
    // samples, so half of their difference is more than the error of the whole.
    let [ratio, error] = told_by_true(SamplerKind::Sobol);
    assert!(error < 0.4 && ratio > 1.0 - 4.0 * error && ratio < 4.0, "{ratio} +- {error}");
}
