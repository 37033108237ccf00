//! Lines for humans, and numbers in them.

use std::fmt::Display;
use std::io::{self, Write};
use std::time::Duration;

/// Prints a line on stderr. A stderr that is closed is no failure.
pub(crate) fn say(line: impl Display) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// A number as `%g` prints it: 6 significant digits, no zeros at the end.
pub(crate) fn number(x: f64) -> String {
    digits(x, 6)
}

/// A number with so many significant digits, at least 1, and no zeros at the end.
pub(crate) fn digits(x: f64, count: usize) -> String {
    let rounded: f64 = format!("{x:.*e}", count - 1).parse().unwrap_or(x);
    let is_plain = rounded == 0.0 || (1e-5..1e15).contains(&rounded.abs());
    if is_plain { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// A rate or count with three digits and a prefix: `1.23 M`.
pub(crate) fn with_prefix(x: f64) -> String {
    let (scaled, prefix) = match x {
        1e9.. => (x / 1e9, " G"),
        1e6.. => (x / 1e6, " M"),
        1e3.. => (x / 1e3, " k"),
        _ => (x, " "),
    };
    let digits = if scaled >= 99.95 {
        0
    } else if scaled >= 9.995 {
        1
    } else {
        2
    };
    format!("{scaled:.digits$}{prefix}")
}

/// A duration in its two largest units.
pub(crate) fn duration(time: Duration) -> String {
    match time.as_secs() {
        0..10 => format!("{:.2} s", time.as_secs_f64()),
        seconds @ 10..60 => format!("{seconds} s"),
        seconds @ 60..3600 => format!("{} min {} s", seconds / 60, seconds % 60),
        seconds => format!("{} h {} min", seconds / 3600, seconds / 60 % 60),
    }
}

/// Text of a file without what a terminal would obey.
pub(crate) fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect()
}
