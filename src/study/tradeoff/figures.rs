//! The result as tables, CSV and JSON.

use super::grid::VariantRecord;
use super::{Row, Tradeoff};
use crate::study::bench::{Leak, Rung};
use crate::study::statistics::Estimate;
use crate::study::table::{Table, grouped, quoted, short};
use serde::Serialize;

/// One measured number of one configuration or variant.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Figure {
    /// The settings.
    #[serde(flatten)]
    pub variant: VariantRecord,
    /// Samples a pixel; none for what belongs to all of them.
    pub samples: Option<u64>,
    /// What it is, such as `seconds` or `rel_mse`.
    pub measure: &'static str,
    /// The unit.
    pub unit: &'static str,
    /// The number with its interval of 95 % confidence.
    #[serde(flatten)]
    pub value: Estimate,
}

impl Tradeoff {
    /// What a variant is called in tables: how it differs from the default.
    pub fn label(&self, variant: usize) -> String {
        self.variants[variant].difference(&self.variants[0])
    }

    /// Everything that was measured, but for rays.
    pub fn figures(&self) -> Vec<Figure> {
        let mut figures = Vec::new();
        for row in &self.rows {
            let variant = self.variants[row.configuration.variant].record();
            let samples = Some(row.configuration.samples);
            let certain = |value: f64| Estimate { value, low: value, high: value, standard_error: 0.0 };
            let front = certain(f64::from(u8::from(row.on_front)));
            let share = certain(row.front_share);
            let all = [
                ("seconds", "s", Some(row.seconds)),
                ("build_seconds", "s", Some(row.build_seconds)),
                ("mrays_per_second", "Mrays/s", Some(row.mrays)),
                ("mse", "radiance^2", Some(row.mse)),
                ("rel_mse", "1", Some(row.rel_mse)),
                ("trimmed_rel_mse", "1", Some(row.trimmed)),
                ("flip", "1", Some(row.flip)),
                ("energy", "radiance", Some(row.energy)),
                ("bias", "1", row.bias),
                ("relative_efficiency", "1", Some(row.efficiency)),
                ("on_pareto_front", "0 or 1", Some(front)),
                ("pareto_front_share", "1", Some(share)),
            ];
            figures.extend(all.into_iter().filter_map(|(measure, unit, value)| {
                Some(Figure { variant: variant.clone(), samples, measure, unit, value: value? })
            }));
        }
        figures.extend(self.convergence.iter().map(|convergence| Figure {
            variant: self.variants[convergence.variant].record(),
            samples: None,
            measure: "convergence",
            unit: "power of samples",
            value: convergence.slope,
        }));
        figures
    }

    /// The table of all configurations.
    pub fn table(&self) -> Table {
        let mut table = Table::new([
            "settings",
            "samples",
            "ms",
            "±",
            "Mrays/s",
            "MSE",
            "relMSE",
            "±",
            "trimmed",
            "FLIP",
            "bias %",
            "efficiency",
            "95 %",
            "front",
        ]);
        for row in &self.rows {
            table.push(self.cells(row));
        }
        table
    }

    fn cells(&self, row: &Row) -> Vec<String> {
        let percent = |estimate: &Estimate| format!("{:.0} %", 100.0 * estimate.relative());
        let bias = row.bias.map_or("-".into(), |bias| {
            let bias = bias.scaled(100.0);
            format!("{:.2} ± {:.2}", bias.value, 0.5 * (bias.high - bias.low))
        });
        let front = match (row.on_front, row.front_share) {
            (true, _) => format!("* {:.0} %", 100.0 * row.front_share),
            (false, 0.005..) => format!("{:.0} %", 100.0 * row.front_share),
            _ => String::new(),
        };
        vec![
            self.label(row.configuration.variant),
            grouped(row.configuration.samples),
            short(1e3 * row.seconds.value),
            percent(&row.seconds),
            short(row.mrays.value),
            small(row.mse.value),
            small(row.rel_mse.value),
            percent(&row.rel_mse),
            small(row.trimmed.value),
            format!("{:.4}", row.flip.value),
            bias,
            format!("{:.2}", row.efficiency.value),
            format!("{:.2} - {:.2}", row.efficiency.low, row.efficiency.high),
            front,
        ]
    }

    /// How every variant converges; `None` with a single number of samples.
    pub fn convergence_table(&self) -> Option<Table> {
        if self.convergence.is_empty() {
            return None;
        }
        let mut table = Table::new(["relMSE falls as samples ^", "", "95 %"]);
        for convergence in &self.convergence {
            let Estimate { value, low, high, .. } = convergence.slope;
            table.push([
                self.label(convergence.variant),
                format!("{value:.2}"),
                format!("{low:.2} to {high:.2}"),
            ]);
        }
        Some(table)
    }

    /// What a ray costs and how many are lost.
    pub fn rays_table(&self) -> Option<Table> {
        let rung = self.rays.as_ref()?;
        let mut headings: Vec<String> = ["rays, 1 thread", "ns/ray", "min - max"].map(Into::into).into();
        headings.extend(
            aims(rung).iter().map(|leak| format!("lost at {} of {}", leak.aim.name(), grouped(leak.rays))),
        );
        let mut table = Table::new(headings);
        for row in &rung.rows {
            let nanoseconds = |rate: f64| format!("{:.0}", 1e9 / rate);
            let mean = row.mean[0];
            let mut cells = vec![
                format!("{} {}", row.kind.accel_name(), row.kind.precision_name()),
                nanoseconds(mean.median),
                format!("{} - {}", nanoseconds(mean.max), nanoseconds(mean.min)),
            ];
            cells.extend(row.leaks.iter().map(|leak| grouped(leak.lost)));
            table.push(cells);
        }
        Some(table)
    }

    /// The last line: the cheapest settings for the wanted error.
    pub fn recommendation_line(&self) -> String {
        let target = self.target;
        let [width, height] = self.size;
        let Some(chosen) = &self.recommendation else {
            return format!(
                "for relMSE {target}: none of these settings reaches it; their bias alone is more"
            );
        };
        let variant = &self.variants[chosen.variant];
        let Estimate { value, low, high, .. } = chosen.seconds;
        let beyond = if chosen.extrapolated { ", extrapolated" } else { "" };
        format!(
            "for relMSE {target}: {}, {}: {} s at {width} x {height} (95 %: {} to {} s{beyond})",
            variant.name(),
            crate::study::table::counted(chosen.samples, "sample"),
            short(value),
            short(low),
            short(high),
        )
    }

    /// The command that renders with the recommended settings.
    pub fn recommended_command(&self) -> Option<String> {
        let chosen = self.recommendation.as_ref()?;
        let variant = &self.variants[chosen.variant];
        let [width, height] = self.size;
        Some(format!(
            "pathtracer {} {width} {height} {} {} IMAGE{}",
            self.scene,
            chosen.samples,
            variant.bounces,
            variant.options()
        ))
    }
}

/// What lost rays were aimed at.
fn aims(rung: &Rung) -> &[Leak] {
    rung.rows.first().map_or(&[], |row| &row.leaks)
}

/// The figures as CSV (RFC 4180, lines ended by a line feed), with a line of headings.
pub fn csv(figures: &[Figure]) -> String {
    let mut text =
        "accelerator,precision,sampler,light_sampling,bounces,clamp,noise,denoise,samples,measure,unit,value,low,high,\
                    standard_error\n"
            .to_owned();
    let optional = |value: Option<String>| value.unwrap_or_default();
    for Figure { variant, samples, measure, unit, value } in figures {
        let cells = [
            variant.accelerator.into(),
            variant.precision.into(),
            variant.sampler.into(),
            variant.light_sampling.to_string(),
            variant.bounces.to_string(),
            optional(variant.clamp.map(|limit| limit.to_string())),
            optional(variant.noise.map(|target| target.to_string())),
            variant.denoise.to_string(),
            optional(samples.map(|samples| samples.to_string())),
            (*measure).into(),
            quoted(unit),
            value.value.to_string(),
            value.low.to_string(),
            value.high.to_string(),
            value.standard_error.to_string(),
        ];
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

/// A number of any size with three digits.
pub fn small(x: f64) -> String {
    if x == 0.0 || x.abs() >= 1e-3 { short(x) } else { format!("{x:.2e}") }
}
