//! The result as charts.

use super::{Row, Tradeoff};
use crate::accel::Precision;
use crate::study::bench::{self, Rung};
use crate::study::plot::chart::{Chart, Guide, Mark, Point, Scale, Series, Sheet};
use crate::study::plot::color_of;
use crate::study::statistics::{Estimate, share_interval};

/// Colours that can be told apart on white and on black, also by those who confuse red and green.
const COLORS: [[u8; 3]; 9] = [
    [35, 35, 220],
    [222, 93, 20],
    [0, 140, 110],
    [190, 60, 140],
    [150, 120, 0],
    [90, 170, 220],
    [120, 80, 200],
    [120, 120, 128],
    [200, 40, 50],
];
const FRONT: [u8; 3] = [255, 205, 90];

impl Tradeoff {
    /// All charts on one sheet.
    pub fn sheet(&self) -> Sheet {
        let [width, height] = self.size;
        let heading = format!("pathtracer tradeoff {}", self.scene);
        let below = format!("{width} x {height} pixels, {} seeds; {}", self.seeds, self.machine.line());
        Sheet { heading: Some([heading, below]), charts: self.charts() }
    }

    /// Error against time; energy against bounces, if there are several limits; cost of a ray against leaks, if that was
    /// measured.
    pub fn charts(&self) -> Vec<Chart> {
        let mut charts = vec![self.error_chart()];
        charts.extend(self.energy_chart());
        charts.extend(self.rays.as_ref().filter(|rung| !rung.rows.is_empty()).map(rays_chart));
        charts
    }

    fn rows_of(&self, variant: usize) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| row.configuration.variant == variant)
    }

    fn error_chart(&self) -> Chart {
        let mut front: Vec<&Row> = self.rows.iter().filter(|row| row.on_front).collect();
        front.sort_by(|a, b| a.seconds.value.total_cmp(&b.seconds.value));
        let front = Series {
            name: "Pareto front".into(),
            color: FRONT,
            mark: Mark::None,
            line: 7,
            points: front.iter().map(|row| Point::bare(row.seconds.value, row.rel_mse.value)).collect(),
        };
        let variant = |variant: usize| Series {
            name: self.label(variant),
            color: COLORS[variant % COLORS.len()],
            mark: Mark::SHAPES[variant % Mark::SHAPES.len()],
            line: 1,
            points: self.rows_of(variant).map(|row| point(&row.seconds, &row.rel_mse)).collect(),
        };
        // The default is drawn last, above the others, and named first by the order of the legend alone.
        let series = std::iter::once(front).chain((0..self.variants.len()).map(variant)).collect();
        let base = &self.rows[0];
        let guide = |name: &str, power: f64| Guide {
            name: name.into(),
            power,
            through: [base.seconds.value, base.rel_mse.value],
        };
        Chart {
            title: "Error against time; bars: 95 % confidence".into(),
            labels: ["seconds of sampling".into(), "relMSE".into()],
            scales: [Scale::Log; 2],
            series,
            guides: vec![guide("relMSE ~ 1/t (RMSE ~ t^-1/2)", -1.0), guide("relMSE ~ t^-3/2", -1.5)],
        }
    }

    /// The mean of the picture beside the right one, of the variants that differ from the default by their bounces alone.
    fn energy_chart(&self) -> Option<Chart> {
        let base = &self.variants[0];
        let is_turned = |i: &usize| {
            let mut variant = self.variants[*i];
            variant.bounces = base.bounces;
            variant == *base
        };
        let mut points: Vec<Point> = (0..self.variants.len())
            .filter(is_turned)
            .filter_map(|i| {
                let bias = self.rows_of(i).last()?.bias;
                let exact = Estimate { value: 0.0, low: 0.0, high: 0.0, standard_error: 0.0 };
                let Estimate { value, low, high, .. } = bias.unwrap_or(exact);
                let percent = |bias: f64| 100.0 * (1.0 + bias);
                let x = f64::from(self.variants[i].bounces);
                Some(Point { at: [x, percent(value)], bars: [[x, x], [percent(low), percent(high)]] })
            })
            .collect();
        if points.len() < 2 {
            return None;
        }
        points.sort_by(|a, b| a.at[0].total_cmp(&b.at[0]));
        let beside =
            if self.has_reference { "the reference".into() } else { format!("{} bounces", base.bounces) };
        Some(Chart {
            title: "Energy against bounces: the light that the limit of bounces lets through; bars: 95 % confidence".into(),
            labels: ["bounces (longest path in segments)".into(), format!("% of the light of {beside}")],
            scales: [Scale::Log, Scale::Linear],
            series: vec![Series {
                name: "mean of the picture".into(),
                color: COLORS[0],
                mark: Mark::Disk,
                line: 1,
                points,
            }],
            guides: Vec::new(),
        })
    }
}

fn point(x: &Estimate, y: &Estimate) -> Point {
    Point { at: [x.value, y.value], bars: [[x.low, x.high], [y.low, y.high]] }
}

/// A ray's cost against the share that is lost.
fn rays_chart(rung: &Rung) -> Chart {
    let series = |row: &bench::Row| {
        let lost: u64 = row.leaks.iter().map(|leak| leak.lost).sum();
        let rays: u64 = row.leaks.iter().map(|leak| leak.rays).sum();
        let (low, high) = share_interval(lost, rays);
        // A logarithmic axis has no zero: none lost stands where half a ray would be.
        let least = 0.5 / rays.max(1) as f64;
        let share = (lost as f64 / rays.max(1) as f64).max(least);
        let mean = row.mean[0];
        let color = color_of(row.kind);
        Series {
            name: format!("{} {}{}", row.kind.accel_name(), row.kind.precision_name(), none(lost)),
            color: [color.0, color.1, color.2],
            mark: match row.kind.precision {
                Precision::Exact => Mark::Disk,
                Precision::Robust => Mark::Ring,
                Precision::Fast => Mark::Triangle,
            },
            line: 0,
            points: vec![Point {
                at: [share, 1e9 / mean.median],
                bars: [[low.max(least), high], [1e9 / mean.max, 1e9 / mean.min]],
            }],
        }
    };
    Chart {
        title: "Cost of a ray against leaks, by precision; bars: 95 % confidence, all rounds".into(),
        labels: [
            "share of rays lost at seams, corners and insides of the meshes (left end: none)".into(),
            "nanoseconds a ray, 1 thread".into(),
        ],
        scales: [Scale::Log, Scale::Linear],
        series: rung.rows.iter().map(series).collect(),
        guides: Vec::new(),
    }
}

fn none(lost: u64) -> &'static str {
    if lost == 0 { ": none lost" } else { "" }
}
