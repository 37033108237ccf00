//! Text files that are written whole or not at all.

use crate::error::{Error, Result};
use crate::picture::{partial_file, replaced_file};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A place for a file that was found to be writable.
pub(crate) struct TextFile {
    path: PathBuf,
    partial: PathBuf,
}

impl TextFile {
    /// Looks whether a file can be written to `path`, by creating and removing a temporary one beside it. Nothing that
    /// exists is changed.
    pub(crate) fn new(path: &Path) -> Result<TextFile> {
        let failed = |error| failed(path, error);
        let target = replaced_file(path).map_err(failed)?;
        if target.file_name().is_none() {
            return Err(failed(io::ErrorKind::InvalidInput.into()));
        }
        let partial = partial_file(&target);
        File::create(&partial).and_then(|_| fs::remove_file(&partial)).map_err(failed)?;
        Ok(TextFile { path: target, partial })
    }

    /// Writes the text under the temporary name, brings it to the disk and renames it. It gets the permissions of the file that
    /// it replaces.
    pub(crate) fn write(&self, text: &str) -> Result<()> {
        self.try_write(text).map_err(|error| {
            // It may not even be there.
            let _ = fs::remove_file(&self.partial);
            failed(&self.path, error)
        })
    }

    fn try_write(&self, text: &str) -> io::Result<()> {
        let mut file = File::create(&self.partial)?;
        file.write_all(text.as_bytes())?;
        if let Ok(before) = fs::metadata(&self.path) {
            file.set_permissions(before.permissions())?;
        }
        file.sync_all()?;
        fs::rename(&self.partial, &self.path)
    }
}

fn failed(path: &Path, source: io::Error) -> Error {
    Error::Io { action: "write".into(), path: path.into(), source }
}
