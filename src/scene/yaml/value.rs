//! Values with their paths, read as what the format wants them to be. Whatever does not fit is reported.

use super::node::{Kind, Node};
use super::position::{Part, Target};
use crate::error::Severity;
use crate::math::DVec3;
use crate::scene::diagnostic::{Finding, Place, Report, alternatives, nearest, quote};
use std::fmt;

/// The numbers that a key takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Range {
    /// Any finite number.
    Finite,
    /// Greater than 0.
    Positive,
    /// 0 or greater.
    NonNegative,
    /// From 0 to 1.
    Unit,
    /// Greater than 0 and less than 1.
    OpenUnit,
}

impl Range {
    fn holds(self, x: f64) -> bool {
        x.is_finite()
            && match self {
                Range::Finite => true,
                Range::Positive => x > 0.0,
                Range::NonNegative => x >= 0.0,
                Range::Unit => (0.0..=1.0).contains(&x),
                Range::OpenUnit => x > 0.0 && x < 1.0,
            }
    }

    /// What follows `a finite number` or `finite numbers`.
    fn words(self) -> &'static str {
        match self {
            Range::Finite => "",
            Range::Positive => " > 0",
            Range::NonNegative => " >= 0",
            Range::Unit => " from 0 to 1",
            Range::OpenUnit => " > 0 and < 1",
        }
    }
}

/// The way from the root to a value, as a list that grows down the stack.
#[derive(Clone, Copy)]
pub(crate) struct Path<'p> {
    parent: Option<&'p Path<'p>>,
    name: Name<'p>,
    index: u32,
}

#[derive(Clone, Copy)]
enum Name<'p> {
    Root,
    Key(&'p str),
    Item,
}

impl Path<'_> {
    fn indices(&self) -> Vec<u32> {
        let mut indices = self.parent.map(Path::indices).unwrap_or_default();
        if self.parent.is_some() {
            indices.push(self.index);
        }
        indices
    }
}

impl fmt::Display for Path<'_> {
    /// Such as `Objects[3].Object.Radius`; `the scene` for the root.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.parent, self.name) {
            (_, Name::Root) | (None, _) => write!(f, "the scene"),
            (Some(parent), Name::Item) => write!(f, "{parent}[{}]", self.index),
            (Some(parent), Name::Key(key)) if parent.parent.is_none() => write!(f, "{key}"),
            (Some(parent), Name::Key(key)) => write!(f, "{parent}.{key}"),
        }
    }
}

/// A value of the document and the way to it.
#[derive(Clone, Copy)]
pub(crate) struct Value<'v> {
    /// The value itself.
    pub(crate) node: &'v Node<'v>,
    /// The way to it.
    pub(crate) path: Path<'v>,
    /// Offset of its key, or of something around it that has a known one.
    near: usize,
}

impl<'v> Value<'v> {
    /// The whole document.
    pub(crate) fn root(node: &'v Node<'v>) -> Value<'v> {
        let path = Path { parent: None, name: Name::Root, index: 0 };
        let near = match &node.kind {
            Kind::Map(entries) => entries.first().and_then(|(key, _)| key.offset()),
            _ => node.offset(),
        };
        Value { node, path, near: near.unwrap_or(0) }
    }

    /// Entry `index` of this mapping, whose key reads `key`.
    pub(super) fn entry<'c>(
        &'c self,
        index: usize,
        key: &'c str,
        entry: &'c (Node<'v>, Node<'v>),
    ) -> Value<'c>
    where
        'v: 'c,
    {
        let path = Path { parent: Some(&self.path), name: Name::Key(key), index: index as u32 };
        Value { node: &entry.1, path, near: entry.0.offset().unwrap_or(self.near) }
    }

    /// Item `index` of this list.
    pub(crate) fn item<'c>(&'c self, index: usize, node: &'c Node<'v>) -> Value<'c>
    where
        'v: 'c,
    {
        let path = Path { parent: Some(&self.path), name: Name::Item, index: index as u32 };
        Value { node, path, near: self.near }
    }

    /// Offset of its key, or of something around it.
    pub(crate) fn near(&self) -> usize {
        self.near
    }

    /// Where the value stands.
    pub(crate) fn place(&self) -> Place {
        let part = if self.node.is_scalar() { Part::Scalar } else { Part::Collection };
        match self.node.offset() {
            Some(offset) => Place::Offset(offset),
            None => Place::Search(Target { path: self.path.indices(), part }, self.near),
        }
    }

    /// Where the key of entry `index` of this mapping stands.
    pub(super) fn place_of_key(&self, index: usize, key: &Node<'_>) -> Place {
        match key.offset() {
            Some(offset) => Place::Offset(offset),
            None => {
                let mut path = self.path.indices();
                path.push(index as u32);
                Place::Search(Target { path, part: Part::Key }, self.near)
            }
        }
    }

    /// Reports `<path> <text>` as an error.
    pub(crate) fn error(&self, text: &str, help: Option<String>, report: &mut Report) {
        report.push(Finding {
            severity: Severity::Error,
            subject: self.path.to_string(),
            text: format!(" {text}"),
            help,
            place: self.place(),
            elsewhere: None,
        });
    }

    /// Reports that the value is not `expected`.
    pub(crate) fn refuse(&self, expected: &str, help: Option<String>, report: &mut Report) {
        self.error(&format!("must be {expected}, found {}", Found(self.node)), help, report);
    }

    /// A number in `range`.
    pub(crate) fn number(&self, range: Range, report: &mut Report) -> Option<f64> {
        match self.node.kind {
            Kind::Number(x) if range.holds(x) => Some(x),
            _ => {
                let expected = format!("a finite number{}", range.words());
                self.refuse(&expected, number_help(self.node, range), report);
                None
            }
        }
    }

    /// Three numbers in `range`.
    pub(crate) fn vector(&self, range: Range, report: &mut Report) -> Option<DVec3> {
        let Kind::List(items) = &self.node.kind else {
            let expected = format!("a list of 3 finite numbers{}", range.words());
            let help = match self.node.kind {
                Kind::Number(_) | Kind::Text(_) => Some("write it as [x, y, z]".to_owned()),
                _ => None,
            };
            self.refuse(&expected, help, report);
            return None;
        };
        if items.len() != 3 {
            self.refuse(&format!("a list of 3 finite numbers{}", range.words()), None, report);
            return None;
        }
        let mut numbers = [None; 3];
        for (index, (item, number)) in items.iter().zip(&mut numbers).enumerate() {
            *number = self.item(index, item).number(range, report);
        }
        let [x, y, z] = numbers;
        Some(DVec3::new(x?, y?, z?))
    }

    /// `true` or `false`.
    pub(crate) fn flag(&self, report: &mut Report) -> Option<bool> {
        match self.node.kind {
            Kind::Bool(flag) => Some(flag),
            _ => {
                self.refuse("true or false", None, report);
                None
            }
        }
    }

    /// A text that is not empty.
    pub(crate) fn text(&self, expected: &str, report: &mut Report) -> Option<&'v str> {
        match self.node.text() {
            Some(text) if !text.is_empty() => Some(text),
            _ => {
                self.refuse(expected, None, report);
                None
            }
        }
    }

    /// One of the named choices.
    pub(crate) fn choice<T: Copy>(&self, choices: &[(&str, T)], report: &mut Report) -> Option<T> {
        let found = choices.iter().find(|(name, _)| self.node.text() == Some(name));
        if found.is_none() {
            let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
            let near = self.node.text().and_then(|text| nearest(text, &names));
            self.refuse(&alternatives(&names), near.map(|name| format!("did you mean {name}?")), report);
        }
        found.map(|(_, choice)| *choice)
    }

    /// The choice that a misspelt name was probably meant to be: what else is wrong can be said by it.
    pub(crate) fn meant<T: Copy>(&self, choices: &[(&str, T)]) -> Option<T> {
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        let near = nearest(self.node.text()?, &names)?;
        choices.iter().find(|(name, _)| *name == near).map(|(_, choice)| *choice)
    }

    /// A name, which any scalar can be: the scene information prints it as it was understood.
    pub(crate) fn name(&self, report: &mut Report) -> Option<String> {
        match &self.node.kind {
            Kind::Null => None,
            Kind::Text(text) => Some(text.to_string()),
            Kind::Number(x) => Some(x.to_string()),
            Kind::Bool(flag) => Some(flag.to_string()),
            _ => {
                self.refuse("a text", None, report);
                None
            }
        }
    }
}

/// What to do about a value that should have been a number in `range`.
fn number_help(node: &Node<'_>, range: Range) -> Option<String> {
    if let Kind::Number(byte) = node.kind {
        let is_byte = range == Range::Unit && (16.0..=255.0).contains(&byte) && byte.fract() == 0.0;
        return is_byte.then(|| format!("as a share of 255 that is {:.3}", byte / 255.0));
    }
    let text = node.text()?;
    let plain = text.trim().replace('_', "").replace(',', ".");
    let number = plain.parse::<f64>().ok().filter(|x| x.is_finite())?;
    let quotes = if plain == text { " without quotes" } else { "" };
    Some(format!("write {number}{quotes}"))
}

/// What was found, for a message.
struct Found<'n>(&'n Node<'n>);

impl fmt::Display for Found<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0.kind {
            Kind::Null => write!(f, "nothing"),
            Kind::Bool(flag) => write!(f, "{flag}"),
            Kind::Number(x) if *x != 0.0 && !(1e-6..1e15).contains(&x.abs()) && x.is_finite() => {
                write!(f, "{x:e}")
            }
            Kind::Number(x) => write!(f, "{x}"),
            Kind::Text(text) if text.parse::<f64>().is_ok_and(|x| !x.is_finite()) => write!(f, "{text}"),
            Kind::Text(text) => write!(f, "the text {}", quote(text)),
            Kind::List(items) if items.is_empty() => write!(f, "an empty list"),
            Kind::List(items) if items.len() == 1 => write!(f, "a list of 1 value"),
            Kind::List(items) => write!(f, "a list of {} values", items.len()),
            Kind::Map(_) => write!(f, "a mapping"),
            Kind::Tagged(tag) => write!(f, "the tag {}", quote(tag)),
        }
    }
}
