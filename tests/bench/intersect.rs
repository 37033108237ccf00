//! The kernels one by one: a thousand rays of each kind against a scanned body of 10,000 triangles, and its builds.
//! `cargo bench` runs all, `cargo bench -- native` a part.

use criterion::{Criterion, Throughput};
use pathtracer::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use pathtracer::accel::embree::Embree;
use pathtracer::accel::{Accelerator, BuildOptions, Precision};
use pathtracer::geometry::Geometry;
use pathtracer::study::meshes::Family;
use pathtracer::study::rays::{RaySet, count_hits};
use std::hint::black_box;

const TRIANGLES: usize = 10_000;
const RAYS: usize = 1000;
const PRECISIONS: [(&str, Precision); 3] =
    [("exact", Precision::Exact), ("robust", Precision::Robust), ("fast", Precision::Fast)];

fn options(precision: Precision) -> BuildOptions {
    BuildOptions { precision, ..BuildOptions::default() }
}

fn trace<A: Accelerator>(criterion: &mut Criterion, name: &str, accelerator: &A, sets: &[RaySet]) {
    let mut group = criterion.benchmark_group(name);
    group.throughput(Throughput::Elements(RAYS as u64));
    for set in sets {
        group.bench_function(set.kind.name(), |bencher| {
            bencher.iter(|| count_hits(accelerator, set.kind, black_box(&set.queries)));
        });
    }
}

fn intersect(criterion: &mut Criterion) {
    let geometry = Geometry::new(Vec::new(), &[Family::Scan.make(TRIANGLES, 1)]);
    let native = |precision| Bvh::build(&geometry, &options(precision)).expect("a tree");
    let sets = Family::Scan.view().ray_sets(&geometry, &native(Precision::Exact), RAYS, 1);
    for (name, precision) in PRECISIONS {
        trace(criterion, &format!("native {name}"), &native(precision), &sets);
        #[cfg(feature = "embree")]
        {
            let embree = Embree::build(&geometry, &options(precision)).expect("a scene");
            trace(criterion, &format!("embree {name}"), &embree, &sets);
        }
    }
}

fn build(criterion: &mut Criterion) {
    let geometry = Geometry::new(Vec::new(), &[Family::Scan.make(TRIANGLES, 1)]);
    let mut group = criterion.benchmark_group("build");
    group.throughput(Throughput::Elements(TRIANGLES as u64)).sample_size(20);
    for (name, precision) in PRECISIONS {
        group.bench_function(format!("native {name}"), |bencher| {
            bencher.iter(|| Bvh::build(&geometry, &options(precision)).expect("a tree").bytes());
        });
        #[cfg(feature = "embree")]
        group.bench_function(format!("embree {name}"), |bencher| {
            bencher.iter(|| Embree::build(&geometry, &options(precision)).expect("a scene").bytes());
        });
    }
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    intersect(&mut criterion);
    build(&mut criterion);
    criterion.final_summary();
}
