//! Whole pictures against references that another renderer made; `README.md` beside this file says how.

mod blocks;
mod make;

use blocks::{BLOCKS, Blocks, SIDE, Verdict};
use pathtracer::math::Rgb;
use pathtracer::render::{Progress, Settings, Watch, render};
use pathtracer::sampling::SamplerKind;
use pathtracer::scene;
use pathtracer::world::World;
use std::path::{Path, PathBuf};

/// A scene with a reference.
struct Golden {
    name: &'static str,
    bounces: u32,
}

const A: Golden = Golden { name: "A", bounces: 8 };
const B: Golden = Golden { name: "B", bounces: 16 };
const D: Golden = Golden { name: "D", bounces: 16 };
const SCENES: [Golden; 3] = [A, B, D];

struct Unwatched;

impl Watch for Unwatched {
    fn progress(&self, _: &Progress) {}

    fn cancelled(&self) -> bool {
        false
    }
}

impl Golden {
    /// `A.yaml` or `A_mean.exr`, say.
    fn file(&self, ending: &str) -> PathBuf {
        let separator = if ending.starts_with('.') { "" } else { "_" };
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
        folder.join(format!("{}{separator}{ending}", self.name))
    }

    /// The pixels of a render.
    fn render(&self, bounces: u32, seed: u64, samples: u64, sampler: SamplerKind) -> Vec<Rgb> {
        let desc = scene::load(&self.file(".yaml")).expect("a valid scene").desc;
        let world = World::compile(&desc).expect("a valid scene");
        let settings =
            Settings { seed, sampler, ..Settings::new(SIDE as u32, SIDE as u32, samples, bounces) };
        let rendered = render(&world, &desc.camera, &settings, &Unwatched).expect("a render without trouble");
        assert_eq!(rendered.counters.dropped, 0);
        rendered.film.means().collect()
    }
}

fn pixels_of(path: &Path) -> Vec<Rgb> {
    let picture = image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    picture.into_rgb32f().pixels().map(|pixel| Rgb::from_array(pixel.0.map(f64::from))).collect()
}
