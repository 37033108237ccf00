//! The node test in SSE2, AVX2 and AVX-512, chosen at run time. All `unsafe` of the tree is in this folder.
//!
//! A whole traversal is compiled for each instruction set: functions with `#[target_feature]` are not inlined into
//! callers without it, so the choice is made at the entry points below: once for all triangles of the world, and again
//! for solids and instances.
#![allow(unsafe_code)]

mod avx2;
mod sse2;
mod stack;

use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};

use self::avx2::Avx2;
use self::sse2::Sse2;
use self::stack::LANE_BITS;
pub(super) use self::stack::{Entry, Stack};
use super::Bvh;
use super::front::Using;
use super::node::{Node, NodeRay};
use super::traverse::{self, Leaf};
use crate::accel::{Isa, front_any, front_closest};
use crate::error::{Error, Result};
use crate::geometry::{Hit, Lanes, LinearSolids, Nearest, PrimitiveId, Ray};
#[cfg(feature = "embree")]
use crate::geometry::{ShearedRay, TriangleBlock, TriangleHit, any_in_lanes, closest_in_lanes};

/// An instruction set that this machine has; can only be had from [`Instructions::choose`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::accel) struct Instructions(Isa);

impl Instructions {
    /// The set asked for, or the machine's best.
    pub(in crate::accel) fn choose(wanted: Option<Isa>) -> Result<Instructions> {
        let best = best();
        match wanted {
            Some(isa) if isa > best => Err(Error::Usage(format!(
                "this machine has no {}; its best instruction set is {}",
                name(isa),
                name(best)
            ))),
            Some(isa) => Ok(Instructions(isa)),
            None => Ok(Instructions(best)),
        }
    }

    /// Which it is.
    pub(in crate::accel) fn isa(self) -> Isa {
        self.0
    }

    /// [`traverse::closest`] in these instructions.
    #[inline]
    pub(super) fn closest<L: Leaf>(self, nodes: &[Node], ray: &NodeRay, leaf: &mut L) {
        match self.0 {
            // SAFETY: SSE2 is part of x86-64.
            Isa::Sse2 => traverse::closest(nodes, ray, leaf, unsafe { Sse2::new() }),
            // SAFETY: `choose` has found these instructions.
            Isa::Avx2 => unsafe { closest_avx2(nodes, ray, leaf) },
            // SAFETY: as above.
            Isa::Avx512 => unsafe { closest_avx512(nodes, ray, leaf) },
        }
    }

    /// [`traverse::any`] in these instructions.
    #[inline]
    pub(super) fn any<L: Leaf>(self, nodes: &[Node], ray: &NodeRay, leaf: &mut L) -> bool {
        match self.0 {
            // SAFETY: SSE2 is part of x86-64.
            Isa::Sse2 => traverse::any(nodes, ray, leaf, unsafe { Sse2::new() }),
            // SAFETY: `choose` has found these instructions.
            Isa::Avx2 => unsafe { any_avx2(nodes, ray, leaf) },
            // SAFETY: as above.
            Isa::Avx512 => unsafe { any_avx512(nodes, ray, leaf) },
        }
    }
}

/// The front, with the trees of triangles.
impl Instructions {
    /// [`front_closest`] in these instructions.
    #[inline]
    pub(super) fn front_closest<const FAST: bool>(self, bvh: &Bvh, ray: &Ray) -> Option<Hit> {
        match self.0 {
            Isa::Sse2 => front_closest_sse2::<FAST>(bvh, ray),
            // SAFETY: `choose` has found these instructions.
            Isa::Avx2 => unsafe { front_closest_avx2::<FAST>(bvh, ray) },
            // SAFETY: as above.
            Isa::Avx512 => unsafe { front_closest_avx512::<FAST>(bvh, ray) },
        }
    }

    /// [`front_any`] in these instructions.
    #[inline]
    pub(super) fn front_any<const FAST: bool>(
        self,
        bvh: &Bvh,
        ray: &Ray,
        t_max: f64,
        target: PrimitiveId,
    ) -> bool {
        match self.0 {
            Isa::Sse2 => front_any_sse2::<FAST>(bvh, ray, t_max, target),
            // SAFETY: `choose` has found these instructions.
            Isa::Avx2 => unsafe { front_any_avx2::<FAST>(bvh, ray, t_max, target) },
            // SAFETY: as above.
            Isa::Avx512 => unsafe { front_any_avx512::<FAST>(bvh, ray, t_max, target) },
        }
    }
}

/// Solids without a tree.
impl Instructions {
    /// [`LinearSolids::closest`] in these instructions.
    #[inline]
    pub(in crate::accel) fn closest_abreast(self, solids: &LinearSolids, ray: &Ray) -> Nearest {
        match self.0 {
            // SAFETY: SSE2 is part of x86-64.
            Isa::Sse2 => solids.closest(ray, unsafe { Sse2::new() }),
            // SAFETY: `choose` has found these instructions, or more.
            Isa::Avx2 | Isa::Avx512 => unsafe { closest_abreast_avx2(solids, ray) },
        }
    }

    /// [`LinearSolids::any`] in these instructions.
    #[inline]
    pub(in crate::accel) fn any_abreast(
        self,
        solids: &LinearSolids,
        ray: &Ray,
        t_max: f64,
        target: PrimitiveId,
    ) -> Option<bool> {
        match self.0 {
            // SAFETY: SSE2 is part of x86-64.
            Isa::Sse2 => solids.any(ray, t_max, target, unsafe { Sse2::new() }),
            // SAFETY: `choose` has found these instructions, or more.
            Isa::Avx2 | Isa::Avx512 => unsafe { any_abreast_avx2(solids, ray, t_max, target) },
        }
    }
}

// Nothing below is contracted to FMA: leaves must round every product, and the node test gains nothing from it. So AVX2 is
// enabled without it, and where AVX-512 brings it, the compiler does not contract what is written as two operations.
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn closest_abreast_avx2(solids: &LinearSolids, ray: &Ray) -> Nearest {
    // SAFETY: this function is only called where there is AVX2.
    solids.closest(ray, unsafe { Avx2::new() })
}

#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn any_abreast_avx2(solids: &LinearSolids, ray: &Ray, t_max: f64, target: PrimitiveId) -> Option<bool> {
    // SAFETY: this function is only called where there is AVX2.
    solids.any(ray, t_max, target, unsafe { Avx2::new() })
}

/// The shared leaf alone, for Embree's callbacks.
#[cfg(feature = "embree")]
impl Instructions {
    /// [`closest_in_lanes`] in these instructions.
    #[inline]
    pub(in crate::accel) fn closest_in_block(
        self,
        block: &TriangleBlock,
        ray: &ShearedRay,
        best: &mut Option<TriangleHit>,
    ) -> bool {
        match self.0 {
            // SAFETY: SSE2 is part of x86-64.
            Isa::Sse2 => closest_in_lanes(block, ray, best, unsafe { Sse2::new() }),
            // SAFETY: `choose` has found these instructions, or more.
            Isa::Avx2 | Isa::Avx512 => unsafe { closest_in_avx2(block, ray, best) },
        }
    }

    /// [`any_in_lanes`] in these instructions.
    #[inline]
    pub(in crate::accel) fn any_in_block(self, block: &TriangleBlock, ray: &ShearedRay) -> bool {
        match self.0 {
            // SAFETY: SSE2 is part of x86-64.
            Isa::Sse2 => any_in_lanes(block, ray, unsafe { Sse2::new() }),
            // SAFETY: `choose` has found these instructions, or more.
            Isa::Avx2 | Isa::Avx512 => unsafe { any_in_avx2(block, ray) },
        }
    }
}

#[cfg(feature = "embree")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn closest_in_avx2(block: &TriangleBlock, ray: &ShearedRay, best: &mut Option<TriangleHit>) -> bool {
    // SAFETY: this function is only called where there is AVX2.
    closest_in_lanes(block, ray, best, unsafe { Avx2::new() })
}

#[cfg(feature = "embree")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn any_in_avx2(block: &TriangleBlock, ray: &ShearedRay) -> bool {
    // SAFETY: this function is only called where there is AVX2.
    any_in_lanes(block, ray, unsafe { Avx2::new() })
}

fn best() -> Isa {
    let avx2 = is_x86_feature_detected!("avx2")
        && is_x86_feature_detected!("fma")
        && is_x86_feature_detected!("bmi1")
        && is_x86_feature_detected!("bmi2")
        && is_x86_feature_detected!("lzcnt")
        && is_x86_feature_detected!("popcnt");
    let avx512 = avx2
        && is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512bw")
        && is_x86_feature_detected!("avx512dq")
        && is_x86_feature_detected!("avx512vl");
    match (avx2, avx512) {
        (_, true) => Isa::Avx512,
        (true, _) => Isa::Avx2,
        _ => Isa::Sse2,
    }
}

fn name(isa: Isa) -> &'static str {
    match isa {
        Isa::Sse2 => "SSE2",
        Isa::Avx2 => "AVX2",
        Isa::Avx512 => "AVX-512",
    }
}

fn front_closest_sse2<const FAST: bool>(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    // SAFETY: SSE2 is part of x86-64.
    front_closest(&Using::<_, FAST> { bvh, lanes: unsafe { Sse2::new() } }, ray)
}

fn front_any_sse2<const FAST: bool>(bvh: &Bvh, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
    // SAFETY: SSE2 is part of x86-64.
    front_any(&Using::<_, FAST> { bvh, lanes: unsafe { Sse2::new() } }, ray, t_max, target)
}

#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn front_closest_avx2<const FAST: bool>(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    // SAFETY: this function is only called where there is AVX2.
    front_closest(&Using::<_, FAST> { bvh, lanes: unsafe { Avx2::new() } }, ray)
}

#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn front_any_avx2<const FAST: bool>(bvh: &Bvh, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
    // SAFETY: this function is only called where there is AVX2.
    front_any(&Using::<_, FAST> { bvh, lanes: unsafe { Avx2::new() } }, ray, t_max, target)
}

#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt")]
fn front_closest_avx512<const FAST: bool>(bvh: &Bvh, ray: &Ray) -> Option<Hit> {
    // SAFETY: this function is only called where there is AVX-512.
    front_closest(&Using::<_, FAST> { bvh, lanes: unsafe { Avx2::new() } }, ray)
}

#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt")]
fn front_any_avx512<const FAST: bool>(bvh: &Bvh, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
    // SAFETY: this function is only called where there is AVX-512.
    front_any(&Using::<_, FAST> { bvh, lanes: unsafe { Avx2::new() } }, ray, t_max, target)
}

#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn closest_avx2<L: Leaf>(nodes: &[Node], ray: &NodeRay, leaf: &mut L) {
    // SAFETY: this function is only called where there is AVX2.
    traverse::closest(nodes, ray, leaf, unsafe { Avx2::new() });
}

#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn any_avx2<L: Leaf>(nodes: &[Node], ray: &NodeRay, leaf: &mut L) -> bool {
    // SAFETY: this function is only called where there is AVX2.
    traverse::any(nodes, ray, leaf, unsafe { Avx2::new() })
}

#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt")]
fn closest_avx512<L: Leaf>(nodes: &[Node], ray: &NodeRay, leaf: &mut L) {
    // SAFETY: this function is only called where there is AVX-512.
    traverse::closest(nodes, ray, leaf, unsafe { Avx2::new() });
}

#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt")]
fn any_avx512<L: Leaf>(nodes: &[Node], ray: &NodeRay, leaf: &mut L) -> bool {
    // SAFETY: this function is only called where there is AVX-512.
    traverse::any(nodes, ray, leaf, unsafe { Avx2::new() })
}

/// The node test in one instruction set.
pub(super) trait NodeTest: Lanes {
    /// The ray where the test finds it soonest.
    type Ray;

    /// Brings a ray there.
    fn prepare(self, ray: &NodeRay) -> Self::Ray;

    /// A bit for every child whose box may be entered at a distance in [0, `limit`], and the distances, rounded down.
    fn enter(self, node: &Node, ray: &Self::Ray, limit: f32) -> (u32, Self::Floats);

    /// Puts the children in `mask`, three or more, on the stack, the nearest last.
    ///
    /// Every instruction set orders by the same keys, the distance without its lowest bits and then the lane, so that
    /// all visit the same nodes in the same order: the f32 leaf depends on it in the last bits.
    #[inline(always)]
    fn push_sorted(self, node: &Node, mut mask: u32, near: Self::Floats, stack: &mut Stack) {
        let near = self.to_array(near);
        let bottom = stack.len();
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            let key = near[lane].to_bits() & !LANE_BITS | lane as u32;
            stack.push(Entry::new(f32::from_bits(key), node.children[lane]));
        }
        stack.sort_from(bottom);
    }
}

/// Asks for `LINES` lines of 64 bytes that will be needed soon.
#[inline(always)]
pub(super) fn prefetch<const LINES: usize>(start: *const u8) {
    for line in 0..LINES {
        // SAFETY: SSE is part of x86-64; a prefetch may be given any address.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(start.wrapping_add(64 * line).cast()) };
    }
}
