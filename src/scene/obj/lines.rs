//! The logical lines of an OBJ file: continued lines joined, comments set aside, places kept.

use crate::error::Diagnostic;
use std::io::{self, BufRead, Read};

/// Longest physical line in bytes; a polygon of a million corners fits.
const MAX_LINE: u64 = 64 << 20;

/// A line after the joining of continuations.
#[derive(Default)]
pub(super) struct Line {
    bytes: Vec<u8>,
    /// Where the comment starts, or the end.
    end: usize,
    /// Number of its first physical line, from 1.
    number: usize,
    /// Where each further physical line starts in `bytes`.
    joins: Vec<usize>,
}

impl Line {
    /// The line without its comment.
    pub(super) fn statement(&self) -> &[u8] {
        self.bytes.get(..self.end).unwrap_or_default()
    }

    /// Line and column of byte `offset`, and the excerpt of the physical line.
    pub(super) fn place(&self, offset: usize) -> (usize, usize, String) {
        let join = self.joins.partition_point(|&start| start <= offset);
        let start = join.checked_sub(1).and_then(|i| self.joins.get(i)).copied().unwrap_or(0);
        let end = self.joins.get(join).copied().unwrap_or(self.bytes.len());
        let text = |end: usize| String::from_utf8_lossy(self.bytes.get(start..end).unwrap_or_default());
        let column = text(offset).chars().count() + 1;
        (self.number + join, column, Diagnostic::excerpt(text(end).trim_end(), column))
    }
}

/// Reads logical lines.
pub(super) struct Lines<R> {
    reader: R,
    read: usize,
    line: Line,
}

impl<R: BufRead> Lines<R> {
    /// The lines of `reader`.
    pub(super) fn new(reader: R) -> Lines<R> {
        Lines { reader, read: 0, line: Line::default() }
    }

    /// The next line, or `None` at the end. The encoding does not matter: statements are ASCII.
    pub(super) fn next(&mut self) -> io::Result<Option<&Line>> {
        let line = &mut self.line;
        line.bytes.clear();
        line.joins.clear();
        line.number = self.read + 1;
        loop {
            let start = line.bytes.len();
            let length = self.reader.by_ref().take(MAX_LINE).read_until(b'\n', &mut line.bytes)?;
            if length == 0 {
                break;
            }
            if length as u64 == MAX_LINE {
                return Err(io::Error::new(io::ErrorKind::InvalidData, "a line is longer than 64 MiB"));
            }
            self.read += 1;
            if self.read == 1 && line.bytes.starts_with(b"\xEF\xBB\xBF") {
                line.bytes.drain(..3);
            }
            let text = line.bytes.trim_ascii_end().len();
            line.bytes.truncate(text.max(start));
            let comment = line.bytes[start..].iter().position(|&byte| byte == b'#');
            line.end = comment.map_or(line.bytes.len(), |at| start + at);
            if comment.is_some() || line.bytes[start..].last() != Some(&b'\\') {
                return Ok(Some(&self.line));
            }
            // The backslash becomes the blank that separates words.
            line.bytes.pop();
            line.bytes.push(b' ');
            line.end = line.bytes.len();
            line.joins.push(line.end);
        }
        Ok((self.read >= line.number).then_some(&self.line))
    }
}
