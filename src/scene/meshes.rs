//! Finding the mesh files that a scene names, and reading each of them once.

use super::desc::MeshDesc;
use super::diagnostic::{Finding, Report, quote};
use super::digest::Digest;
use super::files;
use super::from_file::Part;
use super::obj::{self, Failure, Fault};
use super::yaml::node::Node;
use super::yaml::value::Value;
use crate::error::{Location, Severity};
use crate::memory::available_bytes;
use crate::words::bytes;
use rayon::prelude::*;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The mesh files of one scene.
pub(crate) struct Meshes {
    folder: PathBuf,
    /// By canonical path; `None` for a file that could not be read, which was reported.
    read: HashMap<PathBuf, Option<Arc<MeshDesc>>>,
    /// The parts of meshes with materials of their own, by the mesh; `None` after an error.
    pub(crate) parts: HashMap<*const MeshDesc, Option<Vec<Part>>>,
    /// Of every file that was read, in the order in which the scene names them first.
    digests: Vec<Digest>,
    /// The files that were read, and those of materials.
    files: Vec<PathBuf>,
    /// By canonical path: what was read ahead and not asked for yet.
    ahead: HashMap<PathBuf, Result<obj::Loaded, Failure>>,
}

impl Meshes {
    /// The meshes named in the scene file `file`.
    pub(crate) fn beside(file: &Path) -> Meshes {
        let folder = file.parent().unwrap_or(Path::new("")).to_path_buf();
        Meshes {
            folder,
            read: HashMap::new(),
            parts: HashMap::new(),
            digests: Vec::new(),
            files: Vec::new(),
            ahead: HashMap::new(),
        }
    }

    /// Reads the meshes that some objects name all at once, if they are small: of a small file one thread reads most. What
    /// is wrong is said where the objects are read.
    pub(crate) fn read_ahead(&mut self, objects: &[Node<'_>]) {
        let names = objects.iter().filter_map(|object| object.entry("Object")?.entry("Filepath")?.text());
        let path = |name| files::places(&self.folder, name).into_iter().find(|path| path.is_file());
        let mut paths: Vec<PathBuf> =
            names.filter_map(path).filter_map(|path| path.canonicalize().ok()).collect();
        paths.sort_unstable();
        paths.dedup();
        let sizes = paths.iter().map(|path| std::fs::metadata(path).map_or(u64::MAX, |file| file.len()));
        let free = available_bytes().map_or(u64::MAX, |bytes| bytes / READ_BYTES);
        if sizes.fold(0, u64::saturating_add) <= MOST_AHEAD.min(free) {
            let read = paths.into_par_iter().map(|path| (obj::load(&path), path));
            self.ahead = read.map(|(loaded, path)| (path, loaded)).collect();
        }
    }

    /// Of all files that were read.
    pub(crate) fn digests(&self) -> &[Digest] {
        &self.digests
    }

    /// All files that were read.
    pub(crate) fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// Adds another file that was read.
    pub(crate) fn add_file(&mut self, path: PathBuf, bytes: &[u8]) {
        self.digests.push(Digest::of(bytes));
        self.files.push(path);
    }

    /// The mesh that the `Filepath` in `value` names, and the file that was found.
    pub(crate) fn get(&mut self, value: Value<'_>, report: &mut Report) -> Option<(PathBuf, Arc<MeshDesc>)> {
        let name = value.text("the name of an OBJ file", report)?;
        let path = files::find(&self.folder, name, &files::MESH, value, report)?;
        let key = path.canonicalize().unwrap_or_else(|_| path.clone());
        let mesh = match self.read.get(&key) {
            Some(mesh) => mesh.clone(),
            None => {
                let loaded = self.ahead.remove(&key);
                let mesh = read(&path, loaded, value, report).map(|(mesh, digest)| {
                    self.digests.push(digest);
                    self.files.push(path.clone());
                    Arc::new(mesh)
                });
                self.read.insert(key, mesh.clone());
                mesh
            }
        };
        Some((path, mesh?))
    }
}

/// Bytes of all mesh files of a scene that are read at once.
const MOST_AHEAD: u64 = 64 << 20;

/// Bytes of memory that reading takes for a byte of a mesh file: its text and the mesh.
const READ_BYTES: u64 = 2;

fn shown(path: &Path) -> String {
    quote(&path.display().to_string())
}

/// Reads a mesh, unless it was read ahead, and reports what is wrong with it.
fn read(
    path: &Path,
    ahead: Option<Result<obj::Loaded, Failure>>,
    value: Value<'_>,
    report: &mut Report,
) -> Option<(MeshDesc, Digest)> {
    if let (Ok(file), Some(available)) = (std::fs::metadata(path), available_bytes())
        && file.len().saturating_mul(READ_BYTES) > available
    {
        let text = format!(
            "names {}, a mesh of {} that takes about {} to read, and {} of memory are free",
            shown(path),
            bytes(file.len()),
            bytes(file.len().saturating_mul(READ_BYTES)),
            bytes(available)
        );
        value.error(&text, Some("a coarser mesh takes less".to_owned()), report);
        return None;
    }
    let loaded = match ahead.unwrap_or_else(|| obj::load(path)) {
        Ok(loaded) => loaded,
        Err(Failure::Unreadable(reason)) => {
            value.error(&format!("names {}, which cannot be read: {reason}", shown(path)), None, report);
            return None;
        }
        Err(Failure::Faults { first, more }) => {
            for fault in first {
                report_fault(fault, path, value, report);
            }
            if more > 0 {
                value.error(&format!("names a mesh with {more} more errors: {}", shown(path)), None, report);
            }
            return None;
        }
    };
    if loaded.mesh.triangles.is_empty() {
        let what = if loaded.dropped > 0 { "whose faces have no area" } else { "without faces" };
        value.error(&format!("names a mesh {what}: {}", shown(path)), None, report);
        return None;
    }
    if loaded.dropped > 0 {
        let faces = if loaded.dropped == 1 { "1 face".into() } else { format!("{} faces", loaded.dropped) };
        warn(format!(": {faces} without area dropped from {}", shown(path)), value, report);
    }
    if loaded.fanned > 0 {
        let text = format!(
            ": {} concave faces of {} have too many corners to be split properly",
            loaded.fanned,
            shown(path)
        );
        warn(text, value, report);
    }
    Some((loaded.mesh, loaded.digest))
}

fn warn(text: String, value: Value<'_>, report: &mut Report) {
    report.push(Finding {
        severity: Severity::Warning,
        subject: value.path.to_string(),
        text,
        help: None,
        place: value.place(),
        elsewhere: None,
    });
}

/// Reports an error in the mesh file, with the place there and who named the file.
pub(crate) fn report_fault(fault: Fault, path: &Path, value: Value<'_>, report: &mut Report) {
    let location = Location { file: path.to_path_buf(), line: fault.line, column: fault.column };
    report.push(Finding {
        severity: Severity::Error,
        subject: String::new(),
        text: fault.message,
        help: Some(format!("the mesh is named by {}", value.path)),
        place: value.place(),
        elsewhere: Some((location, fault.excerpt)),
    });
}
