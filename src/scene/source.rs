//! A text with its lines: from a byte offset to the line and column that a person sees.

use crate::error::{Diagnostic, Location, Severity};
use std::path::Path;

/// Bytes between two entries of [`Source::chars`].
const STRIDE: usize = 4096;

/// A file's text, without a byte-order mark.
pub(crate) struct Source<'t> {
    file: &'t Path,
    text: &'t str,
    /// Offset of the first byte of each line. Lines end as editors show them: at LF, CR LF or CR.
    lines: Vec<usize>,
    /// Characters that start before byte `i * STRIDE`. Counting from the start of the line instead would be
    /// quadratic where a whole scene stands in one line.
    chars: Vec<usize>,
}

impl<'t> Source<'t> {
    /// Indexes `text`.
    pub(crate) fn new(file: &'t Path, text: &'t str) -> Source<'t> {
        let bytes = text.as_bytes();
        let mut lines = vec![0];
        for (i, &byte) in bytes.iter().enumerate() {
            if byte == b'\n' || (byte == b'\r' && bytes.get(i + 1) != Some(&b'\n')) {
                lines.push(i + 1);
            }
        }
        let mut chars = vec![0];
        for chunk in bytes.chunks(STRIDE) {
            chars.push(chars.last().copied().unwrap_or(0) + starts(chunk));
        }
        Source { file, text, lines, chars }
    }

    /// The text.
    pub(crate) fn text(&self) -> &'t str {
        self.text
    }

    /// Line and column of the character at byte `offset`.
    pub(crate) fn location(&self, offset: usize) -> Location {
        let offset = offset.min(self.text.len());
        let line = self.line_index(offset);
        let column = self.chars_before(offset) - self.chars_before(self.line_start(line)) + 1;
        Location { file: self.file.to_path_buf(), line: line + 1, column }
    }

    /// A diagnostic that points at byte `offset`.
    pub(crate) fn diagnostic(
        &self,
        severity: Severity,
        message: String,
        offset: usize,
        help: Option<String>,
    ) -> Diagnostic {
        let location = self.location(offset);
        let line = self.line_text(location.line - 1);
        let source_line = (!line.trim().is_empty()).then(|| Diagnostic::excerpt(line, location.column));
        Diagnostic { severity, message, location: Some(location), source_line, help }
    }

    /// The line that holds byte `offset`, from its first character.
    pub(crate) fn line_at(&self, offset: usize) -> &'t str {
        self.line_text(self.line_index(offset))
    }

    fn line_index(&self, offset: usize) -> usize {
        self.lines.partition_point(|&start| start <= offset).saturating_sub(1)
    }

    fn line_start(&self, line: usize) -> usize {
        self.lines.get(line).copied().unwrap_or(self.text.len())
    }

    fn line_text(&self, line: usize) -> &'t str {
        let text = self.text.get(self.line_start(line)..self.line_start(line + 1)).unwrap_or("");
        text.trim_end_matches(['\n', '\r'])
    }

    fn chars_before(&self, offset: usize) -> usize {
        let block = offset / STRIDE;
        let before = self.chars.get(block).copied().unwrap_or(0);
        before + self.text.as_bytes().get(block * STRIDE..offset).map_or(0, starts)
    }
}

/// How many characters start in a piece of UTF-8.
fn starts(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&byte| byte & 0xC0 != 0x80).count()
}
