//! Pixels in files: which formats there are, and writing that leaves either the whole picture or nothing.

mod exr;
mod png;

use crate::error::{Error, Result};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// The file formats of pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8 bits a channel, sRGB.
    Png,
    /// OpenEXR: linear f32, unclamped.
    Exr,
}

/// Every known extension with its format.
const EXTENSIONS: [(&str, Format); 2] = [("png", Format::Png), ("exr", Format::Exr)];

impl Format {
    /// The format that the extension of `path` asks for. Case does not matter; an error lists what is known.
    pub fn of(path: &Path) -> Result<Format> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let found = EXTENSIONS.iter().find(|(name, _)| *name == extension);
        found.map(|&(_, format)| format).ok_or_else(|| {
            let known: Vec<String> = EXTENSIONS.iter().map(|(name, _)| format!(".{name}")).collect();
            let known = known.join(", ");
            Error::Usage(format!("the picture {} has no known extension; known are {known}", path.display()))
        })
    }
}

/// The pixels of a picture, R G B, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// sRGB-encoded, for [`Format::Png`].
    Bytes(Vec<u8>),
    /// Linear, for [`Format::Exr`].
    Floats(Vec<f32>),
}

/// A place for a picture that was found to be writable.
#[derive(Clone, Debug)]
pub struct Destination {
    path: PathBuf,
    partial: PathBuf,
    format: Format,
}

impl Destination {
    /// Looks whether a picture can be written to `path`, by creating and removing the temporary file beside it. Nothing
    /// that exists is changed. Errors: an unknown extension; a folder that is missing or read-only; a path that is
    /// something other than a file.
    pub fn new(path: &Path) -> Result<Destination> {
        let format = Format::of(path)?;
        let failed = |source| Error::Io { action: "write the picture".into(), path: path.into(), source };
        let target = match fs::metadata(path) {
            Ok(found) if found.is_dir() => return Err(failed(io::ErrorKind::IsADirectory.into())),
            Ok(found) if !found.is_file() => {
                return Err(failed(io::Error::other("it is not a regular file")));
            }
            // The file behind a symbolic link is replaced, not the link.
            Ok(_) => fs::canonicalize(path).map_err(failed)?,
            Err(_) => path.to_path_buf(),
        };
        // Short, whatever the name of the picture, and different for every picture under way.
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let partial = target.with_file_name(format!(".pathtracer-{}-{number}.part", std::process::id()));
        drop(Partial::create(&partial).map_err(failed)?);
        Ok(Destination { path: target, partial, format })
    }

    /// The picture's file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The format that the file's extension asks for.
    pub fn format(&self) -> Format {
        self.format
    }

    /// The file that holds the picture until it is complete, in the same folder.
    pub fn partial_path(&self) -> &Path {
        &self.partial
    }

    /// Writes the whole picture under a temporary name, brings it to the disk and then renames it. After an error the
    /// file at the path is as before and no temporary file is left.
    pub fn write(&self, width: u32, height: u32, pixels: &Pixels) -> Result<()> {
        let failed =
            |source| Error::Io { action: "write the picture".into(), path: self.path.clone(), source };
        let partial = Partial::create(&self.partial).map_err(failed)?;
        let mut writer = BufWriter::with_capacity(1 << 20, &partial.file);
        match pixels {
            Pixels::Bytes(bytes) => png::encode(&mut writer, width, height, bytes),
            Pixels::Floats(floats) => exr::encode(&mut writer, width, height, floats),
        }
        .map_err(|error| match error {
            image::ImageError::IoError(source) => failed(source),
            other => Error::Picture(format!("cannot write the picture {}: {other}", self.path.display())),
        })?;
        writer.flush().map_err(failed)?;
        drop(writer);
        partial.rename_to(&self.path).map_err(failed)
    }
}

/// Counts the temporary names of this process.
static NUMBER: AtomicU32 = AtomicU32::new(0);

/// A temporary file that is removed unless it got its final name.
struct Partial<'p> {
    path: &'p Path,
    file: File,
}

impl<'p> Partial<'p> {
    fn create(path: &'p Path) -> io::Result<Partial<'p>> {
        Ok(Partial { path, file: File::create(path)? })
    }

    fn rename_to(self, path: &Path) -> io::Result<()> {
        self.file.sync_all()?;
        fs::rename(self.path, path)
    }
}

impl Drop for Partial<'_> {
    fn drop(&mut self) {
        // After the rename there is nothing by this name; an error has been reported already.
        let _ = fs::remove_file(self.path);
    }
}
