//! Writing: whole or not at all.

use super::{BUFFER, FORMAT, MAGIC};
use crate::error::{Error, Result};
use crate::picture::{partial_file, replaced_file};
use serde::Serialize;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::Xxh3;

/// A place for a film file.
#[derive(Clone, Debug)]
pub struct FilePlace {
    path: PathBuf,
    partial: PathBuf,
}

impl FilePlace {
    /// Looks whether a file can be written to `path`, by creating and removing a temporary one beside it. Nothing that
    /// exists is changed.
    pub fn new(path: &Path) -> Result<FilePlace> {
        let failed = |source| failed(path, source);
        let target = replaced_file(path).map_err(failed)?;
        if target.file_name().is_none() {
            return Err(failed(io::ErrorKind::InvalidInput.into()));
        }
        let partial = partial_file(&target);
        File::create(&partial).and_then(|_| fs::remove_file(&partial)).map_err(failed)?;
        Ok(FilePlace { path: target, partial })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The file that holds it until it is complete, in the same folder.
    pub fn partial_path(&self) -> &Path {
        &self.partial
    }

    /// Writes a header and what `sums` adds, brings it to the disk and gives it its name. After an error the file at the
    /// path is as before and no temporary file is left.
    pub fn write<H: Serialize>(
        &self,
        header: &H,
        sums: impl FnOnce(&mut Writer) -> io::Result<()>,
    ) -> Result<()> {
        self.try_write(header, sums).map_err(|error| {
            // It may not even be there.
            let _ = fs::remove_file(&self.partial);
            failed(&self.path, error)
        })
    }

    fn try_write<H: Serialize>(
        &self,
        header: &H,
        sums: impl FnOnce(&mut Writer) -> io::Result<()>,
    ) -> io::Result<()> {
        let header = serde_json::to_vec(header)?;
        let file = BufWriter::with_capacity(BUFFER, File::create(&self.partial)?);
        let mut writer = Writer { file, hash: Xxh3::new(), buffer: Vec::new() };
        writer.put(&MAGIC)?;
        writer.put(&FORMAT.to_le_bytes())?;
        writer.put(&u32::try_from(header.len()).map_err(io::Error::other)?.to_le_bytes())?;
        writer.put(&header)?;
        sums(&mut writer)?;
        let checksum = writer.hash.digest128();
        writer.put(&checksum.to_le_bytes())?;
        let file = writer.file.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        drop(file);
        fs::rename(&self.partial, &self.path)?;
        sync_folder(&self.path);
        Ok(())
    }
}

/// Brings the new name to the disk too. Some file systems can't; the file itself is there already.
fn sync_folder(path: &Path) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}

fn failed(path: &Path, source: io::Error) -> Error {
    Error::Io { action: "write".into(), path: path.into(), source }
}

/// A film file on its way.
pub struct Writer {
    file: BufWriter<File>,
    hash: Xxh3,
    buffer: Vec<u8>,
}

impl Writer {
    /// Adds f64.
    pub fn doubles(&mut self, values: impl IntoIterator<Item = f64>) -> io::Result<()> {
        self.all(values.into_iter().map(f64::to_le_bytes))
    }

    /// Adds f32.
    pub fn floats(&mut self, values: impl IntoIterator<Item = f32>) -> io::Result<()> {
        self.all(values.into_iter().map(f32::to_le_bytes))
    }

    /// Adds u64.
    pub fn integers(&mut self, values: impl IntoIterator<Item = u64>) -> io::Result<()> {
        self.all(values.into_iter().map(u64::to_le_bytes))
    }

    fn all<const N: usize>(&mut self, values: impl Iterator<Item = [u8; N]>) -> io::Result<()> {
        let mut buffer = std::mem::take(&mut self.buffer);
        for value in values {
            buffer.extend(value);
            if buffer.len() >= BUFFER {
                self.put(&buffer)?;
                buffer.clear();
            }
        }
        self.put(&buffer)?;
        buffer.clear();
        self.buffer = buffer;
        Ok(())
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hash.update(bytes);
        self.file.write_all(bytes)
    }
}
