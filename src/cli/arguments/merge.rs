//! `pathtracer merge` as it was typed.

use super::values::{choice, stops};
use crate::error::Error;
use crate::output::{Aov, Wanted};
use crate::picture::Depth;
use std::path::{Path, PathBuf};

/// What to merge, and how the picture is written.
#[derive(Debug, clap::Args)]
#[command(override_usage = "pathtracer merge [OPTIONS] PART... IMAGE")]
pub(in crate::cli) struct MergeArguments {
    /// Part files, in any order, and the picture to write
    #[arg(value_name = "PART... IMAGE", required = true)]
    files: Vec<PathBuf>,
    /// Take parts of Embree's own kernels with different instruction sets, which differ in the last bits
    #[arg(long)]
    pub(in crate::cli) mix_instruction_sets: bool,
    /// Also write the error of every pixel
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) error_bars: Option<PathBuf>,
    /// Brightness of a picture that is not linear in stops, -100 to 100
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, default_value = "0", value_parser = stops)]
    pub(in crate::cli) exposure: f64,
    /// What a value of the picture takes
    #[arg(long, value_name = "NAME", value_parser = choice(&Depth::ALL, Depth::name))]
    pub(in crate::cli) depth: Option<Depth>,
    /// Channels of an EXR beside the light, if the parts have them
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = choice(&Aov::ALL, Aov::name))]
    pub(in crate::cli) aov: Vec<Aov>,
    /// Remove noise by Open Image Denoise, if the parts were rendered with --aov or --denoise
    #[arg(long)]
    pub(in crate::cli) denoise: bool,
    /// Print errors only
    #[arg(long, short)]
    pub(in crate::cli) quiet: bool,
}

impl MergeArguments {
    /// The picture.
    pub(in crate::cli) fn wanted(&self, image: &Path) -> Wanted {
        Wanted {
            image: image.to_path_buf(),
            depth: self.depth,
            exposure: self.exposure,
            aov: self.aov.clone(),
            denoise: self.denoise,
            stamp: false,
        }
    }

    /// The parts, and the picture.
    pub(in crate::cli) fn files(&self) -> Result<(&[PathBuf], &PathBuf), Error> {
        match self.files.split_last() {
            Some((image, parts)) if !parts.is_empty() => Ok((parts, image)),
            _ => Err(Error::Usage("merge needs part files and, after them, the picture to write".into())),
        }
    }
}
