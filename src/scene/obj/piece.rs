//! What one piece of a file says, read without knowing the others.

use super::lines::{Line, Lines};
use super::statement::{self, FaceForm, Mistake, NORMAL, POSITION, TEXCOORD, Words};

/// Added to indices that count back from a face: only the pieces before tell what they count back from.
const RELATIVE: u32 = 1 << 31;
/// No index is larger: the largest file has fewer statements.
const MAX_INDEX: i64 = 1 << 30;

/// Faces in a row with the same form and number of corners.
pub(super) struct Run {
    /// How many.
    pub(super) faces: usize,
    /// Corners of each.
    pub(super) arity: u32,
    /// Their form.
    pub(super) form: FaceForm,
}

/// The vertices and faces of a piece.
#[derive(Default)]
pub(super) struct Piece {
    /// Positions.
    pub(super) positions: Vec<[f64; 3]>,
    /// Texture coordinates.
    pub(super) texcoords: Vec<[f32; 2]>,
    /// Normals; [0, 0, 0] has no direction.
    pub(super) normals: Vec<[f32; 3]>,
    /// The indices of the corners into each of the three, coded (see [`Piece::resolve`]), where a face gives them.
    pub(super) corners: [Vec<u32>; 3],
    /// The faces.
    pub(super) runs: Vec<Run>,
    /// Where materials begin: the run, and the name behind `usemtl`.
    pub(super) materials: Vec<(usize, String)>,
    /// The names behind `mtllib`.
    pub(super) libraries: Vec<String>,
}

impl Piece {
    /// Reads the lines in `bytes`. If one of them is wrong, only a survey can tell what about it.
    pub(super) fn parse(bytes: &[u8]) -> Option<Piece> {
        let mut piece = Piece::default();
        let mut lines = Lines::of(bytes);
        while let Some(line) = lines.next() {
            piece.add(line).ok()?;
        }
        piece.shrink();
        Some(piece)
    }

    fn add(&mut self, line: Line<'_>) -> Result<(), Mistake> {
        let mut words = Words::of(line);
        match words.next() {
            Some((at, b"v")) => self.positions.push(statement::numbers(at, words, &POSITION)?),
            Some((at, b"vt")) => {
                let [u, v, _] = statement::numbers(at, words, &TEXCOORD)?;
                self.texcoords.push([u as f32, v as f32]);
            }
            Some((at, b"vn")) => {
                let normal = statement::numbers(at, words, &NORMAL)?;
                self.normals.push(single_precision(normal));
            }
            Some((at, b"f")) => {
                let counts = [self.positions.len(), self.texcoords.len(), self.normals.len()];
                let code = |kind: usize, index| {
                    // What is wrong with the index, a survey tells.
                    code(index, counts[kind]).ok_or_else(String::new)
                };
                let (arity, form) = statement::face(at, words, code, &mut self.corners)?;
                let begins = self.materials.last().is_some_and(|&(run, _)| run == self.runs.len());
                match self.runs.last_mut() {
                    Some(run) if !begins && (run.arity, run.form) == (arity, form) => run.faces += 1,
                    _ => self.runs.push(Run { faces: 1, arity, form }),
                }
            }
            Some((_, b"usemtl")) => self.materials.push((self.runs.len(), rest_of(words))),
            Some((_, b"mtllib")) => self.libraries.push(rest_of(words)),
            _ => {}
        }
        Ok(())
    }

    /// Gives back the room for what did not come.
    fn shrink(&mut self) {
        self.positions.shrink_to_fit();
        self.texcoords.shrink_to_fit();
        self.normals.shrink_to_fit();
        self.corners.iter_mut().for_each(Vec::shrink_to_fit);
        self.runs.shrink_to_fit();
    }

    /// How many triangles the faces become if none is left out.
    pub(super) fn triangles(&self) -> usize {
        self.runs.iter().map(|run| run.faces * (run.arity as usize - 2)).sum()
    }

    /// Turns the codes of the corners into indices into the whole file, of which `before` vertices, texture
    /// coordinates and normals come before this piece, and `total` in all. `None` if one does not exist.
    pub(super) fn resolve(&mut self, before: [usize; 3], total: [usize; 3]) -> Option<()> {
        for ((codes, before), total) in self.corners.iter_mut().zip(before).zip(total) {
            for code in codes {
                let index = decode(*code, before);
                if index >= total as u64 {
                    return None;
                }
                *code = index as u32;
            }
        }
        Some(())
    }
}

/// The words that are left, as one text: names may hold blanks.
fn rest_of(words: Words<'_>) -> String {
    let words: Vec<&[u8]> = words.map(|(_, word)| word).collect();
    String::from_utf8_lossy(&words.join(&b' ')).into_owned()
}

/// The code of an index, of which `count` came before in the piece.
fn code(index: i64, count: usize) -> Option<u32> {
    if index == 0 || index.unsigned_abs() > MAX_INDEX as u64 {
        None
    } else if index > 0 {
        Some((index - 1) as u32)
    } else {
        // Counts are below MAX_INDEX, so that this lies between 0 and RELATIVE.
        Some(RELATIVE + (count as i64 + index + MAX_INDEX) as u32)
    }
}

/// The index that a code means, from 0; huge if it lies before the file.
fn decode(code: u32, before: usize) -> u64 {
    if code < RELATIVE {
        u64::from(code)
    } else {
        (before as u64 + u64::from(code - RELATIVE)).wrapping_sub(MAX_INDEX as u64)
    }
}

/// A normal in f32, rescaled if it would overflow or vanish there.
fn single_precision(normal: [f64; 3]) -> [f32; 3] {
    let largest = normal.iter().fold(0f64, |largest, x| largest.max(x.abs()));
    if largest == 0.0 || (1e-30..1e30).contains(&largest) {
        normal.map(|x| x as f32)
    } else {
        normal.map(|x| (x / largest) as f32)
    }
}
