//! The node test in SSE2, AVX2 and AVX-512, chosen at run time. All `unsafe` of the tree is in this file.
//!
//! A whole traversal is compiled for each instruction set: functions with `#[target_feature]` are not inlined into
//! callers without it, so the choice is made once a ray, at the entry points below.
#![allow(unsafe_code)]

use std::arch::x86_64::*;
use std::mem::MaybeUninit;

use super::node::{Child, MAX_DEPTH, Node, NodeRay, WIDTH};
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
    /// Eight distances.
    type Distances: Copy;

    /// A bit for every child whose box may be entered at a distance in [0, `limit`], and the distances, rounded down.
    ///
    /// A far plane through the origin of a ray parallel to it gives NaN. `min` and `max` return their second operand
    /// if one is NaN, so the distance so far comes second.
    fn enter(self, node: &Node, ray: &NodeRay, limit: f32) -> (u32, Self::Distances);

    /// The distances one by one.
    fn to_array(self, near: Self::Distances) -> [f32; WIDTH];

    /// Puts the children in `mask`, three or more, on the stack, the nearest last.
    ///
    /// Every instruction set orders by the same keys, the distance without its lowest bits and then the lane, so that
    /// all visit the same nodes in the same order: the f32 leaf depends on it in the last bits.
    #[inline(always)]
    fn push_sorted(self, node: &Node, mut mask: u32, near: Self::Distances, stack: &mut Stack) {
        let near = self.to_array(near);
        let bottom = stack.len;
        while mask != 0 {
            let lane = mask.trailing_zeros() as usize & 7;
            mask &= mask - 1;
            let key = near[lane].to_bits() & !LANE_BITS | lane as u32;
            stack.push(Entry::new(f32::from_bits(key), node.children[lane]));
        }
        stack.sort_from(bottom);
    }
}

/// Where the planes that are met first and last on an axis are in [`Node::planes`].
#[inline(always)]
fn planes(node: &Node, ray: &NodeRay, axis: usize) -> (*const f32, *const f32) {
    let first = ray.first_planes[axis];
    // The other plane of the axis: both places are below six, and their sum is 2 * axis + 3.
    let last = 2 * axis + 3 - first;
    let start = node.planes.as_ptr();
    (start.wrapping_add(first).cast(), start.wrapping_add(last).cast())
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
    type Distances = [__m128; 2];

    #[inline(always)]
    fn enter(self, node: &Node, ray: &NodeRay, limit: f32) -> (u32, [__m128; 2]) {
        // SAFETY: there is SSE2 (`Sse2::new`); `planes` points at eight aligned lanes.
        unsafe {
            let mut distances = [_mm_setzero_ps(); 2];
            let mut mask = 0;
            for (half, near) in distances.iter_mut().enumerate() {
                let mut far = _mm_set1_ps(limit);
                for axis in 0..3 {
                    let (first, last) = planes(node, ray, axis);
                    let (first, last) = (first.add(4 * half), last.add(4 * half));
                    let first = _mm_sub_ps(_mm_load_ps(first), _mm_set1_ps(ray.near_origin[axis]));
                    let last = _mm_sub_ps(_mm_load_ps(last), _mm_set1_ps(ray.far_origin[axis]));
                    *near = _mm_max_ps(_mm_mul_ps(first, _mm_set1_ps(ray.near_reciprocal[axis])), *near);
                    far = _mm_min_ps(_mm_mul_ps(last, _mm_set1_ps(ray.far_reciprocal[axis])), far);
                }
                mask |= (_mm_movemask_ps(_mm_cmple_ps(*near, far)) as u32) << (4 * half);
            }
            (mask, distances)
        }
    }

    #[inline(always)]
    fn to_array(self, near: [__m128; 2]) -> [f32; WIDTH] {
        let mut lanes = [0f32; WIDTH];
        // SAFETY: there is SSE2; `lanes` has two times four lanes.
        unsafe {
            _mm_storeu_ps(lanes.as_mut_ptr(), near[0]);
            _mm_storeu_ps(lanes.as_mut_ptr().add(4), near[1]);
        }
        lanes
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

    /// Where the boxes are entered and left.
    #[inline(always)]
    fn interval(self, node: &Node, ray: &NodeRay, limit: f32) -> (__m256, __m256) {
        // SAFETY: there is AVX2 (`Avx2::new`); `planes` points at eight aligned lanes.
        unsafe {
            let (mut near, mut far) = (_mm256_setzero_ps(), _mm256_set1_ps(limit));
            for axis in 0..3 {
                let (first, last) = planes(node, ray, axis);
                let first = _mm256_sub_ps(_mm256_load_ps(first), _mm256_set1_ps(ray.near_origin[axis]));
                let last = _mm256_sub_ps(_mm256_load_ps(last), _mm256_set1_ps(ray.far_origin[axis]));
                near = _mm256_max_ps(_mm256_mul_ps(first, _mm256_set1_ps(ray.near_reciprocal[axis])), near);
                far = _mm256_min_ps(_mm256_mul_ps(last, _mm256_set1_ps(ray.far_reciprocal[axis])), far);
            }
            (near, far)
        }
    }

    /// The lanes of `keys` in descending order, as signed integers: a bitonic network (Batcher 1968).
    #[inline(always)]
    fn sort(self, keys: __m256i) -> __m256i {
        /// Exchanges with the shuffled lanes; the lanes in `LESS` take the lesser one.
        macro_rules! exchange {
            ($keys:expr, $shuffled:expr, $less:literal) => {{
                let (keys, shuffled) = ($keys, $shuffled);
                let (more, less) = (_mm256_max_epi32(keys, shuffled), _mm256_min_epi32(keys, shuffled));
                _mm256_blend_epi32::<$less>(more, less)
            }};
        }
        // SAFETY: there is AVX2.
        unsafe {
            let keys = exchange!(keys, _mm256_shuffle_epi32::<0b10_11_00_01>(keys), 0b1010_1010);
            let keys = exchange!(keys, _mm256_shuffle_epi32::<0b00_01_10_11>(keys), 0b1100_1100);
            let keys = exchange!(keys, _mm256_shuffle_epi32::<0b10_11_00_01>(keys), 0b1010_1010);
            let reversed = _mm256_permutevar8x32_epi32(keys, _mm256_setr_epi32(7, 6, 5, 4, 3, 2, 1, 0));
            let keys = exchange!(keys, reversed, 0b1111_0000);
            let keys = exchange!(keys, _mm256_shuffle_epi32::<0b01_00_11_10>(keys), 0b1100_1100);
            exchange!(keys, _mm256_shuffle_epi32::<0b10_11_00_01>(keys), 0b1010_1010)
        }
    }
}

impl Lanes for Avx2 {
    type Distances = __m256;

    #[inline(always)]
    fn enter(self, node: &Node, ray: &NodeRay, limit: f32) -> (u32, __m256) {
        let (near, far) = self.interval(node, ray, limit);
        // SAFETY: there is AVX2.
        (unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(near, far)) as u32 }, near)
    }

    #[inline(always)]
    fn to_array(self, near: __m256) -> [f32; WIDTH] {
        let mut lanes = [0f32; WIDTH];
        // SAFETY: there is AVX2; `lanes` has eight lanes.
        unsafe { _mm256_storeu_ps(lanes.as_mut_ptr(), near) };
        lanes
    }

    #[inline(always)]
    fn push_sorted(self, node: &Node, mask: u32, near: __m256, stack: &mut Stack) {
        // SAFETY: there is AVX2; the children are eight lanes of 32 bits.
        unsafe {
            // The lane's number in the lowest bits of its distance; lanes that are not hit become negative.
            let numbers = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
            let bits = _mm256_andnot_si256(_mm256_set1_epi32(LANE_BITS as i32), _mm256_castps_si256(near));
            let bits_of_lanes = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let missed = _mm256_cmpeq_epi32(
                _mm256_and_si256(_mm256_set1_epi32(mask as i32), bits_of_lanes),
                _mm256_setzero_si256(),
            );
            let keys = self.sort(_mm256_or_si256(_mm256_or_si256(bits, numbers), missed));
            let children = _mm256_loadu_si256(node.children.as_ptr().cast());
            // The permutation looks at the lowest three bits only, which hold the lane's number.
            let children = _mm256_permutevar8x32_epi32(children, keys);
            let (even, odd) = (_mm256_unpacklo_epi32(children, keys), _mm256_unpackhi_epi32(children, keys));
            let entries =
                [_mm256_permute2x128_si256::<0x20>(even, odd), _mm256_permute2x128_si256::<0x31>(even, odd)];
            stack.push_many(std::mem::transmute::<[__m256i; 2], [Entry; WIDTH]>(entries), mask.count_ones());
        }
    }
}

/// AVX2 with mask registers, and twice as many registers to keep the ray in.
#[derive(Clone, Copy)]
struct Avx512(Avx2);

impl Avx512 {
    /// # Safety
    /// The machine has AVX-512 F and VL.
    #[inline(always)]
    unsafe fn new() -> Avx512 {
        // SAFETY: AVX-512 includes AVX2.
        Avx512(unsafe { Avx2::new() })
    }
}

impl Lanes for Avx512 {
    type Distances = __m256;

    #[inline(always)]
    fn enter(self, node: &Node, ray: &NodeRay, limit: f32) -> (u32, __m256) {
        let (near, far) = self.0.interval(node, ray, limit);
        // SAFETY: there is AVX-512 (`Avx512::new`).
        (unsafe { _mm256_cmp_ps_mask::<_CMP_LE_OQ>(near, far).into() }, near)
    }

    #[inline(always)]
    fn to_array(self, near: __m256) -> [f32; WIDTH] {
        self.0.to_array(near)
    }

    #[inline(always)]
    fn push_sorted(self, node: &Node, mask: u32, near: __m256, stack: &mut Stack) {
        self.0.push_sorted(node, mask, near, stack);
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

/// Bits of an entry's distance that are not part of it.
const LANE_BITS: u32 = 7;

/// A child and the distance at which its box begins, less its lowest three bits. Entries compare by distance first: the
/// bits of floating point numbers that are not negative are ordered like the numbers.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
#[repr(transparent)]
pub(super) struct Entry(u64);

impl Entry {
    /// `near` is not negative.
    #[inline(always)]
    pub(super) fn new(near: f32, child: Child) -> Entry {
        Entry(u64::from(near.to_bits()) << 32 | u64::from(child.bits()))
    }

    #[inline(always)]
    pub(super) fn child(self) -> Child {
        Child::from_bits(self.0 as u32)
    }

    #[inline(always)]
    fn near(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32 & !LANE_BITS)
    }
}

/// Every node on the way down leaves at most all of its children here; [`Stack::push_many`] needs room for as many more.
const CAPACITY: usize = (MAX_DEPTH + 1) * WIDTH;

/// Children yet to be visited: last in, first out.
///
/// The entries before `len` are written; the others are left as they are, because to clear 2 kB a ray takes longer than
/// to visit a node.
pub(super) struct Stack {
    entries: [MaybeUninit<Entry>; CAPACITY],
    len: usize,
}

impl Stack {
    #[inline(always)]
    pub(super) fn new() -> Stack {
        Stack { entries: [const { MaybeUninit::uninit() }; CAPACITY], len: 0 }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, entry: Entry) {
        self.entries[self.len].write(entry);
        self.len += 1;
    }

    /// Pushes the first `count` of these, at most eight.
    #[inline(always)]
    fn push_many(&mut self, entries: [Entry; WIDTH], count: u32) {
        let room = &mut self.entries[self.len..self.len + WIDTH];
        room.copy_from_slice(&entries.map(MaybeUninit::new));
        self.len += (count as usize).min(WIDTH);
    }

    /// The last one.
    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<Entry> {
        self.len = self.len.checked_sub(1)?;
        // SAFETY: it was written when `len` rose above it.
        Some(unsafe { self.entries[self.len].assume_init() })
    }

    /// The next child whose box begins within `limit`.
    #[inline(always)]
    pub(super) fn pop_within(&mut self, limit: f32) -> Option<Child> {
        while let Some(entry) = self.pop() {
            if entry.near() <= limit {
                return Some(entry.child());
            }
        }
        None
    }

    /// Brings the entries from `bottom` on into order, the nearest last.
    #[inline(always)]
    fn sort_from(&mut self, bottom: usize) {
        // SAFETY: everything before `len` has been written.
        let at = |entries: &[MaybeUninit<Entry>], place: usize| unsafe { entries[place].assume_init() };
        for end in bottom + 1..self.len {
            let mut place = end;
            while place > bottom && at(&self.entries, place - 1) < at(&self.entries, place) {
                self.entries.swap(place - 1, place);
                place -= 1;
            }
        }
    }
}
