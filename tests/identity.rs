//! The same bytes in the file: whatever the threads, the tiles and the order of the work; at exact whatever the
//! accelerator and the instructions. Every sample scene is rendered, small; the long version is behind `--ignored`.

use crate::support::watch::Unwatched;
use pathtracer::accel::{BvhQuality, Isa, Precision, check_isa};
use pathtracer::output;
use pathtracer::picture::Destination;
use pathtracer::render::{AccelKind, Settings, render};
use pathtracer::scene::{self, desc::CameraDesc};
use pathtracer::world::World;
use std::path::Path;
use tempfile::TempDir;

/// The sample scenes.
const NAMES: [&str; 7] =
    ["bigBalls", "glassBalls", "legacyBalls", "mirrorRoom", "objectScene", "cornellBox", "gallery"];

/// Samples of the default run, in chunks of this many: the tree of chunks has two leaves and a rest.
const FEW: u64 = 5;
const CHUNK: u32 = 2;
/// Samples of the long run.
const MANY: u64 = 64;

const ACCELERATORS: &[AccelKind] =
    if cfg!(feature = "embree") { &[AccelKind::Embree, AccelKind::Native] } else { &[AccelKind::Native] };

/// A sample scene and a folder for its pictures.
struct Subject {
    world: World,
    camera: CameraDesc,
    folder: TempDir,
    samples: u64,
}

/// The bytes of the PNG and of the EXR.
type Files = [Vec<u8>; 2];

impl Subject {
    fn new(name: &str, samples: u64) -> Subject {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{name}.yaml"));
        let desc = scene::load(&path).expect("a valid scene").desc;
        let world = World::compile(&desc).expect("a valid scene");
        Subject { world, camera: desc.camera, folder: TempDir::new().expect("a folder"), samples }
    }

    /// What a render with one thread, tiles of 8 and else the defaults starts from.
    fn settings(&self) -> Settings {
        let settings = Settings::new(64, 48, self.samples, 12);
        Settings { threads: Some(1), tile: Some(8), chunk: CHUNK, ..settings }
    }

    fn files(&self, settings: &Settings) -> Files {
        let rendered = render(&self.world, &self.camera, settings, &Unwatched).expect("a render");
        assert_eq!((rendered.counters.dropped, rendered.counters.self_hits), (0, 0), "{settings:?}");
        ["a.png", "a.exr"].map(|name| {
            let destination = Destination::new(&self.folder.path().join(name)).expect("a place to write");
            output::write(&rendered.film, 0.0, &destination).expect("a written picture");
            std::fs::read(destination.path()).expect("a picture")
        })
    }
}

/// The instruction sets that this machine has, and the choice of the best.
fn instruction_sets() -> Vec<Option<Isa>> {
    let all = [None, Some(Isa::Sse2), Some(Isa::Avx2), Some(Isa::Avx512)];
    all.into_iter().filter(|&isa| check_isa(isa).is_ok()).collect()
}

/// Fails at the first render whose files are not the expected ones.
fn assert_same(name: &str, subject: &Subject, expected: &Files, variants: impl Iterator<Item = Settings>) {
    for settings in variants {
        let files = subject.files(&settings);
        assert!(files[0] == expected[0], "{name}: another PNG with {settings:?}");
        assert!(files[1] == expected[1], "{name}: another EXR with {settings:?}");
    }
}

/// Threads and tiles, the first pair twice.
fn schedules_agree(samples: u64) {
    for name in NAMES {
        let subject = Subject::new(name, samples);
        schedules_of_size_agree(name, &subject, subject.settings());
    }
}

fn schedules_of_size_agree(name: &str, subject: &Subject, settings: Settings) {
    for &accel in ACCELERATORS {
        let base = Settings { accel, ..settings.clone() };
        let schedules = [(1, 8), (1, 64), (2, 8), (2, 64), (8, 8), (8, 64)];
        let variants = schedules.map(|(threads, tile)| Settings {
            threads: Some(threads),
            tile: Some(tile),
            ..base.clone()
        });
        assert_same(name, subject, &subject.files(&base), variants.into_iter());
    }
}

/// At exact all accelerators in all instruction sets, and with all trees.
fn exact_pictures_agree(samples: u64) {
    for name in NAMES {
        let subject = Subject::new(name, samples);
        let base = Settings { accel: AccelKind::Native, precision: Precision::Exact, ..subject.settings() };
        let expected = subject.files(&base);
        for &accel in ACCELERATORS {
            let variants = instruction_sets().into_iter().map(|isa| Settings { accel, isa, ..base.clone() });
            assert_same(name, &subject, &expected, variants);
            let qualities = [BvhQuality::Fast, BvhQuality::Quality];
            let variants = qualities.into_iter().map(|bvh| Settings { accel, bvh, ..base.clone() });
            assert_same(name, &subject, &expected, variants);
        }
    }
}

/// The native accelerator at the other precisions in all instruction sets.
fn native_pictures_agree(samples: u64) {
    for name in NAMES {
        let subject = Subject::new(name, samples);
        for precision in [Precision::Robust, Precision::Fast] {
            let base = Settings { accel: AccelKind::Native, precision, ..subject.settings() };
            let variants = instruction_sets().into_iter().map(|isa| Settings { isa, ..base.clone() });
            assert_same(name, &subject, &subject.files(&base), variants);
        }
    }
}

#[test]
fn threads_and_tiles_change_no_byte_of_a_sample_scene() {
    schedules_agree(FEW);
}

/// Of this size there are twelve tiles of 64, four of them whole.
#[test]
fn threads_and_tiles_change_no_byte_of_a_larger_picture() {
    for name in ["objectScene", "cornellBox"] {
        let subject = Subject::new(name, 2);
        let settings = Settings { width: 200, height: 136, ..subject.settings() };
        schedules_of_size_agree(name, &subject, settings);
    }
}

#[test]
fn accelerators_and_instruction_sets_change_no_byte_at_exact() {
    exact_pictures_agree(FEW);
}

#[test]
fn instruction_sets_change_no_byte_of_the_native_accelerator() {
    native_pictures_agree(FEW);
}

#[test]
#[ignore = "64 samples: minutes"]
fn threads_and_tiles_change_no_byte_of_64_samples() {
    schedules_agree(MANY);
}

#[test]
#[ignore = "64 samples: minutes"]
fn accelerators_and_instruction_sets_change_no_byte_of_64_samples_at_exact() {
    exact_pictures_agree(MANY);
}

#[test]
#[ignore = "64 samples: minutes"]
fn instruction_sets_change_no_byte_of_64_samples_of_the_native_accelerator() {
    native_pictures_agree(MANY);
}

/// The comparison can fail: another seed is another picture, in both formats, of every scene.
#[test]
fn another_seed_changes_both_files_of_every_sample_scene() {
    for name in NAMES {
        let subject = Subject::new(name, 1);
        let expected = subject.files(&subject.settings());
        let other = subject.files(&Settings { seed: 1, ..subject.settings() });
        assert!(other[0] != expected[0] && other[1] != expected[1], "{name}");
    }
}
