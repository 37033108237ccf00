//! What the front costs that all accelerators share: Embree's own calls in f32 beside the native accelerator, on the meshes
//! and rays of `pathtracer bench`.

use super::bare::{Bare, in_f32};
use embree_sys::RTCRay;
use pathtracer::accel::bvh::Bvh;
use pathtracer::accel::{BuildOptions, Precision};
use pathtracer::geometry::Geometry;
use pathtracer::study::meshes::Family;
use pathtracer::study::rays::{RaySet, count_hits};
use std::hint::black_box;
use std::time::Instant;

const MESHES: [(Family, usize); 4] = [
    (Family::Sphere, 1_000_000),
    (Family::Scan, 875_000),
    (Family::Scan, 70_000),
    (Family::Building, 57_000),
];
const RAYS: usize = 200_000;
const ROUNDS: usize = 5;

/// Traces the rays of a set, which are there in f32 too.
type Tracer<'g> = Box<dyn Fn(&RaySet, &[RTCRay]) -> u64 + 'g>;

/// Nanoseconds a ray of each set: medians of rounds in which the tracers take turns.
fn medians(tracers: &[Tracer<'_>], sets: &[RaySet]) -> Vec<Vec<f64>> {
    let mut all = vec![vec![0.0; sets.len()]; tracers.len()];
    for (which, set) in sets.iter().enumerate() {
        let rays: Vec<RTCRay> = set.queries.iter().map(|query| in_f32(&query.ray, query.t_max)).collect();
        let mut times = vec![Vec::new(); tracers.len()];
        for _ in 0..ROUNDS {
            for (tracer, times) in tracers.iter().zip(&mut times) {
                let start = Instant::now();
                black_box(tracer(set, &rays));
                times.push(start.elapsed().as_secs_f64() * 1e9 / rays.len() as f64);
            }
        }
        for (medians, mut times) in all.iter_mut().zip(times) {
            times.sort_by(f64::total_cmp);
            medians[which] = times[ROUNDS / 2];
        }
    }
    all
}

#[test]
#[ignore = "a measurement"]
fn embree_alone() {
    for (family, triangles) in MESHES {
        let mesh = family.make(triangles, 1);
        let geometry = Geometry::new(Vec::new(), std::slice::from_ref(&mesh));
        let native = |precision| {
            Bvh::build(&geometry, &BuildOptions { precision, ..Default::default() }).expect("a tree")
        };
        let (exact, fast) = (native(Precision::Exact), native(Precision::Fast));
        let (robust, default) = (Bare::new(&mesh, true), Bare::new(&mesh, false));
        let sets = family.view().ray_sets(&geometry, &exact, RAYS, 1);
        let tracers: [Tracer<'_>; 4] = [
            Box::new(|set, rays| default.trace(rays, set.kind.asks_any())),
            Box::new(|set, _| count_hits(&fast, set.kind, &set.queries)),
            Box::new(|set, rays| robust.trace(rays, set.kind.asks_any())),
            Box::new(|set, _| count_hits(&exact, set.kind, &set.queries)),
        ];
        let all = medians(&tracers, &sets);
        println!("{}, {} triangles: nanoseconds a ray", family.name(), mesh.triangles.len());
        for (name, which) in
            ["Embree, default", "native, fast", "Embree, robust", "native, exact"].iter().zip(0..)
        {
            let times: &[f64] = &all[which];
            let logs = times.iter().zip(&all[which / 2 * 2]).map(|(time, base)| (base / time).ln());
            let relative = (logs.sum::<f64>() / times.len() as f64).exp();
            let times: String = times.iter().map(|time| format!("{time:6.0}")).collect();
            println!("{name:16}{times}   speed {relative:.2}");
        }
    }
}
