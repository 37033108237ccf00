//! Where the picture of a render goes: one file, or two if it is denoised.

use crate::error::{Error, Result};
use crate::output::{self, Aov, Provenance, same_file};
use crate::picture::{Denoiser, Depth, Destination, Format, Metadata, Value};
use crate::render::{Rendered, in_pool};
use std::path::{Path, PathBuf};

/// What picture is wanted.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Its file; the extension says the format.
    pub image: PathBuf,
    /// What a value takes, or `None` for the format's default.
    pub depth: Option<Depth>,
    /// Brightness in stops, of depths that are not linear.
    pub exposure: f64,
    /// What goes beside the light into an EXR.
    pub aov: Vec<Aov>,
    /// Whether it is denoised.
    pub denoise: bool,
    /// Whether it says when and where it was made.
    pub stamp: bool,
}

/// The places of the pictures, found to be writable, and what makes them.
pub struct Target {
    wanted: Wanted,
    /// The picture's place.
    picture: Destination,
    /// The place of the picture before it is denoised, and what denoises it.
    denoised: Option<(Destination, Denoiser)>,
}

impl Target {
    /// Whatever can be known to fail fails here, before the render.
    ///
    /// # Errors
    /// An unknown extension, a folder that is missing or read-only, channels or a depth that the format does not take, a denoiser
    /// that is not there.
    pub fn new(wanted: Wanted) -> Result<Target> {
        let picture = place(&wanted.image, wanted.depth)?;
        if !wanted.aov.is_empty() && picture.format() != Format::Exr {
            return Err(Error::Usage("--aov needs a picture that ends in .exr".into()));
        }
        let denoised = if wanted.denoise {
            Some((place(&noisy_path(&wanted.image), wanted.depth)?, Denoiser::load()?))
        } else {
            None
        };
        Ok(Target { wanted, picture, denoised })
    }

    /// The picture's place.
    pub fn picture(&self) -> &Destination {
        &self.picture
    }

    /// The files that hold pictures until they are complete.
    pub fn partial_paths(&self) -> Vec<PathBuf> {
        let noisy = self.denoised.as_ref().map(|(noisy, _)| noisy);
        [&self.picture].into_iter().chain(noisy).map(|place| place.partial_path().to_path_buf()).collect()
    }

    /// Whether one of the pictures goes to this file.
    pub fn holds(&self, path: &Path) -> bool {
        let noisy = self.denoised.as_ref().map(|(noisy, _)| noisy);
        [&self.picture].into_iter().chain(noisy).any(|place| same_file(place.path(), path))
    }

    /// Writes what was rendered.
    ///
    /// # Errors
    /// Files that can't be written; a denoiser that fails.
    pub fn write(&self, provenance: &Provenance<'_>, rendered: &Rendered) -> Result<()> {
        let light: Vec<f64> = output::channels(&rendered.film).collect();
        let made = |denoiser| Made { provenance, rendered: Some(rendered), denoiser };
        let Some((noisy_place, denoiser)) = &self.denoised else {
            return self.write_to(&self.picture, &light, &made(None));
        };
        self.write_to(noisy_place, &light, &made(None))?;
        let clean: Vec<f64> = output::denoised(rendered, denoiser)?.into_iter().map(f64::from).collect();
        self.write_to(&self.picture, &clean, &made(Some(denoiser)))
    }

    /// Writes the means of a render that goes on, R G B, row by row.
    ///
    /// # Errors
    /// A file that can't be written.
    pub fn write_light(&self, provenance: &Provenance<'_>, light: &[f64]) -> Result<()> {
        self.write_to(&self.picture, light, &Made { provenance, rendered: None, denoiser: None })
    }

    fn write_to(&self, destination: &Destination, light: &[f64], made: &Made<'_>) -> Result<()> {
        let settings = made.provenance.settings;
        let size = (settings.width, settings.height);
        let mut picture = output::picture(size, light, self.wanted.exposure, destination.depth());
        picture.metadata = self.metadata(destination, made);
        if let Some(rendered) = made.rendered {
            picture.channels = self.wanted.aov.iter().flat_map(|aov| aov.channels(rendered)).collect();
        }
        in_pool(settings, || destination.write_picture(&picture))
    }

    /// What the picture's file says.
    fn metadata(&self, destination: &Destination, made: &Made<'_>) -> Metadata {
        let mut metadata = made.provenance.metadata(destination);
        let mut own = |name: &str, value: String| {
            metadata.push(format!("{}{name}", output::PREFIX), Value::Text(value))
        };
        if let Some(denoiser) = made.denoiser {
            own("denoised", format!("oidn-{}", denoiser.version()));
        }
        let aov = &self.wanted.aov;
        if !aov.is_empty() {
            let names: Vec<&str> = aov.iter().map(|kind| kind.name()).collect();
            own("aov", names.join(","));
        }
        if self.wanted.stamp {
            let seconds = made.rendered.map_or(0.0, |rendered| rendered.render_seconds);
            output::stamp(&mut metadata, seconds, made.provenance.settings.thread_count());
        }
        metadata
    }
}

/// How light was made.
struct Made<'m> {
    provenance: &'m Provenance<'m>,
    /// `None` of a render that goes on.
    rendered: Option<&'m Rendered>,
    denoiser: Option<&'m Denoiser>,
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
