//! Writing: whole or not at all.

use super::{BUFFER, FORMAT, MAGIC};
use crate::error::Result;
use crate::whole_file::WholeFile;
use serde::Serialize;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use xxhash_rust::xxh3::Xxh3;

/// A place for a film file.
#[derive(Clone, Debug)]
pub struct FilePlace(WholeFile);

impl FilePlace {
    /// Looks whether a file can be written to `path`, by creating and removing a temporary one beside it. Nothing that
    /// exists is changed.
    ///
    /// # Errors
    /// A folder that is missing or read-only; a path that is something other than a file.
    pub fn new(path: &Path) -> Result<FilePlace> {
        WholeFile::new(path, "write").map(FilePlace)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// The file that holds it until it is complete, in the same folder.
    pub fn partial_path(&self) -> &Path {
        self.0.partial_path()
    }

    /// Writes a header and what `sums` adds, brings it to the disk and gives it its name.
    ///
    /// # Errors
    /// A disk that is full or fails, a folder that is gone. The file at the path is as before then, and no temporary file is
    /// left.
    pub fn write<H: Serialize>(
        &self,
        header: &H,
        sums: impl FnOnce(&mut Writer<'_>) -> io::Result<()>,
    ) -> Result<()> {
        self.0.write(|file| fill(file, header, sums).map_err(|source| self.0.failed(source)))
    }
}

fn fill<H: Serialize>(
    file: &File,
    header: &H,
    sums: impl FnOnce(&mut Writer<'_>) -> io::Result<()>,
) -> io::Result<()> {
    let header = serde_json::to_vec(header)?;
    let file = BufWriter::with_capacity(BUFFER, file);
    let mut writer = Writer { file, hash: Xxh3::new(), buffer: Vec::new() };
    writer.put(&MAGIC)?;
    writer.put(&FORMAT.to_le_bytes())?;
    writer.put(&u32::try_from(header.len()).map_err(io::Error::other)?.to_le_bytes())?;
    writer.put(&header)?;
    sums(&mut writer)?;
    let checksum = writer.hash.digest128();
    writer.put(&checksum.to_le_bytes())?;
    writer.file.flush()
}

/// A film file on its way.
pub struct Writer<'f> {
    file: BufWriter<&'f File>,
    hash: Xxh3,
    buffer: Vec<u8>,
}

impl Writer<'_> {
    /// Adds f64.
    ///
    /// # Errors
    /// Those of writing the file.
    pub fn doubles(&mut self, values: impl IntoIterator<Item = f64>) -> io::Result<()> {
        self.all(values.into_iter().map(f64::to_le_bytes))
    }

    /// Adds f32.
    ///
    /// # Errors
    /// Those of writing the file.
    pub fn floats(&mut self, values: impl IntoIterator<Item = f32>) -> io::Result<()> {
        self.all(values.into_iter().map(f32::to_le_bytes))
    }

    /// Adds u64.
    ///
    /// # Errors
    /// Those of writing the file.
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
