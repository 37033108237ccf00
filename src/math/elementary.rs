//! Elementary functions for inner loops: several times faster than functions for all arguments, good to a few
//! roundings, and the same bits on every machine.
//!
//! The polynomials interpolate at Chebyshev nodes and are rounded to f64; each says how far it is from its function,
//! relatively, in exact arithmetic. They are summed by Estrin's scheme, whose parts do not wait for each other.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// Sine and cosine of an angle in [-pi / 4, pi / 4].
#[inline]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    // sin x / x and cos x as polynomials of x^2, off by 7e-18 each.
    const SIN: [f64; 8] = [
        1.0,
        -0.16666666666666666,
        0.008333333333333321,
        -0.00019841269841253478,
        2.7557319213562225e-06,
        -2.5052104779095043e-08,
        1.6058352428871255e-10,
        -7.578090160922686e-13,
    ];
    const COS: [f64; 8] = [
        1.0,
        -0.5,
        0.04166666666666645,
        -0.0013888888888861095,
        2.4801587283881152e-5,
        -2.7557313097790086e-7,
        2.0875582380663952e-9,
        -1.1353379638297575e-11,
    ];
    let square = angle * angle;
    (angle * polynomial(SIN, square), polynomial(COS, square))
}

/// Sine and cosine of an angle in turns, 0 to 1.
#[inline]
pub fn sin_cos_turns(turns: f64) -> (f64, f64) {
    let quarter = (4.0 * turns + 0.5) as i32;
    let (sin, cos) = sin_cos((4.0 * turns - f64::from(quarter)) * FRAC_PI_2);
    let (s, c) = if quarter & 1 == 0 { (sin, cos) } else { (cos, sin) };
    // The sine is negative in the second half of a turn, the cosine in the second and third quarter.
    (if quarter & 2 == 0 { s } else { -s }, if (quarter + 1) & 2 == 0 { c } else { -c })
}

/// The angle, from 0 to pi, of the vector (x, y) with y >= 0 to the x axis; 0 for the zero vector.
#[inline]
pub fn half_plane_angle(x: f64, y: f64) -> f64 {
    const TAN_PI_8: f64 = std::f64::consts::SQRT_2 - 1.0;
    // atan t / t as a polynomial of t^2, for t up to tan (pi / 8), off by 4e-18.
    const LOW: [f64; 8] = [
        1.0,
        -0.3333333333333312,
        0.19999999999940893,
        -0.14285714279250245,
        0.11111110744919658,
        -0.09090896809064027,
        0.07692045330902225,
        -0.06662951813629191,
    ];
    const HIGH: [f64; 4] =
        [0.05846878297330872, -0.05035102456601551, 0.03796525745386593, -0.01780539720541944];

    let size = x.abs();
    let (small, large) = if y < size { (y, size) } else { (size, y) };
    if large == 0.0 {
        return 0.0;
    }
    // atan (s / l) = pi / 4 + atan ((s - l) / (s + l)).
    let near_diagonal = small > TAN_PI_8 * large;
    let t = if near_diagonal { (small - large) / (small + large) } else { small / large };
    let square = t * t;
    let fourth = square * square;
    let eighth = fourth * fourth;
    let high = (HIGH[0] + HIGH[1] * square) + (HIGH[2] + HIGH[3] * square) * fourth;
    let atan = t * (polynomial(LOW, square) + high * (eighth * eighth));
    let from_axis = if near_diagonal { FRAC_PI_4 + atan } else { atan };
    let acute = if y < size { from_axis } else { FRAC_PI_2 - from_axis };
    if x < 0.0 { PI - acute } else { acute }
}

/// x^(-1/5) for a normal x > 0.
#[inline]
pub fn inverse_fifth_root(x: f64) -> f64 {
    // m^(-1/5) for m in [1, 2], off by 7.85e-08.
    const MANTISSA: [f64; 8] = [
        1.5239254322555207,
        -1.2472718059956305,
        1.419472348208924,
        -1.121506356994699,
        0.5842119024821197,
        -0.19196023516657518,
        0.03609059770917945,
        -0.0029619609639150077,
    ];
    // 2^(-r / 5).
    const REST: [f64; 5] =
        [1.0, 0.8705505632961241, 0.757858283255199, 0.6597539553864471, 0.5743491774985175];
    const BIAS: i64 = 1023;
    const FRACTION: u64 = (1 << 52) - 1;

    let bits = x.to_bits();
    let exponent = (bits >> 52) as i64 - BIAS;
    let (fifth, rest) = (exponent.div_euclid(5), exponent.rem_euclid(5));
    let mantissa = f64::from_bits(bits & FRACTION | (BIAS as u64) << 52);
    let power = f64::from_bits(((BIAS - fifth) as u64) << 52);
    let y = polynomial(MANTISSA, mantissa) * (REST[rest as usize] * power);
    // y (1 - e)^(-1/5) with the error e = 1 - x y^5, up to e^2; the next term is below 1e-20.
    let y2 = y * y;
    let error = 1.0 - (x * y) * (y2 * y2);
    y + y * (error * (0.2 + 0.12 * error))
}

/// The sum of c[i] x^i.
#[inline(always)]
fn polynomial(c: [f64; 8], x: f64) -> f64 {
    let x2 = x * x;
    let x4 = x2 * x2;
    let low = (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2;
    let high = (c[4] + c[5] * x) + (c[6] + c[7] * x) * x2;
    low + high * x4
}
