//! The node test in SSE2, AVX2 and AVX-512, chosen at run time. All `unsafe` of the tree is in this file.
//!
//! A whole traversal is compiled for each instruction set: functions with `#[target_feature]` are not inlined into
//! callers without it, so the choice is made once a ray, at the entry points below.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::node::{Node, NodeRay};
use super::traverse::{self, Leaf};
use crate::accel::Isa;
use crate::error::{Error, Result};

/// An instruction set that this machine has; can only be had from [`Instructions::choose`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Instructions(Isa);

impl Instructions {
    /// The set asked for, or the machine's best.
    pub(super) fn choose(wanted: Option<Isa>) -> Result<Instructions> {
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
    pub(super) fn isa(self) -> Isa {
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
    pub(super) fn any<L: Leaf>(self, nodes: &[Node], ray: &NodeRay, leaf: &L) -> bool {
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

// FMA is not enabled: leaves must round every product, and the node test gains nothing from it.
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn closest_avx2<L: Leaf>(nodes: &[Node], ray: &NodeRay, leaf: &mut L) {
    // SAFETY: this function is only called where there is AVX2.
    traverse::closest(nodes, ray, leaf, unsafe { Avx2::new() });
}

#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn any_avx2<L: Leaf>(nodes: &[Node], ray: &NodeRay, leaf: &L) -> bool {
    // SAFETY: this function is only called where there is AVX2.
    traverse::any(nodes, ray, leaf, unsafe { Avx2::new() })
}

#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt")]
fn closest_avx512<L: Leaf>(nodes: &[Node], ray: &NodeRay, leaf: &mut L) {
    // SAFETY: this function is only called where there is AVX-512.
    traverse::closest(nodes, ray, leaf, unsafe { Avx512::new() });
}

#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,bmi1,bmi2,lzcnt,popcnt")]
fn any_avx512<L: Leaf>(nodes: &[Node], ray: &NodeRay, leaf: &L) -> bool {
    // SAFETY: this function is only called where there is AVX-512.
    traverse::any(nodes, ray, leaf, unsafe { Avx512::new() })
}

/// The node test in one instruction set. A value of such a type is the proof that the machine has it.
pub(super) trait Lanes: Copy {
    /// A bit for every child whose box may be entered at a distance in [0, `limit`], and the distances, rounded down.
    ///
    /// A far plane through the origin of a ray parallel to it gives NaN. `min` and `max` return their second operand
    /// if one is NaN, so the distance so far comes second.
    fn enter(self, node: &Node, ray: &NodeRay, limit: f32) -> (u32, [f32; 8]);
}

/// Where the planes that are met first and last on an axis are in [`Node::planes`].
#[inline(always)]
fn planes(node: &Node, ray: &NodeRay, axis: usize) -> (*const f32, *const f32) {
    let upper_first = 3 * usize::from(ray.upper_first[axis]);
    let first = node.planes.as_ptr().cast::<f32>();
    // In bounds: axis < 3, so both are below 6 * 8.
    (first.wrapping_add(8 * (axis + upper_first)), first.wrapping_add(8 * (axis + 3 - upper_first)))
}

/// Two registers of four lanes.
#[derive(Clone, Copy)]
struct Sse2(());

impl Sse2 {
    /// # Safety
    /// The machine has SSE2.
    #[inline(always)]
    unsafe fn new() -> Sse2 {
        Sse2(())
    }
}

impl Lanes for Sse2 {
    #[inline(always)]
    fn enter(self, node: &Node, ray: &NodeRay, limit: f32) -> (u32, [f32; 8]) {
        let mut distances = [0f32; 8];
        let mut mask = 0;
        for half in [0, 4] {
            // SAFETY: there is SSE2 (`Sse2::new`); `planes` points at eight aligned lanes, `distances` has eight.
            unsafe {
                let (mut near, mut far) = (_mm_setzero_ps(), _mm_set1_ps(limit));
                for axis in 0..3 {
                    let (first, last) = planes(node, ray, axis);
                    let origin = _mm_set1_ps(ray.origin[axis]);
                    let first = _mm_sub_ps(_mm_load_ps(first.add(half)), origin);
                    let last = _mm_sub_ps(_mm_load_ps(last.add(half)), origin);
                    near = _mm_max_ps(_mm_mul_ps(first, _mm_set1_ps(ray.near_reciprocal[axis])), near);
                    far = _mm_min_ps(_mm_mul_ps(last, _mm_set1_ps(ray.far_reciprocal[axis])), far);
                }
                mask |= (_mm_movemask_ps(_mm_cmple_ps(near, far)) as u32) << half;
                _mm_storeu_ps(distances.as_mut_ptr().add(half), near);
            }
        }
        (mask, distances)
    }
}

/// One register of eight lanes.
#[derive(Clone, Copy)]
struct Avx2(());

impl Avx2 {
    /// # Safety
    /// The machine has AVX2.
    #[inline(always)]
    unsafe fn new() -> Avx2 {
        Avx2(())
    }
}

/// Where the boxes are entered and left.
///
/// # Safety
/// The machine has AVX.
#[inline(always)]
unsafe fn interval(node: &Node, ray: &NodeRay, limit: f32) -> (__m256, __m256) {
    // SAFETY: there is AVX; `planes` points at eight aligned lanes.
    unsafe {
        let (mut near, mut far) = (_mm256_setzero_ps(), _mm256_set1_ps(limit));
        for axis in 0..3 {
            let (first, last) = planes(node, ray, axis);
            let origin = _mm256_set1_ps(ray.origin[axis]);
            let first = _mm256_sub_ps(_mm256_load_ps(first), origin);
            let last = _mm256_sub_ps(_mm256_load_ps(last), origin);
            near = _mm256_max_ps(_mm256_mul_ps(first, _mm256_set1_ps(ray.near_reciprocal[axis])), near);
            far = _mm256_min_ps(_mm256_mul_ps(last, _mm256_set1_ps(ray.far_reciprocal[axis])), far);
        }
        (near, far)
    }
}

impl Lanes for Avx2 {
    #[inline(always)]
    fn enter(self, node: &Node, ray: &NodeRay, limit: f32) -> (u32, [f32; 8]) {
        let mut distances = [0f32; 8];
        // SAFETY: there is AVX2 (`Avx2::new`); `distances` has eight lanes.
        unsafe {
            let (near, far) = interval(node, ray, limit);
            _mm256_storeu_ps(distances.as_mut_ptr(), near);
            (_mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(near, far)) as u32, distances)
        }
    }
}

/// One register of eight lanes and mask registers.
#[derive(Clone, Copy)]
struct Avx512(());

impl Avx512 {
    /// # Safety
    /// The machine has AVX-512 F and VL.
    #[inline(always)]
    unsafe fn new() -> Avx512 {
        Avx512(())
    }
}

impl Lanes for Avx512 {
    #[inline(always)]
    fn enter(self, node: &Node, ray: &NodeRay, limit: f32) -> (u32, [f32; 8]) {
        let mut distances = [0f32; 8];
        // SAFETY: there is AVX-512 (`Avx512::new`); `distances` has eight lanes.
        unsafe {
            let (near, far) = interval(node, ray, limit);
            _mm256_storeu_ps(distances.as_mut_ptr(), near);
            (_mm256_cmp_ps_mask::<_CMP_LE_OQ>(near, far).into(), distances)
        }
    }
}
