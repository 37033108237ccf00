//! What a film takes, and whether the machine has it.

use super::Settings;
use crate::error::{Error, Result};
use crate::film::Film;
use crate::integrator::Features;
use crate::math::Rgb;
use std::fs;

/// The most bytes that the film and its picture take at once.
pub fn film_bytes(width: u32, height: u32, samples: u64, chunk: u32) -> u64 {
    let pixels = u64::from(width) * u64::from(height);
    let planes = Film::most_nodes(samples.div_ceil(u64::from(chunk.max(1))));
    // Two planes more: the chunk under way and its last complete pass; afterwards the encoded picture (24 bytes a pixel
    // for EXR).
    pixels.saturating_mul((planes + 2) * size_of::<Rgb>() as u64)
}

/// Whether the film fits into the memory that is free now; passes where the system does not say.
pub(super) fn check(settings: &Settings) -> Result<()> {
    let pixels = u64::from(settings.width) * u64::from(settings.height);
    // The features and the channels that they become.
    let features = if settings.features { pixels * 2 * size_of::<Features>() as u64 } else { 0 };
    let film = film_bytes(settings.width, settings.height, settings.samples, settings.chunk);
    let needed = film.saturating_add(features);
    match available_bytes() {
        Some(available) if needed > available => Err(too_large(settings, Some(available))),
        _ => Ok(()),
    }
}

/// One zero a pixel.
pub(super) fn plane<T: Clone + Default>(settings: &Settings) -> Result<Vec<T>> {
    let pixels = settings.width as usize * settings.height as usize;
    let mut plane = Vec::new();
    plane.try_reserve_exact(pixels).map_err(|_| too_large(settings, None))?;
    plane.resize(pixels, T::default());
    Ok(plane)
}

fn too_large(settings: &Settings, available: Option<u64>) -> Error {
    let Settings { width, height, samples, chunk, .. } = *settings;
    let needed = gigabytes(film_bytes(width, height, samples, chunk));
    let available = available.map_or("less".into(), gigabytes);
    Error::Usage(format!(
        "a picture of {width} x {height} pixels with {samples} samples needs {needed} GB of memory, and {available} GB \
         are free"
    ))
}

fn gigabytes(bytes: u64) -> String {
    format!("{:.1}", bytes as f64 / 1e9)
}

/// `MemAvailable` of Linux, in bytes.
pub(crate) fn available_bytes() -> Option<u64> {
    let text = fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    kilobytes.checked_mul(1024)
}
