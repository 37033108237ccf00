//! Accelerators: equal answers, no leaks, ties, odd rays, and the structure of the tree.

mod few_solids;
mod identity;
mod mutations;
mod odd_rays;
mod structure;
mod ties;
mod watertight;

use pathtracer::accel::bvh::Bvh;
use pathtracer::accel::{BuildOptions, BvhQuality, Isa, Precision, check_isa};
use pathtracer::geometry::Geometry;

/// The native accelerator with the machine's best instructions.
fn native(geometry: &Geometry) -> Bvh<'_> {
    Bvh::build(geometry, &BuildOptions { precision: Precision::Exact, ..Default::default() }).unwrap()
}

/// All of them.
const QUALITIES: [BvhQuality; 3] = [BvhQuality::Fast, BvhQuality::Default, BvhQuality::Quality];

/// The native accelerator, exact, with a tree of this quality.
fn native_of(geometry: &Geometry, quality: BvhQuality) -> Bvh<'_> {
    let options = BuildOptions { precision: Precision::Exact, quality, ..Default::default() };
    Bvh::build(geometry, &options).unwrap()
}

/// The instruction sets that this machine has.
fn instruction_sets() -> impl Iterator<Item = Isa> {
    [Isa::Sse2, Isa::Avx2, Isa::Avx512].into_iter().filter(|&isa| check_isa(Some(isa)).is_ok())
}

/// The native accelerator in every instruction set that this machine has.
fn every_isa(geometry: &Geometry, precision: Precision) -> Vec<Bvh<'_>> {
    let options = |isa| BuildOptions { precision, isa: Some(isa), ..Default::default() };
    instruction_sets().map(|isa| Bvh::build(geometry, &options(isa)).expect("a tree")).collect()
}
