//! Reading: nothing is believed before the checksum, and nothing is allocated that the file does not hold.

use super::{BUFFER, CHECKSUM, FORMAT, MAGIC, MOST_HEADER, PREFIX, refused};
use crate::error::{Error, Result};
use serde::de::DeserializeOwned;
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::Xxh3;

/// A film file whose checksum is right.
pub struct Reader {
    path: PathBuf,
    file: BufReader<File>,
    /// Bytes of sums that were not read yet.
    left: u64,
}

impl Reader {
    /// Opens a file, compares its checksum and reads its header.
    ///
    /// # Errors
    /// [`Error::Io`] if it can't be read, [`Error::Film`] if it is no film file, is damaged, or of another version of this
    /// program.
    pub fn open<H: DeserializeOwned>(path: &Path) -> Result<(H, Reader)> {
        let failed = |source| Error::Io { action: "read".into(), path: path.into(), source };
        let found = std::fs::metadata(path).map_err(failed)?;
        if !found.is_file() {
            return Err(refused(path, "is not a regular file"));
        }
        let file = File::open(path).map_err(failed)?;
        let bytes = file.metadata().map_err(failed)?.len();
        let mut file = BufReader::with_capacity(BUFFER, file);
        let Some([format, length]) = begin(&mut file).filter(|_| bytes >= PREFIX + CHECKSUM) else {
            return Err(refused(path, "is neither a checkpoint nor a part of a picture"));
        };
        if format != FORMAT {
            let why = format!("has format {format}, and this program reads format {FORMAT}");
            return Err(refused(path, &why));
        }
        check_sum(&mut file, bytes)
            .map_err(failed)?
            .then_some(())
            .ok_or_else(|| refused(path, "is damaged: its checksum is not that of its content"))?;
        if length > MOST_HEADER || u64::from(length) > bytes - PREFIX - CHECKSUM {
            return Err(refused(path, "has a header that is too long"));
        }
        let mut header = vec![0; length as usize];
        file.seek(SeekFrom::Start(PREFIX)).and_then(|_| file.read_exact(&mut header)).map_err(failed)?;
        let header = serde_json::from_slice(&header).map_err(|error| {
            refused(path, &format!("has a header of another program or version: {error}"))
        })?;
        let left = bytes - PREFIX - CHECKSUM - u64::from(length);
        Ok((header, Reader { path: path.into(), file, left }))
    }

    /// The header alone, of a file whose content is not looked at; `None` where there is none, or another one.
    pub fn header<H: DeserializeOwned>(path: &Path) -> Option<H> {
        let mut file = File::open(path).ok()?;
        let [format, length] = begin(&mut file)?;
        if format != FORMAT || length > MOST_HEADER {
            return None;
        }
        let mut header = vec![0; length as usize];
        file.read_exact(&mut header).ok()?;
        serde_json::from_slice(&header).ok()
    }

    /// Whether there is a film file whose content is not what was written, or nothing at all.
    pub fn is_damaged(path: &Path) -> bool {
        let Ok(file) = File::open(path) else { return false };
        let Ok(bytes) = file.metadata().map(|found| found.len()) else { return false };
        let mut file = BufReader::with_capacity(BUFFER, file);
        let mut magic = [0; MAGIC.len()];
        let is_film = file.read_exact(&mut magic).is_ok() && magic == MAGIC;
        bytes == 0 || is_film && (bytes < PREFIX + CHECKSUM || !check_sum(&mut file, bytes).unwrap_or(true))
    }

    /// Reads `count` f64.
    ///
    /// # Errors
    /// A file that ends before, or can't be read.
    pub fn doubles(&mut self, count: u64) -> Result<Vec<f64>> {
        self.all(count, f64::from_le_bytes)
    }

    /// Reads `count` f32.
    ///
    /// # Errors
    /// A file that ends before, or can't be read.
    pub fn floats(&mut self, count: u64) -> Result<Vec<f32>> {
        self.all(count, f32::from_le_bytes)
    }

    /// Reads `count` u64.
    ///
    /// # Errors
    /// A file that ends before, or can't be read.
    pub fn integers(&mut self, count: u64) -> Result<Vec<u64>> {
        self.all(count, u64::from_le_bytes)
    }

    /// Reads `count` f64 that are sums of light, so neither negative nor NaN.
    ///
    /// # Errors
    /// A file that ends before, or can't be read; sums that are negative or NaN.
    pub fn light(&mut self, count: u64) -> Result<Vec<f64>> {
        let values = self.doubles(count)?;
        match values.iter().all(|&value| value >= 0.0) {
            true => Ok(values),
            false => Err(self.refuse("holds sums that are no light")),
        }
    }

    /// All sums must have been read.
    ///
    /// # Errors
    /// There are more.
    pub fn finish(self) -> Result<()> {
        if self.left > 0 {
            return Err(self.refuse("holds more sums than its header says"));
        }
        Ok(())
    }

    /// An error about this file; `why` goes on after its name.
    pub fn refuse(&self, why: &str) -> Error {
        refused(&self.path, why)
    }

    fn all<T, const N: usize>(&mut self, count: u64, value: fn([u8; N]) -> T) -> Result<Vec<T>> {
        let bytes = count.checked_mul(N as u64).filter(|&bytes| bytes <= self.left);
        let bytes = bytes.ok_or_else(|| self.refuse("holds fewer sums than its header says"))?;
        let mut values = Vec::new();
        // The file has that many bytes, but the machine may not.
        values.try_reserve_exact(count as usize).map_err(|_| self.refuse("does not fit into memory"))?;
        self.left -= bytes;
        let mut item = [0; N];
        for _ in 0..count {
            self.file.read_exact(&mut item).map_err(|source| Error::Io {
                action: "read".into(),
                path: self.path.clone(),
                source,
            })?;
            values.push(value(item));
        }
        Ok(values)
    }
}

/// The format of a film file and the length of its header.
fn begin(file: &mut impl Read) -> Option<[u32; 2]> {
    let mut prefix = [0; PREFIX as usize];
    file.read_exact(&mut prefix).ok()?;
    let (magic, numbers) = prefix.split_first_chunk()?;
    let numbers = numbers.as_chunks().0;
    (*magic == MAGIC).then(|| [numbers[0], numbers[1]].map(u32::from_le_bytes))
}

/// Whether the last bytes are the checksum of those before.
fn check_sum(file: &mut BufReader<File>, bytes: u64) -> io::Result<bool> {
    file.seek(SeekFrom::Start(0))?;
    let (mut hash, mut buffer, mut left) = (Xxh3::new(), vec![0; BUFFER], bytes - CHECKSUM);
    while left > 0 {
        let size = left.min(BUFFER as u64) as usize;
        file.read_exact(&mut buffer[..size])?;
        hash.update(&buffer[..size]);
        left -= size as u64;
    }
    let mut checksum = [0; CHECKSUM as usize];
    file.read_exact(&mut checksum)?;
    Ok(u128::from_le_bytes(checksum) == hash.digest128())
}
