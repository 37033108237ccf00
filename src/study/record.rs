//! The rays of real paths, recorded once.

use super::rays::{Query, RayKind, RaySet, thinned};
use crate::accel::Accelerator;
use crate::geometry::{Hit, PrimitiveId, Ray};
use crate::integrator::{Counters, PathTracer};
use crate::sampling::{Sampler, Sobol};
use crate::scene::desc::CameraDesc;
use crate::world::World;
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Which paths are recorded, and how much of them is kept.
#[derive(Clone, Copy, Debug)]
pub struct Recording {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Paths a pixel.
    pub samples: u32,
    /// The longest path in segments.
    pub bounces: u32,
    /// The most rays of a kind; of more, evenly chosen ones are kept.
    pub rays: usize,
    /// Seed of the paths.
    pub seed: u64,
}

/// The primary, bounce and shadow rays of the paths of a render, in the order in which one thread would ask them.
pub fn rays_of_paths<A: Accelerator>(
    world: &World,
    camera: &CameraDesc,
    accelerator: &A,
    recording: &Recording,
) -> Vec<RaySet> {
    let camera = world.camera(camera, recording.width, recording.height);
    let sampler = Sobol::new(recording.seed);
    let row = |y: u32| {
        let recorder = Recorder::new(accelerator);
        let tracer = PathTracer::new(world, &camera, &recorder, recording.bounces, true);
        for x in 0..recording.width {
            for index in 0..recording.samples {
                recorder.begin_path();
                tracer.sample(&sampler, x, y, index.into(), &mut Counters::default());
            }
        }
        recorder.into_log()
    };
    let rows: Vec<Log> = (0..recording.height).into_par_iter().map(row).collect();
    let all = |queries: fn(&Log) -> &Vec<Query>| {
        thinned(rows.iter().flat_map(|log| queries(log).iter().copied()).collect(), recording.rays)
    };
    vec![
        RaySet { kind: RayKind::Primary, queries: all(|log| &log.primary) },
        RaySet { kind: RayKind::Bounce, queries: all(|log| &log.bounce) },
        RaySet { kind: RayKind::Shadow, queries: all(|log| &log.shadow) },
    ]
}

/// An accelerator that writes down what it is asked.
struct Recorder<'a, A> {
    accelerator: &'a A,
    log: Mutex<Log>,
}

#[derive(Default)]
struct Log {
    /// Whether the next ray to the closest hit is the first of its path.
    begins: bool,
    primary: Vec<Query>,
    bounce: Vec<Query>,
    shadow: Vec<Query>,
}

impl<'a, A> Recorder<'a, A> {
    fn new(accelerator: &'a A) -> Recorder<'a, A> {
        Recorder { accelerator, log: Mutex::default() }
    }

    fn begin_path(&self) {
        self.write(|log| log.begins = true);
    }

    fn write(&self, add: impl FnOnce(&mut Log)) {
        add(&mut self.log.lock().unwrap_or_else(PoisonError::into_inner));
    }

    fn into_log(self) -> Log {
        self.log.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<A: Accelerator> Accelerator for Recorder<'_, A> {
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.write(|log| {
            let rays = if log.begins { &mut log.primary } else { &mut log.bounce };
            rays.push(Query::closest(*ray));
            log.begins = false;
        });
        self.accelerator.intersect(ray)
    }

    fn occluded(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        self.write(|log| log.shadow.push(Query { ray: *ray, t_max, target }));
        self.accelerator.occluded(ray, t_max, target)
    }
}
