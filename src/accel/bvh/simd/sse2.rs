//! SSE2: two registers of four lanes.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::super::node::{Node, NodeRay, WIDTH};
use super::NodeTest;
use crate::geometry::{Doubles, FourDoubles, Lanes};

/// The proof that there is SSE2.
#[derive(Clone, Copy)]
pub(super) struct Sse2(());

impl Sse2 {
    /// # Safety
    /// The machine has SSE2.
    #[inline(always)]
    pub(super) unsafe fn new() -> Sse2 {
        Sse2(())
    }
}

/// The operation on both halves.
macro_rules! both {
    ($operation:ident, $a:expr, $b:expr) => {
        // SAFETY: there is SSE2 (`Sse2::new`).
        unsafe { [$operation($a[0], $b[0]), $operation($a[1], $b[1])] }
    };
}

impl Lanes for Sse2 {
    type Floats = [__m128; 2];

    #[inline(always)]
    fn load(self, lanes: &[f32; 8]) -> [__m128; 2] {
        // SAFETY: there is SSE2; there are two times four lanes.
        unsafe { [_mm_loadu_ps(lanes.as_ptr()), _mm_loadu_ps(lanes.as_ptr().add(4))] }
    }

    #[inline(always)]
    fn to_array(self, a: [__m128; 2]) -> [f32; 8] {
        let mut lanes = [0f32; 8];
        // SAFETY: there is SSE2; `lanes` has two times four lanes.
        unsafe {
            _mm_storeu_ps(lanes.as_mut_ptr(), a[0]);
            _mm_storeu_ps(lanes.as_mut_ptr().add(4), a[1]);
        }
        lanes
    }

    #[inline(always)]
    fn splat(self, x: f32) -> [__m128; 2] {
        // SAFETY: there is SSE2.
        unsafe { [_mm_set1_ps(x); 2] }
    }

    #[inline(always)]
    fn add(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        both!(_mm_add_ps, a, b)
    }

    #[inline(always)]
    fn sub(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        both!(_mm_sub_ps, a, b)
    }

    #[inline(always)]
    fn mul(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        both!(_mm_mul_ps, a, b)
    }

    #[inline(always)]
    fn div(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        both!(_mm_div_ps, a, b)
    }

    #[inline(always)]
    fn min(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        both!(_mm_min_ps, a, b)
    }

    #[inline(always)]
    fn max(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        both!(_mm_max_ps, a, b)
    }

    #[inline(always)]
    fn abs(self, a: [__m128; 2]) -> [__m128; 2] {
        let signs = self.splat(-0.0);
        both!(_mm_andnot_ps, signs, a)
    }

    #[inline(always)]
    fn at_most(self, a: [__m128; 2], b: [__m128; 2]) -> u32 {
        let [low, high] = both!(_mm_cmple_ps, a, b);
        // SAFETY: there is SSE2.
        unsafe { _mm_movemask_ps(low) as u32 | (_mm_movemask_ps(high) as u32) << 4 }
    }
}

impl Doubles for Sse2 {
    type Double = [__m128d; 2];
    type Mask = [__m128d; 2];

    #[inline(always)]
    fn same(self, x: f64) -> [__m128d; 2] {
        // SAFETY: there is SSE2.
        unsafe { [_mm_set1_pd(x); 2] }
    }

    #[inline(always)]
    fn plus(self, a: [__m128d; 2], b: [__m128d; 2]) -> [__m128d; 2] {
        both!(_mm_add_pd, a, b)
    }

    #[inline(always)]
    fn minus(self, a: [__m128d; 2], b: [__m128d; 2]) -> [__m128d; 2] {
        both!(_mm_sub_pd, a, b)
    }

    #[inline(always)]
    fn times(self, a: [__m128d; 2], b: [__m128d; 2]) -> [__m128d; 2] {
        both!(_mm_mul_pd, a, b)
    }

    #[inline(always)]
    fn over(self, a: [__m128d; 2], b: [__m128d; 2]) -> [__m128d; 2] {
        both!(_mm_div_pd, a, b)
    }

    #[inline(always)]
    fn lesser(self, a: [__m128d; 2], b: [__m128d; 2]) -> [__m128d; 2] {
        both!(_mm_min_pd, a, b)
    }

    #[inline(always)]
    fn greater(self, a: [__m128d; 2], b: [__m128d; 2]) -> [__m128d; 2] {
        both!(_mm_max_pd, a, b)
    }

    #[inline(always)]
    fn both(self, a: [__m128d; 2], b: [__m128d; 2]) -> [__m128d; 2] {
        both!(_mm_and_pd, a, b)
    }

    #[inline(always)]
    fn is_less(self, a: [__m128d; 2], b: [__m128d; 2]) -> [__m128d; 2] {
        both!(_mm_cmplt_pd, a, b)
    }

    #[inline(always)]
    fn is_at_most(self, a: [__m128d; 2], b: [__m128d; 2]) -> [__m128d; 2] {
        both!(_mm_cmple_pd, a, b)
    }

    #[inline(always)]
    fn differs(self, a: [__m128d; 2], b: [__m128d; 2]) -> [__m128d; 2] {
        both!(_mm_cmpneq_pd, a, b)
    }

    #[inline(always)]
    fn root(self, a: [__m128d; 2]) -> [__m128d; 2] {
        // SAFETY: there is SSE2.
        unsafe { [_mm_sqrt_pd(a[0]), _mm_sqrt_pd(a[1])] }
    }

    #[inline(always)]
    fn size(self, a: [__m128d; 2]) -> [__m128d; 2] {
        let signs = self.same(-0.0);
        both!(_mm_andnot_pd, signs, a)
    }

    #[inline(always)]
    fn with_sign(self, a: [__m128d; 2], sign: [__m128d; 2]) -> [__m128d; 2] {
        let signs = self.same(-0.0);
        let (sign, size) = (both!(_mm_and_pd, signs, sign), both!(_mm_andnot_pd, signs, a));
        both!(_mm_or_pd, sign, size)
    }

    #[inline(always)]
    fn choose(self, mask: [__m128d; 2], a: [__m128d; 2], b: [__m128d; 2]) -> [__m128d; 2] {
        let (a, b) = (both!(_mm_and_pd, mask, a), both!(_mm_andnot_pd, mask, b));
        both!(_mm_or_pd, a, b)
    }
}

impl FourDoubles for Sse2 {
    #[inline(always)]
    fn read(self, lanes: &[f64; 4]) -> [__m128d; 2] {
        // SAFETY: there is SSE2; there are two times two lanes.
        unsafe { [_mm_loadu_pd(lanes.as_ptr()), _mm_loadu_pd(lanes.as_ptr().add(2))] }
    }

    #[inline(always)]
    fn to_memory(self, a: [__m128d; 2]) -> [f64; 4] {
        let mut lanes = [0f64; 4];
        // SAFETY: there is SSE2; `lanes` has two times two lanes.
        unsafe {
            _mm_storeu_pd(lanes.as_mut_ptr(), a[0]);
            _mm_storeu_pd(lanes.as_mut_ptr().add(2), a[1]);
        }
        lanes
    }

    #[inline(always)]
    fn any(self, mask: [__m128d; 2]) -> bool {
        // SAFETY: there is SSE2.
        unsafe { _mm_movemask_pd(_mm_or_pd(mask[0], mask[1])) != 0 }
    }
}

impl NodeTest for Sse2 {
    type Ray = NodeRay;

    #[inline(always)]
    fn prepare(self, ray: &NodeRay) -> NodeRay {
        *ray
    }

    #[inline(always)]
    fn enter(self, node: &Node, ray: &NodeRay, limit: f32) -> (u32, [__m128; 2]) {
        let (mut near, mut far) = (self.splat(0.0), self.splat(limit));
        for axis in 0..3 {
            let (first, last) = node.planes_along(axis, ray.backwards[axis]);
            let reciprocal = self.splat(ray.reciprocal[axis]);
            let first = self.sub(self.load(first), self.splat(ray.near_origin[axis]));
            let last = self.sub(self.load(last), self.splat(ray.far_origin[axis]));
            near = self.max(self.mul(first, reciprocal), near);
            far = self.min(self.mul(last, reciprocal), far);
        }
        (self.at_most(near, far), near)
    }
}

const _: () = assert!(WIDTH == 8);
