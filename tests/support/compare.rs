//! Two accelerators on the same rays.

use pathtracer::accel::Accelerator;
use pathtracer::geometry::{Hit, PrimitiveId, Ray};
use rayon::prelude::*;

/// What one accelerator says of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Answer {
    pub(crate) hit: Option<Hit>,
    /// Whether anything is in the way up to infinity, up to the hit, and up to a little beyond it.
    pub(crate) occluded: [bool; 3],
}

impl Answer {
    /// Asks an accelerator for what is in the way of a ray that hits `hit`; `t` is where the any-hit queries end.
    fn of(accelerator: &(impl Accelerator + ?Sized), ray: &Ray, hit: Option<Hit>, t: f64) -> Answer {
        let ends = [f64::INFINITY, t, t * (1.0 + 1e-12)];
        Answer { hit, occluded: ends.map(|end| accelerator.occluded(ray, end, PrimitiveId::NONE)) }
    }

    /// Equal to the last bit.
    fn same(&self, other: &Answer) -> bool {
        let bits = |hit: &Hit| {
            (hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), hit.object, hit.primitive, hit.part)
        };
        self.hit.as_ref().map(bits) == other.hit.as_ref().map(bits) && self.occluded == other.occluded
    }
}

/// A ray on which two accelerators disagree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Difference {
    pub(crate) ray: Ray,
    pub(crate) answers: [Answer; 2],
}

/// All rays on which two accelerators disagree in any bit.
pub(crate) fn differences<A, B>(a: &A, b: &B, rays: &[Ray]) -> Vec<Difference>
where
    A: Accelerator + ?Sized,
    B: Accelerator + ?Sized,
{
    rays.par_iter()
        .filter_map(|&ray| {
            let hits = [a.intersect(&ray), b.intersect(&ray)];
            let t = hits[0].map_or(1.0, |hit| hit.t);
            let answers = [Answer::of(a, &ray, hits[0], t), Answer::of(b, &ray, hits[1], t)];
            (!answers[0].same(&answers[1])).then_some(Difference { ray, answers })
        })
        .collect()
}

/// Fails with the first few differences.
pub(crate) fn assert_identical<A, B>(what: &str, a: &A, b: &B, rays: &[Ray])
where
    A: Accelerator + ?Sized,
    B: Accelerator + ?Sized,
{
    let found = differences(a, b, rays);
    let first = found.iter().take(3).map(|difference| {
        let Difference { ray, answers: [a, b] } = difference;
        format!("\nfrom {:?} along {:?}:\n  {a:?}\n  {b:?}", ray.origin, ray.direction)
    });
    let first: String = first.collect();
    assert!(found.is_empty(), "{what}: {} of {} rays differ:{first}", found.len(), rays.len());
}

/// How many rays hit anything.
pub(crate) fn count_hits(accelerator: &impl Accelerator, rays: &[Ray]) -> usize {
    rays.par_iter().filter(|ray| accelerator.intersect(ray).is_some()).count()
}
