//! Pixels in files: which formats there are, and writing that leaves either the whole picture or nothing.

mod denoise;
mod exr;
mod hdr;
mod info;
mod metadata;
#[cfg_attr(not(feature = "oiio"), path = "oiio_missing.rs")]
mod oiio;
mod png;
mod read;
mod srgb;

pub use denoise::{Denoiser, Noisy};
pub use exr::{Channel, Samples};
pub use info::Info;
pub use metadata::{Metadata, Value};
pub use read::{Decoded, byte_values, read};
pub use srgb::{quantize, quantize_word, srgb_decode, srgb_encode};

use crate::error::{Error, Result};
use ::png::EncodingError;
pub use half::f16;
use std::fs::{self, File};
use std::hash::{BuildHasher, RandomState};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The file formats in which pictures are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Portable Network Graphics.
    Png,
    /// OpenEXR.
    Exr,
    /// Tagged Image File Format, by OpenImageIO.
    Tiff,
    /// Radiance's shared exponents, by OpenImageIO.
    Hdr,
    /// JPEG, by OpenImageIO.
    Jpeg,
}

/// What a value of a picture takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// 8 bits: sRGB, clipped to 0..1.
    Eight,
    /// 16 bits: sRGB, clipped to 0..1.
    Sixteen,
    /// A float of 16 bits: linear, up to 65504.
    Half,
    /// A float of 32 bits: linear, unclipped.
    Float,
}

/// A format: its name, its extension in the words of OpenImageIO, its depths, of which the first is the default.
type Row = (Format, &'static str, &'static str, &'static [Depth]);

const FORMATS: [Row; 5] = [
    (Format::Png, "PNG", "png", &[Depth::Eight, Depth::Sixteen]),
    (Format::Exr, "EXR", "exr", &[Depth::Float, Depth::Half]),
    (Format::Tiff, "TIFF", "tif", &[Depth::Eight, Depth::Sixteen, Depth::Float]),
    (Format::Hdr, "HDR", "hdr", &[Depth::Float]),
    (Format::Jpeg, "JPEG", "jpg", &[Depth::Eight]),
];

/// Every extension with its format; the first two need no library.
const EXTENSIONS: [(&str, Format); 7] = [
    ("png", Format::Png),
    ("exr", Format::Exr),
    ("tif", Format::Tiff),
    ("tiff", Format::Tiff),
    ("hdr", Format::Hdr),
    ("jpg", Format::Jpeg),
    ("jpeg", Format::Jpeg),
];

impl Format {
    /// The format that the extension of `path` asks for. Case does not matter; an error lists what is known.
    pub fn of(path: &Path) -> Result<Format> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let found = EXTENSIONS.iter().find(|(name, _)| *name == extension);
        found.map(|&(_, format)| format).ok_or_else(|| {
            let known = Format::extensions();
            Error::Usage(format!("the picture {} has no known extension; known are {known}", path.display()))
        })
    }

    /// All extensions: `.png, .exr` and so on.
    pub fn extensions() -> String {
        let known: Vec<String> = EXTENSIONS.iter().map(|(name, _)| format!(".{name}")).collect();
        known.join(", ")
    }

    fn row(self) -> &'static Row {
        FORMATS.iter().find(|row| row.0 == self).unwrap_or(&FORMATS[0])
    }

    /// The name of the format.
    pub fn name(self) -> &'static str {
        self.row().1
    }

    /// The depths that it can have, the default first.
    pub fn depths(self) -> &'static [Depth] {
        self.row().3
    }

    /// What its files begin with, one of these; none where the format is not read by OpenImageIO.
    fn beginnings(self) -> &'static [&'static [u8]] {
        match self {
            // Little and big endian, classic and with offsets of 64 bits.
            Format::Tiff => &[b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"],
            Format::Hdr => &[b"#?"],
            Format::Jpeg => &[b"\xff\xd8\xff"],
            Format::Png | Format::Exr => &[],
        }
    }

    /// Whether OpenImageIO writes it.
    fn needs_library(self) -> bool {
        !matches!(self, Format::Png | Format::Exr)
    }
}

impl Depth {
    /// All of them.
    pub const ALL: [Depth; 4] = [Depth::Eight, Depth::Sixteen, Depth::Half, Depth::Float];

    /// The name on the command line and in pictures.
    pub const fn name(self) -> &'static str {
        match self {
            Depth::Eight => "8",
            Depth::Sixteen => "16",
            Depth::Half => "half",
            Depth::Float => "float",
        }
    }

    /// Whether it holds linear light; else sRGB values in 0..1.
    pub fn is_linear(self) -> bool {
        matches!(self, Depth::Half | Depth::Float)
    }
}

/// The pixels of a picture, R G B, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub enum Pixels {
    /// sRGB-encoded.
    Bytes(Vec<u8>),
    /// sRGB-encoded.
    Words(Vec<u16>),
    /// Linear.
    Halves(Vec<f16>),
    /// Linear.
    Floats(Vec<f32>),
}

/// A picture as it is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Their colours.
    pub pixels: Pixels,
    /// More channels beside the colours, for [`Format::Exr`] only.
    pub channels: Vec<Channel>,
    /// What the file says about itself.
    pub metadata: Metadata,
}

impl Picture {
    /// What a value takes.
    pub fn depth(&self) -> Depth {
        match self.pixels {
            Pixels::Bytes(_) => Depth::Eight,
            Pixels::Words(_) => Depth::Sixteen,
            Pixels::Halves(_) => Depth::Half,
            Pixels::Floats(_) => Depth::Float,
        }
    }
}

/// A place for a picture that was found to be writable.
#[derive(Clone, Debug)]
pub struct Destination {
    path: PathBuf,
    partial: PathBuf,
    format: Format,
    depth: Depth,
}

/// The file that is replaced when something is written to `path`. Errors: a folder, something other than a file.
pub(crate) fn replaced_file(path: &Path) -> io::Result<PathBuf> {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(found) if !found.is_file() => Err(io::Error::other("it is not a regular file")),
        // The file behind a symbolic link is replaced, not the link.
        Ok(_) => fs::canonicalize(path),
        Err(_) => Ok(path.to_path_buf()),
    }
}

/// A new name beside a file that is to be replaced: short, whatever the file's own is, and different for every file under
/// way, on all machines that see the folder: 64 random bits.
pub(crate) fn partial_file(target: &Path) -> PathBuf {
    // Every one of these states has keys of its own, made from the system's random numbers.
    let random = RandomState::new().hash_one(std::process::id());
    target.with_file_name(format!(".pathtracer-{random:016x}.part"))
}

impl Destination {
    /// Looks whether a picture can be written to `path`, by creating and removing the temporary file beside it. Nothing
    /// that exists is changed. Errors: an unknown extension; a folder that is missing or read-only; a path that is
    /// something other than a file.
    pub fn new(path: &Path) -> Result<Destination> {
        let format = Format::of(path)?;
        if format.needs_library() {
            oiio::check()
                .map_err(|why| Error::Unavailable(format!("cannot write {}: {why}", path.display())))?;
        }
        let failed = |source| Error::Io { action: "write the picture".into(), path: path.into(), source };
        let target = replaced_file(path).map_err(failed)?;
        let partial = partial_file(&target);
        drop(Partial::create(&partial).map_err(failed)?);
        Ok(Destination { path: target, partial, format, depth: format.depths()[0] })
    }

    /// The same place for pixels of another depth. An error if the format can't have it.
    pub fn with_depth(self, depth: Depth) -> Result<Destination> {
        let depths = self.format.depths();
        if !depths.contains(&depth) {
            let known: Vec<&str> = depths.iter().map(|depth| depth.name()).collect();
            let (name, known) = (self.format.name(), known.join(" or "));
            return Err(Error::Usage(format!("a {name} has values of depth {known}, not {}", depth.name())));
        }
        Ok(Destination { depth, ..self })
    }

    /// What a value takes.
    pub fn depth(&self) -> Depth {
        self.depth
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

    /// Writes pixels alone; see [`Destination::write_picture`].
    pub fn write(&self, width: u32, height: u32, pixels: &Pixels) -> Result<()> {
        self.write_all(width, height, pixels, &[], &Metadata::default())
    }

    /// Writes the whole picture under a temporary name, brings it to the disk and then renames it. After an error the
    /// file at the path is as before and no temporary file is left.
    pub fn write_picture(&self, picture: &Picture) -> Result<()> {
        let Picture { width, height, pixels, channels, metadata } = picture;
        self.write_all(*width, *height, pixels, channels, metadata)
    }

    fn write_all(
        &self,
        width: u32,
        height: u32,
        pixels: &Pixels,
        channels: &[Channel],
        metadata: &Metadata,
    ) -> Result<()> {
        let failed =
            |source| Error::Io { action: "write the picture".into(), path: self.path.clone(), source };
        let partial = Partial::create(&self.partial).map_err(failed)?;
        let refused =
            |why: String| Error::Picture(format!("cannot write the picture {}: {why}", self.path.display()));
        if self.format.needs_library() {
            oiio::write(&self.partial, self.format.row().2, (width, height), pixels, metadata)
                .map_err(refused)?;
            if self.format == Format::Hdr {
                let bytes = fs::read(&self.partial).map_err(failed)?;
                fs::write(&self.partial, hdr::with_metadata(&bytes, metadata)).map_err(failed)?;
            }
            return partial.rename_to(&self.path).map_err(failed);
        }
        let mut writer = BufWriter::with_capacity(1 << 20, &partial.file);
        let size = (width, height);
        match self.format {
            Format::Png => png::encode(&mut writer, size, pixels, metadata).map_err(|error| match error {
                EncodingError::IoError(source) => failed(source),
                other => refused(other.to_string()),
            }),
            _ => exr::encode(&mut writer, size, pixels, channels, metadata).map_err(failed),
        }?;
        writer.flush().map_err(failed)?;
        drop(writer);
        partial.rename_to(&self.path).map_err(failed)
    }
}

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
