//! The statements of an OBJ file that matter: `v`, `vt`, `vn` and `f`, checked word by word.

use super::cleaner::Survey;
use crate::scene::diagnostic::quote;

/// Nothing, or the byte offset in the line of what is wrong, and what.
pub(super) type Checked = Result<(), (usize, String)>;

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
    statement: &'l [u8],
    at: usize,
}

impl<'l> Words<'l> {
    /// The words of `statement`.
    pub(super) fn of(statement: &'l [u8]) -> Words<'l> {
        Words { statement, at: 0 }
    }
}

impl<'l> Iterator for Words<'l> {
    type Item = (usize, &'l [u8]);

    fn next(&mut self) -> Option<(usize, &'l [u8])> {
        let rest = self.statement.get(self.at..)?;
        let start = self.at + rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let rest = self.statement.get(start..)?;
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.at = start + length;
        Some((start, rest.get(..length)?))
    }
}

/// A statement that holds numbers.
pub(super) struct Numbers {
    keyword: &'static str,
    /// Index into [`Survey::counts`].
    kind: usize,
    /// What it is called in messages.
    name: &'static str,
    /// How many numbers it needs.
    least: usize,
    /// How many `tobj` reads. What follows (colours, a third texture coordinate) does not matter.
    used: usize,
    /// The largest magnitude.
    limit: f64,
}

/// `v x y z [w]` or `v x y z r g b`.
pub(super) const POSITION: Numbers =
    Numbers { keyword: "v", kind: 0, name: "a vertex", least: 3, used: 3, limit: f64::MAX };
/// `vt u [v [w]]`.
pub(super) const TEXCOORD: Numbers = Numbers {
    keyword: "vt",
    kind: 1,
    name: "a texture coordinate",
    least: 1,
    used: 2,
    limit: f32::MAX as f64,
};
/// `vn x y z`.
pub(super) const NORMAL: Numbers =
    Numbers { keyword: "vn", kind: 2, name: "a normal", least: 3, used: 3, limit: f64::MAX };

/// Checks a statement of numbers, which starts at `at`, and appends to `batch` what `tobj` shall read.
pub(super) fn numbers(
    at: usize,
    words: Words<'_>,
    rule: &Numbers,
    survey: &mut Survey,
    batch: &mut Vec<u8>,
) -> Checked {
    survey.counts[rule.kind] += 1;
    let count = words.count();
    if count < rule.least {
        let s = if rule.least == 1 { "" } else { "s" };
        return Err((at, format!("{} needs {} number{s}, found {count}", rule.name, rule.least)));
    }
    batch.extend_from_slice(rule.keyword.as_bytes());
    let weighted = rule.kind == POSITION.kind && count == 4;
    let mut values = [0.0; 4];
    for ((at, word), value) in words.take(rule.used + usize::from(weighted)).zip(&mut values) {
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse::<f64>().ok());
        let Some(number) = number.filter(|x| x.abs() <= rule.limit) else {
            return Err((at, format!("{} is made of finite numbers, found {}", rule.name, shown(word))));
        };
        *value = number;
        batch.push(b' ');
        batch.extend_from_slice(word);
    }
    // `tobj` divides a vertex by its weight.
    let [position @ .., weight] = values;
    if weighted && !position.iter().all(|x| (x / weight).is_finite()) {
        return Err((at, format!("the vertex divided by its weight {weight} is not finite")));
    }
    for _ in count..rule.used {
        batch.extend_from_slice(b" 0");
    }
    Ok(())
}

/// Checks a face, which starts at `at`, and appends it to `batch`. `limits` are the counts of the whole file, if an
/// earlier pass knows them.
pub(super) fn face(
    at: usize,
    words: Words<'_>,
    limits: Option<[usize; 3]>,
    survey: &mut Survey,
    batch: &mut Vec<u8>,
) -> Checked {
    let mut form = None;
    let mut corners = 0;
    batch.push(b'f');
    for (at, word) in words {
        let corner = corner(word, limits, survey).map_err(|message| (at, message))?;
        if *form.get_or_insert(corner) != corner {
            let message = "a face gives texture coordinates, and normals, for all of its corners or for none";
            return Err((at, message.to_owned()));
        }
        batch.push(b' ');
        batch.extend_from_slice(word);
        corners += 1;
    }
    match form {
        Some(form) if corners >= 3 => survey.faces.push(form),
        _ => return Err((at, format!("a face needs at least 3 corners, found {corners}"))),
    }
    Ok(())
}

/// Checks a corner: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
fn corner(word: &[u8], limits: Option<[usize; 3]>, survey: &mut Survey) -> Result<FaceForm, String> {
    let mut given = [false; 3];
    for (kind, part) in word.split(|&byte| byte == b'/').enumerate() {
        if part.is_empty() && kind > 0 {
            continue;
        }
        let index = std::str::from_utf8(part).ok().and_then(|part| part.parse::<i64>().ok());
        let (Some(index), Some(given)) = (index, given.get_mut(kind)) else {
            return Err(format!(
                "a corner is v, v/vt, v//vn or v/vt/vn with whole numbers, found {}",
                shown(word)
            ));
        };
        *given = true;
        check_index(kind, index, limits, survey)?;
    }
    Ok(FaceForm { texcoords: given[1], normals: given[2] })
}

/// Checks an index into the vertices, texture coordinates or normals (`kind` 0, 1, 2).
fn check_index(
    kind: usize,
    index: i64,
    limits: Option<[usize; 3]>,
    survey: &mut Survey,
) -> Result<(), String> {
    const NAMES: [[&str; 2]; 3] =
        [["vertex", "vertices"], ["texture coordinate", "texture coordinates"], ["normal", "normals"]];
    let [one, many] = NAMES[kind];
    let count = survey.counts[kind];
    // `tobj` computes with three times an index.
    let magnitude = usize::try_from(index.unsigned_abs()).unwrap_or(usize::MAX);
    if index == 0 {
        Err(format!("{one} 0 does not exist: indices start at 1"))
    } else if index < 0 && magnitude > count {
        Err(format!("{one} {index} does not exist: the number of {many} before this line is {count}"))
    } else if index > 0 && limits.is_some_and(|limits| magnitude > limits[kind]) {
        let count = limits.map_or(0, |limits| limits[kind]);
        Err(format!("{one} {index} does not exist: the number of {many} in the file is {count}"))
    } else {
        if index > 0 {
            survey.highest[kind] = survey.highest[kind].max(magnitude);
        }
        Ok(())
    }
}

fn shown(word: &[u8]) -> String {
    quote(&String::from_utf8_lossy(word))
}
