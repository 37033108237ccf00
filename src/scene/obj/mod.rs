//! OBJ files, read in parallel.
//!
//! A file is cut at line ends into pieces (`cuts`). Each piece is read on its own (`piece`), into numbers and corners
//! whose indices may still wait for the counts of the pieces before; then the pieces become one mesh (`assemble`). At
//! the first mistake all that is given up, and the file is read again from its start, line by line, to tell what is
//! wrong and where (`survey`). Both ways read statements by the same code (`lines`, `statement`, `number`).
//!
//! The mesh is the same for any number of threads. Its parts are there at most twice while it is made; of the file
//! there is one piece a thread.

mod assemble;
mod cuts;
mod lines;
mod number;
mod piece;
mod polygon;
mod statement;
mod survey;

use super::desc::MeshDesc;
use super::digest::Digest;
use cuts::Cuts;
use piece::Piece;
use rayon::prelude::*;
use std::fs::File;
use std::io;
use std::path::Path;
pub(crate) use survey::Fault;
use survey::Survey;

/// Largest mesh file in bytes. Its counts fit 30 bits, since a vertex takes at least 8 bytes and a texture coordinate
/// at least 5.
const MAX_BYTES: u64 = 4 << 30;

/// A mesh as read.
#[derive(Debug)]
pub(crate) struct Loaded {
    /// The mesh, which may be empty.
    pub(crate) mesh: MeshDesc,
    /// Of the file.
    pub(crate) digest: Digest,
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
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    if length > MAX_BYTES {
        return Err(Failure::Unreadable(format!("it is larger than {} GiB", MAX_BYTES >> 30)));
    }
    let cuts = Cuts::find(&file, length)?;
    let parse = |buffer: &mut Vec<u8>, piece| {
        let bytes = cuts.read(piece, buffer).ok()?;
        Some((Digest::of(bytes), Piece::parse(bytes)?))
    };
    let pieces = (0..cuts.pieces()).into_par_iter().map_init(Vec::new, parse);
    let pieces = pieces.collect::<Option<(Vec<Digest>, Vec<Piece>)>>();
    let loaded = pieces.and_then(|(digests, pieces)| assemble::assemble(pieces, Digest::join(&digests)));
    loaded.ok_or_else(|| explain(&cuts))
}

/// Why a file was not read.
fn explain(cuts: &Cuts<'_>) -> Failure {
    match Survey::of(cuts) {
        Err(error) => error.into(),
        Ok(survey) if survey.faults.is_empty() => {
            Failure::Unreadable("it changed while it was read".to_owned())
        }
        Ok(survey) => Failure::Faults { first: survey.faults, more: survey.more_faults },
    }
}
