//! PNG, 8 or 16 bits a value.

use super::Pixels;
use super::metadata::Metadata;
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter, SrgbRenderingIntent};
use std::borrow::Cow;
use std::io::Write;

/// Writes `width` x `height` pixels of bytes or words.
pub(super) fn encode(
    writer: &mut impl Write,
    (width, height): (u32, u32),
    pixels: &Pixels,
    metadata: &Metadata,
) -> Result<(), EncodingError> {
    let (depth, bytes) = match pixels {
        Pixels::Bytes(bytes) => (BitDepth::Eight, Cow::Borrowed(&bytes[..])),
        Pixels::Words(words) => {
            (BitDepth::Sixteen, words.iter().flat_map(|word| word.to_be_bytes()).collect())
        }
        Pixels::Halves(_) | Pixels::Floats(_) => (BitDepth::Eight, Cow::default()),
    };
    let mut encoder = Encoder::new(writer, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(depth);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    for (name, value) in metadata.iter() {
        // Plain text chunks hold Latin-1, of which all readers agree on ASCII only.
        let text = value.to_string();
        if text.is_ascii() {
            encoder.add_text_chunk(name.to_owned(), text)?;
        } else {
            encoder.add_itxt_chunk(name.to_owned(), text)?;
        }
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&bytes)?;
    writer.finish()
}
