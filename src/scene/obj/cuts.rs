//! A file cut at line ends into pieces that can be read alone.

use rayon::prelude::*;
use std::fs::File;
use std::io;
use std::ops::Range;
use std::os::unix::fs::FileExt;

/// Bytes between the places from which a cut is looked for.
const WINDOW: u64 = 1 << 20;
/// Bytes that are read at a time to find a cut: some lines.
const PEEK: usize = 1 << 10;
/// Longest piece in bytes; lines such as a polygon of a million corners fit.
const MAX_PIECE: u64 = 64 << 20;
/// Marks UTF-8 and is no part of the first line.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// Where a file is cut. That depends on nothing but the file, and neither does what is read from it.
pub(super) struct Cuts<'f> {
    file: &'f File,
    /// Start of the file, where each further piece starts, and end of the file.
    places: Vec<u64>,
}

impl Cuts<'_> {
    /// Cuts the first `length` bytes of a file into pieces of about a window.
    pub(super) fn find(file: &File, length: u64) -> io::Result<Cuts<'_>> {
        let windows = 1..length.div_ceil(WINDOW);
        let find = |window| find_in(file, window * WINDOW..length.min((window + 1) * WINDOW)).transpose();
        let inner: Vec<u64> = windows.into_par_iter().filter_map(find).collect::<io::Result<_>>()?;
        let mut places = vec![0];
        places.extend(inner.into_iter().filter(|place| *place < length));
        places.push(length);
        if places.windows(2).any(|ends| ends[1] - ends[0] > MAX_PIECE) {
            let message = format!("a line is longer than {} MiB", MAX_PIECE >> 20);
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        Ok(Cuts { file, places })
    }

    /// The number of pieces.
    pub(super) fn pieces(&self) -> usize {
        self.places.len() - 1
    }

    /// The bytes of a piece, which are whole logical lines. `buffer` is room for them.
    pub(super) fn read<'b>(&self, piece: usize, buffer: &'b mut Vec<u8>) -> io::Result<&'b [u8]> {
        let (start, end) = (self.places[piece], self.places[piece + 1]);
        buffer.resize((end - start) as usize, 0);
        self.file.read_exact_at(buffer, start)?;
        let text = if piece == 0 { buffer.strip_prefix(BYTE_ORDER_MARK) } else { None };
        Ok(text.unwrap_or(buffer))
    }
}

/// The end of the first line in the window that surely does not go on in the next line, if there is one.
fn find_in(file: &File, window: Range<u64>) -> io::Result<Option<u64>> {
    let mut block = [0; PEEK];
    let mut start = window.start;
    // The last byte of the line that is not blank. The first line may have started before the window.
    let mut last = None;
    let mut is_whole = false;
    while start < window.end {
        let length = (window.end - start).min(PEEK as u64) as usize;
        let block = &mut block[..length];
        file.read_exact_at(block, start)?;
        for (at, byte) in (start + 1..).zip(block.iter()) {
            match byte {
                b'\n' if last.map_or(is_whole, |last| last != b'\\') => return Ok(Some(at)),
                b'\n' => (last, is_whole) = (None, true),
                byte if !byte.is_ascii_whitespace() => last = Some(*byte),
                _ => {}
            }
        }
        start += length as u64;
    }
    Ok(None)
}
