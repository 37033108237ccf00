//! `pathtracer info PICTURE`: how it was made, and the command that makes it again.

use super::console::printable;
use crate::output;
use crate::picture::Info;
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::Path;

/// Prints what a picture says about itself; returns the exit code.
pub(super) fn run(picture: &Path) -> anyhow::Result<u8> {
    let info = Info::read(picture)?;
    let shown = printable(&picture.to_string_lossy());
    let mut text = format!("{shown}: {}, {} x {} pixels\n", info.format, info.width, info.height);
    if !info.channels.is_empty() {
        let _ = writeln!(text, "channels: {}", printable(&info.channels.join(", ")));
    }
    let width = info.metadata.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    for (name, value) in info.metadata.iter() {
        let _ = writeln!(text, "{:width$}  {}", printable(name), printable(&value.to_string()));
    }
    let command = match output::arguments(&info.metadata, picture) {
        Some(words) => format!("made again by: pathtracer {}", printable(&output::shell_line(words))),
        None => "the picture does not say how this program would make it".to_owned(),
    };
    // A reader that has gone away does not change the answer.
    let _ = writeln!(io::stdout(), "{text}{command}");
    Ok(0)
}
