//! How two accelerators agree on a set of rays.

use super::rays::{Query, RayKind, RaySet};
use super::triangles;
use super::verdict::Verdict;
use crate::accel::Accelerator;
use crate::accel::brute_force::BruteForce;
use crate::geometry::{Geometry, Hit};
use rayon::prelude::*;

/// Counts of one kind of rays.
#[derive(Clone, Debug)]
pub struct Tally {
    /// What the rays ask.
    pub kind: RayKind,
    /// How many were asked.
    pub rays: u64,
    /// How many hit, by accelerator.
    pub hits: [u64; 2],
    /// How many got each verdict, in the order of [`Verdict::ALL`].
    pub counts: [u64; 4],
    /// The worst differences, worst first.
    pub worst: Vec<Difference>,
    /// A sample of the rays against brute force.
    pub oracle: Oracle,
}

/// How two accelerators differ from brute force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Oracle {
    /// How many rays were tried.
    pub rays: u64,
    /// On how many of them each accelerator gives another answer.
    pub differing: [u64; 2],
}

/// A ray with two answers.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// What the difference is.
    pub verdict: Verdict,
    /// The ray.
    pub query: Query,
    /// What each accelerator says.
    pub answers: [Answer; 2],
}

/// What an accelerator says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// To who asks for the closest hit.
    Closest(Option<Hit>),
    /// To who asks whether anything is in the way.
    Occluded(bool),
}

impl Answer {
    fn of(accelerator: &dyn Accelerator, kind: RayKind, query: &Query) -> Answer {
        if kind.asks_any() {
            Answer::Occluded(accelerator.occluded(&query.ray, query.t_max, query.target))
        } else {
            Answer::Closest(accelerator.intersect(&query.ray))
        }
    }

    fn is_hit(&self) -> bool {
        matches!(self, Answer::Closest(Some(_)) | Answer::Occluded(true))
    }
}

impl Tally {
    /// How many rays got a verdict.
    pub fn count(&self, verdict: Verdict) -> u64 {
        self.counts[verdict as usize]
    }

    /// Whether any answer differs from another.
    pub fn differs(&self) -> bool {
        self.count(Verdict::Same) < self.rays || self.oracle.differing != [0, 0]
    }
}

impl Difference {
    /// How far apart the answers are, as a share of the nearer distance; infinite if only one is a hit.
    fn gap(&self) -> f64 {
        match self.answers {
            [Answer::Closest(Some(a)), Answer::Closest(Some(b))] => (a.t - b.t).abs() / a.t.min(b.t),
            _ => f64::INFINITY,
        }
    }
}

/// Asks both accelerators every ray and keeps the `worst` differences.
pub fn tally(geometry: &Geometry, set: &RaySet, sides: [&dyn Accelerator; 2], worst: usize) -> Tally {
    let judged = |query: &Query| {
        let answers = sides.map(|side| Answer::of(side, set.kind, query));
        let verdict = verdict(geometry, query, answers, sides);
        Difference { verdict, query: *query, answers }
    };
    let mut tally = Tally {
        kind: set.kind,
        rays: set.queries.len() as u64,
        hits: [0; 2],
        counts: [0; 4],
        worst: Vec::new(),
        oracle: Oracle::default(),
    };
    // By portions, so that the answers of millions of rays need not be held.
    for portion in set.queries.chunks(1 << 16) {
        let all: Vec<Difference> = portion.par_iter().map(judged).collect();
        for difference in &all {
            tally.counts[difference.verdict as usize] += 1;
            for (hits, answer) in tally.hits.iter_mut().zip(&difference.answers) {
                *hits += u64::from(answer.is_hit());
            }
        }
        tally.worst.extend(all.into_iter().filter(|difference| difference.verdict != Verdict::Same));
        tally.worst.sort_by(|a, b| b.verdict.cmp(&a.verdict).then(b.gap().total_cmp(&a.gap())));
        tally.worst.truncate(worst);
    }
    tally
}

fn verdict(
    geometry: &Geometry,
    query: &Query,
    answers: [Answer; 2],
    sides: [&dyn Accelerator; 2],
) -> Verdict {
    match answers {
        [Answer::Closest(a), Answer::Closest(b)] => Verdict::on_hits(geometry, &query.ray, a, b),
        [Answer::Occluded(a), Answer::Occluded(b)] if a == b => Verdict::Same,
        [Answer::Occluded(true), _] => Verdict::on_shadow(geometry, query, sides[0]),
        _ => Verdict::on_shadow(geometry, query, sides[1]),
    }
}

/// Tests of a ray against a primitive that brute force may make for one set of rays.
const BRUTE_FORCE_TESTS: usize = 100_000_000;

/// Asks brute force too, as many evenly chosen rays of the set as are affordable.
pub fn against_brute_force(geometry: &Geometry, set: &RaySet, sides: [&dyn Accelerator; 2]) -> Oracle {
    let affordable = BRUTE_FORCE_TESTS / triangles::seen_count(geometry).max(1);
    let step = set.queries.len().div_ceil(affordable.max(1)).max(1);
    let brute_force = BruteForce::new(geometry);
    let differs = |query: &Query| {
        let oracle = Answer::of(&brute_force, set.kind, query);
        sides.map(|side| {
            let answers = [oracle, Answer::of(side, set.kind, query)];
            u64::from(verdict(geometry, query, answers, [&brute_force, side]) != Verdict::Same)
        })
    };
    let sample: Vec<[u64; 2]> = set.queries.par_iter().step_by(step).map(differs).collect();
    let differing = [0, 1].map(|side| sample.iter().map(|counts| counts[side]).sum());
    Oracle { rays: sample.len() as u64, differing }
}
