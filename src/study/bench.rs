//! Both accelerators at all precisions on meshes of growing size.

use super::contender::{self, Contender, Kind, Pools, build_options};
use super::leaks::{self, Aim};
use super::meshes::Family;
use super::rays::{RayKind, RaySet, Sphere};
use super::record::{Recording, rays_of_paths};
use super::rounds::{Spread, geometric_mean};
use super::seams;
use super::statistics::slope;
use super::view::View;
use super::{table::Figure, triangles};
use crate::accel::bvh::Bvh;
use crate::accel::{Isa, Precision};
use crate::error::Result;
use crate::geometry::{Geometry, MeshPart};
use crate::math::DVec3;
use crate::render::AccelKind;
use crate::scene::desc::{CameraDesc, MeshDesc};
use crate::world::World;

/// How to measure.
#[derive(Clone, Debug)]
pub struct Options {
    /// The most instructions to use, or `None` for the machine's best.
    pub isa: Option<Isa>,
    /// Threads of the measurements on all threads.
    pub threads: usize,
    /// Rays of each kind.
    pub rays: usize,
    /// How often everything is timed, at least 1.
    pub rounds: usize,
    /// Seed of meshes and rays.
    pub seed: u64,
    /// Rays of each kind that look for leaks, or 0.
    pub leak_rays: usize,
}

/// One mesh, measured.
#[derive(Clone, Debug)]
pub struct Rung {
    /// Name of the family, or of the file.
    pub mesh: String,
    /// Its triangles.
    pub triangles: usize,
    /// The kinds of rays that were traced, and how many.
    pub sets: Vec<(RayKind, usize)>,
    /// The threads of the measurements on all threads.
    pub threads: usize,
    /// Every accelerator at every precision.
    pub rows: Vec<Row>,
}

/// One accelerator at one precision on one mesh.
#[derive(Clone, Debug)]
pub struct Row {
    /// Which one.
    pub kind: Kind,
    /// Seconds to build it, on one thread and on all.
    pub build_seconds: [Spread; 2],
    /// Bytes of nodes and leaves.
    pub bytes: usize,
    /// Rays a second on one thread and on all, in the order of [`Rung::sets`].
    pub rates: [Vec<Spread>; 2],
    /// Geometric mean of the rates over the sets.
    pub mean: [Spread; 2],
    /// That mean relative to the baseline's in the same round: Embree at fast where it is compiled in, else native.
    pub relative: [Spread; 2],
    /// Of how many rays that must hit how many did not.
    pub leaks: Vec<Leak>,
}

/// Rays that were lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leak {
    /// What they were aimed at.
    pub aim: Aim,
    /// How many were traced.
    pub rays: u64,
    /// How many hit nothing.
    pub lost: u64,
}

/// Bytes that measuring takes, at most, for a mesh of so many triangles: the mesh in f64 and f32, and all accelerators at
/// once, each while it is built.
pub fn memory_bytes(triangles: usize) -> u64 {
    triangles as u64 * 1000
}

/// Measures a generated mesh.
pub fn family(family: Family, triangles: usize, options: &Options) -> Result<Rung> {
    let geometry = triangles::geometry_of(family.make(triangles, options.seed));
    let mut leak_rays = Vec::new();
    if options.leak_rays > 0 && family.is_closed() {
        let aims = Aim::INSIDE.into_iter().chain((family == Family::Cube).then_some(Aim::Parallel));
        leak_rays =
            aims.map(|aim| (aim, leaks::rays(&geometry, aim, options.leak_rays, options.seed))).collect();
    }
    let pools = Pools::new(options.threads)?;
    let sets = seen(&geometry, family.view(), options, &pools)?;
    let (mut rung, contenders) = measure(family.name().to_owned(), &geometry, &sets, options, &pools)?;
    for (row, contender) in rung.rows.iter_mut().zip(&contenders) {
        let leak = |(aim, rays): &(Aim, Vec<_>)| {
            let lost = pools.all().install(|| leaks::lost(contender.accelerator(), rays));
            Leak { aim: *aim, rays: rays.len() as u64, lost }
        };
        row.leaks = leak_rays.iter().map(leak).collect();
    }
    Ok(rung)
}

/// Measures the mesh of a file, seen from outside.
pub fn mesh(name: String, desc: MeshDesc, options: &Options) -> Result<Rung> {
    let upright = |[x, y, z]: [f64; 3]| DVec3::new(x, -z, y);
    let positions = desc.positions.into_iter().map(upright).collect();
    let geometry = triangles::geometry_of(MeshPart { object: 0, positions, triangles: desc.triangles });
    let pools = Pools::new(options.threads)?;
    let sphere = Sphere::around(&geometry).unwrap_or(Sphere { center: Default::default(), radius: 1.0 });
    let sets = seen(&geometry, View::onto(&sphere), options, &pools)?;
    Ok(measure(name, &geometry, &sets, options, &pools)?.0)
}

/// Width and height of the picture whose paths give the rays of a scene.
pub fn scene_size(options: &Options) -> [u32; 2] {
    let height = ((options.rays as f64 * 9.0 / 16.0).sqrt().round() as u32).max(1);
    [(options.rays as u32).div_ceil(height), height]
}

/// Measures a scene with the rays of its own paths.
pub fn scene(name: String, world: &World, camera: &CameraDesc, options: &Options) -> Result<Rung> {
    let pools = Pools::new(options.threads)?;
    let [width, height] = scene_size(options);
    let recording =
        Recording { width, height, samples: 1, bounces: 8, rays: options.rays, seed: options.seed };
    let mut sets = pools.all().install(|| {
        let recorder = Bvh::build(&world.geometry, &build_options(Precision::Exact, options.isa))?;
        Ok(rays_of_paths(world, camera, &recorder, &recording))
    })?;
    let sphere = Sphere::around(&world.geometry);
    sets.extend(sphere.map(|sphere| sphere.chords(options.rays, options.seed)));
    let (mut rung, contenders) = measure(name, &world.geometry, &sets, options, &pools)?;
    if options.leak_rays > 0 {
        let rays =
            Aim::INSIDE.map(|aim| (aim, seams::rays(&world.geometry, aim, options.leak_rays, options.seed)));
        for (row, contender) in rung.rows.iter_mut().zip(&contenders) {
            let leak = |(aim, rays): &(Aim, Vec<seams::Sure>)| {
                let lost = pools.all().install(|| seams::lost(contender.accelerator(), rays));
                Leak { aim: *aim, rays: rays.len() as u64, lost }
            };
            row.leaks = rays.iter().filter(|(_, rays)| !rays.is_empty()).map(leak).collect();
        }
    }
    Ok(rung)
}

fn seen(geometry: &Geometry, view: View, options: &Options, pools: &Pools) -> Result<Vec<RaySet>> {
    pools.all().install(|| {
        let accelerator = Bvh::build(geometry, &build_options(Precision::Exact, options.isa))?;
        Ok(view.ray_sets(geometry, &accelerator, options.rays, options.seed))
    })
}

fn measure<'g>(
    mesh: String,
    geometry: &'g Geometry,
    sets: &[RaySet],
    options: &Options,
    pools: &Pools,
) -> Result<(Rung, Vec<Contender<'g>>)> {
    let sets: Vec<RaySet> = sets.iter().filter(|set| !set.queries.is_empty()).cloned().collect();
    let kinds = Kind::all(&Precision::ALL);
    let contenders = contender::build(&kinds, geometry, options.isa, pools, options.rounds)?;
    let rates = contender::measure(&contenders, &sets, pools, options.rounds);
    // Geometric means by thread count, contender and round.
    let mean =
        |t: usize, i: usize, round: usize| geometric_mean(rates[t][i].iter().map(|values| values[round]));
    let means =
        |t: usize, i: usize| (0..options.rounds).map(move |round| mean(t, i, round)).collect::<Vec<f64>>();
    let wanted = if cfg!(feature = "embree") { AccelKind::Embree } else { AccelKind::Native };
    let baseline = Kind { accel: wanted, precision: Precision::Fast };
    let baseline = kinds.iter().position(|&kind| kind == baseline).unwrap_or(0);
    let row = |(i, contender): (usize, &Contender<'_>)| {
        let relative = |t: usize| {
            let ratios: Vec<f64> = means(t, i).iter().zip(means(t, baseline)).map(|(a, b)| a / b).collect();
            Spread::of(&ratios)
        };
        Row {
            kind: contender.kind,
            build_seconds: contender.build_seconds,
            bytes: contender.bytes,
            rates: [0, 1].map(|t| rates[t][i].iter().map(|values| Spread::of(values)).collect()),
            mean: [0, 1].map(|t| Spread::of(&means(t, i))),
            relative: [0, 1].map(relative),
            leaks: Vec::new(),
        }
    };
    let rung = Rung {
        mesh,
        triangles: triangles::count(geometry),
        sets: sets.iter().map(|set| (set.kind, set.queries.len())).collect(),
        threads: pools.threads(),
        rows: contenders.iter().enumerate().map(row).collect(),
    };
    Ok((rung, contenders))
}

impl Rung {
    /// The threads of the measurements: one, and all where that is more.
    pub fn thread_counts(&self) -> Vec<usize> {
        if self.threads == 1 { vec![1] } else { vec![1, self.threads] }
    }

    /// All numbers, one by one.
    pub fn figures(&self) -> Vec<Figure> {
        self.rows.iter().flat_map(|row| self.figures_of(row)).collect()
    }

    fn figures_of(&self, row: &Row) -> Vec<Figure> {
        let figure = |measure: &str, threads, unit, value| Figure {
            mesh: self.mesh.clone(),
            triangles: self.triangles,
            accelerator: row.kind.accel_name(),
            precision: row.kind.precision_name(),
            measure: measure.to_owned(),
            threads,
            unit,
            value,
        };
        let mut figures = vec![figure("memory", None, "bytes", Spread::of(&[row.bytes as f64]))];
        for (t, threads) in self.thread_counts().into_iter().enumerate() {
            let threads = Some(threads);
            figures.push(figure("build", threads, "s", row.build_seconds[t]));
            let rates = self.sets.iter().zip(&row.rates[t]);
            figures.extend(
                rates.map(|((kind, _), rate)| figure(kind.name(), threads, "Mrays/s", rate.scaled(1e-6))),
            );
            figures.push(figure("mean", threads, "Mrays/s", row.mean[t].scaled(1e-6)));
            figures.push(figure("relative", threads, "1", row.relative[t]));
        }
        figures.extend(row.leaks.iter().map(|leak| {
            let share = leak.lost as f64 / leak.rays.max(1) as f64;
            figure(&format!("leak {}", leak.aim.name()), None, "lost/ray", Spread::of(&[share]))
        }));
        figures
    }
}

/// How a cost grows with the number of triangles n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// Which accelerator.
    pub kind: Kind,
    /// The time of a ray, the geometric mean over the sets on one thread, grows as n to this power.
    pub trace: f64,
    /// The time of a build on one thread grows as n to this power.
    pub build: f64,
}

/// The growth over rungs of one mesh, by least squares in logarithms; empty for fewer than two sizes.
pub fn growth(rungs: &[&Rung]) -> Vec<Growth> {
    let Some(first) = rungs.first() else { return Vec::new() };
    if rungs.iter().all(|rung| rung.triangles == first.triangles) {
        return Vec::new();
    }
    let power = |cost: &dyn Fn(&Row) -> f64, i: usize| {
        slope(rungs.iter().map(|rung| ((rung.triangles as f64).ln(), cost(&rung.rows[i]).max(1e-12).ln())))
    };
    let of = |(i, row): (usize, &Row)| Growth {
        kind: row.kind,
        trace: power(&|row| 1.0 / row.mean[0].median, i),
        build: power(&|row| row.build_seconds[0].median, i),
    };
    first.rows.iter().enumerate().map(of).collect()
}
