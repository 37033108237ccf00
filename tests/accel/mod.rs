//! Accelerators: equal answers, no leaks, ties, odd rays, and the structure of the tree.

mod identity;
mod mutations;
mod odd_rays;
mod structure;
mod ties;
mod watertight;

use pathtracer::accel::bvh::Bvh;
use pathtracer::accel::{BuildOptions, Isa, Precision};
use pathtracer::geometry::Geometry;

/// The native accelerator with the machine's best instructions.
fn native(geometry: &Geometry) -> Bvh<'_> {
    Bvh::build(geometry, &BuildOptions { precision: Precision::Exact, isa: None }).unwrap()
}

/// The native accelerator in every instruction set that this machine has.
fn every_isa(geometry: &Geometry, precision: Precision) -> Vec<Bvh<'_>> {
    let sets = [Isa::Sse2, Isa::Avx2, Isa::Avx512];
    sets.into_iter()
        .filter_map(|isa| Bvh::build(geometry, &BuildOptions { precision, isa: Some(isa) }).ok())
        .collect()
}
