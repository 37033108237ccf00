//! The statements of an OBJ file that matter: `v`, `vt`, `vn` and `f`, checked word by word.

use super::lines::Line;
use super::number;
use crate::scene::diagnostic::quote;

/// The byte offset in the statement of what is wrong, and what.
pub(super) type Mistake = (usize, String);

/// Which of the optional indices a face gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct FaceForm {
    /// Indices of texture coordinates.
    pub(super) texcoords: bool,
    /// Indices of normals.
    pub(super) normals: bool,
}

/// The words of a statement with their byte offsets.
#[derive(Clone, Copy)]
pub(super) struct Words<'l> {
    line: Line<'l>,
    at: usize,
}

impl<'l> Words<'l> {
    /// The words of `line`.
    pub(super) fn of(line: Line<'l>) -> Words<'l> {
        Words { line, at: 0 }
    }

    /// The bytes from here on, also those behind the line.
    #[inline]
    fn rest(&self) -> &'l [u8] {
        self.line.bytes.get(self.at..).unwrap_or_default()
    }

    /// The byte here.
    #[inline]
    fn peek(&self) -> Option<u8> {
        if self.at < self.line.length { self.line.bytes.get(self.at).copied() } else { None }
    }

    /// Whether a word ends here.
    #[inline]
    fn is_between(&self) -> bool {
        self.peek().is_none_or(is_blank)
    }

    /// Moves to the next word; false if there is none.
    #[inline]
    fn go_on(&mut self) -> bool {
        while let Some(byte) = self.peek() {
            if !is_blank(byte) {
                return true;
            }
            self.at += 1;
        }
        false
    }

    /// The number that the next word is; `None` if there is no word or it is something else.
    #[inline(always)]
    fn number(&mut self) -> Option<f64> {
        if !self.go_on() {
            return None;
        }
        let start = self.at;
        if let Some((number, length)) = number::short(self.rest()) {
            self.at += length;
            if self.is_between() {
                return Some(number);
            }
            self.at = start;
        }
        self.long_number()
    }

    /// A number with many digits, a large exponent or a plus, or no number.
    #[cold]
    fn long_number(&mut self) -> Option<f64> {
        number::of_word(self.next()?.1)
    }

    /// The index that stands here, up to the next slash or blank.
    #[inline(always)]
    fn index(&mut self) -> Option<i64> {
        let start = self.at;
        if let Some((index, length)) = number::integer(self.rest()) {
            self.at += length;
            if self.is_between() || self.peek() == Some(b'/') {
                return Some(index);
            }
            self.at = start;
        }
        self.unusual_index()
    }

    /// An index with a sign or leading zeros, or no index.
    #[cold]
    fn unusual_index(&mut self) -> Option<i64> {
        let start = self.at;
        while !self.is_between() && self.peek() != Some(b'/') {
            self.at += 1;
        }
        std::str::from_utf8(self.line.bytes.get(start..self.at)?).ok()?.parse().ok()
    }
}

/// As `u8::is_ascii_whitespace`, quick about the bytes of words.
#[inline]
fn is_blank(byte: u8) -> bool {
    byte <= b' ' && byte.is_ascii_whitespace()
}

impl<'l> Iterator for Words<'l> {
    type Item = (usize, &'l [u8]);

    #[inline]
    fn next(&mut self) -> Option<(usize, &'l [u8])> {
        if !self.go_on() {
            return None;
        }
        let start = self.at;
        while !self.is_between() {
            self.at += 1;
        }
        Some((start, self.line.bytes.get(start..self.at)?))
    }
}

/// A statement that holds numbers.
pub(super) struct Numbers {
    /// Which of `v`, `vt`, `vn`, as 0, 1, 2.
    pub(super) kind: usize,
    /// What it is called in messages.
    name: &'static str,
    /// How many numbers it needs.
    least: usize,
    /// How many are used. What follows (colours, a third texture coordinate) does not matter.
    used: usize,
    /// Whether a fourth number, if it is the last, is a weight.
    weighted: bool,
    /// The largest magnitude.
    limit: f64,
}

/// `v x y z [w]` or `v x y z r g b`.
pub(super) const POSITION: Numbers =
    Numbers { kind: 0, name: "a vertex", least: 3, used: 3, weighted: true, limit: f64::MAX };
/// `vt u [v [w]]`.
pub(super) const TEXCOORD: Numbers = Numbers {
    kind: 1,
    name: "a texture coordinate",
    least: 1,
    used: 2,
    weighted: false,
    limit: f32::MAX as f64,
};
/// `vn x y z`.
pub(super) const NORMAL: Numbers =
    Numbers { kind: 2, name: "a normal", least: 3, used: 3, weighted: false, limit: f64::MAX };

/// Reads a statement of numbers, which starts at `at`; what is not given is 0. A vertex is divided by its weight.
pub(super) fn numbers(at: usize, words: Words<'_>, rule: &Numbers) -> Result<[f64; 3], Mistake> {
    let mut values = [0.0; 3];
    let mut left = words;
    for (found, value) in values.iter_mut().enumerate().take(rule.used) {
        if found >= rule.least && !left.go_on() {
            break;
        }
        match left.number() {
            Some(number) if number.abs() <= rule.limit => *value = number,
            _ => return Err(mistake(at, words, rule)),
        }
    }
    if rule.weighted && left.go_on() { divide(at, words, rule, values) } else { Ok(values) }
}

/// Divides a vertex by the fourth number if there are just four.
#[cold]
fn divide(at: usize, words: Words<'_>, rule: &Numbers, values: [f64; 3]) -> Result<[f64; 3], Mistake> {
    if words.count() != 4 {
        return Ok(values);
    }
    let Some(weight) = words.last().and_then(|(_, word)| finite(word, rule)) else {
        return Err(mistake(at, words, rule));
    };
    let position = values.map(|x| x / weight);
    if position.iter().all(|x| x.is_finite()) {
        Ok(position)
    } else {
        Err((at, format!("the vertex divided by its weight {weight} is not finite")))
    }
}

fn finite(word: &[u8], rule: &Numbers) -> Option<f64> {
    number::of_word(word).filter(|x| x.abs() <= rule.limit)
}

/// What is wrong with a statement of numbers.
#[cold]
fn mistake(at: usize, mut words: Words<'_>, rule: &Numbers) -> Mistake {
    let count = words.count();
    if count < rule.least {
        let s = if rule.least == 1 { "" } else { "s" };
        return (at, format!("{} needs {} number{s}, found {count}", rule.name, rule.least));
    }
    let (at, word) = words.find(|(_, word)| finite(word, rule).is_none()).unwrap_or((at, b""));
    (at, format!("{} is made of finite numbers, found {}", rule.name, shown(word)))
}

/// Reads a face, which starts at `at`: appends the indices of its corners to `corners` and returns their number and
/// the form. `resolve` makes what is appended of an index into the vertices, texture coordinates or normals (0, 1, 2).
pub(super) fn face(
    at: usize,
    mut words: Words<'_>,
    mut resolve: impl FnMut(usize, i64) -> Result<u32, String>,
    corners: &mut [Vec<u32>; 3],
) -> Result<(u32, FaceForm), Mistake> {
    let mut form = None;
    let mut count = 0;
    while words.go_on() {
        let at = words.at;
        let corner = corner(&mut words, &mut resolve, corners).map_err(|message| (at, message))?;
        if *form.get_or_insert(corner) != corner {
            let message = "a face gives texture coordinates, and normals, for all of its corners or for none";
            return Err((at, message.to_owned()));
        }
        count += 1;
    }
    match form {
        Some(form) if count >= 3 => Ok((count, form)),
        _ => Err((at, format!("a face needs at least 3 corners, found {count}"))),
    }
}

/// Reads a corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
#[inline]
fn corner(
    words: &mut Words<'_>,
    resolve: &mut impl FnMut(usize, i64) -> Result<u32, String>,
    corners: &mut [Vec<u32>; 3],
) -> Result<FaceForm, String> {
    let mut here = *words;
    let mut given = [false; 3];
    for kind in 0.. {
        if kind == 0 || !(words.is_between() || words.peek() == Some(b'/')) {
            let (Some(index), Some(given), Some(indices)) =
                (words.index(), given.get_mut(kind), corners.get_mut(kind))
            else {
                let word = here.next().map_or(&[][..], |(_, word)| word);
                let form = "a corner is v, v/vt, v//vn or v/vt/vn with whole numbers, found";
                return Err(format!("{form} {}", shown(word)));
            };
            *given = true;
            indices.push(resolve(kind, index)?);
        }
        if words.peek() != Some(b'/') {
            break;
        }
        words.at += 1;
    }
    Ok(FaceForm { texcoords: given[1], normals: given[2] })
}

fn shown(word: &[u8]) -> String {
    quote(&String::from_utf8_lossy(word))
}
