//! What a film takes, and whether the machine has it.

use super::Settings;
use super::cells::Layout;
use crate::error::{Error, Result};
use crate::film::Film;
use crate::integrator::Features;
use crate::math::Rgb;
use crate::memory::available_bytes;
use crate::sampling::SCRAMBLES;
use crate::words::bytes;

/// The most bytes that the film of the render's region and its picture take at once. Without a limit of samples, 65,536 are reckoned with.
pub fn film_bytes(settings: &Settings) -> u64 {
    let pixels = settings.area();
    let chunk = u64::from(settings.chunk.max(1));
    let samples = if settings.samples == 0 { 1 << 16 } else { settings.samples };
    let radiance = size_of::<Rgb>() as u64;
    // Of one scramble there are deviations.
    let greys = |count: usize| (size_of::<f32>() * count) as u64;
    let only = |samples: u64| settings.scrambles().only(0..samples.max(1)).is_some();
    let cell = |samples: u64| match Layout::new(settings, 0) {
        Layout::Plain(_) if !only(samples) => radiance + greys(SCRAMBLES + 1),
        Layout::Plain(_) => radiance + greys(2),
        Layout::Scrambled => radiance + greys(SCRAMBLES),
        Layout::Halved => 2 * radiance + greys(SCRAMBLES),
    };
    let nodes = Film::most_nodes(samples.div_ceil(chunk));
    let film: u64 =
        (0..nodes).map(|node| cell(chunk.saturating_mul(1 << node).min(samples.max(chunk)))).sum();
    // Beside it the chunk under way and its last complete pass, and what blocks know of themselves; afterwards the encoded picture (24 bytes a pixel for EXR).
    let under_way = Layout::new(settings, 0).stride() * size_of::<f64>();
    let planes = if settings.noise.is_some() { 3 } else { 2 };
    pixels.saturating_mul(film + (planes * under_way) as u64)
}

/// Whether the film fits into the memory that is free now; passes where the system does not say.
pub(super) fn check(settings: &Settings) -> Result<()> {
    let needed = needed_bytes(settings);
    match available_bytes() {
        Some(available) if needed > available => Err(too_large(settings, Some(available))),
        _ => Ok(()),
    }
}

/// So many zeros a pixel.
pub(super) fn zeros(settings: &Settings, each: usize) -> Result<Vec<f64>> {
    filled(settings, each)
}

/// What is collected in every pixel, before anything is.
pub(super) fn plane<T: Clone + Default>(settings: &Settings) -> Result<Vec<T>> {
    filled(settings, 1)
}

/// So many defaults a pixel.
fn filled<T: Clone + Default>(settings: &Settings, each: usize) -> Result<Vec<T>> {
    let count = settings.area() as usize * each;
    let mut filled = Vec::new();
    filled.try_reserve_exact(count).map_err(|_| too_large(settings, None))?;
    filled.resize(count, T::default());
    Ok(filled)
}

/// What the film and the features take.
fn needed_bytes(settings: &Settings) -> u64 {
    let pixels = settings.area();
    // The features and the channels that they become.
    let features = if settings.features { pixels * 2 * size_of::<Features>() as u64 } else { 0 };
    film_bytes(settings).saturating_add(features)
}

fn too_large(settings: &Settings, available: Option<u64>) -> Error {
    let Settings { width, height, samples, .. } = *settings;
    let needed = bytes(needed_bytes(settings));
    let available = available.map_or("fewer bytes".into(), bytes);
    Error::Usage(format!(
        "the film of a picture of {width} x {height} pixels with {samples} samples needs {needed} of memory, and \
         {available} are free: make the picture smaller, or render it in parts (--part)"
    ))
}
