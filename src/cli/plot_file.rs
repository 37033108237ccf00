//! Places for plots.

use crate::error::{Error, Result};
use crate::output::TextFile;
use crate::picture::{Destination, Pixels};
use std::path::Path;

/// A drawing in both forms.
pub(super) trait Drawing {
    /// As an SVG file.
    fn svg(&self) -> Result<String>;

    /// R G B row by row, with width and height.
    fn pixels(&self) -> Result<(Vec<u8>, u32, u32)>;
}

impl Drawing for crate::study::plot::Plot<'_> {
    fn svg(&self) -> Result<String> {
        self.svg()
    }

    fn pixels(&self) -> Result<(Vec<u8>, u32, u32)> {
        self.pixels()
    }
}

impl Drawing for crate::study::plot::chart::Sheet {
    fn svg(&self) -> Result<String> {
        self.svg()
    }

    fn pixels(&self) -> Result<(Vec<u8>, u32, u32)> {
        self.pixels()
    }
}

/// A place for a plot that was found to be writable.
pub(super) enum PlotFile {
    Svg(TextFile),
    Png(Destination),
}

impl PlotFile {
    /// The form is that of the extension.
    pub(super) fn new(path: &Path) -> Result<PlotFile> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match extension.as_str() {
            "svg" => Ok(PlotFile::Svg(TextFile::new(path)?)),
            "png" => Ok(PlotFile::Png(Destination::new(path)?)),
            _ => Err(Error::Usage(format!(
                "the plot {} has no known extension; known are .svg, .png",
                path.display()
            ))),
        }
    }

    pub(super) fn write(&self, drawing: &dyn Drawing) -> Result<()> {
        match self {
            PlotFile::Svg(file) => file.write(&drawing.svg()?),
            PlotFile::Png(file) => {
                let (pixels, width, height) = drawing.pixels()?;
                file.write(width, height, &Pixels::Bytes(pixels))
            }
        }
    }
}
