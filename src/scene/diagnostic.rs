//! Collecting what is wrong with a scene, and the words of the messages.

use super::source::Source;
use super::yaml::position::{self, Target};
use crate::error::{Diagnostic, Location, Severity};
use std::collections::HashSet;

/// Most errors, and most warnings, that are kept; more are counted.
const MAX_FINDINGS: usize = 10_000;

/// Where in the scene file something was found.
pub(crate) enum Place {
    /// At a byte offset.
    Offset(usize),
    /// At a value or key that is still to be located; else at the offset of something around it.
    Search(Target, usize),
}

/// One thing that was found wrong. Its message reads `subject` + `text`.
pub(crate) struct Finding {
    /// Error or warning.
    pub(crate) severity: Severity,
    /// The path of the value, such as `Camera.Fov`; empty if `text` says it all.
    pub(crate) subject: String,
    /// What is wrong with it.
    pub(crate) text: String,
    /// What would be right.
    pub(crate) help: Option<String>,
    /// Where in the scene file.
    pub(crate) place: Place,
    /// The place to show if it is in another file, with the excerpt of its line.
    pub(crate) elsewhere: Option<(Location, String)>,
}

/// All findings of one scene file.
#[derive(Default)]
pub(crate) struct Report {
    findings: Vec<Finding>,
    errors: usize,
    warnings: usize,
}

impl Report {
    /// Adds a finding.
    pub(crate) fn push(&mut self, finding: Finding) {
        let count = match finding.severity {
            Severity::Error => &mut self.errors,
            Severity::Warning => &mut self.warnings,
        };
        *count += 1;
        if *count <= MAX_FINDINGS {
            self.findings.push(finding);
        }
    }

    /// Whether nothing stops the scene from being rendered.
    pub(crate) fn is_renderable(&self) -> bool {
        self.errors == 0
    }

    /// The diagnostics in the order of the file. A value that is reached through several aliases is reported once.
    pub(crate) fn into_diagnostics(self, source: &Source<'_>) -> Vec<Diagnostic> {
        let dropped = self.errors.saturating_sub(MAX_FINDINGS) + self.warnings.saturating_sub(MAX_FINDINGS);
        let mut placed = locate(self.findings, source);
        placed.sort_by_key(|(offset, _)| *offset);
        let mut seen = HashSet::new();
        let mut diagnostics = Vec::new();
        for (offset, finding) in placed {
            let last_key = finding.subject.rsplit('.').next().unwrap_or("").to_owned();
            if finding.elsewhere.is_some() || seen.insert((offset, last_key, finding.text.clone())) {
                diagnostics.push(diagnostic(finding, offset, source));
            }
        }
        if dropped > 0 {
            let message = format!("{dropped} more errors and warnings are not shown");
            let severity = if self.errors > 0 { Severity::Error } else { Severity::Warning };
            diagnostics.push(Diagnostic { severity, message, location: None, source_line: None, help: None });
        }
        diagnostics
    }
}

/// The findings with their byte offsets.
fn locate(findings: Vec<Finding>, source: &Source<'_>) -> Vec<(usize, Finding)> {
    let mut placed = Vec::new();
    let mut targets = Vec::new();
    let mut waiting = Vec::new();
    for mut finding in findings {
        match std::mem::replace(&mut finding.place, Place::Offset(0)) {
            Place::Offset(offset) => placed.push((offset, finding)),
            Place::Search(target, around) => {
                waiting.push(placed.len());
                placed.push((around, finding));
                targets.push(target);
            }
        }
    }
    for (&index, found) in waiting.iter().zip(position::find(source.text(), &targets)) {
        if let (Some((offset, _)), Some(found)) = (placed.get_mut(index), found) {
            *offset = found;
        }
    }
    placed
}

fn diagnostic(finding: Finding, offset: usize, source: &Source<'_>) -> Diagnostic {
    let message = format!("{}{}", finding.subject, finding.text);
    match finding.elsewhere {
        None => source.diagnostic(finding.severity, message, offset, finding.help),
        Some((location, source_line)) => Diagnostic {
            severity: finding.severity,
            message,
            location: Some(location),
            source_line: Some(source_line),
            help: finding.help.map(|help| format!("{help}, {}", source.location(offset))),
        },
    }
}

/// `text` in quotes, with control characters escaped and long texts cut.
pub(crate) fn quote(text: &str) -> String {
    const LONGEST: usize = 60;
    let mut quoted = String::from("\"");
    for c in text.chars().take(LONGEST) {
        if c.is_control() || c == '"' {
            quoted.extend(c.escape_default());
        } else {
            quoted.push(c);
        }
    }
    if text.chars().nth(LONGEST).is_some() {
        quoted.push('\u{2026}');
    }
    quoted.push('"');
    quoted
}

/// The names as `A, B or C`.
pub(crate) fn alternatives(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

/// The name that `word` was probably meant to be: at most a third of its letters differ, and at least one agrees.
pub(crate) fn nearest<'n>(word: &str, names: &[&'n str]) -> Option<&'n str> {
    let word: Vec<char> = word.chars().take(64).flat_map(char::to_lowercase).collect();
    let distance = |name: &&str| edit_distance(&word, &name.to_lowercase().chars().collect::<Vec<_>>());
    let (distance, name) = names.iter().map(|name| (distance(name), *name)).min_by_key(|(d, _)| *d)?;
    let limit = (word.len().max(name.len()) / 3).max(1);
    (distance <= limit && distance < word.len()).then_some(name)
}

/// Edits that turn `a` into `b`: insertions, deletions, substitutions and swaps of neighbours (the optimal string
/// alignment distance).
fn edit_distance(a: &[char], b: &[char]) -> usize {
    let mut before_last: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut row = vec![i + 1];
        for (j, y) in b.iter().enumerate() {
            let mut edits = (last[j] + usize::from(x != y)).min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && a[i - 1] == *y && *x == b[j - 1] {
                edits = edits.min(before_last[j - 1] + 1);
            }
            row.push(edits);
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last.last().copied().unwrap_or(0)
}
