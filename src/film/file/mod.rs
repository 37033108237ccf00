//! Files of sums: checkpoints, and parts of a picture.
//!
//! | bytes | what |
//! |---|---|
//! | 8 | `PTfilm\r\n` |
//! | 4 | the number of the format, 1 |
//! | 4 | the length of the header |
//! | that many | the header, JSON: what was rendered, how, and which sums follow |
//! | all but 16 | the sums: f64, f32 and u64 without gaps, in the order that the header implies |
//! | 16 | XXH3 (128 bits) of everything before |
//!
//! All numbers are little-endian. Line ends in the first bytes show a file that was sent as text. A file is written under
//! another name, brought to the disk and renamed, so there is never half of one by its name.

mod read;
mod record;
mod write;

pub use read::Reader;
pub use record::{FilmRecord, copy_pixels};
pub use write::{FilePlace, Writer};

use crate::error::Error;
use std::path::Path;

/// What a film file begins with.
const MAGIC: [u8; 8] = *b"PTfilm\r\n";
/// The number of the format.
const FORMAT: u32 = 1;
/// Bytes of the checksum.
const CHECKSUM: u64 = 16;
/// Bytes before the header.
const PREFIX: u64 = 16;
/// The longest header, in bytes; those that are written take some thousand.
const MOST_HEADER: u32 = 1 << 20;
/// Bytes that are read and written at once.
const BUFFER: usize = 1 << 20;

/// An error about a film file; `why` goes on after its name.
pub(crate) fn refused(path: &Path, why: &str) -> Error {
    Error::Film(format!("{} {why}", path.display()))
}
