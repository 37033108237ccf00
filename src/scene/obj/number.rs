//! Numbers in decimal notation, rounded correctly.

/// The powers of ten that f64 holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];
/// The powers of ten up to the number of digits that are read at once.
const TENS: [u64; 9] = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];
/// Most digits that surely fit `u64`.
const MAX_DIGITS: usize = 19;
/// Up to here f64 holds every integer.
const MAX_MANTISSA: u64 = 1 << 53;

/// The number that a whole word is.
pub(super) fn of_word(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The number at the start of `bytes`, and its length, if it is an integer up to 2^53 times or over a power of ten up
/// to 10^22. Both are exact in f64, so that the one operation rounds correctly (Clinger, "How to read floating point
/// numbers accurately", 1990). What follows the number is not looked at.
#[inline]
pub(super) fn short(bytes: &[u8]) -> Option<(f64, usize)> {
    let negative = bytes.first() == Some(&b'-');
    let mut at = usize::from(negative);
    let mut mantissa = 0;
    let mut digits = take_digits(bytes, &mut at, &mut mantissa);
    let mut exponent = 0;
    if bytes.get(at) == Some(&b'.') {
        at += 1;
        let places = take_digits(bytes, &mut at, &mut mantissa);
        digits += places;
        exponent = -(places as i64);
    }
    if digits == 0 || digits > MAX_DIGITS || mantissa > MAX_MANTISSA {
        return None;
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let (power, length) = integer(bytes.get(at + 1..)?)?;
        exponent += power;
        at += 1 + length;
    }
    let power = POWERS.get(exponent.unsigned_abs() as usize)?;
    let magnitude = if exponent < 0 { mantissa as f64 / power } else { mantissa as f64 * power };
    Some((if negative { -magnitude } else { magnitude }, at))
}

/// The integer at the start of `bytes`, and its length, if it has so few digits that it surely fits.
#[inline]
pub(super) fn integer(bytes: &[u8]) -> Option<(i64, usize)> {
    let negative = bytes.first() == Some(&b'-');
    let mut at = usize::from(negative);
    let mut magnitude = 0;
    let digits = take_digits(bytes, &mut at, &mut magnitude);
    if digits == 0 || digits >= MAX_DIGITS {
        return None;
    }
    let magnitude = magnitude as i64;
    Some((if negative { -magnitude } else { magnitude }, at))
}

/// Appends the digits from `at` on to `value`, which wraps if there are too many; returns how many there were.
#[inline]
fn take_digits(bytes: &[u8], at: &mut usize, value: &mut u64) -> usize {
    let start = *at;
    while let Some(word) = bytes.get(*at..).and_then(|rest| rest.first_chunk()) {
        let (number, digits) = leading_digits(*word);
        *value = value.wrapping_mul(TENS[digits]).wrapping_add(number);
        *at += digits;
        if digits < 8 {
            return *at - start;
        }
    }
    while let Some(digit) = bytes.get(*at).map(|byte| byte.wrapping_sub(b'0')).filter(|digit| *digit < 10) {
        *value = value.wrapping_mul(10).wrapping_add(u64::from(digit));
        *at += 1;
    }
    *at - start
}

/// The number that the digits at the start of eight bytes make, and how many they are: all eight at once, in the
/// lanes of one integer.
#[inline]
fn leading_digits(word: [u8; 8]) -> (u64, usize) {
    const HIGH_BITS: u64 = 0x8080_8080_8080_8080;
    // Digits become 0 to 9, other bytes 10 and more. Adding 118 then carries into the high bit unless it is set.
    let lanes = u64::from_le_bytes(word) ^ 0x3030_3030_3030_3030;
    let others = (lanes.wrapping_add(0x7676_7676_7676_7676) | lanes) & HIGH_BITS;
    let digits = others.trailing_zeros() as usize / 8;
    if digits == 0 {
        return (0, 0);
    }
    // The digits move to the end; zeros come before them.
    let lanes = lanes << (64 - 8 * digits);
    // Pairs of lanes become one of twice the width, three times.
    let lanes = (lanes & 0x0f0f_0f0f_0f0f_0f0f).wrapping_mul((10 << 8) + 1) >> 8;
    let lanes = (lanes & 0x00ff_00ff_00ff_00ff).wrapping_mul((100 << 16) + 1) >> 16;
    ((lanes & 0x0000_ffff_0000_ffff).wrapping_mul((10_000 << 32) + 1) >> 32, digits)
}
