//! Random valid scenes through both accelerators with random settings: no panic, no light that is none, the same bytes, no
//! growing memory.

use crate::support::random::Random;
use crate::support::random_scenes;
use crate::support::watch::Unwatched;
use pathtracer::accel::Precision;
use pathtracer::error::Error;
use pathtracer::film::{Film, Region};
use pathtracer::math::Rgb;
use pathtracer::render::{AccelKind, Rendered, Settings, render};
use pathtracer::sampling::SamplerKind;
use pathtracer::scene;
use pathtracer::world::World;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Settings of any kind for a small picture.
fn settings(random: &mut Random) -> Settings {
    let (width, height) = (1 + random.index(48) as u32, 1 + random.index(36) as u32);
    let (samples, bounces) = (1 + random.index(40) as u64, 1 + random.index(12) as u32);
    let mut some = |chance: f64| random.unit() < chance;
    Settings {
        light_sampling: some(0.8),
        error_estimate: some(0.5),
        sampler: if some(0.5) { SamplerKind::Sobol } else { SamplerKind::Independent },
        clamp: some(0.2).then_some(3.0),
        noise: some(0.3).then_some(0.2),
        scramble_length: some(0.3).then_some(2),
        features: some(0.3),
        tile: some(0.5).then_some(8),
        threads: some(0.3).then_some(1),
        seed: random.bits(),
        ..Settings::new(width, height, samples, bounces)
    }
}

/// Whether the pixels of a film are light.
fn assert_is_light(film: &Film, what: &str) {
    assert!(film.means().all(|mean| mean.is_finite() && mean.min_element() >= 0.0), "{what}");
}

/// One scene with both accelerators, and as two parts; false where the scene can't be compiled.
fn try_scene(folder: &Path, seed: u64) -> bool {
    let mut random = Random::new(seed);
    let path = random_scenes::write(folder, &mut random);
    let what = format!("seed {seed}");
    let scene = scene::load(&path).unwrap_or_else(|error| panic!("{what}: {error}"));
    let world = match World::compile(&scene.desc) {
        Ok(world) => world,
        Err(Error::Scene(_)) => return false,
        Err(error) => panic!("{what}: {error}"),
    };
    let settings = settings(&mut random);
    let run = |settings: &Settings| -> Rendered {
        render(&world, &scene.desc.camera, settings, &Unwatched)
            .unwrap_or_else(|error| panic!("{what}: {error}"))
    };
    let native = run(&Settings { accel: AccelKind::Native, ..settings.clone() });
    assert_is_light(&native.film, &what);
    assert_eq!(native.counters.dropped, 0, "{what}");
    if cfg!(feature = "embree") {
        let embree =
            run(&Settings { accel: AccelKind::Embree, threads: Some(2), tile: None, ..settings.clone() });
        assert!(embree.film == native.film, "{what}: {settings:?}");
        assert_eq!(embree.counters, native.counters, "{what}");
        let precision = [Precision::Robust, Precision::Fast][random.index(2)];
        assert_is_light(&run(&Settings { precision, ..settings.clone() }).film, &what);
    }
    let region =
        Region::Crop { left: 0, top: 0, right: settings.width.min(16), bottom: settings.height.min(16) };
    let part = run(&Settings { accel: AccelKind::Native, region, ..settings.clone() });
    let whole: Vec<Rgb> = native.film.means().collect();
    let expected = region.pixels(settings.width, settings.height).map(|pixel| whole[pixel]);
    assert!(part.film.means().eq(expected), "{what}: {settings:?}");
    true
}

/// Bytes of this process in memory.
#[cfg(target_os = "linux")]
fn resident_bytes() -> u64 {
    let text = fs::read_to_string("/proc/self/statm").expect("a file of the kernel");
    text.split(' ').nth(1).and_then(|pages| pages.parse::<u64>().ok()).expect("a number") * 4096
}

#[test]
fn random_scenes_are_rendered_alike_by_both_accelerators() {
    let folder = tempfile::tempdir().expect("a folder");
    let good = (0..60).filter(|&seed| try_scene(folder.path(), seed)).count();
    assert!(good >= 40, "{good} of 60 scenes");
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
    let seconds = std::env::var("PATHTRACER_SOAK_SECONDS").ok().and_then(|text| text.parse().ok());
    let time = Duration::from_secs(seconds.unwrap_or(1200));
    let folder = tempfile::tempdir().expect("a folder");
    // Until then allocators grow to what the largest scenes need.
    let warm = try_for(folder.path(), 1000, time / 4);
    let before = resident_bytes();
    let count = try_for(folder.path(), 1000 + warm, time / 4 * 3);
    let after = resident_bytes();
    println!("{} scenes; {before} bytes after {warm} of them, {after} at the end", warm + count);
    // A leak of one such film (48 x 36 pixels of 3 f64) a scene would be more.
    let film = 48 * 36 * 24;
    assert!(after < before + (32 << 20) + count * film / 4, "{before} bytes became {after}");
}
