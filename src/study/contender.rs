//! The accelerators side by side: built in turn, timed in turn.

use super::rays::{Query, RayKind, RaySet, count_hits};
use super::rounds::{Spread, interleaved, timed};
use crate::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use crate::accel::embree::Embree;
use crate::accel::{Accelerator, BuildOptions, Isa, Precision, used_isa};
use crate::error::{Error, Result};
use crate::geometry::Geometry;
use crate::render::AccelKind;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::hint::black_box;

/// Which accelerator, and at which precision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    /// The accelerator.
    pub accel: AccelKind,
    /// How it finds hits of triangles.
    pub precision: Precision,
}

impl Kind {
    /// All accelerators that are of this build at these precisions, the default accelerator first.
    pub fn all(precisions: &[Precision]) -> Vec<Kind> {
        let of = |&accel| precisions.iter().map(move |&precision| Kind { accel, precision });
        AccelKind::BUILT.iter().flat_map(of).collect()
    }

    /// The accelerator's name.
    pub fn accel_name(self) -> &'static str {
        self.accel.name()
    }

    /// The precision's name.
    pub fn precision_name(self) -> &'static str {
        self.precision.name()
    }

    fn build(self, geometry: &Geometry, isa: Option<Isa>) -> Result<Contender<'_>> {
        let options = build_options(self.precision, isa);
        let (tracer, bytes): (Box<dyn Tracer + '_>, usize) = match self.accel {
            #[cfg(feature = "embree")]
            AccelKind::Embree => {
                let embree = Embree::build(geometry, &options)?;
                let bytes = embree.bytes();
                (Box::new(embree), bytes)
            }
            #[cfg(not(feature = "embree"))]
            AccelKind::Embree => return Err(AccelKind::Embree.missing()),
            AccelKind::Native => {
                let native = Bvh::build(geometry, &options)?;
                let bytes = native.bytes();
                (Box::new(native), bytes)
            }
        };
        Ok(Contender { kind: self, tracer, bytes, build_seconds: [Spread::default(); 2] })
    }
}

/// With everything else at its default.
pub(super) fn build_options(precision: Precision, isa: Option<Isa>) -> BuildOptions {
    let precise = BuildOptions { precision, ..BuildOptions::default() };
    BuildOptions { isa, ..precise }
}

/// An accelerator, built, with what that took.
pub struct Contender<'g> {
    /// Which one it is.
    pub kind: Kind,
    /// Seconds to build it on one thread and on all.
    pub build_seconds: [Spread; 2],
    /// Bytes of nodes and leaves, without the geometry's own arrays.
    pub bytes: usize,
    tracer: Box<dyn Tracer + 'g>,
}

impl Contender<'_> {
    /// As what it is.
    pub fn accelerator(&self) -> &dyn Accelerator {
        &*self.tracer
    }
}

/// An accelerator with its loop over rays compiled for it, as in a render.
trait Tracer: Accelerator + Send {
    fn count_hits(&self, kind: RayKind, queries: &[Query]) -> u64;
}

impl<A: Accelerator + Send> Tracer for A {
    fn count_hits(&self, kind: RayKind, queries: &[Query]) -> u64 {
        count_hits(self, kind, queries)
    }
}

/// Pools of one thread and of all.
pub struct Pools([ThreadPool; 2]);

impl Pools {
    /// Of one and of `threads` threads.
    ///
    /// # Errors
    /// Threads that can't be started.
    pub fn new(threads: usize) -> Result<Pools> {
        let pool = |threads| {
            let pool = ThreadPoolBuilder::new().num_threads(threads).build();
            pool.map_err(|error| Error::Unavailable(format!("cannot start {threads} threads: {error}")))
        };
        Ok(Pools([pool(1)?, pool(threads)?]))
    }

    /// Threads of the larger one.
    pub fn threads(&self) -> usize {
        self.0[1].current_num_threads()
    }

    /// The pool of all threads.
    pub fn all(&self) -> &ThreadPool {
        &self.0[1]
    }
}

/// A build is repeated until so many seconds a round are spent on it, or all rounds are done: so a slow build is made a
/// few times only.
const BUILD_SECONDS: f64 = 0.1;

/// Builds every kind over `geometry`, up to `rounds` times in turn, on one thread and then on all.
///
/// # Errors
/// An accelerator that this build lacks, or that can't be built; an instruction set that the machine lacks.
pub fn build<'g>(
    kinds: &[Kind],
    geometry: &'g Geometry,
    isa: Option<Isa>,
    pools: &Pools,
    rounds: usize,
) -> Result<Vec<Contender<'g>>> {
    // One thread first: Embree serves all its scenes with as many threads as the one that asked for most.
    let mut seconds = Vec::new();
    let mut built = Vec::new();
    for pool in &pools.0 {
        built.clear();
        let (last, spreads) = pool.install(|| build_in_turn(kinds, geometry, isa, rounds))?;
        built = last;
        seconds.push(spreads);
    }
    for (i, contender) in built.iter_mut().enumerate() {
        contender.build_seconds = [seconds[0][i], seconds[1][i]];
    }
    Ok(built)
}

/// The contenders of the last round, and what each kind took.
fn build_in_turn<'g>(
    kinds: &[Kind],
    geometry: &'g Geometry,
    isa: Option<Isa>,
    rounds: usize,
) -> Result<(Vec<Contender<'g>>, Vec<Spread>)> {
    let mut seconds = vec![Vec::new(); kinds.len()];
    let mut last: Vec<Option<Contender<'g>>> = kinds.iter().map(|_| None).collect();
    for _ in 0..rounds {
        for ((kind, seconds), slot) in kinds.iter().zip(&mut seconds).zip(&mut last) {
            if slot.is_some() && seconds.iter().sum::<f64>() > BUILD_SECONDS * rounds as f64 {
                continue;
            }
            // Not two at a time.
            *slot = None;
            let (contender, took) = timed(|| kind.build(geometry, isa));
            *slot = Some(contender?);
            seconds.push(took);
        }
    }
    Ok((last.into_iter().flatten().collect(), seconds.iter().map(|s| Spread::of(s)).collect()))
}

/// Rays a second by contender, set of rays, and round.
pub type Rates = Vec<Vec<Vec<f64>>>;

/// Times every contender on every set of rays, in `rounds` rounds and in turn, on one thread and on all.
pub fn measure(contenders: &[Contender<'_>], sets: &[RaySet], pools: &Pools, rounds: usize) -> [Rates; 2] {
    [0, 1].map(|i| pools.0[i].install(|| rates(contenders, sets, rounds)))
}

/// Rays that a thread takes at a time.
const PORTION: usize = 1024;

fn rates(contenders: &[Contender<'_>], sets: &[RaySet], rounds: usize) -> Rates {
    let mut jobs: Vec<(&Contender<'_>, &RaySet)> =
        sets.iter().flat_map(|set| contenders.iter().map(move |contender| (contender, set))).collect();
    let parallel = rayon::current_num_threads() > 1;
    let values = interleaved(rounds, &mut jobs, |(contender, set)| {
        let count = |queries: &[Query]| contender.tracer.count_hits(set.kind, queries);
        let queries = set.queries.as_slice();
        let (hits, seconds) = timed(|| match parallel {
            true => queries.par_chunks(PORTION).map(count).sum(),
            false => count(queries),
        });
        black_box(hits);
        queries.len() as f64 / seconds.max(1e-9)
    });
    let mut rates: Rates = contenders.iter().map(|_| Vec::new()).collect();
    for (job, values) in values.into_iter().enumerate() {
        rates[job % contenders.len()].push(values);
    }
    rates
}

/// The instruction set that is used if `isa` is asked for.
///
/// # Errors
/// The machine lacks it.
pub fn instructions(isa: Option<Isa>) -> Result<&'static str> {
    used_isa(isa).map(Isa::name)
}
