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
use crate::whole_file::WholeFile;
use ::png::EncodingError;
pub use half::f16;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

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

impl Format {
    /// In the order in which they are listed to users.
    pub const ALL: [Format; 5] = [Format::Png, Format::Exr, Format::Tiff, Format::Hdr, Format::Jpeg];

    /// The format that the extension of `path` asks for. Case does not matter.
    ///
    /// # Errors
    /// An extension that is none of those known, which are listed.
    pub fn of(path: &Path) -> Result<Format> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let found = Format::ALL.into_iter().find(|format| format.own_extensions().contains(&&*extension));
        found.ok_or_else(|| {
            let known = Format::extensions();
            Error::Usage(format!("the picture {} has no known extension; known are {known}", path.display()))
        })
    }

    /// The extensions of all formats: `.png, .exr` and so on.
    pub fn extensions() -> String {
        let known = Format::ALL.iter().flat_map(|format| format.own_extensions());
        known.map(|name| format!(".{name}")).collect::<Vec<_>>().join(", ")
    }

    /// Its extensions.
    const fn own_extensions(self) -> &'static [&'static str] {
        match self {
            Format::Png => &["png"],
            Format::Exr => &["exr"],
            Format::Tiff => &["tif", "tiff"],
            Format::Hdr => &["hdr"],
            Format::Jpeg => &["jpg", "jpeg"],
        }
    }

    /// The name of the format.
    pub const fn name(self) -> &'static str {
        match self {
            Format::Png => "PNG",
            Format::Exr => "EXR",
            Format::Tiff => "TIFF",
            Format::Hdr => "HDR",
            Format::Jpeg => "JPEG",
        }
    }

    /// The depths that it can have, the default first.
    pub const fn depths(self) -> &'static [Depth] {
        match self {
            Format::Png => &[Depth::Eight, Depth::Sixteen],
            Format::Exr => &[Depth::Float, Depth::Half],
            Format::Tiff => &[Depth::Eight, Depth::Sixteen, Depth::Float],
            Format::Hdr => &[Depth::Float],
            Format::Jpeg => &[Depth::Eight],
        }
    }

    /// Who writes it.
    const fn writer(self) -> Writer {
        match self {
            Format::Png => Writer::Png,
            Format::Exr => Writer::Exr,
            Format::Tiff => Writer::Library("tif"),
            Format::Hdr => Writer::Library("hdr"),
            Format::Jpeg => Writer::Library("jpg"),
        }
    }

    /// What its files begin with, one of these; none where the format is not read by OpenImageIO.
    const fn beginnings(self) -> &'static [&'static [u8]] {
        match self {
            // Little and big endian, classic and with offsets of 64 bits.
            Format::Tiff => &[b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"],
            Format::Hdr => &[b"#?"],
            Format::Jpeg => &[b"\xff\xd8\xff"],
            Format::Png | Format::Exr => &[],
        }
    }
}

/// What writes a format.
enum Writer {
    /// `png`.
    Png,
    /// `exr`.
    Exr,
    /// OpenImageIO, by the name that it knows the format under.
    Library(&'static str),
}

impl Depth {
    /// The smallest first.
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
    file: WholeFile,
    format: Format,
    depth: Depth,
}

impl Destination {
    /// Looks whether a picture can be written to `path`, by creating and removing the temporary file beside it. Nothing
    /// that exists is changed.
    ///
    /// # Errors
    /// An unknown extension; a format that needs OpenImageIO, without it; a folder that is missing or read-only; a path that
    /// is something other than a file.
    pub fn new(path: &Path) -> Result<Destination> {
        let format = Format::of(path)?;
        if let Writer::Library(_) = format.writer() {
            oiio::check()
                .map_err(|why| Error::Unavailable(format!("cannot write {}: {why}", path.display())))?;
        }
        let file = WholeFile::new(path, "write the picture")?;
        Ok(Destination { file, format, depth: format.depths()[0] })
    }

    /// The same place for pixels of another depth.
    ///
    /// # Errors
    /// A depth that the format can't have.
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
        self.file.path()
    }

    /// The format that the file's extension asks for.
    pub fn format(&self) -> Format {
        self.format
    }

    /// The file that holds the picture until it is complete, in the same folder.
    pub fn partial_path(&self) -> &Path {
        self.file.partial_path()
    }

    /// Writes pixels alone; see [`Destination::write_picture`].
    ///
    /// # Errors
    /// As there.
    pub fn write(&self, width: u32, height: u32, pixels: &Pixels) -> Result<()> {
        self.write_all((width, height), pixels, &[], &Metadata::default())
    }

    /// Writes the whole picture under a temporary name, brings it to the disk and then renames it.
    ///
    /// # Errors
    /// A disk that is full or fails, a folder that is gone; a picture that the format refuses. The file at the path is as
    /// before then, and no temporary file is left.
    pub fn write_picture(&self, picture: &Picture) -> Result<()> {
        let Picture { width, height, pixels, channels, metadata } = picture;
        self.write_all((*width, *height), pixels, channels, metadata)
    }

    fn write_all(
        &self,
        size: (u32, u32),
        pixels: &Pixels,
        channels: &[Channel],
        metadata: &Metadata,
    ) -> Result<()> {
        let failed = |source| self.file.failed(source);
        self.file.write(|file| match self.format.writer() {
            Writer::Png => {
                buffered(file, |writer| png::encode(writer, size, pixels, metadata)).map_err(|error| {
                    match error {
                        EncodingError::IoError(source) => failed(source),
                        other => self.refused(&other.to_string()),
                    }
                })
            }
            Writer::Exr => {
                buffered(file, |writer| exr::encode(writer, size, pixels, channels, metadata)).map_err(failed)
            }
            Writer::Library(name) => self.write_by_library(name, size, pixels, metadata),
        })
    }

    /// Fills the temporary file.
    fn write_by_library(
        &self,
        name: &str,
        size: (u32, u32),
        pixels: &Pixels,
        metadata: &Metadata,
    ) -> Result<()> {
        let partial = self.partial_path();
        oiio::write(partial, name, size, pixels, metadata).map_err(|why| self.refused(&why))?;
        if self.format != Format::Hdr {
            return Ok(());
        }
        let with_metadata = |bytes: Vec<u8>| fs::write(partial, hdr::with_metadata(&bytes, metadata));
        fs::read(partial).and_then(with_metadata).map_err(|source| self.file.failed(source))
    }

    fn refused(&self, why: &str) -> Error {
        Error::Picture(format!("cannot write the picture {}: {why}", self.path().display()))
    }
}

/// Lets `encode` write to a file in large pieces.
fn buffered<E: From<io::Error>>(
    file: &File,
    encode: impl FnOnce(&mut BufWriter<&File>) -> std::result::Result<(), E>,
) -> std::result::Result<(), E> {
    let mut writer = BufWriter::with_capacity(1 << 20, file);
    encode(&mut writer)?;
    Ok(writer.flush()?)
}
