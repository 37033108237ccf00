//! OpenEXR, linear f32.

use image::codecs::openexr::OpenExrEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageResult};
use std::io::{Seek, Write};

/// Writes `width` x `height` pixels of three f32.
pub(super) fn encode(
    writer: &mut (impl Write + Seek),
    width: u32,
    height: u32,
    rgb: &[f32],
) -> ImageResult<()> {
    let bytes: Vec<u8> = rgb.iter().flat_map(|value| value.to_ne_bytes()).collect();
    OpenExrEncoder::new(writer).write_image(&bytes, width, height, ExtendedColorType::Rgb32F)
}
