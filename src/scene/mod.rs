//! What the scene file says: YAML text becomes a [`desc::SceneDesc`] with its meshes, or every mistake in it with
//! its place.
//!
//! The way: `yaml` parses the text into a tree of values, `read` gives the keys their meaning, `meshes` `obj` and `pictures` read
//! what the scene names, `diagnostic` collects what is wrong and `source` knows the lines.

pub mod desc;
pub mod edit;

mod diagnostic;
mod digest;
mod files;
mod from_file;
mod meshes;
mod mtl;
mod obj;
mod pictures;
mod read;
mod source;
mod yaml;

pub use digest::Digest;

use crate::error::{Diagnostic, Error, Location, Result, Severity};
use desc::{MeshDesc, SceneDesc};
use diagnostic::Report;
use meshes::Meshes;
use pictures::Pictures;
use read::Context;
use source::Source;
use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// A scene that can be rendered.
#[derive(Clone, Debug)]
pub struct Scene {
    /// What the file says.
    pub desc: SceneDesc,
    /// What the user should know, in the order of the file.
    pub warnings: Vec<Diagnostic>,
    /// Of the file and all that it names.
    pub digest: Digest,
    /// All that was read beside the scene file: meshes, their materials, pictures. Ascending, each once.
    pub files: Vec<PathBuf>,
}

/// Reads the scene file at `path` and the meshes that it names.
///
/// # Errors
/// [`Error::Scene`]: that the file can't be read, or all errors and warnings of the scene and its meshes.
pub fn load(path: &Path) -> Result<Scene> {
    let failed = |error: io::Error| Error::Scene(vec![unreadable(path, &error)]);
    let file = File::open(path).map_err(failed)?;
    let size = file.metadata().map_err(failed)?.len();
    let mut bytes = Vec::new();
    if size <= yaml::MAX_BYTES {
        // A pipe has no size, and a file may grow.
        file.take(yaml::MAX_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    }
    if size > yaml::MAX_BYTES || bytes.len() as u64 > yaml::MAX_BYTES {
        return Err(Error::Scene(vec![yaml::too_large(path)]));
    }
    let text = yaml::decode(&bytes, path).map_err(|diagnostic| Error::Scene(vec![*diagnostic]))?;
    read_text(text, path)
}

/// Reads a scene from `text` as if it stood in `file`, whose folder is where meshes are looked for first.
///
/// # Errors
/// [`Error::Scene`] as for [`load`].
pub fn parse(text: &str, file: &Path) -> Result<Scene> {
    let text = yaml::decode(text.as_bytes(), file).map_err(|diagnostic| Error::Scene(vec![*diagnostic]))?;
    read_text(text, file)
}

/// Reads the OBJ file at `path` without a scene.
///
/// # Errors
/// [`Error::Scene`]: that the file can't be read, or the first errors in it, or that it has no faces.
pub fn load_mesh(path: &Path) -> Result<MeshDesc> {
    let diagnostic = |message: String, location, source_line| Diagnostic {
        severity: Severity::Error,
        message,
        location,
        source_line,
        help: None,
    };
    let failed = |reason: &str| {
        let message = format!("cannot read the mesh {}: {reason}", path.display());
        Error::Scene(vec![diagnostic(message, None, None)])
    };
    match obj::load(path) {
        Ok(loaded) if loaded.mesh.triangles.is_empty() => Err(failed("it has no faces with an area")),
        Ok(loaded) => Ok(loaded.mesh),
        Err(obj::Failure::Unreadable(reason)) => Err(failed(&reason)),
        Err(obj::Failure::Faults { first, .. }) => {
            let fault = |fault: obj::Fault| {
                let location = Location { file: path.into(), line: fault.line, column: fault.column };
                diagnostic(fault.message, Some(location), Some(fault.excerpt))
            };
            Err(Error::Scene(first.into_iter().map(fault).collect()))
        }
    }
}

fn unreadable(path: &Path, error: &io::Error) -> Diagnostic {
    let message = format!("cannot read the scene {}: {error}", path.display());
    Diagnostic { severity: Severity::Error, message, location: None, source_line: None, help: None }
}

fn read_text(text: &str, file: &Path) -> Result<Scene> {
    let source = Source::new(file, text);
    let root = yaml::parse(&source).map_err(|diagnostic| Error::Scene(vec![*diagnostic]))?;
    let mut report = Report::default();
    let (mut meshes, mut pictures) = (Meshes::beside(file), Pictures::beside(file));
    let mut context =
        Context { source: &source, meshes: &mut meshes, pictures: &mut pictures, report: &mut report };
    let desc = read::read(&root, file, &mut context);
    let text_digest = [Digest::of(text.as_bytes())];
    let digest = Digest::join(&[&text_digest, meshes.digests(), pictures.digests()].concat());
    let renderable = report.is_renderable();
    let diagnostics = report.into_diagnostics(&source);
    match desc {
        Some(desc) if renderable => {
            let files: BTreeSet<&PathBuf> = meshes.files().iter().chain(pictures.files()).collect();
            let files = files.into_iter().cloned().collect();
            Ok(Scene { desc, warnings: diagnostics, digest, files })
        }
        _ => Err(Error::Scene(diagnostics)),
    }
}
