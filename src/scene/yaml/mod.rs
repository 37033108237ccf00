//! The text of a scene as a tree of values with places, or what is wrong with it as YAML.

pub(crate) mod fields;
pub(crate) mod node;
pub(crate) mod position;
pub(crate) mod value;

use super::source::Source;
use crate::error::{Diagnostic, Location, Severity};
use node::{MAX_VALUES, Node, NodeSeed};
use serde::de::DeserializeSeed;
use std::cell::Cell;
use std::path::Path;

/// Largest scene file in bytes.
pub(crate) const MAX_BYTES: u64 = 256 << 20;
/// Most brackets that may be open at once: the parser's time grows with their number at every token.
const MAX_BRACKETS: usize = 1000;
/// Most characters that may start a value, which bounds the parser's memory before it starts.
const MAX_INDICATORS: usize = 2 * MAX_VALUES;

/// The text of a file, without its byte-order mark.
pub(crate) fn decode<'b>(bytes: &'b [u8], file: &Path) -> Result<&'b str, Box<Diagnostic>> {
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return Err(Box::new(whole_file("the scene file is UTF-16".to_owned(), file, "save it as UTF-8")));
    }
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    std::str::from_utf8(bytes).map_err(|error| {
        let (valid, rest) = bytes.split_at(error.valid_up_to());
        let line_end = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len()).min(1000);
        let shown = String::from_utf8_lossy(&bytes[..valid.len() + line_end]);
        let byte = rest.first().copied().unwrap_or(0);
        let (message, help) = if bytes.contains(&0) {
            ("the scene file is no text".to_owned(), None)
        } else {
            (format!("the scene file is not UTF-8: byte 0x{byte:02X}"), Some("save it as UTF-8".to_owned()))
        };
        Box::new(Source::new(file, &shown).diagnostic(Severity::Error, message, valid.len(), help))
    })
}

/// The diagnostic for a file of more than [`MAX_BYTES`].
pub(crate) fn too_large(file: &Path) -> Diagnostic {
    let message = format!("the scene file is larger than {} MiB", MAX_BYTES >> 20);
    whole_file(message, file, "put large meshes into OBJ files")
}

/// A diagnostic about the file as such.
fn whole_file(message: String, file: &Path, help: &str) -> Diagnostic {
    let location = Some(Location { file: file.to_path_buf(), line: 1, column: 1 });
    Diagnostic {
        severity: Severity::Error,
        message,
        location,
        source_line: None,
        help: Some(help.to_owned()),
    }
}

/// Parses the one document of `source`.
pub(crate) fn parse<'t>(source: &Source<'t>) -> Result<Node<'t>, Box<Diagnostic>> {
    let text = source.text();
    if let Some((offset, message)) = beyond_limits(text) {
        return Err(Box::new(source.diagnostic(Severity::Error, message, offset, None)));
    }
    let left = Cell::new(MAX_VALUES);
    let seed = NodeSeed { text, left: &left };
    seed.deserialize(serde_yaml::Deserializer::from_str(text)).map_err(|error| {
        if left.get() == 0 {
            let message =
                format!("the scene has more than {MAX_VALUES} values, those behind aliases included");
            return Box::new(source.diagnostic(Severity::Error, message, 0, None));
        }
        Box::new(syntax_error(&error, source))
    })
}

/// The first thing in `text` that the parser must not see: a character that is not text, or input that would cost
/// it too much time or memory. Brackets in comments and quotes count too, which no real scene notices.
fn beyond_limits(text: &str) -> Option<(usize, String)> {
    let (mut open, mut indicators) = (0usize, 0usize);
    for (offset, c) in text.char_indices() {
        match c {
            '[' | '{' => open += 1,
            ']' | '}' => open = open.saturating_sub(1),
            _ => {}
        }
        indicators += usize::from(matches!(c, '[' | '{' | ',' | ':' | '-' | '?' | '\n'));
        if !is_allowed(c) {
            return Some((
                offset,
                format!("the scene file is no text: it holds the character U+{:04X}", c as u32),
            ));
        }
        if open > MAX_BRACKETS {
            return Some((offset, format!("more than {MAX_BRACKETS} brackets are open")));
        }
        if indicators > MAX_INDICATORS {
            return Some((offset, format!("the scene has more than {MAX_VALUES} values")));
        }
    }
    None
}

/// Whether YAML allows the character (YAML 1.2.2, section 5.1; a byte-order mark only at the start).
fn is_allowed(c: char) -> bool {
    match c {
        '\t' | '\n' | '\r' | '\u{85}' | ' '..='~' => true,
        '\u{FEFF}' | '\u{FFFE}' | '\u{FFFF}' => false,
        _ => c >= '\u{A0}',
    }
}

/// The diagnostic for an error of the parser.
fn syntax_error(error: &serde_yaml::Error, source: &Source<'_>) -> Diagnostic {
    let problem = error.to_string();
    let Some(location) = error.location() else {
        let (offset, message, help) = if problem.contains("more than one document") {
            let offset = position::second_document(source.text()).unwrap_or(0);
            (
                offset,
                "a second document starts here".to_owned(),
                Some("a scene file holds one document; remove ---"),
            )
        } else if problem.contains("repetition limit") {
            (0, "the aliases of the scene repeat too much".to_owned(), None)
        } else {
            (0, format!("not valid YAML: {problem}"), None)
        };
        return source.diagnostic(Severity::Error, message, offset, help.map(str::to_owned));
    };
    let offset = location.index();
    if problem.contains("recursion limit") {
        return source.diagnostic(
            Severity::Error,
            "the values are nested too deeply".to_owned(),
            offset,
            None,
        );
    }
    let place = format!(" at line {} column {}", location.line(), location.column());
    let message = format!("not valid YAML: {}", problem.replacen(&place, "", 1));
    let line = source.line_at(offset);
    let indentation = &line[..line.len() - line.trim_start().len()];
    let help = if indentation.contains('\t') {
        Some("indent with blanks; YAML does not allow tabs")
    } else {
        HELP.iter().find(|(part, _)| problem.contains(part)).map(|(_, help)| *help)
    };
    source.diagnostic(Severity::Error, message, offset, help.map(str::to_owned))
}

/// What usually lies behind the parser's messages.
const HELP: [(&str, &str); 9] = [
    ("mapping values are not allowed", "check the indentation; a text with a colon needs quotes"),
    ("could not find expected ':'", "a key is followed by a colon and a blank"),
    ("did not find expected ',' or ']'", "a comma or the closing ] is missing"),
    ("did not find expected ',' or '}'", "a comma or the closing } is missing"),
    ("did not find expected key", "check the indentation: the keys of a mapping start in the same column"),
    ("did not find expected '-'", "check the indentation: the items of a list start in the same column"),
    ("unexpected end of stream", "a quote is not closed"),
    ("cannot start any token", "a text that starts with a special character needs quotes"),
    ("unknown anchor", "*NAME repeats a value that &NAME marks further up"),
];
