//! What `tobj` may see of a file: the statements about vertices and faces, each checked.
//!
//! On its own, `tobj` reports errors without a line, takes NaN and infinity, loses the first vertex behind a
//! byte-order mark, makes triangles of polylines, fails on trailing comments, continued lines and bytes that are
//! not UTF-8, wraps indices that are out of range, and lends a face without normals those of the face before. So
//! everything is checked here, on the way to it, and it sees only statements that it reads rightly.

use super::lines::{Line, Lines};
use super::statement::{self, FaceForm, NORMAL, POSITION, TEXCOORD, Words};
use std::io::{self, BufRead, Read};

/// Most faults that are kept; more are counted.
const MAX_FAULTS: usize = 20;
/// Faces after which `tobj` is told to finish a group: it holds over 100 bytes for each face of the open one.
const GROUP: usize = 1 << 20;
/// Bytes of statements that are prepared at a time.
const BATCH: usize = 1 << 16;

/// Something wrong in a mesh file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    /// What, in one sentence.
    pub(crate) message: String,
    /// Line, from 1.
    pub(crate) line: usize,
    /// Column, from 1.
    pub(crate) column: usize,
    /// The line.
    pub(crate) excerpt: String,
}

/// What was seen of a file.
#[derive(Default)]
pub(super) struct Survey {
    /// The form of each face that `tobj` saw.
    pub(super) faces: Vec<FaceForm>,
    /// The first faults.
    pub(super) faults: Vec<Fault>,
    /// How many more faults there were.
    pub(super) more_faults: usize,
    /// How many `v`, `vt` and `vn` there were.
    pub(super) counts: [usize; 3],
    /// The highest index into each that a face gave.
    pub(super) highest: [usize; 3],
}

impl Survey {
    /// Keeps a fault at byte `offset` of `line`.
    pub(super) fn fault(&mut self, line: &Line, offset: usize, message: String) {
        if self.faults.len() == MAX_FAULTS {
            self.more_faults += 1;
            return;
        }
        let (line, column, excerpt) = line.place(offset);
        self.faults.push(Fault { message, line, column, excerpt });
    }

    /// Whether some face names a vertex, texture coordinate or normal that has not come yet.
    pub(super) fn looks_ahead(&self) -> bool {
        self.highest.iter().zip(&self.counts).any(|(highest, count)| highest > count)
    }
}

/// The filter between a file and `tobj`.
pub(super) struct Cleaner<R> {
    lines: Lines<R>,
    /// Prepared statements, and how much of them was consumed.
    batch: Vec<u8>,
    consumed: usize,
    faces_in_group: usize,
    /// Why reading failed. `tobj` keeps to itself what it is told.
    failure: Option<io::Error>,
    /// Counts of a finished survey. Faces may name what comes later, so only with these the first pass's doubts
    /// about indices that are too high become faults.
    limits: Option<[usize; 3]>,
    /// What was seen so far.
    pub(super) survey: Survey,
}

impl<R: BufRead> Cleaner<R> {
    /// Cleans what `reader` gives; `limits` are the counts of an earlier survey.
    pub(super) fn new(reader: R, limits: Option<[usize; 3]>) -> Cleaner<R> {
        let lines = Lines::new(reader);
        Cleaner {
            lines,
            batch: Vec::new(),
            consumed: 0,
            faces_in_group: 0,
            failure: None,
            limits,
            survey: Survey::default(),
        }
    }

    /// Surveys what is left of the file.
    pub(super) fn finish(mut self) -> io::Result<Survey> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        while self.read_statement()? {
            self.batch.clear();
        }
        Ok(self.survey)
    }

    /// Checks one line and appends it to the batch if it is about vertices or faces; false at the end of the file.
    fn read_statement(&mut self) -> io::Result<bool> {
        let Some(line) = self.lines.next()? else { return Ok(false) };
        let mut words = Words::of(line.statement());
        let survey = &mut self.survey;
        let length = self.batch.len();
        let accepted = match words.next() {
            Some((at, b"v")) => statement::numbers(at, words, &POSITION, survey, &mut self.batch),
            Some((at, b"vt")) => statement::numbers(at, words, &TEXCOORD, survey, &mut self.batch),
            Some((at, b"vn")) => statement::numbers(at, words, &NORMAL, survey, &mut self.batch),
            Some((at, b"f")) => {
                self.faces_in_group += 1;
                statement::face(at, words, self.limits, survey, &mut self.batch)
            }
            _ => return Ok(true),
        };
        match accepted {
            Ok(()) => self.batch.push(b'\n'),
            Err((at, message)) => {
                survey.fault(line, at, message);
                self.batch.truncate(length);
            }
        }
        if self.faces_in_group >= GROUP && !self.survey.looks_ahead() {
            self.faces_in_group = 0;
            self.batch.extend_from_slice(b"g\n");
        }
        Ok(true)
    }
}

impl<R: BufRead> BufRead for Cleaner<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.consumed >= self.batch.len() {
            self.consumed = 0;
            self.batch.clear();
            while self.batch.len() < BATCH {
                match self.read_statement() {
                    Ok(true) => {}
                    Ok(false) => break,
                    Err(failure) => {
                        let kind = failure.kind();
                        self.failure = Some(failure);
                        return Err(kind.into());
                    }
                }
            }
        }
        Ok(self.batch.get(self.consumed..).unwrap_or_default())
    }

    fn consume(&mut self, amount: usize) {
        self.consumed += amount;
    }
}

impl<R: BufRead> Read for Cleaner<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let length = self.fill_buf()?.read(buffer)?;
        self.consume(length);
        Ok(length)
    }
}
