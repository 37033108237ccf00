//! Reference pictures.

use crate::error::{Error, Result};
use std::path::Path;

/// Reads an OpenEXR picture of `width` x `height` pixels: linear R G B, row by row.
///
/// # Errors
/// [`Error::Usage`] for another extension or size, [`Error::Picture`] if it can't be read.
pub fn read(path: &Path, [width, height]: [u32; 2]) -> Result<Vec<f32>> {
    let is_exr = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("exr"));
    if !is_exr {
        return Err(Error::Usage(format!(
            "the reference {} is not an .exr: only that is linear",
            path.display()
        )));
    }
    let picture = image::open(path)
        .map_err(|error| Error::Picture(format!("cannot read the reference {}: {error}", path.display())))?;
    if (picture.width(), picture.height()) != (width, height) {
        return Err(Error::Usage(format!(
            "the reference {} has {} x {} pixels: render with --size {}x{}",
            path.display(),
            picture.width(),
            picture.height(),
            picture.width(),
            picture.height()
        )));
    }
    Ok(picture.into_rgb32f().into_raw())
}
