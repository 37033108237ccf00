use pathtracer::error::Error;
use pathtracer::film::{Film, Sums};
use pathtracer::integrator::Counters;
use pathtracer::math::Rgb;
use pathtracer::render::{Ended, Progress, Rendered, Settings, SoFar, Watch, accumulate};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Follows a render, and stops it once so many samples are taken.
struct Limit {
    most: u64,
    seen: Mutex<Vec<Progress>>,
}

impl Limit {
    fn new(most: u64) -> Limit {
        Limit { most, seen: Mutex::new(Vec::new()) }
    }
}

impl Watch for Limit {
    fn progress(&self, progress: &Progress) {
        self.seen.lock().expect("no panic before").push(*progress);
    }

    fn cancelled(&self) -> bool {
        self.seen.lock().expect("no panic before").iter().any(|progress| progress.samples >= self.most)
    }
}

/// Numbers of very different sizes, so that every other order of adding gives other bits.
fn synthetic(x: u32, y: u32, index: u64, counters: &mut Counters) -> Rgb {
    counters.rays += 3;
    let value = |i: u64| {
        libm::exp(libm::sin((u64::from(x) * 37 + u64::from(y) * 101 + index * 13 + i) as f64) * 20.0)
    };
    Rgb::new(value(0), value(1), value(2))
}

fn small(samples: u64) -> Settings {
    Settings { threads: Some(2), tile: Some(8), ..Settings::new(37, 23, samples, 1) }
}

fn run(settings: &Settings) -> Rendered {
    accumulate(settings, &Limit::new(u64::MAX), synthetic).expect("a render without trouble")
}

/// Keeps the picture after every pass.
#[derive(Default)]
struct Passes(Mutex<Vec<(u64, Vec<Rgb>)>>);

impl Watch for Passes {
    fn progress(&self, _: &Progress) {}

    fn cancelled(&self) -> bool {
        false
    }

    fn pass(&self, so_far: &SoFar<'_>) {
        let mut means = Vec::new();
        so_far.means(&mut means);
        self.0.lock().expect("no panic before").push((so_far.samples(), means));
    }
}

#[test]
fn the_picture_after_every_pass_is_that_of_a_render_of_as_many_samples() {
    let passes = Passes::default();
    accumulate(&small(60), &passes, synthetic).expect("a render without trouble");
    let passes = passes.0.into_inner().expect("no panic before");
    let samples: Vec<u64> = passes.iter().map(|pass| pass.0).collect();
    assert_eq!(samples[..6], [1, 2, 4, 8, 16, 17]);
    assert_eq!(samples.last(), Some(&60));
    for (samples, means) in passes {
        assert_eq!(means, run(&small(samples)).film.means().collect::<Vec<_>>(), "{samples} samples");
    }
}

#[test]
fn tiles_and_threads_do_not_change_a_bit() {
    let settings = small(40);
    let expected = run(&settings);
    for threads in [1, 2, 8] {
        for tile in [None, Some(1), Some(8), Some(64)] {
            let rendered = run(&Settings { threads: Some(threads), tile, ..settings.clone() });
            assert_eq!(rendered.film, expected.film);
            assert_eq!(rendered.counters, expected.counters);
        }
    }
}

#[test]
fn every_pixel_gets_its_own_samples() {
    let settings = small(40);
    let mut film = Film::new(settings.width, settings.height, settings.chunk.into());
    for (chunk, samples) in [(0, 0..16), (1, 16..32), (2, 32..40)] {
        let sum = |x, y| samples.clone().map(|i| synthetic(x, y, i, &mut Counters::default())).sum();
        let sums = (0..settings.height).flat_map(|y| (0..settings.width).map(move |x| (x, y)));
        let sums = sums.map(|(x, y)| sum(x, y)).collect();
        film.add(chunk, Sums::plain(samples.end - samples.start, sums)).expect("chunks in order");
    }
    assert!(run(&settings).film.means().eq(film.means()));
}

#[test]
fn rays_and_progress_are_counted() {
    let settings = small(20);
    let watch = Limit::new(u64::MAX);
    let rendered = accumulate(&settings, &watch, synthetic).expect("a render without trouble");
    let total = 37 * 23 * 20;
    assert_eq!(rendered.counters.rays, 3 * total);
    let seen = watch.seen.lock().expect("no panic before");
    // 5 x 3 tiles in each pass: of 1, 1, 2, 4 and 8 samples in the first chunk, of 1, 1 and 2 in the second.
    assert_eq!(seen.len(), 15 * 8);
    let last = seen.iter().max_by_key(|progress| progress.samples).expect("entries");
    assert_eq!((last.samples, last.total, last.rays), (total, total, 3 * total));
}

#[test]
fn samples_that_are_no_light_are_counted_and_black() {
    let rendered = accumulate(&small(16), &Limit::new(u64::MAX), |x, _, index, _| match (x, index) {
        (0, 0) => Rgb::new(f64::NAN, 1.0, 1.0),
        (0, 1) => Rgb::new(1.0, f64::INFINITY, 1.0),
        (0, 2) => Rgb::new(1.0, 1.0, -1e-300),
        _ => Rgb::ONE,
    })
    .expect("a render without trouble");
    assert_eq!(rendered.counters.dropped, 3 * 23);
    let means: Vec<Rgb> = rendered.film.means().collect();
    assert_eq!(means[0], Rgb::splat(13.0 / 16.0));
    assert_eq!(means[1], Rgb::ONE);
}

#[test]
fn a_cancelled_render_keeps_its_complete_chunks() {
    let settings = small(64);
    let pixels = 37 * 23;
    let rendered = accumulate(&settings, &Limit::new(pixels * 32), synthetic).expect("no error");
    assert_eq!(rendered.ended, Ended::Cancelled);
    assert_eq!(rendered.film, run(&small(32)).film);
    assert_eq!(rendered.counters.rays, 3 * pixels * 32);
}

#[test]
fn a_render_cancelled_in_its_first_chunk_keeps_its_complete_passes() {
    let pixels = 37 * 23;
    for taken in [1, 2, 4, 8] {
        let rendered = accumulate(&small(64), &Limit::new(pixels * taken), synthetic).expect("no error");
        assert_eq!(rendered.ended, Ended::Cancelled);
        assert_eq!(rendered.film, run(&small(taken)).film);
    }
}

#[test]
fn a_render_that_is_cancelled_at_once_holds_nothing() {
    let rendered = accumulate(&small(64), &Limit::new(1), synthetic).expect("no error");
    assert_eq!(rendered.ended, Ended::Cancelled);
    assert_eq!(rendered.film.samples(), 0);
    assert_eq!(rendered.film.means().count(), 0);
}

#[test]
fn a_panic_in_a_worker_becomes_an_error() {
    let error = accumulate(&small(16), &Limit::new(u64::MAX), |x, y, _, _| {
        assert!((x, y) != (20, 20), "a wrong turn");
        Rgb::ONE
    })
    .expect_err("a panic");
    assert!(matches!(&error, Error::Internal(message) if message.contains("a wrong turn")), "{error}");
}

#[test]
fn settings_that_cannot_be_are_refused_before_any_work() {
    let wrong = [
        Settings::new(0, 10, 1, 1),
        Settings::new(10, 0, 1, 1),
        Settings::new(1_000_000_000, 10, 1, 1),
        Settings::new(u32::MAX, u32::MAX, 1, 1),
        Settings::new(65_536, 65_536, 1, 1),
        Settings::new(10, 10, 0, 1),
        Settings::new(10, 10, u64::MAX, 1),
        Settings::new(10, 10, 1, 0),
        Settings { tile: Some(0), ..Settings::new(10, 10, 1, 1) },
        Settings { tile: Some(u32::MAX), ..Settings::new(10, 10, 1, 1) },
        Settings { threads: Some(0), ..Settings::new(10, 10, 1, 1) },
        Settings { threads: Some(1_000_000), ..Settings::new(10, 10, 1, 1) },
        Settings { chunk: 0, ..Settings::new(10, 10, 1, 1) },
    ];
    for settings in wrong {
        let result = accumulate(&settings, &Limit::new(u64::MAX), synthetic);
        assert!(matches!(result, Err(Error::Usage(_))), "{settings:?}");
    }
}

#[cfg(not(feature = "embree"))]
#[test]
fn a_build_without_embree_says_how_to_get_it() {
    use pathtracer::render::AccelKind;
    let settings = Settings { accel: AccelKind::Embree, ..small(1) };
    let error = settings.check().expect_err("no Embree");
    assert!(error.to_string().contains("--features embree"), "{error}");
}

#[test]
fn small_pictures_get_small_tiles_so_that_all_threads_work() {
    let side = |width, height, threads| {
        Settings { threads: Some(threads), ..Settings::new(width, height, 1, 1) }.tile_side()
    };
    assert_eq!(side(1920, 1080, 2), 32);
    assert_eq!(side(64, 64, 2), 8);
    assert_eq!(side(16, 16, 64), 4);
}

/// Holds the render once after every tile, for longer than the tile takes.
#[derive(Default)]
struct Brake(Mutex<Duration>);

impl Watch for Brake {
    fn progress(&self, _: &Progress) {
        let start = Instant::now();
        while start.elapsed() < Duration::from_millis(1) {
            std::hint::spin_loop();
        }
        *self.0.lock().expect("no panic before") += start.elapsed();
    }

    fn cancelled(&self) -> bool {
        false
    }

    fn paused(&self) -> Duration {
        *self.0.lock().expect("no panic before")
    }
}

#[test]
fn the_time_in_which_a_render_is_held_does_not_count() {
    let (brake, start) = (Brake::default(), Instant::now());
    let settings = Settings { threads: Some(1), ..small(8) };
    let rendered = accumulate(&settings, &brake, synthetic).expect("a render without trouble");
    let (all, held) = (start.elapsed().as_secs_f64(), brake.paused().as_secs_f64());
    // Fifteen tiles in each of four passes.
    assert!(held >= 0.06, "{held}");
    assert!(rendered.render_seconds <= all - held, "{} of {all}, {held} held", rendered.render_seconds);
}
