//! OBJ files, read by `tobj` behind a filter that checks every statement (see `cleaner`).

mod assemble;
mod cleaner;
mod lines;
mod polygon;
mod statement;

use super::desc::MeshDesc;
use cleaner::Cleaner;
pub(crate) use cleaner::Fault;
use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

/// Largest mesh file in bytes. Its counts fit `u32`: a vertex takes at least 8 bytes, a corner 2.
const MAX_BYTES: u64 = 4 << 30;

/// A mesh as read.
#[derive(Debug, Default)]
pub(crate) struct Loaded {
    /// The mesh, which may be empty.
    pub(crate) mesh: MeshDesc,
    /// Faces that were left out because all their triangles have no area.
    pub(crate) dropped: usize,
    /// Concave faces with so many corners that they were split as if they were convex.
    pub(crate) fanned: usize,
}

/// Why a mesh can't be used.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The file can't be read at all.
    Unreadable(String),
    /// The file holds mistakes.
    Faults {
        /// The first ones, in the order of the file.
        first: Vec<Fault>,
        /// How many more there are.
        more: usize,
    },
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Failure {
        Failure::Unreadable(error.to_string())
    }
}

/// Reads a mesh.
pub(crate) fn load(path: &Path) -> Result<Loaded, Failure> {
    if path.metadata()?.len() > MAX_BYTES {
        return Err(Failure::Unreadable(format!("it is larger than {} GiB", MAX_BYTES >> 30)));
    }
    let open = || File::open(path).map(|file| BufReader::with_capacity(1 << 16, file));
    let mut cleaner = Cleaner::new(open()?, None);
    let options = tobj::LoadOptions::default();
    let outcome = tobj::load_obj_buf(&mut cleaner, &options, |_| Err(tobj::LoadError::MaterialParseError));
    let mut survey = cleaner.finish()?;
    if survey.looks_ahead() {
        survey = Cleaner::new(open()?, Some(survey.counts)).finish()?;
    }
    if !survey.faults.is_empty() {
        return Err(Failure::Faults { first: survey.faults, more: survey.more_faults });
    }
    let (models, _) = outcome.map_err(|error| Failure::Unreadable(error.to_string()))?;
    Ok(assemble::assemble(models, &survey))
}
