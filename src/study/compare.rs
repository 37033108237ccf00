//! Both accelerators on the same rays of one scene.

use super::contender::{self, Contender, Kind, Pools, build_options};
use super::machine::Machine;
use super::rays::{RaySet, Sphere};
use super::record::{Recording, rays_of_paths};
use super::rounds::Spread;
use super::table::Figure;
use super::tally::{Tally, against_brute_force, tally};
use super::triangles;
use super::verdict::Verdict;
use crate::accel::bvh::Bvh;
use crate::accel::{Isa, Precision};
use crate::error::Result;
use crate::math::Rgb;
use crate::render::{AccelKind, Settings, Unwatched, render};
use crate::scene::desc::CameraDesc;
use crate::world::World;

/// What to compare, but for the scene.
#[derive(Clone, Debug)]
pub struct Options {
    /// The precision of both.
    pub precision: Precision,
    /// The most instructions to use, or `None` for the machine's best.
    pub isa: Option<Isa>,
    /// Threads of the measurements on all threads.
    pub threads: usize,
    /// The paths whose rays are traced; also the size of the pictures.
    pub recording: Recording,
    /// How often everything is timed, at least 1.
    pub rounds: usize,
    /// How many differing rays of each kind are kept, the worst ones.
    pub worst: usize,
}

/// What came out.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// What it was measured on.
    pub machine: Machine,
    /// The precision of both.
    pub precision: Precision,
    /// Triangles of meshes.
    pub triangles: usize,
    /// Balls, boxes and rectangles.
    pub solids: usize,
    /// Instances of meshes.
    pub instances: usize,
    /// Embree and native.
    pub sides: [Side; 2],
    /// How the hits agree, by kind of ray.
    pub tallies: Vec<Tally>,
    /// How the pictures agree.
    pub picture: PictureDifference,
}

/// What one accelerator took.
#[derive(Clone, Debug)]
pub struct Side {
    /// Which one.
    pub kind: Kind,
    /// Seconds to build it, on one thread and on all.
    pub build_seconds: [Spread; 2],
    /// Bytes of nodes and leaves.
    pub bytes: usize,
    /// Rays a second on one thread and on all, in the order of [`Comparison::tallies`].
    pub rates: [Vec<Spread>; 2],
}

/// How the pictures of the two accelerators differ.
#[derive(Clone, Debug, PartialEq)]
pub struct PictureDifference {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Samples per pixel.
    pub samples: u64,
    /// Pixels whose sums differ in any bit.
    pub differing: u64,
    /// The greatest difference of a component's mean, in units of radiance.
    pub greatest: f64,
    /// Where that is, from the top left.
    pub at: [u32; 2],
}

impl Comparison {
    /// Whether any hit or pixel differs.
    pub fn differs(&self) -> bool {
        self.picture.differing > 0 || self.tallies.iter().any(Tally::differs)
    }

    /// The threads of the measurements: one, and all where that is more.
    pub fn thread_counts(&self) -> Vec<usize> {
        if self.machine.threads == 1 { vec![1] } else { vec![1, self.machine.threads] }
    }

    /// Whether something differs that exact promises to be equal.
    pub fn breaks_promise(&self) -> bool {
        self.precision == Precision::Exact && self.differs()
    }
}

/// Compares Embree with the native accelerator on the rays of a scene; `say` is told what is being done.
///
/// # Errors
/// A build without Embree; an instruction set that the machine lacks; what building and rendering may fail with.
pub fn run(world: &World, camera: &CameraDesc, options: &Options, say: &dyn Fn(&str)) -> Result<Comparison> {
    AccelKind::Embree.check()?;
    let machine = Machine::here(options.isa, options.threads)?;
    let pools = Pools::new(options.threads)?;
    say("recording rays");
    let sets = pools.all().install(|| record(world, camera, options))?;
    say("building");
    let geometry = &world.geometry;
    let contenders =
        contender::build(&Kind::all(&[options.precision]), geometry, options.isa, &pools, options.rounds)?;
    say("comparing hits");
    let tallies = pools.all().install(|| tallies(world, &sets, &contenders, options.worst));
    say("timing");
    let rates = contender::measure(&contenders, &sets, &pools, options.rounds);
    let side = |i: usize| {
        let Contender { kind, build_seconds, bytes, .. } = contenders[i];
        let rates = [0, 1].map(|t| rates[t][i].iter().map(|values| Spread::of(values)).collect());
        Side { kind, build_seconds, bytes, rates }
    };
    let sides = [side(0), side(1)];
    drop(contenders);
    say("rendering");
    let picture = pictures(world, camera, options)?;
    let instances = geometry.solids.iter().filter_map(triangles::as_instance).count();
    Ok(Comparison {
        machine,
        precision: options.precision,
        triangles: triangles::count(geometry),
        solids: geometry.solids.len() - instances,
        instances,
        sides,
        tallies,
        picture,
    })
}

/// The rays of the scene's paths, and chords; kinds without rays are left out.
fn record(world: &World, camera: &CameraDesc, options: &Options) -> Result<Vec<RaySet>> {
    let recording = &options.recording;
    let recorder = Bvh::build(&world.geometry, &build_options(Precision::Exact, options.isa))?;
    let mut sets = rays_of_paths(world, camera, &recorder, recording);
    let sphere = Sphere::around(&world.geometry);
    sets.extend(sphere.map(|sphere| sphere.chords(recording.rays, recording.seed)));
    sets.retain(|set| !set.queries.is_empty());
    Ok(sets)
}

fn tallies(world: &World, sets: &[RaySet], contenders: &[Contender<'_>], worst: usize) -> Vec<Tally> {
    let sides = [contenders[0].accelerator(), contenders[1].accelerator()];
    let of = |set: &RaySet| {
        let oracle = against_brute_force(&world.geometry, set, sides);
        Tally { oracle, ..tally(&world.geometry, set, sides, worst) }
    };
    sets.iter().map(of).collect()
}

/// Samples per pixel of the compared pictures.
const PICTURE_SAMPLES: u64 = 4;

fn pictures(world: &World, camera: &CameraDesc, options: &Options) -> Result<PictureDifference> {
    let Recording { width, height, bounces, seed, .. } = options.recording;
    let means = |accel: AccelKind| {
        let settings = Settings {
            accel,
            precision: options.precision,
            isa: options.isa,
            threads: Some(options.threads),
            seed,
            ..Settings::new(width, height, PICTURE_SAMPLES, bounces)
        };
        Ok(render(world, camera, &settings, &Unwatched)?.film.means().collect())
    };
    let (embree, native): (Vec<Rgb>, Vec<Rgb>) = (means(AccelKind::Embree)?, means(AccelKind::Native)?);
    let mut difference = PictureDifference {
        width,
        height,
        samples: PICTURE_SAMPLES,
        differing: 0,
        greatest: 0.0,
        at: [0, 0],
    };
    for (i, (a, b)) in (0..).zip(embree.iter().zip(&native)) {
        difference.differing += u64::from(a.to_array().map(f64::to_bits) != b.to_array().map(f64::to_bits));
        let most = (*a - *b).abs().max_element();
        if most > difference.greatest {
            (difference.greatest, difference.at) = (most, [i % width, i / width]);
        }
    }
    Ok(difference)
}

impl Comparison {
    /// All numbers, one by one.
    pub fn figures(&self, scene: &str) -> Vec<Figure> {
        let precision = self.sides[0].kind.precision_name();
        let figure = |accelerator, measure: &str, threads, unit, value| Figure {
            mesh: scene.to_owned(),
            triangles: self.triangles,
            accelerator,
            precision,
            measure: measure.to_owned(),
            threads,
            unit,
            value,
        };
        let mut figures = Vec::new();
        for side in &self.sides {
            let name = side.kind.accel_name();
            figures.push(figure(name, "memory", None, "bytes", Spread::of(&[side.bytes as f64])));
            for (t, threads) in self.thread_counts().into_iter().enumerate() {
                figures.push(figure(name, "build", Some(threads), "s", side.build_seconds[t]));
                for (tally, rate) in self.tallies.iter().zip(&side.rates[t]) {
                    let rate = rate.scaled(1e-6);
                    figures.push(figure(name, tally.kind.name(), Some(threads), "Mrays/s", rate));
                }
            }
        }
        for tally in &self.tallies {
            for verdict in Verdict::ALL {
                let count = Spread::of(&[tally.count(verdict) as f64]);
                figures.push(figure(
                    "both",
                    &format!("{} {}", tally.kind.name(), verdict.name()),
                    None,
                    "rays",
                    count,
                ));
            }
        }
        let differing = Spread::of(&[self.picture.differing as f64]);
        figures.push(figure("both", "picture", None, "differing pixels", differing));
        figures
    }
}
