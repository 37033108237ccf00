//! Arithmetic on one f64 or on several side by side: what is written with it once decides about one solid and about four,
//! with the same bits.

/// A set of instructions that a value of this type proves to be there. Every operation rounds to nearest, by itself.
pub(crate) trait Doubles: Copy {
    /// One number, or several.
    type Double: Copy;
    /// One truth value, or several.
    type Mask: Copy;

    /// The same number everywhere.
    fn same(self, x: f64) -> Self::Double;

    fn plus(self, a: Self::Double, b: Self::Double) -> Self::Double;
    fn minus(self, a: Self::Double, b: Self::Double) -> Self::Double;
    fn times(self, a: Self::Double, b: Self::Double) -> Self::Double;
    fn over(self, a: Self::Double, b: Self::Double) -> Self::Double;
    fn root(self, a: Self::Double) -> Self::Double;
    fn size(self, a: Self::Double) -> Self::Double;

    /// `a` with the sign of `sign`; zeros have one.
    fn with_sign(self, a: Self::Double, sign: Self::Double) -> Self::Double;

    /// The lesser one; `b` if one is NaN.
    fn lesser(self, a: Self::Double, b: Self::Double) -> Self::Double;

    /// The greater one; `b` if one is NaN.
    fn greater(self, a: Self::Double, b: Self::Double) -> Self::Double;

    /// Whether `a < b`; not if one is NaN.
    fn is_less(self, a: Self::Double, b: Self::Double) -> Self::Mask;

    /// Whether `a <= b`; not if one is NaN.
    fn is_at_most(self, a: Self::Double, b: Self::Double) -> Self::Mask;

    /// Whether `a != b`.
    fn differs(self, a: Self::Double, b: Self::Double) -> Self::Mask;

    fn both(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;

    /// `a` where the mask is set, else `b`.
    fn choose(self, mask: Self::Mask, a: Self::Double, b: Self::Double) -> Self::Double;

    /// The sum of the products, in the order of [`crate::math::DVec3::dot`].
    #[inline(always)]
    fn dot(self, a: [Self::Double; 3], b: [Self::Double; 3]) -> Self::Double {
        let xy = self.plus(self.times(a[0], b[0]), self.times(a[1], b[1]));
        self.plus(xy, self.times(a[2], b[2]))
    }

    /// `a - b`.
    #[inline(always)]
    fn difference(self, a: [Self::Double; 3], b: [Self::Double; 3]) -> [Self::Double; 3] {
        [self.minus(a[0], b[0]), self.minus(a[1], b[1]), self.minus(a[2], b[2])]
    }

    /// `a + direction * t`.
    #[inline(always)]
    fn along(self, a: [Self::Double; 3], direction: [Self::Double; 3], t: Self::Double) -> [Self::Double; 3] {
        [
            self.plus(a[0], self.times(direction[0], t)),
            self.plus(a[1], self.times(direction[1], t)),
            self.plus(a[2], self.times(direction[2], t)),
        ]
    }

    /// The same vector everywhere.
    #[inline(always)]
    fn same_each(self, [x, y, z]: [f64; 3]) -> [Self::Double; 3] {
        [self.same(x), self.same(y), self.same(z)]
    }
}

/// Four numbers side by side.
pub(crate) trait FourDoubles: Doubles {
    /// Four numbers from memory.
    fn read(self, lanes: &[f64; 4]) -> Self::Double;

    /// Four numbers to memory.
    fn to_memory(self, a: Self::Double) -> [f64; 4];

    /// Whether any is set.
    fn any(self, mask: Self::Mask) -> bool;
}

/// One number, in the instructions that everything is compiled with.
#[derive(Clone, Copy)]
pub(super) struct One;

impl Doubles for One {
    type Double = f64;
    type Mask = bool;

    #[inline(always)]
    fn same(self, x: f64) -> f64 {
        x
    }

    #[inline(always)]
    fn plus(self, a: f64, b: f64) -> f64 {
        a + b
    }

    #[inline(always)]
    fn minus(self, a: f64, b: f64) -> f64 {
        a - b
    }

    #[inline(always)]
    fn times(self, a: f64, b: f64) -> f64 {
        a * b
    }

    #[inline(always)]
    fn over(self, a: f64, b: f64) -> f64 {
        a / b
    }

    #[inline(always)]
    fn root(self, a: f64) -> f64 {
        a.sqrt()
    }

    #[inline(always)]
    fn size(self, a: f64) -> f64 {
        a.abs()
    }

    #[inline(always)]
    fn with_sign(self, a: f64, sign: f64) -> f64 {
        a.copysign(sign)
    }

    #[inline(always)]
    fn lesser(self, a: f64, b: f64) -> f64 {
        if a < b { a } else { b }
    }

    #[inline(always)]
    fn greater(self, a: f64, b: f64) -> f64 {
        if a > b { a } else { b }
    }

    #[inline(always)]
    fn is_less(self, a: f64, b: f64) -> bool {
        a < b
    }

    #[inline(always)]
    fn is_at_most(self, a: f64, b: f64) -> bool {
        a <= b
    }

    #[inline(always)]
    fn differs(self, a: f64, b: f64) -> bool {
        a != b
    }

    #[inline(always)]
    fn both(self, a: bool, b: bool) -> bool {
        a & b
    }

    #[inline(always)]
    fn choose(self, mask: bool, a: f64, b: f64) -> f64 {
        if mask { a } else { b }
    }
}
