//! Student's t distribution.

/// The normal distribution's two-sided 95 % quantile.
const NORMAL: f64 = 1.959_963_984_540_054;

/// The two-sided 95 % quantile for so many degrees of freedom, by the expansion in their reciprocal (Abramowitz and Stegun
/// 26.7.5): within 0.2 % from 4 degrees on, and more from 1; too small below 3.
pub fn quantile(degrees: f64) -> f64 {
    let (z, r) = (NORMAL, 1.0 / degrees.max(1.0));
    let s = z * z;
    let first = (s + 1.0) / 4.0;
    let second = ((5.0 * s + 16.0) * s + 3.0) / 96.0;
    let third = (((3.0 * s + 19.0) * s + 17.0) * s - 15.0) / 384.0;
    let fourth = ((((79.0 * s + 776.0) * s + 1482.0) * s - 1920.0) * s - 945.0) / 92_160.0;
    z * (1.0 + r * (first + r * (second + r * (third + r * fourth))))
}
