//! What a picture file says about itself, read without its pixels.

use super::metadata::{Metadata, Value};
use super::read::{check_start, failed, refused};
use super::{Format, hdr, oiio};
use crate::error::Result;
use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, Text};
use exr::meta::header::Header;
use png::Decoder;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// A picture file without its pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct Info {
    /// The name of its format.
    pub format: &'static str,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Names of the channels of an EXR that has others than R, G and B; else empty.
    pub channels: Vec<String>,
    /// What it says.
    pub metadata: Metadata,
}

impl Info {
    /// Reads it from the file at `path`.
    ///
    /// # Errors
    /// A file that can't be read or is damaged; a format that needs OpenImageIO, without it.
    pub fn read(path: &Path) -> Result<Info> {
        let damaged = refused(path);
        let file = BufReader::new(File::open(path).map_err(failed(path))?);
        match Format::of(path) {
            Ok(Format::Png) => png(file).map_err(|error| damaged(error.to_string())),
            Ok(Format::Exr) => exr(file).map_err(|error| damaged(error.to_string())),
            other => {
                let other = other.ok();
                check_start(path, other)?;
                let ([width, height], mut metadata) = oiio::info(path).map_err(damaged)?;
                if other == Some(Format::Hdr) {
                    metadata = hdr::metadata(file).map_err(failed(path))?;
                }
                let format = other.map_or("a picture", Format::name);
                Ok(Info { format, width, height, channels: Vec::new(), metadata })
            }
        }
    }
}

fn png(file: BufReader<File>) -> std::result::Result<Info, png::DecodingError> {
    let mut reader = Decoder::new(file).read_info()?;
    // Text may stand behind the pixels too.
    reader.finish()?;
    let info = reader.info();
    let mut metadata = Metadata::default();
    for chunk in &info.uncompressed_latin1_text {
        metadata.push(&chunk.keyword, Value::Text(chunk.text.clone()));
    }
    for chunk in &info.compressed_latin1_text {
        metadata.push(&chunk.keyword, Value::Text(chunk.get_text()?));
    }
    for chunk in &info.utf8_text {
        metadata.push(&chunk.keyword, Value::Text(chunk.get_text()?));
    }
    let (width, height) = (info.width, info.height);
    Ok(Info { format: Format::Png.name(), width, height, channels: Vec::new(), metadata })
}

fn exr(file: BufReader<File>) -> exr::error::Result<Info> {
    let all = MetaData::read_from_buffered(file, false)?;
    let Some(header) = all.headers.first() else {
        return Err(exr::error::Error::Invalid("a file without layers".into()));
    };
    let (width, height) = (header.layer_size.width() as u32, header.layer_size.height() as u32);
    let names: Vec<String> = header.channels.list.iter().map(|channel| channel.name.to_string()).collect();
    let is_plain = names.iter().all(|name| ["R", "G", "B"].contains(&name.as_str()));
    let channels = if is_plain { Vec::new() } else { names };
    Ok(Info { format: Format::Exr.name(), width, height, channels, metadata: attributes(header) })
}

/// The attributes that are text, numbers or matrices: those that this program writes first, then the others by name.
fn attributes(header: &Header) -> Metadata {
    let own = &header.own_attributes;
    let text = |text: &Option<Text>| text.as_ref().map(|text| Value::Text(text.to_string()));
    let standard = [
        ("DateTime", text(&own.capture_date)),
        ("owner", text(&own.owner)),
        ("comments", text(&own.comments)),
        ("worldToCamera", own.world_to_camera.map(|m| Value::Matrix(m.map(f64::from)))),
    ];
    let standard = standard.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?)));
    let more = own.other.iter().filter_map(|(name, value)| Some((name.to_string(), value_of(value)?)));
    let mut found: Vec<(String, Value)> = standard.chain(more).collect();
    found.sort_by(|a, b| a.0.cmp(&b.0));
    let mut metadata = Metadata::default();
    found.into_iter().for_each(|(name, value)| metadata.push(name, value));
    metadata
}

fn value_of(value: &AttributeValue) -> Option<Value> {
    Some(match value {
        AttributeValue::Text(text) => Value::Text(text.to_string()),
        AttributeValue::I32(number) => Value::Integer((*number).into()),
        // The shortest text that is this f32, not the f64 beside it.
        AttributeValue::F32(number) => Value::Number(number.to_string().parse().ok()?),
        AttributeValue::F64(number) => Value::Number(*number),
        AttributeValue::Matrix4x4(rows) => Value::Matrix(rows.map(f64::from)),
        _ => return None,
    })
}
