//! Mappings whose keys are known: unknown and repeated keys are errors, unused ones warnings.

use super::node::{Kind, Node};
use super::value::{Range, Value};
use crate::error::Severity;
use crate::math::DVec3;
use crate::scene::diagnostic::{Finding, Place, Report, nearest, quote};

/// A kind of mapping in the format: its name in messages, and its keys.
#[derive(Debug)]
pub(crate) struct Section {
    /// What holds the keys, such as `Material`.
    pub(crate) name: &'static str,
    /// All keys that any variant takes.
    pub(crate) keys: &'static [&'static str],
}

/// A mapping of a [`Section`].
#[derive(Clone, Copy)]
pub(crate) struct Fields<'v> {
    /// The mapping.
    pub(crate) value: Value<'v>,
    entries: &'v [(Node<'v>, Node<'v>)],
}

impl<'v> Fields<'v> {
    /// The entries of `value`, which must be a mapping. Reports keys that `section` does not know, with the section
    /// of `all` where they belong, and keys that come twice.
    pub(crate) fn open(
        value: Value<'v>,
        section: &Section,
        all: &[Section],
        report: &mut Report,
    ) -> Option<Fields<'v>> {
        let Kind::Map(entries) = &value.node.kind else {
            let keys = section.keys.join(", ");
            value.refuse("a mapping", Some(format!("the keys of {} are {keys}", section.name)), report);
            return None;
        };
        let mut seen = vec![false; section.keys.len()];
        for (index, (key, _)) in entries.iter().enumerate() {
            let known = key.text().and_then(|text| section.keys.iter().position(|known| *known == text));
            let (text, help) = match known {
                None => (format!(" has the unknown key {}", key_words(key)), unknown_help(key, section, all)),
                Some(known) if std::mem::replace(&mut seen[known], true) => {
                    (format!(".{} is given twice", section.keys[known]), "remove one of the two".to_owned())
                }
                Some(_) => continue,
            };
            let place = value.place_of_key(index, key);
            push(Severity::Error, value, text, Some(help), place, report);
        }
        Some(Fields { value, entries })
    }

    /// The value of `key`, if it is given.
    pub(crate) fn get<'c>(&'c self, key: &'c str) -> Option<Value<'c>> {
        let index = self.entries.iter().position(|(k, _)| k.text() == Some(key))?;
        Some(self.value.entry(index, key, self.entries.get(index)?))
    }

    /// The value of `key`; reports its absence, with what it would have been.
    pub(crate) fn require<'c>(
        &'c self,
        key: &'c str,
        meaning: &str,
        report: &mut Report,
    ) -> Option<Value<'c>> {
        let found = self.get(key);
        if found.is_none() {
            let text = format!(" has no {key}");
            let help = Some(format!("add {key}: {meaning}"));
            push(Severity::Error, self.value, text, help, Place::Offset(self.value.near()), report);
        }
        found
    }

    /// A required number.
    pub(crate) fn number(&self, key: &str, range: Range, meaning: &str, report: &mut Report) -> Option<f64> {
        self.require(key, meaning, report)?.number(range, report)
    }

    /// A number that is `default` if it is not given.
    pub(crate) fn number_or(
        &self,
        key: &str,
        range: Range,
        default: f64,
        report: &mut Report,
    ) -> Option<f64> {
        self.get(key).map_or(Some(default), |value| value.number(range, report))
    }

    /// Three required numbers.
    pub(crate) fn vector(
        &self,
        key: &str,
        range: Range,
        meaning: &str,
        report: &mut Report,
    ) -> Option<DVec3> {
        self.require(key, meaning, report)?.vector(range, report)
    }

    /// Three numbers that are `default` if they are not given.
    pub(crate) fn vector_or(
        &self,
        key: &str,
        range: Range,
        default: DVec3,
        report: &mut Report,
    ) -> Option<DVec3> {
        self.get(key).map_or(Some(default), |value| value.vector(range, report))
    }

    /// The optional `Name`.
    pub(crate) fn name(&self, report: &mut Report) -> Option<String> {
        self.get("Name").and_then(|value| value.name(report))
    }

    /// Warns of the keys of `section` that are given but not among `used`, by the variant named `user`.
    pub(crate) fn warn_unused(&self, section: &Section, used: &[&str], user: &str, report: &mut Report) {
        for (index, (key, _)) in self.entries.iter().enumerate() {
            let Some(text) = key.text().filter(|text| section.keys.contains(text) && !used.contains(text))
            else {
                continue;
            };
            let text = format!(".{text} is not used by {user}");
            let help = Some(format!("{user} uses {}", used.join(", ")));
            push(Severity::Warning, self.value, text, help, self.value.place_of_key(index, key), report);
        }
    }

    /// Whether any of `keys` is given.
    pub(crate) fn has_any(&self, keys: &[&str]) -> bool {
        self.entries.iter().any(|(key, _)| key.text().is_some_and(|text| keys.contains(&text)))
    }
}

/// Reports something about a key of `value`.
fn push(
    severity: Severity,
    value: Value<'_>,
    text: String,
    help: Option<String>,
    place: Place,
    report: &mut Report,
) {
    report.push(Finding { severity, subject: value.path.to_string(), text, help, place, elsewhere: None });
}

/// A key in a message: bare if it looks like one.
fn key_words(key: &Node<'_>) -> String {
    match key.text() {
        Some(text) if !text.is_empty() && text.chars().all(char::is_alphanumeric) && text.len() <= 40 => {
            text.to_owned()
        }
        Some(text) => quote(text),
        None => "that is no text".to_owned(),
    }
}

/// What an unknown key was probably meant to be.
fn unknown_help(key: &Node<'_>, section: &Section, all: &[Section]) -> String {
    let word = key.text().unwrap_or("");
    let owner = all.iter().find(|other| other.name != section.name && other.keys.contains(&word));
    match (owner, nearest(word, section.keys)) {
        (_, Some(near)) => format!("did you mean {near}?"),
        (Some(owner), None) => format!("{word} is a key of {}", owner.name),
        (None, None) => format!("the keys of {} are {}", section.name, section.keys.join(", ")),
    }
}
