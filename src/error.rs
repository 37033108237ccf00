//! The errors of the library: what, where, and what would be right.

use std::fmt;
use std::io;
use std::path::PathBuf;

/// A result whose error is [`Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// A place in a text file. `line` and `column` count from 1, columns in characters.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Location {
    /// The file as the user named it.
    pub file: PathBuf,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
}

/// Whether a [`Diagnostic`] stops the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The scene can't be rendered.
    Error,
    /// The scene can be rendered; the user should know.
    Warning,
}

/// One thing that is wrong with an input file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// Error or warning.
    pub severity: Severity,
    /// What was found and what was expected, in one sentence without a full stop.
    pub message: String,
    /// Where, if there is a place.
    pub location: Option<Location>,
    /// The text of the line at `location`, as [`Diagnostic::excerpt`] gives it.
    pub source_line: Option<String>,
    /// What would be right ("did you mean ...").
    pub help: Option<String>,
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file.display(), self.line, self.column)
    }
}

/// Characters of a long line that an excerpt shows before the place.
const EXCERPT_BEFORE: usize = 60;
/// Characters of a long line that an excerpt shows from the place on.
const EXCERPT_AFTER: usize = 60;
/// What stands for a piece of a line that was left out.
const ELLIPSIS: char = '\u{2026}';

impl Diagnostic {
    /// The part of `line` around `column` that is worth showing: the whole line if it is short, else some
    /// characters before and after, with an ellipsis for each piece left out. Control characters become U+FFFD,
    /// so that a file can't talk to the terminal.
    pub fn excerpt(line: &str, column: usize) -> String {
        let place = column.saturating_sub(1);
        let cut = place > EXCERPT_BEFORE + EXCERPT_AFTER;
        let first = if cut { place - EXCERPT_BEFORE } else { 0 };
        let mut excerpt: String = if cut { ELLIPSIS.to_string() } else { String::new() };
        let mut rest = line.chars().skip(if cut { first + 1 } else { 0 });
        let visible = |c: char| if c.is_control() && c != '\t' { char::REPLACEMENT_CHARACTER } else { c };
        excerpt.extend(rest.by_ref().take(place + EXCERPT_AFTER - first).map(visible));
        if rest.next().is_some() {
            excerpt.push(ELLIPSIS);
        }
        excerpt
    }

    /// Blanks that bring a caret below the place in an excerpt; a tab stays a tab.
    fn indent(excerpt: &str, column: usize) -> String {
        let place = column.saturating_sub(1);
        let cut = place > EXCERPT_BEFORE + EXCERPT_AFTER && excerpt.starts_with(ELLIPSIS);
        let before = if cut { EXCERPT_BEFORE } else { place };
        excerpt.chars().take(before).map(|c| if c == '\t' { '\t' } else { ' ' }).collect()
    }
}

impl fmt::Display for Diagnostic {
    /// A block: the message, `-->` and the place, the source line with a caret, the help.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let word = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        write!(f, "{word}: {}", self.message)?;
        if let Some(location) = &self.location {
            write!(f, "\n  --> {location}")?;
            if let Some(line) = &self.source_line {
                let number = location.line.to_string();
                let indent = Diagnostic::indent(line, location.column);
                write!(f, "\n {number} | {line}\n {:width$} | {indent}^", "", width = number.len())?;
            }
        }
        if let Some(help) = &self.help {
            write!(f, "\n  help: {help}")?;
        }
        Ok(())
    }
}

/// Everything that can go wrong in the library.
#[derive(Debug)]
pub enum Error {
    /// The input files hold mistakes: all of them, errors and warnings, in the order of the file.
    Scene(Vec<Diagnostic>),
    /// A setting that can't be.
    Usage(String),
    /// Something that this machine lacks.
    Unavailable(String),
    /// A file could not be read or written; `action` reads like "write the picture".
    Io {
        /// What was tried.
        action: String,
        /// The file.
        path: PathBuf,
        /// The system's answer.
        source: io::Error,
    },
    /// The accelerator's library failed.
    Accelerator(String),
    /// The picture could not be encoded.
    Picture(String),
    /// A checkpoint or a part of a picture can't be used: which, and why.
    Film(String),
    /// The user stopped the render.
    Interrupted,
    /// A bug in this program, met and contained.
    Internal(String),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::Scene(diagnostics) => {
                for (i, diagnostic) in diagnostics.iter().enumerate() {
                    if i > 0 {
                        writeln!(f)?;
                    }
                    write!(f, "{diagnostic}")?;
                }
                Ok(())
            }
            Error::Usage(message)
            | Error::Unavailable(message)
            | Error::Accelerator(message)
            | Error::Picture(message)
            | Error::Film(message) => write!(f, "{message}"),
            Error::Io { action, path, source } => write!(f, "cannot {action} {}: {source}", path.display()),
            Error::Interrupted => write!(f, "interrupted"),
            Error::Internal(message) => write!(f, "a bug in this program: {message}"),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Error::Io { source, .. } => Some(source),
            _ => None,
        }
    }
}

impl Error {
    /// The exit code of a program that ends with this error: 1 failure, 2 usage, 3 bad scene, 130 interrupted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Scene(_) => 3,
            Error::Usage(_) => 2,
            Error::Interrupted => 130,
            Error::Unavailable(_)
            | Error::Io { .. }
            | Error::Accelerator(_)
            | Error::Picture(_)
            | Error::Film(_)
            | Error::Internal(_) => 1,
        }
    }
}
