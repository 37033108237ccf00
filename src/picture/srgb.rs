//! The sRGB curve of IEC 61966-2-1, and bytes.

/// The curve at a linear value, which is clipped to 0..1 first. The value lies in 0..1.
pub fn srgb_encode(linear: f64) -> f64 {
    let x = linear.clamp(0.0, 1.0);
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * libm::pow(x, 1.0 / 2.4) - 0.055 }
}

/// The linear value of an encoded one, which is clipped to 0..1 first.
pub fn srgb_decode(encoded: f64) -> f64 {
    let x = encoded.clamp(0.0, 1.0);
    if x <= 0.04045 { x / 12.92 } else { libm::pow((x + 0.055) / 1.055, 2.4) }
}

/// A value in 0..1 as the nearest of 256 steps; halves go up.
pub fn quantize(value: f64) -> u8 {
    (value * 255.0 + 0.5) as u8
}

/// A value in 0..1 as the nearest of 65536 steps; halves go up.
pub fn quantize_word(value: f64) -> u16 {
    (value * 65_535.0 + 0.5) as u16
}
