//! Numbers of about 106 bits as unevaluated sums of two f64 (Dekker, "A Floating-Point Technique for Extending the
//! Available Precision", 1971): an oracle for formulas in f64.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// hi + lo with |lo| at most half a unit in the last place of hi.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DoubleDouble {
    hi: f64,
    lo: f64,
}

impl DoubleDouble {
    pub(crate) fn sqrt(self) -> DoubleDouble {
        let root = DoubleDouble::from(self.hi.sqrt());
        if root.hi == 0.0 {
            return root;
        }
        // One step of Newton's method doubles the digits.
        root + (self - root * root) / (root + root)
    }

    pub(crate) fn to_f64(self) -> f64 {
        self.hi
    }
}

impl From<f64> for DoubleDouble {
    fn from(x: f64) -> DoubleDouble {
        DoubleDouble { hi: x, lo: 0.0 }
    }
}

/// a + b exactly.
fn two_sum(a: f64, b: f64) -> DoubleDouble {
    let hi = a + b;
    let b_rounded = hi - a;
    DoubleDouble { hi, lo: (a - (hi - b_rounded)) + (b - b_rounded) }
}

/// a b exactly, unless something overflows or underflows.
fn two_product(a: f64, b: f64) -> DoubleDouble {
    let split = |x: f64| {
        let shifted = 134_217_729.0 * x;
        let high = shifted - (shifted - x);
        (high, x - high)
    };
    let hi = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    DoubleDouble { hi, lo: ((a1 * b1 - hi) + a1 * b2 + a2 * b1) + a2 * b2 }
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;
    fn add(self, other: DoubleDouble) -> DoubleDouble {
        let (high, low) = (two_sum(self.hi, other.hi), two_sum(self.lo, other.lo));
        let sum = two_sum(high.hi, high.lo + low.hi);
        two_sum(sum.hi, sum.lo + low.lo)
    }
}

impl Neg for DoubleDouble {
    type Output = DoubleDouble;
    fn neg(self) -> DoubleDouble {
        DoubleDouble { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;
    fn sub(self, other: DoubleDouble) -> DoubleDouble {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;
    fn mul(self, other: DoubleDouble) -> DoubleDouble {
        let product = two_product(self.hi, other.hi);
        two_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

impl Div for DoubleDouble {
    type Output = DoubleDouble;
    fn div(self, other: DoubleDouble) -> DoubleDouble {
        let first = DoubleDouble::from(self.hi / other.hi);
        let second = DoubleDouble::from((self - first * other).hi / other.hi);
        let third = DoubleDouble::from((self - first * other - second * other).hi / other.hi);
        first + second + third
    }
}

#[test]
fn double_double_holds_twice_the_digits() {
    let (one, tiny) = (DoubleDouble::from(1.0), DoubleDouble::from(2f64.powi(-80)));
    let x = one + tiny;
    assert_eq!((x * x - one - tiny - tiny).to_f64(), 0.0, "2^-160 is out of reach, all else exact");
    assert!(((x / x) - one).to_f64().abs() < 2f64.powi(-100));
    let root = (one + one).sqrt();
    assert!((root * root - one - one).to_f64().abs() < 2f64.powi(-100));
}
