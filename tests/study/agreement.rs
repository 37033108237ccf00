//! Tallies of answers: equal ones, a broken tie rule, a hole, displaced corners.

use pathtracer::accel::{Accelerator, BuildOptions, bvh::Bvh};
use pathtracer::geometry::{Geometry, Hit, MeshPart, PrimitiveId, Ray};
use pathtracer::math::DVec3;
use pathtracer::study::meshes::Family;
use pathtracer::study::rays::{Query, RayKind, RaySet, Sphere};
use pathtracer::study::tally::{Tally, against_brute_force, tally};
use pathtracer::study::verdict::Verdict;

fn geometry(mesh: MeshPart) -> Geometry {
    Geometry::new(Vec::new(), &[mesh])
}

fn native(geometry: &Geometry) -> Bvh<'_> {
    Bvh::build(geometry, &BuildOptions::default()).expect("a tree")
}

fn chords(geometry: &Geometry, count: usize) -> RaySet {
    Sphere::around(geometry).expect("some triangles").chords(count, 9)
}

fn adds_up(tally: &Tally) -> bool {
    tally.counts.iter().sum::<u64>() == tally.rays
}

/// Reports the last of several triangles in one place, not the first.
struct LastOfTies<'g>(Bvh<'g>, &'g Geometry);

impl Accelerator for LastOfTies<'_> {
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let first = self.0.intersect(ray)?;
        let space = &self.1.spaces[0];
        let corners = |hit: &Hit| hit.primitive.as_triangle().map(|index| space.corners32(index));
        let triangles = (0..space.triangles.len() as u32).rev();
        let mut last = triangles.map(|part| Hit { part, primitive: PrimitiveId::triangle(0, part), ..first });
        last.find(|hit| corners(hit) == corners(&first))
    }

    fn occluded(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        self.0.occluded(ray, t_max, target)
    }
}

#[test]
fn an_accelerator_agrees_with_itself() {
    let geometry = geometry(Family::Scan.make(2000, 1));
    let (a, set) = (native(&geometry), chords(&geometry, 5000));
    let found = tally(&geometry, &set, [&a, &a], 3);
    assert_eq!((found.rays, found.count(Verdict::Same)), (5000, 5000));
    assert!(found.hits[0] > 1000 && found.hits[0] == found.hits[1]);
    assert!(!found.differs() && found.worst.is_empty());
}

#[test]
fn a_broken_tie_rule_is_counted_as_ties() {
    let geometry = geometry(Family::Duplicates.make(800, 1));
    let (good, bad) = (native(&geometry), LastOfTies(native(&geometry), &geometry));
    let found = tally(&geometry, &chords(&geometry, 2000), [&good, &bad], 3);
    assert!(found.differs() && adds_up(&found));
    assert_eq!(found.count(Verdict::Tie), found.hits[0], "each face is there four times");
    assert_eq!(found.count(Verdict::Edge) + found.count(Verdict::Other), 0);
    assert_eq!(found.worst.len(), 3);
    assert!(found.worst.iter().all(|difference| difference.verdict == Verdict::Tie));
}

/// Misses whatever `is_lost` says, seen by where it was hit.
struct Lossy<'g, F>(Bvh<'g>, F);

impl<F: Fn(&Hit) -> bool + Sync> Accelerator for Lossy<'_, F> {
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.0.intersect(ray).filter(|hit| !(self.1)(hit))
    }

    fn occluded(&self, ray: &Ray, t_max: f64, _: PrimitiveId) -> bool {
        self.intersect(ray).is_some_and(|hit| hit.t < t_max)
    }
}

#[test]
fn a_missing_triangle_is_other() {
    let geometry = geometry(Family::Sphere.make(500, 1));
    let (good, bad) = (native(&geometry), Lossy(native(&geometry), |hit: &Hit| hit.part == 100));
    let found = tally(&geometry, &chords(&geometry, 20_000), [&good, &bad], 2);
    assert!(found.count(Verdict::Other) > 10 && adds_up(&found));
    assert_eq!(found.count(Verdict::Tie) + found.count(Verdict::Edge), 0);
}

#[test]
fn a_missing_triangle_is_other_for_shadow_rays_too() {
    let geometry = geometry(Family::Sphere.make(500, 1));
    let (good, bad) = (native(&geometry), Lossy(native(&geometry), |hit: &Hit| hit.part.is_multiple_of(5)));
    let chords = chords(&geometry, 2000);
    let queries = chords.queries.iter().map(|query| Query { t_max: 1e3, ..*query }).collect();
    let set = RaySet { kind: RayKind::Shadow, queries };
    let found = tally(&geometry, &set, [&good, &bad], 2);
    assert!(found.count(Verdict::Other) > 100 && adds_up(&found));
}

#[test]
fn a_leak_at_an_edge_is_told_as_such() {
    let geometry = geometry(Family::Cube.make(300, 1));
    // Within 1e-9 of an edge of a triangle, which f32 can't tell from the edge.
    let is_at_edge = |hit: &Hit| hit.u.min(hit.v).min(1.0 - hit.u - hit.v).abs() < 1e-9;
    let (good, bad) = (native(&geometry), Lossy(native(&geometry), is_at_edge));
    let queries = (0..500)
        .map(|i| {
            // On the diagonals of the cells of the upper face.
            let x = f64::from(i) / 250.0 - 0.999;
            Query::closest(Ray::new(DVec3::new(x, x, 5.0), DVec3::NEG_Z))
        })
        .collect();
    let found = tally(&geometry, &RaySet { kind: RayKind::Primary, queries }, [&good, &bad], 2);
    assert!(found.count(Verdict::Edge) > 400 && adds_up(&found), "{:?}", found.counts);
    assert_eq!(found.count(Verdict::Other), 0, "{:?}", found.worst);
}

#[test]
fn the_worst_come_first() {
    let geometry = geometry(Family::Duplicates.make(800, 1));
    let broken = LastOfTies(native(&geometry), &geometry);
    let lossy = Lossy(native(&geometry), |hit: &Hit| hit.part == 7);
    let found = tally(&geometry, &chords(&geometry, 5000), [&lossy, &broken], 10_000);
    let verdicts: Vec<Verdict> = found.worst.iter().map(|difference| difference.verdict).collect();
    assert!(verdicts.is_sorted_by(|a, b| a >= b));
    assert_eq!(verdicts.len() as u64, found.rays - found.count(Verdict::Same));
}

#[test]
fn brute_force_tells_which_one_is_wrong() {
    let geometry = geometry(Family::Sphere.make(500, 1));
    let (good, bad) = (native(&geometry), Lossy(native(&geometry), |hit: &Hit| hit.part.is_multiple_of(10)));
    let oracle = against_brute_force(&geometry, &chords(&geometry, 1000), [&good, &bad]);
    assert_eq!((oracle.rays, oracle.differing[0]), (1000, 0));
    assert!(oracle.differing[1] > 0);
}
