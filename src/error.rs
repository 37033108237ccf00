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
    /// The text of the line at `location`.
    pub source_line: Option<String>,
    /// What would be right ("did you mean ...").
    pub help: Option<String>,
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}:{}", self.file.display(), self.line, self.column)
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
                let indent: String = line
                    .chars()
                    .take(location.column - 1)
                    .map(|c| if c == '\t' { '\t' } else { ' ' })
                    .collect();
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
    /// Something that this build or this machine lacks, and how to get it.
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
            | Error::Picture(message) => write!(f, "{message}"),
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
            Error::Usage(_) | Error::Unavailable(_) => 2,
            Error::Interrupted => 130,
            Error::Io { .. } | Error::Accelerator(_) | Error::Picture(_) | Error::Internal(_) => 1,
        }
    }
}
