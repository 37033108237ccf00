//! Random valid scenes through both accelerators with random settings, in one go, in parts, and resumed: no panic, no light
//! that is none, the same bytes, no growing memory.

mod settings;
mod ways;

use crate::support::random::Random;
use crate::support::random_scenes;
use pathtracer::accel::Precision;
use pathtracer::error::Error;
use pathtracer::film::Film;
use pathtracer::render::{AccelKind, Settings};
use pathtracer::scene;
use pathtracer::world::World;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::time::{Duration, Instant};
use ways::{Subject, assert_same};

/// Whether the pixels of a film are light.
#[track_caller]
fn assert_is_light(film: &Film) {
    assert!(film.means().all(|mean| mean.is_finite() && mean.min_element() >= 0.0), "a pixel is no light");
}

/// One scene; false where it can't be compiled. A failure says which seed and settings it was.
fn try_scene(folder: &Path, seed: u64) -> bool {
    catch_unwind(AssertUnwindSafe(|| try_seed(folder, seed))).unwrap_or_else(|panic| {
        let mut random = Random::new(seed);
        random_scenes::write(folder, &mut random);
        eprintln!("seed {seed} fails: {:?}", settings::any(&mut random));
        resume_unwind(panic)
    })
}

/// The scene with both accelerators at `exact`, with one of them at another precision, and in another way.
fn try_seed(folder: &Path, seed: u64) -> bool {
    let mut random = Random::new(seed);
    let path = random_scenes::write(folder, &mut random);
    let scene = scene::load(&path).expect("a valid scene");
    let world = match World::compile(&scene.desc) {
        Ok(world) => world,
        Err(Error::Scene(_)) => return false,
        Err(error) => panic!("{error}"),
    };
    let settings = settings::any(&mut random);
    let subject = Subject { scene: &scene, world: &world, folder };
    let native = subject.render(&Settings { accel: AccelKind::Native, ..settings.clone() });
    assert_is_light(&native.film);
    assert_eq!(native.counters.dropped, 0);
    if cfg!(feature = "embree") {
        let other = settings::elsewhere(&settings, &mut random);
        assert_same(&subject.render(&Settings { accel: AccelKind::Embree, ..other }), &native);
    }
    let precision = random.pick(&[Precision::Robust, Precision::Fast]);
    assert_is_light(&subject.render(&Settings { precision, ..settings.clone() }).film);
    subject.any_way(&settings, &native, &mut random);
    true
}

/// Bytes of this process in memory.
#[cfg(target_os = "linux")]
fn resident_bytes() -> u64 {
    let text = fs::read_to_string("/proc/self/statm").expect("a file of the kernel");
    text.split(' ').nth(1).and_then(|pages| pages.parse::<u64>().ok()).expect("a number") * 4096
}

#[test]
fn random_scenes_are_rendered_alike_by_both_accelerators_in_parts_and_in_several_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let good = (0..60).filter(|&seed| try_scene(folder.path(), seed)).count();
    assert!(good >= 40, "{good} of 60 scenes");
}

/// Passes double, so they end elsewhere after a render that did not end at a power of two.
#[test]
fn chunks_of_any_size_go_on_after_any_number_of_samples() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "Camera: {Position: [0, 0, 0], LookingAt: [5, 0, 0], Fov: 0.3, FocusDistance: 5}\n\
                Objects:\n  - Object: {Type: Ball, Position: [5, 0, 0], Radius: 1, Material: {Type: Diffuse}}\n";
    let scene = scene::parse(text, &folder.path().join("scene.yaml")).expect("a valid scene");
    let world = World::compile(&scene.desc).expect("a world");
    let subject = Subject { scene: &scene, world: &world, folder: folder.path() };
    for chunk in [1, 7, 16, 17] {
        let settings = Settings { chunk, error_estimate: true, ..Settings::new(4, 3, 22, 3) };
        let whole = subject.render(&settings);
        (1..=22).for_each(|first| assert_same(&subject.from(first, &settings, &settings), &whole));
    }
}

/// Tries seeds from `first` on; how many.
#[cfg(target_os = "linux")]
fn try_for(folder: &Path, first: u64, time: Duration) -> u64 {
    let start = Instant::now();
    let mut seed = first;
    while start.elapsed() < time {
        try_scene(folder, seed);
        seed += 1;
    }
    seed - first
}

#[test]
#[cfg(target_os = "linux")]
#[ignore = "runs for 20 minutes, or as long as PATHTRACER_SOAK_SECONDS says"]
fn memory_stays_flat_over_many_random_scenes() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse().ok());
    let time = Duration::from_secs(number("PATHTRACER_SOAK_SECONDS").unwrap_or(1200));
    let first = number("PATHTRACER_SOAK_SEED").unwrap_or(1000);
    let folder = tempfile::tempdir().expect("a folder");
    // Until then allocators grow to what the largest scenes need.
    let warm = try_for(folder.path(), first, time / 4);
    let before = resident_bytes();
    let count = try_for(folder.path(), first + warm, time / 4 * 3);
    let after = resident_bytes();
    println!("{} scenes; {before} bytes after {warm} of them, {after} at the end", warm + count);
    // A leak of one such film (28 x 20 pixels of 3 f64) a scene would be more.
    let film = 28 * 20 * 24;
    assert!(after < before + (32 << 20) + count * film / 4, "{before} bytes became {after}");
}
