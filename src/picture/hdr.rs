//! The header of Radiance files: lines `NAME=VALUE`, of which OpenImageIO writes and reads none but its own.

use super::metadata::{Metadata, Value};
use std::io::{self, BufRead};

/// The most bytes of a line with its end: some readers take longer ones for several, and an empty one for the last.
const LINE: usize = 120;
/// The most bytes of a header that are read.
const HEADER: u64 = 1 << 20;
/// What the format calls `Software`.
const SOFTWARE: &str = "SOFTWARE";

/// The file `bytes` with metadata behind its first line. A value that is too long for a line is cut into several of its name.
pub(super) fn with_metadata(bytes: &[u8], metadata: &Metadata) -> Vec<u8> {
    let start = bytes.iter().position(|&byte| byte == b'\n').map_or(bytes.len(), |end| end + 1);
    let mut lines = String::new();
    for (name, value) in metadata.iter() {
        let name = if name == "Software" { SOFTWARE } else { name };
        let text: String = value.to_string().chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        let room = LINE.saturating_sub(name.len() + 2).max(16);
        let mut rest = text.as_str();
        loop {
            let (part, more) = rest.split_at(rest.floor_char_boundary(room));
            lines.extend([name, "=", part, "\n"]);
            if more.is_empty() {
                break;
            }
            rest = more;
        }
    }
    [&bytes[..start], lines.as_bytes(), &bytes[start..]].concat()
}

/// The variables of a header but that of its format, those of one name together.
pub(super) fn metadata(file: impl BufRead) -> io::Result<Metadata> {
    let mut found: Vec<(String, String)> = Vec::new();
    for line in file.take(HEADER).split(b'\n') {
        let line = line?;
        if line.is_empty() {
            break;
        }
        let Ok(line) = String::from_utf8(line) else { continue };
        let Some((name, value)) = line.split_once('=').filter(|_| !line.starts_with('#')) else { continue };
        if name == "FORMAT" {
            continue;
        }
        let name = if name == SOFTWARE { "Software" } else { name };
        match found.iter_mut().find(|(other, _)| other == name) {
            Some((_, whole)) => whole.push_str(value),
            None => found.push((name.to_owned(), value.to_owned())),
        }
    }
    let mut metadata = Metadata::default();
    found.into_iter().for_each(|(name, value)| metadata.push(name, Value::Text(value)));
    Ok(metadata)
}
