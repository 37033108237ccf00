//! The logical lines of an OBJ file: continued lines joined, comments set aside, places kept.

use crate::error::Diagnostic;

/// A logical line without its comment. A byte stands as far from its start as in the file.
#[derive(Clone, Copy)]
pub(super) struct Line<'b> {
    /// The line, and after it what comes next in the file, starting with a byte that belongs to no word.
    pub(super) bytes: &'b [u8],
    /// Its length.
    pub(super) length: usize,
}

/// Yields the logical lines of some bytes.
pub(super) struct Lines<'b> {
    bytes: &'b [u8],
    at: usize,
    /// The last line if it was joined.
    joined: Vec<u8>,
}

impl<'b> Lines<'b> {
    /// The lines of `bytes`.
    pub(super) fn of(bytes: &'b [u8]) -> Lines<'b> {
        Lines { bytes, at: 0, joined: Vec::new() }
    }

    /// Where the next line starts.
    pub(super) fn start(&self) -> usize {
        self.at
    }

    /// The next line. The encoding does not matter: statements are ASCII.
    #[inline]
    pub(super) fn next(&mut self) -> Option<Line<'_>> {
        let bytes = self.bytes.get(self.at..).filter(|rest| !rest.is_empty())?;
        let Some(length) = memchr::memchr3(b'\n', b'#', b'\\', bytes) else {
            self.at = self.bytes.len();
            return Some(Line { bytes, length: bytes.len() });
        };
        match bytes[length] {
            b'\n' => self.at += length + 1,
            b'#' => {
                let comment = &bytes[length..];
                self.at += length + memchr::memchr(b'\n', comment).map_or(comment.len(), |length| length + 1);
            }
            _ => return Some(self.join()),
        }
        Some(Line { bytes, length })
    }

    /// A line that holds a backslash, with blanks for the backslash and the line end where it goes on.
    #[cold]
    fn join(&mut self) -> Line<'_> {
        self.joined.clear();
        let start = self.at;
        while let Some(rest) = self.bytes.get(self.at..).filter(|rest| !rest.is_empty()) {
            let line = rest.split(|byte| *byte == b'\n').next().unwrap_or_default();
            self.at = (self.at + line.len() + 1).min(self.bytes.len());
            let Some(text) = continued(line) else {
                self.joined.extend(line.iter().take_while(|byte| **byte != b'#'));
                break;
            };
            self.joined.extend_from_slice(text);
            self.joined.resize(self.at - start, b' ');
        }
        Line { bytes: &self.joined, length: self.joined.len() }
    }
}

/// The text of a physical line before its backslash, if that is the last of it and no comment.
fn continued(line: &[u8]) -> Option<&[u8]> {
    let text = line.trim_ascii_end().strip_suffix(b"\\")?;
    (!text.contains(&b'#')).then_some(text)
}

/// Line, counted from 0, and column, from 1, of the byte at `offset`, and the excerpt of the physical line.
pub(super) fn place(bytes: &[u8], offset: usize) -> (usize, usize, String) {
    let (before, after) = bytes.split_at_checked(offset).unwrap_or((bytes, &[]));
    let start = memchr::memrchr(b'\n', before).map_or(0, |at| at + 1);
    let end = offset + memchr::memchr(b'\n', after).unwrap_or(after.len());
    let line = bytes.get(start..end).unwrap_or_default();
    let text = String::from_utf8_lossy(continued(line).unwrap_or(line));
    let column = String::from_utf8_lossy(before.get(start..).unwrap_or_default()).chars().count() + 1;
    (count(before), column, Diagnostic::excerpt(text.trim_end(), column))
}

/// How many line ends `bytes` holds.
pub(super) fn count(bytes: &[u8]) -> usize {
    memchr::memchr_iter(b'\n', bytes).count()
}
