//! Text files that are written whole or not at all.

use crate::error::Result;
use crate::whole_file::WholeFile;
use std::io::Write;
use std::path::Path;

/// A place for a file that was found to be writable.
pub(crate) struct TextFile(WholeFile);

impl TextFile {
    /// Looks whether a file can be written to `path`; nothing that exists is changed.
    pub(crate) fn new(path: &Path) -> Result<TextFile> {
        WholeFile::new(path, "write").map(TextFile)
    }

    /// Writes the text.
    pub(crate) fn write(&self, text: &str) -> Result<()> {
        self.0.write(|mut file| file.write_all(text.as_bytes()).map_err(|source| self.0.failed(source)))
    }
}
