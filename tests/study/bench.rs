//! A bench of a small mesh: everything is there and adds up.

use pathtracer::scene::desc::MeshDesc;
use pathtracer::study::bench::{self, Options, Rung, growth};
use pathtracer::study::meshes::Family;
use pathtracer::study::rounds::Spread;
use pathtracer::study::table::Figure;

pub(super) const OPTIONS: Options =
    Options { isa: None, threads: 2, rays: 300, rounds: 2, seed: 1, leak_rays: 200 };

fn values<'f>(figures: &'f [Figure], measure: &'f str) -> impl Iterator<Item = &'f Figure> {
    figures.iter().filter(move |figure| figure.measure == measure)
}

fn contenders() -> usize {
    if cfg!(feature = "embree") { 6 } else { 3 }
}

#[test]
fn every_accelerator_is_measured_on_every_kind_of_rays() {
    let rung = bench::family(Family::Cube, 300, &OPTIONS).expect("a measurement");
    assert_eq!((rung.mesh.as_str(), rung.triangles), ("cube", 300));
    let figures = rung.figures();
    for measure in ["build", "primary", "bounce", "shadow", "random", "mean", "relative"] {
        // On one thread and on two.
        assert_eq!(values(&figures, measure).count(), 2 * contenders(), "{measure}");
    }
    for measure in ["memory", "leak random", "leak vertices", "leak edges", "leak parallel"] {
        assert_eq!(values(&figures, measure).count(), contenders(), "{measure}");
    }
    for figure in &figures {
        let range = figure.value.min..=figure.value.max;
        assert!(range.contains(&figure.value.median), "{figure:?}");
    }
}

#[test]
fn accelerators_take_memory_and_the_baseline_is_one() {
    let rung = bench::family(Family::Terrain, 1000, &OPTIONS).expect("a measurement");
    // A triangle takes a part of a leaf: at least its 36 bytes of corners, or an index.
    assert!(rung.rows.iter().all(|row| row.bytes >= 4 * rung.triangles), "{:?}", rung.rows);
    // The first accelerator's exact, robust, fast: fast is what all are related to.
    assert_eq!(rung.rows[2].relative[0].median, 1.0);
    assert!(rung.rows.iter().all(|row| row.leaks.is_empty()), "an open mesh has leaks by itself");
}

#[test]
fn exact_loses_nothing() {
    let rung = bench::family(Family::Scan, 800, &OPTIONS).expect("a measurement");
    let exact = rung.rows.iter().filter(|row| row.kind.precision_name() == "exact");
    let lost: Vec<u64> = exact.flat_map(|row| row.leaks.iter().map(|leak| leak.lost)).collect();
    assert!(!lost.is_empty() && lost.iter().all(|&lost| lost == 0), "{lost:?}");
}

#[test]
fn a_mesh_of_a_file_is_measured() {
    let part = Family::Sphere.make(400, 1);
    let positions = part.positions.iter().map(|p| p.to_array()).collect();
    let desc = MeshDesc { positions, triangles: part.triangles, ..MeshDesc::default() };
    let rung = bench::mesh("sphere.obj".into(), desc, &OPTIONS).expect("a measurement");
    assert_eq!(rung.mesh, "sphere.obj");
    assert_eq!(rung.sets.len(), 4);
}

/// A rung whose costs are powers of its size.
pub(super) fn made_up(mesh: &str, triangles: usize) -> Rung {
    let mut rung =
        bench::family(Family::Cube, 12, &Options { leak_rays: 0, ..OPTIONS }).expect("a measurement");
    let n = triangles as f64;
    (rung.mesh, rung.triangles) = (mesh.to_owned(), triangles);
    for (i, row) in (1..).zip(&mut rung.rows) {
        let speed = 1e7 * f64::from(i) / n.powf(0.25);
        row.mean = row.mean.map(|_| Spread::of(&[0.9 * speed, speed, 1.1 * speed]));
        let seconds = 1e-7 * f64::from(i) * n.powf(1.1);
        row.build_seconds = row.build_seconds.map(|_| Spread::of(&[0.8 * seconds, seconds, 1.2 * seconds]));
    }
    rung
}

#[test]
fn growth_is_the_power_of_the_size() {
    let rungs = [1000, 10_000, 100_000].map(|n| made_up("cube", n));
    let all = growth(&rungs.iter().collect::<Vec<&Rung>>());
    assert_eq!(all.len(), contenders());
    for growth in all {
        // Exact powers but for roundings of logarithms.
        assert!((growth.trace - 0.25).abs() < 1e-9, "{growth:?}");
        assert!((growth.build - 1.1).abs() < 1e-9, "{growth:?}");
    }
    assert!(growth(&[&rungs[0]]).is_empty());
}
