//! Other ways to the same picture: in parts, in several runs, in a given time.

use super::settings::elsewhere;
use crate::support::random::Random;
use crate::support::watch::Unwatched;
use pathtracer::film::Region;
use pathtracer::film::file::FilePlace;
use pathtracer::render::{
    FilmFile, Origin, Progress, Recipe, Rendered, Settings, Snapshot, View, Watch, merge, render, resume,
};
use pathtracer::scene::Scene;
use pathtracer::world::World;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// A scene, and where files of its renders go.
pub(super) struct Subject<'s> {
    pub(super) scene: &'s Scene,
    pub(super) world: &'s World,
    pub(super) folder: &'s Path,
}

impl Subject<'_> {
    pub(super) fn render(&self, settings: &Settings) -> Rendered {
        render(self.world, &self.scene.desc.camera, settings, &Unwatched).expect("a render")
    }

    fn origin(&self, settings: &Settings, brightest: f64) -> Origin {
        let view = View::new(self.world, &self.scene.desc.camera, settings.width, settings.height);
        let recipe = Recipe::new(&self.scene.desc.file, self.scene.digest, settings).expect("a recipe");
        Origin { recipe, view, brightest }
    }

    /// One of the ways.
    pub(super) fn any_way(&self, settings: &Settings, whole: &Rendered, random: &mut Random) {
        match random.index(8) {
            0..3 => self.assert_parts_are(whole, settings, random),
            3..6 => assert_same(&self.in_two_runs(settings, random), whole),
            6 => assert_same(&self.with_more_samples(settings, random), whole),
            _ => self.in_a_given_time(settings, random),
        }
    }

    /// Renders parts that together are the picture, and merges them in any order.
    fn assert_parts_are(&self, whole: &Rendered, settings: &Settings, random: &mut Random) {
        let mut paths: Vec<PathBuf> = Vec::new();
        let mut has_all_chunks = true;
        for region in regions(settings, random) {
            for chunks in chunk_ranges(settings, random) {
                has_all_chunks &= chunks.is_none();
                let part = elsewhere(&Settings { region, chunks, ..settings.clone() }, random);
                let path = self.folder.join(format!("{}.film", paths.len()));
                self.write_part(&part, &path);
                paths.push(path);
            }
        }
        random.shuffle(&mut paths);
        let mut merged = merge(&paths, false).expect("a merged picture").rendered;
        if !has_all_chunks {
            // Where it is told by other samples than those of the picture, their sums are rounded in another order.
            assert_eq!(merged.error.is_some(), whole.error.is_some());
            merged.error = whole.error;
        }
        assert_same(&merged, whole);
    }

    fn write_part(&self, settings: &Settings, path: &Path) {
        let rendered = self.render(settings);
        let origin = self.origin(settings, rendered.brightest);
        let place = FilePlace::new(path).expect("a place");
        rendered.write_part(&place, &origin).expect("a part");
    }

    /// A render that is stopped after any pass, and goes on with its checkpoint.
    fn in_two_runs(&self, settings: &Settings, random: &mut Random) -> Rendered {
        let first = elsewhere(settings, random);
        self.until(&first, 1 + random.index(6));
        self.go_on(&elsewhere(settings, random))
    }

    /// A render of fewer samples, which goes on to all.
    fn with_more_samples(&self, settings: &Settings, random: &mut Random) -> Rendered {
        let first = elsewhere(settings, random);
        self.from(1 + random.bits() % settings.samples, &first, &elsewhere(settings, random))
    }

    /// A render of so many samples, which goes on to all.
    pub(super) fn from(&self, samples: u64, first: &Settings, then: &Settings) -> Rendered {
        self.until(&Settings { samples, ..first.clone() }, usize::MAX);
        self.go_on(then)
    }

    /// Renders until so many checkpoints are written.
    fn until(&self, settings: &Settings, checkpoints: usize) {
        let origin = self.origin(settings, self.world.brightest());
        let place = FilePlace::new(&self.checkpoint()).expect("a place");
        let keeper = Keeper { place: &place, origin: &origin, left: AtomicUsize::new(checkpoints) };
        render(self.world, &self.scene.desc.camera, settings, &keeper).expect("a render");
    }

    fn checkpoint(&self) -> PathBuf {
        self.folder.join("checkpoint.film")
    }

    fn go_on(&self, settings: &Settings) -> Rendered {
        let file = FilmFile::open(&self.checkpoint()).expect("a checkpoint");
        let origin = self.origin(settings, self.world.brightest());
        let state = file.state(settings, &origin.recipe).expect("one of this render");
        resume(self.world, &self.scene.desc.camera, settings, &Unwatched, Some(state)).expect("a render")
    }

    /// Where the time ends a render, its picture is that of one of as many samples.
    fn in_a_given_time(&self, settings: &Settings, random: &mut Random) {
        let timed = Settings { time: Some(Duration::from_millis(100)), noise: None, ..settings.clone() };
        let in_time = self.render(&elsewhere(&timed, random));
        let counted = Settings { samples: in_time.film.samples(), time: None, ..timed };
        assert_same(&self.render(&elsewhere(&counted, random)), &in_time);
    }
}

/// Equal to the last bit.
#[track_caller]
pub(super) fn assert_same(one: &Rendered, other: &Rendered) {
    assert!(one.film == other.film, "the films differ");
    assert_eq!(one.counters, other.counters);
    assert_eq!(one.samples, other.samples);
    assert_eq!(one.error, other.error);
    assert!(one.features == other.features, "the features differ");
}

/// Regions that together are a picture: all of it, every so many blocks, or crops.
fn regions(settings: &Settings, random: &mut Random) -> Vec<Region> {
    let Settings { width, height, .. } = *settings;
    match random.index(3) {
        0 => vec![Region::All],
        1 => {
            let blocks = width.div_ceil(16) * height.div_ceil(16);
            let count = 1 + random.index(blocks.min(4) as usize) as u32;
            (0..count).map(|index| Region::Part { index, count }).collect()
        }
        _ => {
            // Where blocks stop, they must be whole.
            let step = if settings.noise.is_some() { 16 } else { 1 };
            let (columns, rows) = (cuts(width, step, random), cuts(height, step, random));
            let crops = columns.iter().flat_map(|x| rows.iter().map(move |y| (x.clone(), y.clone())));
            let crop = |(x, y): (Range<u32>, Range<u32>)| Region::Crop {
                left: x.start,
                top: y.start,
                right: x.end,
                bottom: y.end,
            };
            crops.map(crop).collect()
        }
    }
}

/// 0 to `side` in one or two ranges that meet at a multiple of `step`.
fn cuts(side: u32, step: u32, random: &mut Random) -> Vec<Range<u32>> {
    let cut = random.index(side.div_ceil(step) as usize) as u32 * step;
    [0..cut, cut..side].into_iter().filter(|range| !range.is_empty()).collect()
}

/// All chunks, in one or two ranges.
fn chunk_ranges(settings: &Settings, random: &mut Random) -> Vec<Option<Range<u64>>> {
    let all = settings.samples.div_ceil(settings.chunk.into());
    let cut = random.bits() % all;
    if settings.noise.is_some() || cut == 0 { vec![None] } else { vec![Some(0..cut), Some(cut..all)] }
}

/// Keeps checkpoints, and stops the render after some.
struct Keeper<'k> {
    place: &'k FilePlace,
    origin: &'k Origin,
    left: AtomicUsize,
}

impl Watch for Keeper<'_> {
    fn progress(&self, _: &Progress) {}

    fn cancelled(&self) -> bool {
        self.left.load(Ordering::Relaxed) == 0
    }

    fn keep(&self, snapshot: &Snapshot<'_>) {
        if snapshot.samples() > 0 && !self.cancelled() {
            snapshot.write(self.place, self.origin).expect("a checkpoint");
            self.left.fetch_sub(1, Ordering::Relaxed);
        }
    }
}
