//! A logarithmic axis with the labels that people expect: 1, 2, 5, 10.

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

/// Numbers > 0, equal ratios apart.
#[derive(Clone, Debug)]
pub(super) struct LogAxis {
    range: Range<f64>,
}

/// Over so many powers of ten only those are labelled.
const LONG: f64 = 2.5;

impl LogAxis {
    /// From a little below the smallest value to a little above the largest, at least a factor of ten; values that are not
    /// finite and > 0 don't count.
    pub(super) fn around(values: impl Iterator<Item = f64>) -> LogAxis {
        let (low, high) = values
            .filter(|value| value.is_finite() && *value > 0.0)
            .fold((f64::INFINITY, 0.0f64), |(low, high), value| (low.min(value), high.max(value)));
        if high == 0.0 {
            return LogAxis { range: 1.0..10.0 };
        }
        let widen = (10.0 / (high / low)).max(1.6).sqrt();
        LogAxis { range: low / widen..high * widen }
    }
}

impl Ranged for LogAxis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let share = (value / self.range.start).ln() / (self.range.end / self.range.start).ln();
        limit.0 + (f64::from(limit.1 - limit.0) * share).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        let (first, last) = (self.range.start.log10(), self.range.end.log10());
        let steps: &[f64] = if last - first > LONG { &[1.0] } else { &[1.0, 2.0, 5.0] };
        let powers = first.floor() as i32..=last.floor() as i32;
        let points = powers.flat_map(|power| steps.iter().map(move |step| step * 10f64.powi(power)));
        points.filter(|point| self.range.contains(point)).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

impl ValueFormatter<f64> for LogAxis {
    /// 2000 as `2k`.
    fn format_ext(&self, &value: &f64) -> String {
        let (scaled, suffix) = match value {
            1e6.. => (value / 1e6, "M"),
            1e3.. => (value / 1e3, "k"),
            _ => (value, ""),
        };
        // Without the noise of the product that made the tick.
        format!("{}{suffix}", (scaled * 1e6).round() / 1e6)
    }
}
