//! The renders: every configuration with every seed, in rounds in which all take turns.

use super::grid::{Frame, Variant};
use crate::error::{Error, Result};
use crate::output::{denoised, linear_floats};
use crate::picture::Denoiser;
use crate::render::{Rendered, Unwatched, available_bytes, render};
use crate::scene::desc::CameraDesc;
use crate::world::World;
use std::time::Instant;

/// One render.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The picture: linear R G B, row by row.
    pub pixels: Vec<f32>,
    /// Seconds from the first ray to the last, and for denoising where that is asked for.
    pub seconds: f64,
    /// Seconds to build the accelerator.
    pub build_seconds: f64,
    /// Rays given to the accelerator.
    pub rays: u64,
}

impl Shot {
    fn of(rendered: &Rendered, denoiser: Option<&Denoiser>) -> Result<Shot> {
        let start = Instant::now();
        let (pixels, denoising) = match denoiser {
            Some(denoiser) => (denoised(rendered, denoiser)?, start.elapsed().as_secs_f64()),
            None => (linear_floats(&rendered.film), 0.0),
        };
        Ok(Shot {
            pixels,
            seconds: rendered.render_seconds + denoising,
            build_seconds: rendered.build_seconds,
            rays: rendered.counters.rays,
        })
    }
}

/// A variant with a number of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Configuration {
    /// Place of the variant in the list.
    pub variant: usize,
    /// Samples a pixel.
    pub samples: u64,
}

/// Who is told about rounds: which one begins, of how many.
pub type Tell<'t> = &'t dyn Fn(usize, usize);

/// The shots of every configuration, one a seed.
pub(super) fn take(
    world: &World,
    camera: &CameraDesc,
    frame: &Frame,
    (variants, configurations): (&[Variant], &[Configuration]),
    seeds: std::ops::Range<u64>,
    tell: Tell<'_>,
) -> Result<Vec<Vec<Shot>>> {
    let rounds = (seeds.end - seeds.start) as usize;
    check_memory(frame, configurations.len(), rounds)?;
    let denoiser = variants.iter().any(|variant| variant.denoise).then(Denoiser::load).transpose()?;
    let mut shots: Vec<Vec<Shot>> = configurations.iter().map(|_| Vec::with_capacity(rounds)).collect();
    for (round, seed) in seeds.enumerate() {
        tell(round, rounds);
        for (configuration, shots) in configurations.iter().zip(&mut shots) {
            let variant = &variants[configuration.variant];
            let settings = variant.settings(frame, configuration.samples, seed);
            let rendered = render(world, camera, &settings, &Unwatched)?;
            shots.push(Shot::of(&rendered, denoiser.as_ref().filter(|_| variant.denoise))?);
        }
    }
    Ok(shots)
}

/// Refuses what the machine has not the memory for; passes where the system does not say.
fn check_memory(frame: &Frame, configurations: usize, seeds: usize) -> Result<()> {
    /// Pictures beside the shots that a seed needs: the mean of the others, and what FLIP keeps of it.
    const MORE: usize = 6;
    let picture = 12 * u64::from(frame.width) * u64::from(frame.height);
    let bytes = picture * ((configurations + MORE) * seeds) as u64;
    match available_bytes() {
        Some(available) if bytes > available => Err(Error::Usage(format!(
            "{configurations} configurations with {seeds} seeds need {:.1} GB of memory, and {:.1} GB are free: choose a \
             smaller --size, or fewer --seeds or settings",
            bytes as f64 / 1e9,
            available as f64 / 1e9
        ))),
        _ => Ok(()),
    }
}
