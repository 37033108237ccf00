//! What is wrong with a file, and where. Only a file that can't be used is surveyed.

use super::cuts::Cuts;
use super::lines::{self, Line, Lines};
use super::statement::{self, Mistake, NORMAL, POSITION, TEXCOORD, Words};
use std::io;

/// Most faults that are kept; more are counted.
const MAX_FAULTS: usize = 20;

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
    /// The first faults.
    pub(super) faults: Vec<Fault>,
    /// How many more faults there were.
    pub(super) more_faults: usize,
    /// How many `v`, `vt` and `vn` there were.
    counts: [usize; 3],
    /// The highest index into each that a face gave.
    highest: [usize; 3],
}

impl Survey {
    /// Surveys a file. Faces may name what comes later, so only a second pass, which knows the counts of the whole
    /// file, can tell which indices are too high.
    pub(super) fn of(cuts: &Cuts<'_>) -> io::Result<Survey> {
        let first = Survey::pass(cuts, None)?;
        if first.highest.iter().zip(&first.counts).any(|(highest, count)| highest > count) {
            Survey::pass(cuts, Some(first.counts))
        } else {
            Ok(first)
        }
    }

    /// Reads the file; `limits` are the counts of an earlier pass.
    fn pass(cuts: &Cuts<'_>, limits: Option<[usize; 3]>) -> io::Result<Survey> {
        let mut survey = Survey::default();
        let mut lines_before = 0;
        let (mut buffer, mut corners) = Default::default();
        for piece in 0..cuts.pieces() {
            let bytes = cuts.read(piece, &mut buffer)?;
            let mut lines = Lines::of(bytes);
            loop {
                let start = lines.start();
                let Some(line) = lines.next() else { break };
                if let Err((at, message)) = survey.check(line, limits, &mut corners) {
                    survey.add_fault(bytes, start + at, lines_before, message);
                }
            }
            lines_before += lines::count(bytes);
        }
        Ok(survey)
    }

    /// Checks a line. `corners` is room for the indices of a face.
    fn check(
        &mut self,
        line: Line<'_>,
        limits: Option<[usize; 3]>,
        corners: &mut [Vec<u32>; 3],
    ) -> Result<(), Mistake> {
        let mut words = Words::of(line);
        let (at, rule) = match words.next() {
            Some((at, b"v")) => (at, POSITION),
            Some((at, b"vt")) => (at, TEXCOORD),
            Some((at, b"vn")) => (at, NORMAL),
            Some((at, b"f")) => {
                corners.iter_mut().for_each(Vec::clear);
                return statement::face(at, words, |k, i| self.check_index(k, i, limits), corners).map(drop);
            }
            _ => return Ok(()),
        };
        self.counts[rule.kind] += 1;
        statement::numbers(at, words, &rule).map(drop)
    }

    /// Checks an index into the vertices, texture coordinates or normals (`kind` 0, 1, 2). What it returns otherwise
    /// does not matter.
    fn check_index(&mut self, kind: usize, index: i64, limits: Option<[usize; 3]>) -> Result<u32, String> {
        const NAMES: [[&str; 2]; 3] =
            [["vertex", "vertices"], ["texture coordinate", "texture coordinates"], ["normal", "normals"]];
        let [one, many] = NAMES[kind];
        let count = self.counts[kind];
        let magnitude = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
        if index == 0 {
            return Err(format!("{one} 0 does not exist: indices start at 1"));
        }
        if index < 0 && magnitude > count {
            return Err(format!(
                "{one} {index} does not exist: the number of {many} before this line is {count}"
            ));
        }
        if index > 0 {
            if let Some(count) = limits.map(|limits| limits[kind]).filter(|count| magnitude > *count) {
                return Err(format!(
                    "{one} {index} does not exist: the number of {many} in the file is {count}"
                ));
            }
            self.highest[kind] = self.highest[kind].max(magnitude);
        }
        Ok(0)
    }

    /// Keeps a fault at byte `offset` of a piece that has `lines_before` lines before it.
    fn add_fault(&mut self, piece: &[u8], offset: usize, lines_before: usize, message: String) {
        if self.faults.len() == MAX_FAULTS {
            self.more_faults += 1;
            return;
        }
        let (line, column, excerpt) = lines::place(piece, offset);
        self.faults.push(Fault { message, line: lines_before + line + 1, column, excerpt });
    }
}
