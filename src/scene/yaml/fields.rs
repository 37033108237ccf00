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

impl Section {
    /// What the keys are, for a help line.
    fn keys_help(&self) -> String {
        match self.keys {
            [only] => format!("{} has the key {only}", self.name),
            keys => format!("the keys of {} are {}", self.name, keys.join(", ")),
        }
    }
}

/// A mapping of a [`Section`].
pub(crate) struct Fields<'v> {
    value: Value<'v>,
    entries: &'v [(Node<'v>, Node<'v>)],
    /// Keys that unknown keys were taken for. They are not reported as missing too.
    guessed: Vec<&'static str>,
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
            value.refuse("a mapping", Some(section.keys_help()), report);
            return None;
        };
        let mut fields = Fields { value, entries, guessed: Vec::new() };
        let mut seen = vec![false; section.keys.len()];
        for (index, (key, _)) in entries.iter().enumerate() {
            match key.text().and_then(|text| section.keys.iter().position(|known| *known == text)) {
                None => fields.unknown(index, key, section, all, report),
                Some(known) if std::mem::replace(&mut seen[known], true) => {
                    let help = "remove one of the two".to_owned();
                    fields.push(Severity::Error, index, " is given twice", help, report);
                }
                Some(_) => {}
            }
        }
        Some(fields)
    }

    /// Reports an unknown key, with what it was probably meant to be.
    fn unknown(
        &mut self,
        index: usize,
        key: &Node<'_>,
        section: &Section,
        all: &[Section],
        report: &mut Report,
    ) {
        let word = key.text().unwrap_or("");
        let owner = all.iter().find(|other| other.name != section.name && other.keys.contains(&word));
        let near = nearest(word, section.keys);
        self.guessed.extend(near);
        let help = match (owner, near) {
            (_, Some(near)) => format!("did you mean {near}?"),
            (Some(owner), None) => format!("{word} is a key of {}", owner.name),
            (None, None) => section.keys_help(),
        };
        report.push(Finding {
            severity: Severity::Error,
            subject: self.value.path.to_string(),
            text: format!(" has {}", unknown_words(key)),
            help: Some(help),
            place: self.value.place_of_key(index, key),
            elsewhere: None,
        });
    }

    /// Reports something about the key of entry `index`, which is a text.
    fn push(&self, severity: Severity, index: usize, text: &str, help: String, report: &mut Report) {
        let Some(entry) = self.entries.get(index) else { return };
        let value = self.value.entry(index, entry.0.text().unwrap_or(""), entry);
        report.push(Finding {
            severity,
            subject: value.path.to_string(),
            text: text.to_owned(),
            help: Some(help),
            place: self.value.place_of_key(index, &entry.0),
            elsewhere: None,
        });
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
        if found.is_none() && !self.guessed.contains(&key) {
            report.push(Finding {
                severity: Severity::Error,
                subject: self.value.path.to_string(),
                text: format!(" has no {key}"),
                help: Some(format!("add {key}: {meaning}")),
                place: Place::Offset(self.value.near()),
                elsewhere: None,
            });
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
            if key.text().is_some_and(|text| section.keys.contains(&text) && !used.contains(&text)) {
                let help = format!("{user} uses {}", used.join(", "));
                self.push(Severity::Warning, index, &format!(" is not used by {user}"), help, report);
            }
        }
    }
}

/// What an unknown key is called: bare if it looks like a key.
fn unknown_words(key: &Node<'_>) -> String {
    match key.text() {
        Some(text) if !text.is_empty() && text.len() <= 40 && text.chars().all(char::is_alphanumeric) => {
            format!("the unknown key {text}")
        }
        Some(text) => format!("the unknown key {}", quote(text)),
        None => "a key that is no text".to_owned(),
    }
}
