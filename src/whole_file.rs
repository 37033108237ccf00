//! Files that are written whole or not at all.

use crate::error::{Error, Result};
use std::fs::{self, File};
use std::hash::{BuildHasher, RandomState};
use std::io;
use std::path::{Path, PathBuf};

/// A place for a file that was found to be writable.
#[derive(Clone, Debug)]
pub(crate) struct WholeFile {
    path: PathBuf,
    partial: PathBuf,
    /// What is done with it, in messages.
    action: &'static str,
}

impl WholeFile {
    /// Looks whether a file can be written to `path`, by creating and removing the temporary file beside it. Nothing that
    /// exists is changed. Errors: a folder that is missing or read-only; a path that is something other than a file.
    pub(crate) fn new(path: &Path, action: &'static str) -> Result<WholeFile> {
        let failed = |source| Error::Io { action: action.into(), path: path.into(), source };
        let target = replaced_file(path).map_err(failed)?;
        if target.file_name().is_none() {
            return Err(failed(io::ErrorKind::InvalidInput.into()));
        }
        let partial = partial_file(&target);
        File::create(&partial).and_then(|_| fs::remove_file(&partial)).map_err(failed)?;
        Ok(WholeFile { path: target, partial, action })
    }

    /// The file; behind a symbolic link the one that it leads to.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The file that holds it until it is complete, in the same folder.
    pub(crate) fn partial_path(&self) -> &Path {
        &self.partial
    }

    /// Lets `fill` write under the temporary name, brings that to the disk and renames it. After an error the file at the path
    /// is as before and no temporary file is left. A file that is replaced passes its permissions on.
    pub(crate) fn write(&self, fill: impl FnOnce(&File) -> Result<()>) -> Result<()> {
        let _partial = Partial(&self.partial);
        let file = File::create(&self.partial).map_err(|source| self.failed(source))?;
        fill(&file)?;
        self.finish(&file).map_err(|source| self.failed(source))
    }

    fn finish(&self, file: &File) -> io::Result<()> {
        if let Ok(before) = fs::metadata(&self.path) {
            // Some file systems have no permissions; what is written counts for more.
            let _ = file.set_permissions(before.permissions());
        }
        file.sync_all()?;
        fs::rename(&self.partial, &self.path)?;
        sync_folder(&self.path);
        Ok(())
    }

    /// What to say where writing fails.
    pub(crate) fn failed(&self, source: io::Error) -> Error {
        Error::Io { action: self.action.into(), path: self.path.clone(), source }
    }
}

/// A temporary file that is removed unless it got its final name.
struct Partial<'p>(&'p Path);

impl Drop for Partial<'_> {
    fn drop(&mut self) {
        // After the rename there is nothing by this name; an error has been reported already.
        let _ = fs::remove_file(self.0);
    }
}

/// The file that is replaced when something is written to `path`. Errors: a folder, something other than a file.
fn replaced_file(path: &Path) -> io::Result<PathBuf> {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(found) if !found.is_file() => Err(io::Error::other("it is not a regular file")),
        // The file behind a symbolic link is replaced, not the link.
        Ok(_) => fs::canonicalize(path),
        Err(_) => Ok(path.to_path_buf()),
    }
}

/// A new name beside a file that is to be replaced: short, whatever the file's own is, and different for every file under
/// way, on all machines that see the folder: 64 random bits.
fn partial_file(target: &Path) -> PathBuf {
    // Every one of these states has keys of its own, made from the system's random numbers.
    let random = RandomState::new().hash_one(std::process::id());
    target.with_file_name(format!(".pathtracer-{random:016x}.part"))
}

/// Brings the new name to the disk too. Some file systems can't; the file itself is there already.
fn sync_folder(path: &Path) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
}
