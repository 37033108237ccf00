//! Replacing values in the text of a scene, and adding lines.

use super::Written;
use crate::error::{Error, Result};
use crate::scene::yaml::node::{Kind, Node};
use crate::scene::yaml::position::{self, Part, Target};
use std::fmt::Write as _;
use std::ops::Range;

/// One step on the way to a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Step {
    /// The value of a key.
    Key(&'static str),
    /// An item of a list.
    Item(usize),
}

/// A text and what it says.
pub(super) struct Editor<'e> {
    pub(super) text: &'e str,
    pub(super) root: &'e Node<'e>,
}

/// The sky that a scene without `Environment` has, as the first step to another one.
const SKY: [&str; 3] =
    ["SkyColor: [0.2, 0.5, 1]", "HorizonColor: [0.7, 0.8, 0.8]", "GroundColor: [0.1, 0.1, 0.1]"];

impl Editor<'_> {
    /// The text with another value of `key` in a section. Without the key it gets a line behind that of `after`, or before
    /// the first if that is empty.
    pub(super) fn set(&self, section: &[Step], key: &str, value: Written, after: &str) -> Result<String> {
        let Some((path, mapping)) = self.walk(section) else {
            return match section {
                [Step::Key("Environment")] => self.with_sky()?.set(section, key, value, after),
                _ => Err(lost(key)),
            };
        };
        if let Some(text) = self.without_alias(section, key, value) {
            return Ok(text);
        }
        if let Some(text) = self.without_anchor(section, key) {
            return Owned(text).set(section, key, value, after);
        }
        match mapping.position(key) {
            Some(index) => self.replace(&[path, vec![index as u32]].concat(), mapping.at(index), key, value),
            None => self.insert(&path, mapping, key, value, after),
        }
    }

    /// The child indices to a section, and the section.
    fn walk(&self, steps: &[Step]) -> Option<(Vec<u32>, &Node<'_>)> {
        let (mut path, mut node) = (Vec::new(), self.root);
        for step in steps {
            let index = match step {
                Step::Key(key) => node.position(key)?,
                Step::Item(index) => *index,
            };
            path.push(index as u32);
            node = node.at(index)?;
        }
        Some((path, node))
    }

    /// Puts other scalars in the place of those of a value.
    fn replace(&self, path: &[u32], node: Option<&Node<'_>>, key: &str, value: Written) -> Result<String> {
        let kind = node.map(|node| &node.kind);
        let scalars: Vec<(Vec<u32>, String)> = match (value, kind) {
            (Written::Vector(vector), Some(Kind::List(items))) if items.len() == 3 => {
                let new = vector.to_array().into_iter().zip(items).zip(0u32..);
                new.filter(|((new, old), _)| old.number().map(f64::to_bits) != Some(new.to_bits()))
                    .map(|((new, _), index)| ([path, &[index]].concat(), number(new)))
                    .collect()
            }
            (Written::Number(new), _) => vec![(path.to_vec(), number(new))],
            (Written::Word(word), _) => vec![(path.to_vec(), word.to_owned())],
            _ => return Err(lost(key)),
        };
        let target = |path: &[u32]| Target { path: path.to_vec(), part: Part::Scalar };
        let targets: Vec<Target> = scalars.iter().map(|(path, _)| target(path)).collect();
        let mut text = self.text.to_owned();
        // From behind, so that places before stay.
        for (offset, (_, new)) in position::find(self.text, &targets).into_iter().zip(&scalars).rev() {
            let span = offset.and_then(|offset| scalar_at(self.text, offset)).ok_or_else(|| lost(key))?;
            text.replace_range(span, new);
        }
        Ok(text)
    }

    /// Adds a key to a mapping.
    fn insert(
        &self,
        path: &[u32],
        mapping: &Node<'_>,
        key: &str,
        value: Written,
        after: &str,
    ) -> Result<String> {
        let first = self.key_offset(path, mapping, 0).ok_or_else(|| lost(key))?;
        let entry = format!("{key}: {}", flow(value));
        let before = self.text[..first].trim_end();
        let line_start = self.text[..first].rfind('\n').map_or(0, |end| end + 1);
        let indent = &self.text[line_start..first];
        let mut text = self.text.to_owned();
        if before.ends_with('{') {
            text.insert_str(first, &format!("{entry}, "));
            return Ok(text);
        }
        if !indent.trim().is_empty() {
            return Err(lost(key));
        }
        let behind = mapping.position(after).and_then(|index| {
            let target = Target { path: [path, &[index as u32]].concat(), part: Part::Scalar };
            let offset = position::find(self.text, &[target]).pop()??;
            scalar_at(self.text, offset).map(|span| span.end)
        });
        let newline = if self.text.contains("\r\n") { "\r\n" } else { "\n" };
        match behind {
            Some(end) => {
                let rest = &self.text[end..];
                let line = rest.find(['\r', '\n']).unwrap_or(rest.len());
                text.insert_str(end + line, &format!("{newline}{indent}{entry}"));
            }
            None => text.insert_str(first, &format!("{entry}{newline}{indent}")),
        }
        Ok(text)
    }

    /// Where the key of an entry stands.
    fn key_offset(&self, path: &[u32], mapping: &Node<'_>, index: usize) -> Option<usize> {
        let Kind::Map(entries) = &mapping.kind else { return None };
        entries.get(index)?.0.offset().or_else(|| {
            let target = Target { path: [path, &[index as u32]].concat(), part: Part::Key };
            position::find(self.text, &[target]).pop()?
        })
    }

    /// The text with an `Environment` that says what holds without one.
    fn with_sky(&self) -> Result<Owned> {
        let first = self.root.position("Objects").unwrap_or(0);
        let offset = self.key_offset(&[], self.root, first).ok_or_else(|| lost("Environment"))?;
        let mut text = self.text.to_owned();
        if self.text[..offset].trim_end().ends_with(['{', ',']) {
            text.insert_str(offset, &format!("Environment: {{{}}}, ", SKY.join(", ")));
        } else {
            let newline = if self.text.contains("\r\n") { "\r\n" } else { "\n" };
            let lines: String = SKY.iter().map(|line| format!("  {line}{newline}")).collect();
            text.insert_str(
                above_comments(self.text, offset),
                &format!("Environment:{newline}{lines}{newline}"),
            );
        }
        Ok(Owned(text))
    }

    /// The text where the alias that stands for the mapping, or for the value, is replaced by what it says then; `None` without
    /// one.
    fn without_alias(&self, section: &[Step], key: &str, value: Written) -> Option<String> {
        let (start, node) =
            self.written_value(section, None).filter(|(start, _)| self.begins(*start, '*')).or_else(
                || self.written_value(section, Some(key)).filter(|(start, _)| self.begins(*start, '*')),
            )?;
        let is_mapping = matches!(node.kind, Kind::Map(_));
        let new = if is_mapping { mapping_with(node, key, value)? } else { flow(value) };
        let mut text = self.text.to_owned();
        text.replace_range(scalar_at(self.text, start)?, &new);
        Some(text)
    }

    /// The text where the anchor of the mapping, or of the value, has gone to the first of its aliases, which says what stands
    /// here; `None` without an anchor, or without an alias.
    fn without_anchor(&self, section: &[Step], key: &str) -> Option<String> {
        let places = [self.written_value(section, None), self.written_value(section, Some(key))];
        let (start, node) = places.into_iter().flatten().find(|(start, _)| self.begins(*start, '&'))?;
        let anchor = scalar_at(self.text, start)?;
        let name = &self.text[anchor.start + 1..anchor.end];
        let alias = alias_after(self.text, name, anchor.end)?;
        let mut text = self.text.to_owned();
        text.replace_range(alias, &format!("&{name} {}", plain(node)?));
        let blank = self.text[anchor.end..].starts_with(' ');
        text.replace_range(anchor.start..anchor.end + usize::from(blank), "");
        Some(text)
    }

    /// The value of a section, or of a key of it, and where it begins, if on the line of its key.
    fn written_value(&self, section: &[Step], key: Option<&str>) -> Option<(usize, &Node<'_>)> {
        let (section, last) = match (key, section.split_last()?) {
            (Some(key), _) => (section, key),
            (None, (Step::Key(last), above)) => (above, *last),
            _ => return None,
        };
        let (path, mapping) = self.walk(section)?;
        let index = mapping.position(last)?;
        let start = self.value_start(self.key_offset(&path, mapping, index)?)?;
        Some((start, mapping.at(index)?))
    }

    fn begins(&self, offset: usize, with: char) -> bool {
        self.text[offset..].starts_with(with)
    }

    /// Where the value of the key at `offset` begins, if on the same line.
    fn value_start(&self, offset: usize) -> Option<usize> {
        let end = scalar_at(self.text, offset)?.end;
        let rest = self.text[end..].trim_start_matches(':');
        let value = rest.trim_start_matches([' ', '\t']);
        Some(self.text.len() - value.len())
    }
}

/// A text that is to be read again.
struct Owned(String);

impl Owned {
    fn set(self, section: &[Step], key: &str, value: Written, after: &str) -> Result<String> {
        let source = crate::scene::source::Source::new(std::path::Path::new(""), &self.0);
        let root =
            crate::scene::yaml::parse(&source).map_err(|diagnostic| Error::Scene(vec![*diagnostic]))?;
        Editor { text: &self.0, root: &root }.set(section, key, value, after)
    }
}

/// The bytes of the scalar that begins at `offset`: a quoted one with its quotes, a plain one without blanks or colon.
fn scalar_at(text: &str, offset: usize) -> Option<Range<usize>> {
    let rest = text.get(offset..)?;
    let length = match rest.chars().next()? {
        quote @ ('"' | '\'') => rest[1..].find(quote)? + 2,
        _ => rest.find([' ', '\t', '\r', '\n', ',', ']', '}', ':']).unwrap_or(rest.len()),
    };
    (length > 0).then(|| offset..offset + length)
}

/// The first alias of a name behind `offset`, but for those in comments.
fn alias_after(text: &str, name: &str, offset: usize) -> Option<Range<usize>> {
    let alias = format!("*{name}");
    let found = text[offset..].match_indices(&alias).map(|(at, _)| offset + at..offset + at + alias.len());
    let is_alias = |span: &Range<usize>| {
        let line = text[..span.start].rfind('\n').map_or(0, |end| end + 1);
        let is_whole = !text[span.end..].starts_with(|c: char| !c.is_whitespace() && !",]}".contains(c));
        is_whole && !text[line..span.start].contains('#')
    };
    found.into_iter().find(is_alias)
}

/// The start of the line at `offset`, or of the comments right above it.
fn above_comments(text: &str, offset: usize) -> usize {
    let mut start = text[..offset].rfind('\n').map_or(0, |end| end + 1);
    while start > 0 {
        let above = text[..start - 1].rfind('\n').map_or(0, |end| end + 1);
        if !text[above..start].starts_with('#') {
            break;
        }
        start = above;
    }
    start
}

/// A mapping in braces with another value of a key.
fn mapping_with(node: &Node<'_>, key: &str, value: Written) -> Option<String> {
    let Kind::Map(entries) = &node.kind else { return None };
    let others = entries.iter().filter(|(name, _)| name.text() != Some(key));
    let mut written = others.map(|(name, node)| Some(format!("{}: {}", name.text()?, plain(node)?)));
    let mut all = written.by_ref().collect::<Option<Vec<String>>>()?;
    all.push(format!("{key}: {}", flow(value)));
    Some(format!("{{{}}}", all.join(", ")))
}

/// A value in one line, as YAML.
fn plain(node: &Node<'_>) -> Option<String> {
    Some(match &node.kind {
        Kind::Null => "~".to_owned(),
        Kind::Bool(flag) => flag.to_string(),
        Kind::Number(x) => number(*x),
        Kind::Text(text) if is_word(text) => text.to_string(),
        Kind::Text(text) => quoted(text),
        Kind::List(items) => {
            let items: Option<Vec<String>> = items.iter().map(plain).collect();
            format!("[{}]", items?.join(", "))
        }
        Kind::Map(entries) => {
            let entry =
                |(name, node): &(Node<'_>, Node<'_>)| Some(format!("{}: {}", plain(name)?, plain(node)?));
            format!("{{{}}}", entries.iter().map(entry).collect::<Option<Vec<_>>>()?.join(", "))
        }
        Kind::Tagged(_) => return None,
    })
}

/// Whether a text needs no quotes: a word of letters that is no number, no truth value and no null.
fn is_word(text: &str) -> bool {
    let reserved = ["true", "false", "yes", "no", "on", "off", "null", "y", "n", "inf", "nan", "infinity"];
    let lower = text.to_ascii_lowercase();
    text.starts_with(|c: char| c.is_ascii_alphabetic())
        && text.chars().all(|c| c.is_ascii_alphanumeric())
        && !reserved.contains(&lower.as_str())
}

/// A text in double quotes.
pub(super) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(quoted, "\\U{:08X}", c as u32);
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

fn flow(value: Written) -> String {
    match value {
        Written::Number(x) => number(x),
        Written::Vector(v) => format!("[{}]", v.to_array().map(number).join(", ")),
        Written::Word(word) => word.to_owned(),
    }
}

/// The shortest text that is read as the same number.
fn number(x: f64) -> String {
    match x.abs() {
        // Without a point it would be read as a whole number, which has no negative zero.
        0.0 if x.is_sign_negative() => "-0.0".to_owned(),
        0.0 => "0".to_owned(),
        size if (1e-5..1e15).contains(&size) => x.to_string(),
        _ => format!("{x:e}"),
    }
}

pub(super) fn lost(key: &str) -> Error {
    Error::Usage(format!("the scene can't be saved: the place of {key} in the file was not found"))
}
