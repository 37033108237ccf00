//! AVX2: one register of eight lanes.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::super::node::{Node, NodeRay, WIDTH};
use super::NodeTest;
use super::stack::{Entry, LANE_BITS, Stack};
use crate::geometry::{Doubles, FourDoubles, Lanes};

/// The proof that there is AVX2.
#[derive(Clone, Copy)]
pub(super) struct Avx2(());

impl Avx2 {
    /// # Safety
    /// The machine has AVX2.
    #[inline(always)]
    pub(super) unsafe fn new() -> Avx2 {
        Avx2(())
    }

    // Not by a closure, which would not be inlined for certain.
    #[inline(always)]
    fn splat_each(self, [x, y, z]: [f32; 3]) -> [__m256; 3] {
        [self.splat(x), self.splat(y), self.splat(z)]
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
    type Floats = __m256;

    #[inline(always)]
    fn load(self, lanes: &[f32; 8]) -> __m256 {
        // SAFETY: there is AVX2 (`Avx2::new`); there are eight lanes.
        unsafe { _mm256_loadu_ps(lanes.as_ptr()) }
    }

    #[inline(always)]
    fn to_array(self, a: __m256) -> [f32; 8] {
        let mut lanes = [0f32; 8];
        // SAFETY: as above.
        unsafe { _mm256_storeu_ps(lanes.as_mut_ptr(), a) };
        lanes
    }

    #[inline(always)]
    fn splat(self, x: f32) -> __m256 {
        // SAFETY: there is AVX2.
        unsafe { _mm256_set1_ps(x) }
    }

    #[inline(always)]
    fn add(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: there is AVX2.
        unsafe { _mm256_add_ps(a, b) }
    }

    #[inline(always)]
    fn sub(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: there is AVX2.
        unsafe { _mm256_sub_ps(a, b) }
    }

    #[inline(always)]
    fn mul(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: there is AVX2.
        unsafe { _mm256_mul_ps(a, b) }
    }

    #[inline(always)]
    fn div(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: there is AVX2.
        unsafe { _mm256_div_ps(a, b) }
    }

    #[inline(always)]
    fn min(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: there is AVX2.
        unsafe { _mm256_min_ps(a, b) }
    }

    #[inline(always)]
    fn max(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: there is AVX2.
        unsafe { _mm256_max_ps(a, b) }
    }

    #[inline(always)]
    fn abs(self, a: __m256) -> __m256 {
        // SAFETY: there is AVX2.
        unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), a) }
    }

    #[inline(always)]
    fn at_most(self, a: __m256, b: __m256) -> u32 {
        // SAFETY: there is AVX2.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32 }
    }
}

impl Doubles for Avx2 {
    type Double = __m256d;
    type Mask = __m256d;

    #[inline(always)]
    fn same(self, x: f64) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_set1_pd(x) }
    }

    #[inline(always)]
    fn plus(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_add_pd(a, b) }
    }

    #[inline(always)]
    fn minus(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_sub_pd(a, b) }
    }

    #[inline(always)]
    fn times(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_mul_pd(a, b) }
    }

    #[inline(always)]
    fn over(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_div_pd(a, b) }
    }

    #[inline(always)]
    fn lesser(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_min_pd(a, b) }
    }

    #[inline(always)]
    fn greater(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_max_pd(a, b) }
    }

    #[inline(always)]
    fn both(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_and_pd(a, b) }
    }

    #[inline(always)]
    fn root(self, a: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_sqrt_pd(a) }
    }

    #[inline(always)]
    fn size(self, a: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), a) }
    }

    #[inline(always)]
    fn with_sign(self, a: __m256d, sign: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe {
            let signs = _mm256_set1_pd(-0.0);
            _mm256_or_pd(_mm256_and_pd(signs, sign), _mm256_andnot_pd(signs, a))
        }
    }

    #[inline(always)]
    fn is_less(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_cmp_pd::<_CMP_LT_OQ>(a, b) }
    }

    #[inline(always)]
    fn is_at_most(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_cmp_pd::<_CMP_LE_OQ>(a, b) }
    }

    #[inline(always)]
    fn differs(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_cmp_pd::<_CMP_NEQ_UQ>(a, b) }
    }

    #[inline(always)]
    fn choose(self, mask: __m256d, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: there is AVX2.
        unsafe { _mm256_blendv_pd(b, a, mask) }
    }
}

impl FourDoubles for Avx2 {
    #[inline(always)]
    fn read(self, lanes: &[f64; 4]) -> __m256d {
        // SAFETY: there is AVX2; there are four lanes.
        unsafe { _mm256_loadu_pd(lanes.as_ptr()) }
    }

    #[inline(always)]
    fn to_memory(self, a: __m256d) -> [f64; 4] {
        let mut lanes = [0f64; 4];
        // SAFETY: as above.
        unsafe { _mm256_storeu_pd(lanes.as_mut_ptr(), a) };
        lanes
    }

    #[inline(always)]
    fn any(self, mask: __m256d) -> bool {
        // SAFETY: there is AVX2.
        unsafe { _mm256_movemask_pd(mask) != 0 }
    }
}

/// A ray in nine registers.
#[derive(Clone, Copy)]
pub(super) struct WideRay {
    near_origin: [__m256; 3],
    far_origin: [__m256; 3],
    reciprocal: [__m256; 3],
    backwards: [usize; 3],
}

impl NodeTest for Avx2 {
    type Ray = WideRay;

    #[inline(always)]
    fn prepare(self, ray: &NodeRay) -> WideRay {
        WideRay {
            near_origin: self.splat_each(ray.near_origin),
            far_origin: self.splat_each(ray.far_origin),
            reciprocal: self.splat_each(ray.reciprocal),
            backwards: ray.backwards,
        }
    }

    #[inline(always)]
    fn enter(self, node: &Node, ray: &WideRay, limit: f32) -> (u32, __m256) {
        let (mut near, mut far) = (self.splat(0.0), self.splat(limit));
        for axis in 0..3 {
            let (first, last) = node.planes_along(axis, ray.backwards[axis]);
            let first = self.sub(self.load(first), ray.near_origin[axis]);
            let last = self.sub(self.load(last), ray.far_origin[axis]);
            near = self.max(self.mul(first, ray.reciprocal[axis]), near);
            far = self.min(self.mul(last, ray.reciprocal[axis]), far);
        }
        (self.at_most(near, far), near)
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
