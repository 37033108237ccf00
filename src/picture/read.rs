//! Reading pixels.

use super::{Format, Pixels, oiio, srgb_decode};
use crate::error::{Error, Result};
use crate::memory::available_bytes;
use image::{DynamicImage, ImageDecoder, ImageReader, Limits};
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

/// The pixels of a file, R G B, row by row from the top left. Grey becomes R = G = B; alpha is left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// Pixels in a row, > 0.
    pub width: u32,
    /// Rows, > 0.
    pub height: u32,
    /// As the file holds them; of 16 bits in 0..1.
    pub pixels: Pixels,
    /// Whether the values are sRGB-encoded, as those of files without floats are.
    pub is_encoded: bool,
}

/// The most memory that a picture may take while it is read, in bytes.
const MOST_BYTES: u64 = 8 << 30;
/// The longest side.
const MOST_SIDE: u32 = 1 << 20;

/// Reads the picture at `path`.
///
/// # Errors
/// A file that can't be read, is damaged, has no pixels or is too large; a format that needs OpenImageIO, without it.
pub fn read(path: &Path) -> Result<Decoded> {
    let (failed, refused) = (failed(path), refused(path));
    let file = BufReader::new(File::open(path).map_err(&failed)?);
    let format = match Format::of(path) {
        Ok(Format::Png) => image::ImageFormat::Png,
        Ok(Format::Exr) => image::ImageFormat::OpenExr,
        other => {
            check_start(path, other.ok())?;
            return oiio::read(path).map_err(refused);
        }
    };
    decode(ImageReader::with_format(file, format)).map_err(|error| match error {
        image::ImageError::IoError(source) => failed(source),
        other => refused(other.to_string()),
    })
}

/// Refuses what does not begin as its extension says: OpenImageIO would try all its other formats, and search a file of
/// zeros to its end. Of extensions that only the library knows, a file that begins with zeros is refused.
pub(super) fn check_start(path: &Path, format: Option<Format>) -> Result<()> {
    let mut start = Vec::new();
    File::open(path).and_then(|file| file.take(START).read_to_end(&mut start)).map_err(failed(path))?;
    let (name, is_one) = match format {
        Some(format) => (format.name(), format.beginnings().iter().any(|bytes| start.starts_with(bytes))),
        None => ("picture", start.iter().any(|&byte| byte != 0)),
    };
    if is_one { Ok(()) } else { Err(refused(path)(format!("this is no {name} file"))) }
}

pub(super) fn failed(path: &Path) -> impl Fn(io::Error) -> Error {
    move |source| Error::Io { action: "read the picture".into(), path: path.into(), source }
}

pub(super) fn refused(path: &Path) -> impl Fn(String) -> Error {
    move |why| Error::Picture(format!("cannot read the picture {}: {why}", path.display()))
}

/// Bytes in which the beginning of a file is looked for.
const START: u64 = 64;

fn decode(mut reader: ImageReader<BufReader<File>>) -> image::ImageResult<Decoded> {
    let mut limits = Limits::no_limits();
    // Half of what is free: pixels of other types are copied.
    limits.max_alloc = Some(available_bytes().map_or(MOST_BYTES, |bytes| MOST_BYTES.min(bytes / 2)));
    (limits.max_image_width, limits.max_image_height) = (Some(MOST_SIDE), Some(MOST_SIDE));
    reader.limits(limits.clone());
    let mut decoder = reader.into_decoder()?;
    // The pixels, which the decoder itself does not count.
    limits.reserve(decoder.total_bytes())?;
    decoder.set_limits(limits)?;
    let image = DynamicImage::from_decoder(decoder)?;
    let (width, height) = (image.width(), image.height());
    let (pixels, is_encoded) = match image {
        DynamicImage::ImageLuma8(_)
        | DynamicImage::ImageLumaA8(_)
        | DynamicImage::ImageRgb8(_)
        | DynamicImage::ImageRgba8(_) => (Pixels::Bytes(image.into_rgb8().into_raw()), true),
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            (Pixels::Floats(image.into_rgb32f().into_raw()), false)
        }
        _ => (Pixels::Floats(image.into_rgb32f().into_raw()), true),
    };
    Ok(Decoded { width, height, pixels, is_encoded })
}

impl Decoded {
    /// Whether no value is negative or no number.
    pub fn is_sound(&self) -> bool {
        match &self.pixels {
            Pixels::Floats(floats) => floats.iter().all(|value| *value >= 0.0 && value.is_finite()),
            Pixels::Halves(halves) => halves.iter().all(|value| value.to_f32() >= 0.0 && value.is_finite()),
            Pixels::Bytes(_) | Pixels::Words(_) => true,
        }
    }

    /// The largest value, at least 1; of integers 1.
    pub fn largest(&self) -> f32 {
        match &self.pixels {
            Pixels::Floats(floats) => floats.iter().copied().fold(1.0, f32::max),
            Pixels::Halves(halves) => halves.iter().map(|half| half.to_f32()).fold(1.0, f32::max),
            Pixels::Bytes(_) | Pixels::Words(_) => 1.0,
        }
    }

    /// The linear values, decoded if `encoded`.
    pub fn to_linear(&self, encoded: bool) -> Vec<f32> {
        match (&self.pixels, encoded) {
            (Pixels::Bytes(bytes), _) => {
                let table = byte_values(encoded);
                bytes.iter().map(|&byte| table[usize::from(byte)]).collect()
            }
            (Pixels::Floats(floats), false) => floats.clone(),
            (Pixels::Floats(floats), true) => floats.iter().map(|&value| decoded(value)).collect(),
            (Pixels::Words(words), _) => {
                let value = |&word: &u16| f32::from(word) / f32::from(u16::MAX);
                words.iter().map(value).map(|value| if encoded { decoded(value) } else { value }).collect()
            }
            (Pixels::Halves(halves), _) => halves.iter().map(|half| half.to_f32()).collect(),
        }
    }
}

fn decoded(value: f32) -> f32 {
    srgb_decode(value.into()) as f32
}

/// The linear value of every byte.
pub fn byte_values(encoded: bool) -> [f32; 256] {
    std::array::from_fn(|byte| {
        let value = byte as f64 / 255.0;
        (if encoded { srgb_decode(value) } else { value }) as f32
    })
}
