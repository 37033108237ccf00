//! A comparison of a small scene, and what breaks the promise of exact.

use pathtracer::accel::Precision;
use pathtracer::math::{DVec3, Rgb};
use pathtracer::study::compare::{self, Comparison, Options};
use pathtracer::study::meshes::Family;
use pathtracer::study::record::Recording;
use pathtracer::study::verdict::Verdict;
use pathtracer::world::World;

use crate::support::build;

/// A soup of triangles beside a lamp.
fn compared(precision: Precision) -> Comparison {
    let soup = Family::Soup.make(500, 1);
    let positions = soup.positions.iter().map(|p| p.to_array()).collect();
    let objects = vec![
        (build::mesh(positions, soup.triangles), build::diffuse(Rgb::splat(0.7))),
        (build::ball(DVec3::new(0.0, 0.0, 3.0), 0.5), build::glowing(Rgb::ZERO, Rgb::splat(4.0))),
    ];
    let mut desc = build::scene(DVec3::new(4.0, 0.0, 1.0), DVec3::ZERO, objects);
    desc.camera.fov = 0.2;
    let world = World::compile(&desc).expect("a valid scene");
    let recording = Recording { width: 24, height: 16, samples: 1, bounces: 4, rays: 300, seed: 1 };
    let options = Options { precision, isa: None, threads: 2, recording, rounds: 1, worst: 2 };
    compare::run(&world, &desc.camera, &options, &|_| ()).expect("a comparison")
}

#[test]
fn exact_keeps_its_promise() {
    let found = compared(Precision::Exact);
    assert_eq!((found.triangles, found.solids, found.instances), (500, 1, 0));
    assert!(!found.differs() && !found.breaks_promise());
    for tally in &found.tallies {
        assert_eq!(tally.counts.iter().sum::<u64>(), tally.rays, "{}", tally.kind.name());
        assert!(tally.hits[0] > 0 && tally.oracle.rays == tally.rays, "{}", tally.kind.name());
    }
    assert_eq!(found.tallies.len(), 4);
}

#[test]
fn any_difference_breaks_the_promise_of_exact_only() {
    let mut found = compared(Precision::Exact);
    found.tallies[1].counts[Verdict::Same as usize] -= 1;
    found.tallies[1].counts[Verdict::Tie as usize] += 1;
    assert!(found.breaks_promise());
    found.precision = Precision::Robust;
    assert!(found.differs() && !found.breaks_promise());
}

#[test]
fn a_pixel_or_brute_force_breaks_it_too() {
    let mut found = compared(Precision::Exact);
    found.picture.differing = 1;
    assert!(found.breaks_promise());
    found.picture.differing = 0;
    assert!(!found.breaks_promise());
    found.tallies[0].oracle.differing = [0, 1];
    assert!(found.breaks_promise());
}
