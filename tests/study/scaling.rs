//! How the cost of a sample grows: sizes, powers, charts.

use pathtracer::study::rounds::Spread;
use pathtracer::study::scaling::{Growth, Kind, Options, Step, csv, run, sheet};

fn growth(kind: Kind, cost: impl Fn(f64) -> f64) -> Growth {
    let step = |size: u64| Step { size, nanoseconds: Spread::of(&[cost(size as f64)]), error: 0.1 };
    Growth { kind, steps: [1, 10, 100, 1000].map(step).into() }
}

#[test]
fn powers_are_of_all_sizes_and_of_the_last_step() {
    let [all, last] = growth(Kind::Triangles, |n| 50.0 * n.powf(0.25)).powers();
    // Logarithms of a few units round to 1e-16.
    assert!((all - 0.25).abs() < 1e-14 && (last - 0.25).abs() < 1e-14, "{all} {last}");
    let [all, last] = growth(Kind::ShiningBalls, |n| if n < 1000.0 { 7.0 } else { 70.0 }).powers();
    assert!((last - 1.0).abs() < 1e-14 && all < 0.5, "{all} {last}");
    assert_eq!(growth(Kind::Threads, |n| 80.0 / n).speedup(), 1000.0);
}

#[test]
fn every_kind_is_measured_over_its_sizes() {
    let options = Options { isa: None, threads: 2, rounds: 2, seed: 1, quick: true };
    for (kind, sizes) in [
        (Kind::Threads, vec![1, 2]),
        (Kind::Pixels, vec![576, 2304, 9216]),
        (Kind::ShiningTriangles, vec![1, 10, 100, 1000]),
        (Kind::ShiningBalls, vec![1, 10, 100]),
    ] {
        let growth = run(kind, &options).expect("a measurement");
        assert_eq!(growth.steps.iter().map(|step| step.size).collect::<Vec<u64>>(), sizes, "{kind:?}");
        assert!(growth.steps.iter().all(|step| step.nanoseconds.min > 0.0 && step.error > 0.0), "{growth:?}");
    }
}

#[test]
fn charts_and_csv_hold_every_kind() {
    let growths = Kind::ALL.map(|kind| growth(kind, |n| 10.0 + n));
    let svg = sheet(&growths, ["the heading".into(), "the machine".into()]).svg().expect("a drawing");
    for kind in Kind::ALL {
        assert!(svg.contains(kind.name()), "{kind:?}");
    }
    assert_eq!(csv(&growths).lines().count(), 1 + 5 * 4);
}
