//! Text files that are written whole or not at all.

use crate::error::{Error, Result};
use crate::picture::partial_file;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A place for a file that was found to be writable.
pub(super) struct OutputFile {
    path: PathBuf,
    partial: PathBuf,
}

impl OutputFile {
    /// Looks whether a file can be written to `path`, by creating and removing a temporary one beside it. Nothing that
    /// exists is changed.
    pub(super) fn new(path: &Path) -> Result<OutputFile> {
        if path.is_dir() {
            return Err(failed(path, io::ErrorKind::IsADirectory.into()));
        }
        if path.file_name().is_none() {
            return Err(failed(path, io::ErrorKind::InvalidInput.into()));
        }
        let partial = partial_file(path);
        fs::write(&partial, "")
            .and_then(|()| fs::remove_file(&partial))
            .map_err(|error| failed(path, error))?;
        Ok(OutputFile { path: path.to_path_buf(), partial })
    }

    /// Writes the text under the temporary name and then renames it.
    pub(super) fn write(&self, text: &str) -> Result<()> {
        fs::write(&self.partial, text).and_then(|()| fs::rename(&self.partial, &self.path)).map_err(|error| {
            // It may not even be there.
            let _ = fs::remove_file(&self.partial);
            failed(&self.path, error)
        })
    }
}

fn failed(path: &Path, source: io::Error) -> Error {
    Error::Io { action: "write".into(), path: path.into(), source }
}
