//! OpenEXR: scan lines, ZIP in blocks of 16 lines, any channels, by the format's specification ("OpenEXR File Layout").
//!
//! The `exr` crate, which reads them, keeps attributes in a hash map of random order; equal renders must make equal
//! files, so they are written here.

use super::Pixels;
use super::metadata::{Metadata, Value};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use half::f16;
use rayon::prelude::*;
use std::io::{self, Seek, SeekFrom, Write};

/// A channel of an EXR, one value a pixel, row by row from the top left.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Such as `R` or `Normal.X`.
    pub name: String,
    /// Its values.
    pub values: Samples,
}

/// The values of a [`Channel`].
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// 32 bits.
    Floats(Vec<f32>),
    /// Whole numbers, such as indices.
    Integers(Vec<u32>),
}

/// Where the values of a channel are: in a plane of their own, or among those of other channels.
enum Source<'p> {
    Floats { values: &'p [f32], first: usize, step: usize },
    Halves { values: &'p [f16], first: usize, step: usize },
    Integers(&'p [u32]),
}

/// A channel as it is written.
struct Plane<'p> {
    name: &'p str,
    source: Source<'p>,
}

/// Lines that are compressed together.
const BLOCK_LINES: usize = 16;
/// Blocks that are compressed before any is written.
const BATCH: usize = 64;
/// The level that OpenEXR itself uses.
const LEVEL: u32 = 4;
/// Names longer than this need a flag, and those longer than 255 bytes are not allowed.
const SHORT_NAME: usize = 31;

/// Writes `width` x `height` pixels of floats, and more channels of the same size.
pub(super) fn encode(
    writer: &mut (impl Write + Seek),
    (width, height): (u32, u32),
    pixels: &Pixels,
    more: &[Channel],
    metadata: &Metadata,
) -> io::Result<()> {
    let color = ["R", "G", "B"].into_iter().enumerate().filter_map(|(first, name)| {
        let source = match pixels {
            Pixels::Floats(values) => Source::Floats { values, first, step: 3 },
            Pixels::Halves(values) => Source::Halves { values, first, step: 3 },
            Pixels::Bytes(_) | Pixels::Words(_) => return None,
        };
        Some(Plane { name, source })
    });
    let mut planes: Vec<Plane<'_>> = color.chain(more.iter().map(Plane::of)).collect();
    // The format wants them in this order.
    planes.sort_by(|a, b| a.name.cmp(b.name));
    let (width, height) = (width as usize, height as usize);
    writer.write_all(&header(width, height, &planes, metadata)?)?;
    let blocks = height.div_ceil(BLOCK_LINES);
    let table = writer.stream_position()?;
    writer.write_all(&vec![0; blocks * size_of::<u64>()])?;
    let mut offsets = Vec::with_capacity(blocks);
    for batch in (0..blocks).collect::<Vec<_>>().chunks(BATCH) {
        let compressed: Vec<Vec<u8>> = batch
            .par_iter()
            .map(|&block| compress(&planes, width, height, block))
            .collect::<io::Result<_>>()?;
        for (&block, bytes) in batch.iter().zip(&compressed) {
            offsets.push(writer.stream_position()?);
            writer.write_all(&((block * BLOCK_LINES) as i32).to_le_bytes())?;
            writer.write_all(&(bytes.len() as i32).to_le_bytes())?;
            writer.write_all(bytes)?;
        }
    }
    let end = writer.stream_position()?;
    writer.seek(SeekFrom::Start(table))?;
    writer.write_all(&offsets.iter().flat_map(|offset| offset.to_le_bytes()).collect::<Vec<u8>>())?;
    writer.seek(SeekFrom::Start(end)).map(drop)
}

impl<'p> Plane<'p> {
    fn of(channel: &'p Channel) -> Plane<'p> {
        let source = match &channel.values {
            Samples::Floats(values) => Source::Floats { values, first: 0, step: 1 },
            Samples::Integers(values) => Source::Integers(values),
        };
        Plane { name: &channel.name, source }
    }

    /// Appends the values of some pixels in a row.
    fn append(&self, pixels: std::ops::Range<usize>, bytes: &mut Vec<u8>) {
        match self.source {
            Source::Floats { values, first, step } => {
                pixels.for_each(|pixel| bytes.extend(values[pixel * step + first].to_le_bytes()));
            }
            Source::Halves { values, first, step } => {
                pixels.for_each(|pixel| bytes.extend(values[pixel * step + first].to_le_bytes()));
            }
            Source::Integers(values) => {
                values[pixels].iter().for_each(|value| bytes.extend(value.to_le_bytes()))
            }
        }
    }
}

/// The lines of a block: line by line, channel by channel, compressed unless that would be longer.
fn compress(planes: &[Plane<'_>], width: usize, height: usize, block: usize) -> io::Result<Vec<u8>> {
    let lines = block * BLOCK_LINES..height.min((block + 1) * BLOCK_LINES);
    let mut raw = Vec::with_capacity(lines.len() * width * planes.len() * size_of::<f32>());
    for line in lines {
        planes.iter().for_each(|plane| plane.append(line * width..(line + 1) * width, &mut raw));
    }
    let mut encoder = ZlibEncoder::new(Vec::with_capacity(raw.len()), Compression::new(LEVEL));
    encoder.write_all(&differences(&raw))?;
    let compressed = encoder.finish()?;
    Ok(if compressed.len() < raw.len() { compressed } else { raw })
}

/// What the format compresses: first the bytes at even places, then those at odd ones, each as its difference from the
/// one before, plus 128.
fn differences(raw: &[u8]) -> Vec<u8> {
    let mut bytes: Vec<u8> = raw.iter().step_by(2).chain(raw.iter().skip(1).step_by(2)).copied().collect();
    let mut before = bytes.first().copied().unwrap_or(0);
    for byte in bytes.iter_mut().skip(1) {
        let difference = byte.wrapping_sub(before).wrapping_add(128);
        before = std::mem::replace(byte, difference);
    }
    bytes
}

/// Everything before the table of offsets.
fn header(width: usize, height: usize, planes: &[Plane<'_>], metadata: &Metadata) -> io::Result<Vec<u8>> {
    let names = planes.iter().map(|plane| plane.name).chain(metadata.iter().map(|(name, _)| name));
    let longest = names.map(str::len).max().unwrap_or(0);
    if longest > 255 {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "a name is longer than 255 bytes"));
    }
    let flags: u32 = if longest > SHORT_NAME { 0x400 } else { 0 };
    let mut header = vec![0x76, 0x2f, 0x31, 0x01];
    header.extend((2 | flags).to_le_bytes());
    let window = [0, 0, width as i32 - 1, height as i32 - 1].map(i32::to_le_bytes).concat();
    let one = 1f32.to_le_bytes();
    attribute(&mut header, "channels", "chlist", &channel_list(planes));
    attribute(&mut header, "compression", "compression", &[3]);
    attribute(&mut header, "dataWindow", "box2i", &window);
    attribute(&mut header, "displayWindow", "box2i", &window);
    attribute(&mut header, "lineOrder", "lineOrder", &[0]);
    attribute(&mut header, "pixelAspectRatio", "float", &one);
    attribute(&mut header, "screenWindowCenter", "v2f", &[0; 8]);
    attribute(&mut header, "screenWindowWidth", "float", &screen_window_width(metadata).to_le_bytes());
    for (name, value) in metadata.iter() {
        let name = if name == "DateTime" { "capDate" } else { name };
        match value {
            Value::Text(text) => attribute(&mut header, name, "string", text.as_bytes()),
            Value::Integer(number) => match i32::try_from(*number) {
                Ok(number) => attribute(&mut header, name, "int", &number.to_le_bytes()),
                Err(_) => attribute(&mut header, name, "string", number.to_string().as_bytes()),
            },
            Value::Number(number) => attribute(&mut header, name, "float", &(*number as f32).to_le_bytes()),
            Value::Matrix(rows) => {
                attribute(&mut header, name, "m44f", &rows.map(|x| (x as f32).to_le_bytes()).concat());
            }
        }
    }
    header.push(0);
    Ok(header)
}

fn attribute(header: &mut Vec<u8>, name: &str, kind: &str, value: &[u8]) {
    for word in [name, kind] {
        header.extend(word.as_bytes());
        header.push(0);
    }
    header.extend((value.len() as i32).to_le_bytes());
    header.extend(value);
}

/// The width of the picture at the distance 1 of the camera.
fn screen_window_width(metadata: &Metadata) -> f32 {
    let degrees = metadata.iter().find_map(|(name, value)| match value {
        Value::Number(degrees) if name == "fov" => Some(*degrees),
        _ => None,
    });
    degrees.map_or(1.0, |degrees| 2.0 * libm::tan(degrees.to_radians() / 2.0)) as f32
}

/// Name, type, whether values are perceptually linear, and sampling rates, of every channel.
fn channel_list(planes: &[Plane<'_>]) -> Vec<u8> {
    let mut list = Vec::new();
    for plane in planes {
        let kind: i32 = match plane.source {
            Source::Integers(_) => 0,
            Source::Halves { .. } => 1,
            Source::Floats { .. } => 2,
        };
        list.extend(plane.name.as_bytes());
        list.push(0);
        [kind, 0, 1, 1].iter().for_each(|number| list.extend(number.to_le_bytes()));
    }
    list.push(0);
    list
}
