//! Where the picture of a render goes: one file, or with `--denoise` two.

use super::arguments::Job;
use crate::error::{Error, Result};
use crate::output::{self, Provenance};
use crate::picture::{Denoiser, Depth, Destination, Format, Metadata, Noisy, Value};
use crate::render::{Rendered, in_pool};
use std::path::{Path, PathBuf};

/// The places of the pictures, found to be writable, and what makes them.
pub(super) struct Target {
    /// The picture's place.
    pub(super) picture: Destination,
    /// The place of the picture before it is denoised, and what denoises it.
    denoised: Option<(Destination, Denoiser)>,
}

impl Target {
    /// Whatever can be known to fail fails here.
    pub(super) fn new(job: &Job) -> Result<Target> {
        let picture = place(&job.image, job.depth)?;
        if !job.aov.is_empty() && picture.format() != Format::Exr {
            return Err(Error::Usage("--aov needs a picture that ends in .exr".into()));
        }
        let denoised = if job.denoise {
            Some((place(&noisy_path(&job.image), job.depth)?, Denoiser::load()?))
        } else {
            None
        };
        Ok(Target { picture, denoised })
    }

    /// The files that hold pictures until they are complete.
    pub(super) fn partial_paths(&self) -> Vec<PathBuf> {
        let noisy = self.denoised.as_ref().map(|(noisy, _)| noisy);
        [&self.picture].into_iter().chain(noisy).map(|place| place.partial_path().to_path_buf()).collect()
    }

    /// Whether one of the pictures goes to the same file.
    pub(super) fn holds(&self, other: &Destination) -> bool {
        let noisy = self.denoised.as_ref().map(|(noisy, _)| noisy.path());
        self.picture.path() == other.path() || noisy == Some(other.path())
    }

    /// Writes what was rendered.
    pub(super) fn write(&self, job: &Job, provenance: &Provenance<'_>, rendered: &Rendered) -> Result<()> {
        let light: Vec<f64> = output::channels(&rendered.film).collect();
        let Some((noisy_place, denoiser)) = &self.denoised else {
            return write(&self.picture, &light, None, job, provenance, rendered);
        };
        write(noisy_place, &light, None, job, provenance, rendered)?;
        let guides = rendered.features.as_ref().map(|features| features.guides());
        let [albedo, normal] = guides.unwrap_or_default();
        let color = output::linear_floats(&rendered.film);
        let (width, height) = (rendered.film.width(), rendered.film.height());
        let noisy = Noisy { width, height, color: &color, albedo: &albedo, normal: &normal };
        let clean: Vec<f64> = denoiser.denoise(&noisy)?.into_iter().map(f64::from).collect();
        write(&self.picture, &clean, Some(denoiser), job, provenance, rendered)
    }
}

fn place(path: &Path, depth: Option<Depth>) -> Result<Destination> {
    let destination = Destination::new(path)?;
    match depth {
        Some(depth) => destination.with_depth(depth),
        None => Ok(destination),
    }
}

/// `a.png` becomes `a.noisy.png`.
fn noisy_path(path: &Path) -> PathBuf {
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    path.with_extension(format!("noisy.{extension}"))
}

fn write(
    destination: &Destination,
    light: &[f64],
    denoiser: Option<&Denoiser>,
    job: &Job,
    provenance: &Provenance<'_>,
    rendered: &Rendered,
) -> Result<()> {
    let size = (rendered.film.width(), rendered.film.height());
    let mut picture = output::picture(size, light, job.exposure, destination.depth());
    picture.metadata = metadata(destination, denoiser, job, provenance, rendered);
    if let Some(features) = &rendered.features {
        picture.channels = features.channels(&job.aov);
    }
    in_pool(&job.settings, || destination.write_picture(&picture))
}

/// What the picture's file says.
fn metadata(
    destination: &Destination,
    denoiser: Option<&Denoiser>,
    job: &Job,
    provenance: &Provenance<'_>,
    rendered: &Rendered,
) -> Metadata {
    let mut metadata = provenance.metadata(destination);
    let mut own =
        |name: &str, value: String| metadata.push(format!("{}{name}", output::PREFIX), Value::Text(value));
    if let Some(denoiser) = denoiser {
        own("denoised", format!("oidn-{}", denoiser.version()));
    }
    if !job.aov.is_empty() {
        let names: Vec<&str> = job.aov.iter().map(|kind| kind.name()).collect();
        own("aov", names.join(","));
    }
    if job.stamp {
        output::stamp(&mut metadata, rendered.render_seconds, job.settings.thread_count());
    }
    metadata
}
