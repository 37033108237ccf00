//! PNG, 8 bits a channel.

use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageResult};
use std::io::Write;

/// Writes `width` x `height` pixels of three bytes.
pub(super) fn encode(writer: &mut impl Write, width: u32, height: u32, rgb: &[u8]) -> ImageResult<()> {
    PngEncoder::new(writer).write_image(rgb, width, height, ExtendedColorType::Rgb8)
}
