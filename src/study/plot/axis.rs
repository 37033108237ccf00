//! Axes for any chart: logarithmic or linear.

use super::log_axis::LogAxis;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

/// How values lie on an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal ratios apart.
    Log,
    /// Equal differences apart.
    Linear,
}

#[derive(Clone, Debug)]
pub(super) enum Axis {
    Log(LogAxis),
    Linear(Range<f64>),
}

impl Axis {
    /// Around values; those that are not finite, and on a logarithmic axis those that are not > 0, don't count.
    pub(super) fn around(scale: Scale, values: impl Iterator<Item = f64>) -> Axis {
        if scale == Scale::Log {
            return Axis::Log(LogAxis::around(values));
        }
        let (low, high) = values
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            return Axis::Linear(0.0..1.0);
        }
        let margin = if high > low { 0.08 * (high - low) } else { 0.05 * high.abs().max(1e-9) };
        Axis::Linear(low - margin..high + margin)
    }

    pub(super) fn contains(&self, value: f64) -> bool {
        self.range().contains(&value)
    }

    /// Whole multiples of 1, 2 or 5 times a power of ten, a handful of them.
    fn linear_ticks(range: &Range<f64>) -> Vec<f64> {
        const WANTED: f64 = 6.0;
        let raw = (range.end - range.start) / WANTED;
        let power = 10f64.powf(raw.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|step| step * power).into_iter().find(|&step| step >= raw);
        let step = step.unwrap_or(10.0 * power);
        let (first, last) = ((range.start / step).ceil() as i64, (range.end / step).floor() as i64);
        (first..=last).map(|i| i as f64 * step).collect()
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        match self {
            Axis::Log(axis) => axis.map(value, limit),
            Axis::Linear(range) => {
                let share = (value - range.start) / (range.end - range.start);
                limit.0 + (f64::from(limit.1 - limit.0) * share).round() as i32
            }
        }
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        match self {
            Axis::Log(axis) => axis.key_points(hint),
            Axis::Linear(range) => Axis::linear_ticks(range),
        }
    }

    fn range(&self) -> Range<f64> {
        match self {
            Axis::Log(axis) => axis.range(),
            Axis::Linear(range) => range.clone(),
        }
    }
}

impl ValueFormatter<f64> for Axis {
    /// 2000 as `2k`, 0.0001 as `1e-4`.
    fn format_ext(&self, &value: &f64) -> String {
        match value.abs() {
            small if small > 0.0 && small < 0.999e-3 => {
                let digits = format!("{value:.1e}");
                digits.replace(".0e", "e")
            }
            1e6.. => format!("{}M", rounded(value / 1e6)),
            1e3.. => format!("{}k", rounded(value / 1e3)),
            _ => rounded(value),
        }
    }
}

/// Without the noise of the product that made the tick.
fn rounded(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6)
}
