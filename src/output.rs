//! A film becomes a picture: exposure, curve, range, and what the file says about itself.

mod aov;
mod provenance;
mod rescue;
mod same_file;
mod stamp;
mod target;
mod text_file;

pub use crate::picture::{quantize, srgb_encode};
pub use crate::words::{shell, shell_line};
pub use aov::Aov;
pub use provenance::{PREFIX, Provenance, arguments};
pub use rescue::{FILM_EXTENSION, Rescue};
pub use same_file::{same_file, whole_path};
pub use stamp::{date_time, stamp};
pub use target::{Target, Wanted};
pub(crate) use text_file::TextFile;

use crate::error::Result;
use crate::film::Film;
use crate::math::Rgb;
use crate::picture::{Denoiser, Depth, Destination, Metadata, Noisy, Picture, Pixels, f16, quantize_word};
use crate::render::{FeaturePlanes, Rendered};

/// Writes the means of a film alone; see [`picture`].
///
/// # Errors
/// As [`Destination::write_picture`].
pub fn write(film: &Film, exposure: f64, destination: &Destination) -> Result<()> {
    let light: Vec<f64> = channels(film).collect();
    let size = (film.width(), film.height());
    destination.write_picture(&picture(size, &light, exposure, destination.depth()))
}

/// Light (R G B, row by row) as a picture of a depth: in 8 or 16 bits x 2^`exposure` (in stops) through the sRGB curve,
/// in floats as it is.
pub fn picture((width, height): (u32, u32), light: &[f64], exposure: f64, depth: Depth) -> Picture {
    let shown = || displayed(light.iter().copied(), exposure);
    let pixels = match depth {
        Depth::Eight => Pixels::Bytes(shown().map(quantize).collect()),
        Depth::Sixteen => Pixels::Words(shown().map(quantize_word).collect()),
        Depth::Half => Pixels::Halves(light.iter().map(|&value| to_half(value)).collect()),
        Depth::Float => Pixels::Floats(light.iter().map(|&value| to_float(value)).collect()),
    };
    Picture { width, height, pixels, channels: Vec::new(), metadata: Metadata::default() }
}

/// How many components of a film's pixels are larger than a picture of this depth can say, and become the largest number
/// there. None where what is brighter than white is white.
pub fn cut_components(film: &Film, depth: Depth) -> u64 {
    let most = match depth {
        Depth::Eight | Depth::Sixteen => return 0,
        Depth::Half => f16::MAX.to_f64(),
        Depth::Float => f64::from(f32::MAX),
    };
    channels(film).filter(|&value| value > most).count() as u64
}

/// Writes the error of every pixel into an EXR: R the mean of its components, G the standard error of that, B half the width
/// of the 95 % interval. Whether it could: the film needs samples in eight scrambles.
///
/// # Errors
/// As [`Destination::write_picture`].
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

/// Values x 2^`exposure` (in stops), clipped to 0..1, sRGB-encoded.
fn displayed(light: impl Iterator<Item = f64>, exposure: f64) -> impl Iterator<Item = f64> {
    let factor = libm::exp2(exposure);
    light.map(move |value| srgb_encode(value * factor))
}

/// The nearest half float; what exceeds their range becomes the largest.
fn to_half(value: f64) -> f16 {
    f16::from_f64(value.min(f16::MAX.to_f64()))
}

/// The nearest f32; what exceeds their range becomes the largest.
fn to_float(value: f64) -> f32 {
    value.min(f64::from(f32::MAX)) as f32
}

/// The means of a film in f32: R G B, row by row. What exceeds the range of f32 becomes its largest number, so that no
/// infinity enters a file.
pub fn linear_floats(film: &Film) -> Vec<f32> {
    channels(film).map(to_float).collect()
}

/// The light of a render without its noise, as the denoiser guesses it by the albedo and the normals: R G B, row by row. The
/// render must have collected features.
///
/// # Errors
/// As [`Denoiser::denoise`].
pub fn denoised(rendered: &Rendered, denoiser: &Denoiser) -> Result<Vec<f32>> {
    let guides = rendered.features.as_ref().map(FeaturePlanes::guides);
    let [albedo, normal] = guides.unwrap_or_default();
    let color = linear_floats(&rendered.film);
    let (width, height) = (rendered.film.width(), rendered.film.height());
    denoiser.denoise(&Noisy { width, height, color: &color, albedo: &albedo, normal: &normal })
}

/// The means of a film: R G B, row by row.
pub fn channels(film: &Film) -> impl Iterator<Item = f64> + '_ {
    film.means().flat_map(|mean: Rgb| mean.to_array())
}
