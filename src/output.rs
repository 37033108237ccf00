//! A film becomes a picture: exposure, curve, range.

use crate::error::Result;
use crate::film::Film;
use crate::math::Rgb;
use crate::picture::{Destination, Format, Pixels};

/// Writes the means of a film. A PNG shows them x 2^`exposure` through the sRGB curve, an EXR holds them as they are.
pub fn write(film: &Film, exposure: f64, destination: &Destination) -> Result<()> {
    let pixels = match destination.format() {
        Format::Png => Pixels::Bytes(display_bytes(film, exposure)),
        Format::Exr => Pixels::Floats(linear_floats(film)),
    };
    destination.write(film.width(), film.height(), &pixels)
}

/// Writes the error of every pixel into an EXR: R the mean of its components, G the standard error of that, B half the width
/// of the 95 % interval. Whether it could: the film needs samples in eight scrambles.
pub fn write_error_bars(film: &Film, destination: &Destination) -> Result<bool> {
    let pixels = film.width() as usize * film.height() as usize;
    let bar = |pixel: usize| {
        let bar = film.error_bar(pixel)?;
        Some(
            [bar.mean, bar.standard_error, bar.half_width()]
                .map(|value| value.min(f64::from(f32::MAX)) as f32),
        )
    };
    let Some(bars) = (0..pixels).map(bar).collect::<Option<Vec<[f32; 3]>>>() else { return Ok(false) };
    let floats = bars.into_iter().flatten().collect();
    destination.write(film.width(), film.height(), &Pixels::Floats(floats))?;
    Ok(true)
}

/// The means of a film x 2^`exposure` (in stops), clipped to 0..1, sRGB-encoded, in 8 bits: R G B, row by row.
pub fn display_bytes(film: &Film, exposure: f64) -> Vec<u8> {
    let factor = libm::exp2(exposure);
    channels(film).map(|value| quantize(srgb_encode(value * factor))).collect()
}

/// The means of a film in f32: R G B, row by row. What exceeds the range of f32 becomes its largest number, so that no
/// infinity enters a file.
pub fn linear_floats(film: &Film) -> Vec<f32> {
    channels(film).map(|value| value.min(f64::from(f32::MAX)) as f32).collect()
}

/// The sRGB curve of IEC 61966-2-1 at a linear value, which is clipped to 0..1 first. The value lies in 0..1.
pub fn srgb_encode(linear: f64) -> f64 {
    let x = linear.clamp(0.0, 1.0);
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * libm::pow(x, 1.0 / 2.4) - 0.055 }
}

/// A value in 0..1 as the nearest of 256 steps; halves go up.
pub fn quantize(value: f64) -> u8 {
    (value * 255.0 + 0.5) as u8
}

fn channels(film: &Film) -> impl Iterator<Item = f64> + '_ {
    film.means().flat_map(|mean: Rgb| mean.to_array())
}
