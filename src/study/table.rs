//! Figures as text: aligned columns for people, CSV for programs.

pub use crate::words::{counted, grouped};

use super::rounds::Spread;
use serde::Serialize;
use std::fmt;

/// A table of words; the first column is aligned to the left, the others to the right.
#[derive(Clone, Debug)]
pub struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with these headings.
    pub fn new<S: Into<String>>(headings: impl IntoIterator<Item = S>) -> Table {
        Table { rows: vec![headings.into_iter().map(Into::into).collect()] }
    }

    /// Adds a row.
    pub fn push<S: Into<String>>(&mut self, cells: impl IntoIterator<Item = S>) {
        self.rows.push(cells.into_iter().map(Into::into).collect());
    }

    /// All rows, the headings first.
    pub fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width = |column: usize| {
            self.rows
                .iter()
                .filter_map(|row| row.get(column))
                .map(|cell| cell.chars().count())
                .max()
                .unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        for row in &self.rows {
            let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| match column {
                0 => format!("{cell:width$}"),
                _ => format!("  {cell:>width$}"),
            });
            writeln!(f, "{}", cells.collect::<String>().trim_end())?;
        }
        Ok(())
    }
}

/// One measured number, with what it is of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// The mesh, or the scene.
    pub mesh: String,
    /// Its triangles.
    pub triangles: usize,
    /// What was measured: an accelerator's name, or `both`.
    pub accelerator: &'static str,
    /// The precision's name.
    pub precision: &'static str,
    /// What it is, such as `build`, `primary`, `bytes`.
    pub measure: String,
    /// On how many threads, where that matters.
    pub threads: Option<usize>,
    /// The unit, such as `s`, `Mrays/s`, `bytes/triangle`, `rays`.
    pub unit: &'static str,
    /// The median, and the range over the rounds.
    #[serde(flatten)]
    pub value: Spread,
}

/// The figures as CSV (RFC 4180, lines ended by a line feed), with a line of headings.
pub fn csv(figures: &[Figure]) -> String {
    let mut text = "mesh,triangles,accelerator,precision,measure,threads,unit,median,min,max\n".to_owned();
    for figure in figures {
        let threads = figure.threads.map(|threads| threads.to_string()).unwrap_or_default();
        let Spread { median, min, max } = figure.value;
        let cells = [
            quoted(&figure.mesh),
            figure.triangles.to_string(),
            figure.accelerator.into(),
            figure.precision.into(),
            figure.measure.clone(),
            threads,
            figure.unit.into(),
            median.to_string(),
            min.to_string(),
            max.to_string(),
        ];
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

/// A cell of CSV.
pub(super) fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.into()
    }
}

/// A number with three significant digits.
pub fn short(x: f64) -> String {
    let digits = match x.abs() {
        99.95.. => 0,
        9.995.. => 1,
        0.9995.. => 2,
        0.0 => 0,
        small => ((2.0 - small.log10().floor()) as usize).min(9),
    };
    format!("{x:.digits$}")
}
