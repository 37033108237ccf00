use super::{BALLS, Desk, load, preview, sample, session, small};
use crate::support::random::Random;
use pathtracer::gui::camera_control;
use pathtracer::gui::saving;
use pathtracer::gui::session::{Order, Purpose, Stage};
use pathtracer::math::Rgb;
use pathtracer::output::Wanted;
use pathtracer::render::{Ended, Settings};
use pathtracer::scene::edit::{self, Editable};

/// Moves the camera, a colour or the light of the scene `BALLS`.
fn change(editable: &mut Editable, random: &mut Random) {
    match (random.unit() * 4.0) as u32 {
        0 => camera_control::orbit(
            &mut editable.camera,
            [random.between(-0.2, 0.2), random.between(-0.1, 0.1)],
        ),
        1 => camera_control::dolly(&mut editable.camera, random.between(0.9, 1.1)),
        2 => {
            let surface = editable.surfaces[1].as_mut().expect("a material of its own");
            surface.color = Rgb::new(random.unit(), random.unit(), random.unit());
        }
        _ => {
            let surface = editable.surfaces[2].as_mut().expect("a material of its own");
            surface.emission_strength = if random.unit() < 0.2 { 0.0 } else { random.between(1.0, 30.0) };
        }
    }
}

#[test]
fn two_hundred_previews_with_changes_in_between_have_the_bytes_of_the_command_line() {
    let desk = Desk::new();
    let loaded = load(&desk.path("balls.yaml"));
    let (session, mut random) = (session(), Random::new(1));
    let mut editable = loaded.editable.clone();
    let settings = Settings { samples: 1 << 20, ..small() };
    for round in 0..200 {
        // Some orders are left before they have a picture.
        for _ in 0..(random.unit() * 3.0) as u32 {
            change(&mut editable, &mut random);
            session.order(preview(&loaded, &editable, &settings));
        }
        change(&mut editable, &mut random);
        let job = session.order(preview(&loaded, &editable, &settings));
        session.wait_for(1 + (random.unit() * 20.0) as u64);
        session.stop();
        let status = session.wait();
        assert_eq!(status.stage, Stage::Done(Ended::Cancelled), "round {round}");
        let frame = session.frame().expect("a picture");
        assert_eq!((frame.job, frame.is_coarse), (job, false), "round {round}");
        saving::write(&frame, &desk.path("window.png"), 0.0).expect("a picture that can be written");
        let text = edit::save(BALLS, &loaded.scene.desc, &editable).expect("a scene that can be saved");
        desk.write("balls.yaml", &text);
        let expected = desk.by_command_line("balls.yaml", &frame.settings, frame.samples, "line.png");
        assert!(desk.read("window.png") == expected, "round {round}, {} samples", frame.samples);
    }
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
        let wanted = Wanted { image: desk.path(image), ..Wanted::default() };
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
    let wanted = Wanted { image: desk.path("so_far.png"), ..Wanted::default() };
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
    let order = preview(&loaded, &loaded.editable, &Settings { samples: 32, ..small() });
    session.order(order);
    session.pause(true);
    assert!(session.is_paused());
    session.pause(false);
    let status = session.wait();
    assert_eq!(status.stage, Stage::Done(Ended::Complete));
    let frame = session.frame().expect("a picture");
    saving::write(&frame, &desk.path("window.png"), 0.0).expect("a picture that can be written");
    assert!(desk.read("window.png") == desk.by_command_line("balls.yaml", &small(), 32, "line.png"));
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

#[test]
fn the_error_that_is_shown_is_near_the_error() {
    // Of a picture of 128 samples the map that halves tell is compared with a picture of eight times as many.
    let loaded = load(&sample("cornellBox"));
    let session = session();
    let of = |samples: u64, seed: u64| {
        let settings = Settings { samples, seed, ..small() };
        session.order(preview(&loaded, &loaded.editable, &settings));
        session.wait();
        session.frame().expect("a picture")
    };
    let (rough, fine) = (of(128, 0), of(1024, 1));
    let mean_square = |values: &mut dyn Iterator<Item = f64>| {
        let (sum, count) = values.fold((0.0, 0.0), |(sum, count), x| (sum + x * x, count + 1.0));
        sum / count
    };
    let pixels = 0..rough.light.len();
    let told = mean_square(&mut pixels.clone().map(|pixel| f64::from(rough.error(pixel).expect("an error"))));
    let grey = |light: Rgb| light.element_sum() / 3.0;
    let true_error = mean_square(&mut pixels.map(|pixel| grey(rough.light[pixel]) - grey(fine.light[pixel])));
    // Pairs of Sobol points that halve the error better than chance tell too much of it; factors are of squares, over 1296
    // pixels of one degree of freedom each, whose relative spread is (2 / 1296)^0.5 = 4 % times the spread of their sizes.
    let ratio = told / true_error;
    assert!((0.3..8.0).contains(&ratio), "{ratio}");
}
