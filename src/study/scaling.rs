//! How the cost of a sample grows: with threads, with the size of the picture, with triangles and with lights.
//!
//! A sample is a path; its cost is the seconds of sampling of a whole render, without load and build, divided by the
//! samples. All sizes of a kind take turns, so that whatever else the machine does hits all alike.

mod scenes;

use super::plot::chart::{Chart, Guide, Mark, Point, Scale, Series, Sheet};
use super::rounds::{Spread, interleaved};
use super::statistics::slope;
use super::table::{Table, grouped, short};
use crate::accel::Isa;
use crate::error::Result;
use crate::output::linear_floats;
use crate::render::{Rendered, Settings, Unwatched, render};
use crate::scene::desc::SceneDesc;
use crate::study::metrics::relative_weight;
use crate::world::World;
use serde::Serialize;

/// How to measure.
#[derive(Clone, Debug)]
pub struct Options {
    /// The most instructions to use, or `None` for the machine's best.
    pub isa: Option<Isa>,
    /// The most threads, and those of all kinds but [`Kind::Threads`].
    pub threads: usize,
    /// How often everything is rendered, at least 2.
    pub rounds: usize,
    /// Seed of the scenes.
    pub seed: u64,
    /// Small pictures and scenes.
    pub quick: bool,
}

/// What grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Threads of a render.
    Threads,
    /// Pixels of the picture.
    Pixels,
    /// Triangles of a mesh.
    Triangles,
    /// Triangles of a mesh that shines.
    ShiningTriangles,
    /// Balls that shine.
    ShiningBalls,
}

impl Kind {
    /// In the order in which they are measured.
    pub const ALL: [Kind; 5] =
        [Kind::Threads, Kind::Pixels, Kind::Triangles, Kind::ShiningTriangles, Kind::ShiningBalls];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Threads => "threads",
            Kind::Pixels => "pixels",
            Kind::Triangles => "triangles",
            Kind::ShiningTriangles => "shining triangles of one mesh",
            Kind::ShiningBalls => "shining balls",
        }
    }
}

/// One size.
#[derive(Clone, Debug, Serialize)]
pub struct Step {
    /// How many of what grows.
    pub size: u64,
    /// Nanoseconds a sample, of all threads together: less with more threads.
    pub nanoseconds: Spread,
    /// The relMSE of one sample a pixel, by the variance across the rounds.
    pub error: f64,
}

/// How the cost grows with one thing.
#[derive(Clone, Debug, Serialize)]
pub struct Growth {
    /// With what.
    pub kind: Kind,
    /// Ascending by size.
    pub steps: Vec<Step>,
}

impl Growth {
    /// The power of the size with which the cost grows, over all sizes and from the last but one to the last. A logarithm has
    /// a power that falls to 0: log n grows as n^(1 / ln n), which is 0.09 at 100,000.
    pub fn powers(&self) -> [f64; 2] {
        let points = |steps: &[Step]| {
            let point = |step: &Step| ((step.size as f64).ln(), step.nanoseconds.median.ln());
            slope(steps.iter().map(point).collect::<Vec<(f64, f64)>>().into_iter())
        };
        [points(&self.steps), points(&self.steps[self.steps.len().saturating_sub(2)..])]
    }

    /// How many times as fast the last size is as the first.
    pub fn speedup(&self) -> f64 {
        match (self.steps.first(), self.steps.last()) {
            (Some(first), Some(last)) => first.nanoseconds.median / last.nanoseconds.median,
            _ => 1.0,
        }
    }

    /// The steps as a table.
    pub fn table(&self) -> Table {
        let mut table = Table::new([self.kind.name(), "ns/sample", "min - max", "relMSE of a sample"]);
        for Step { size, nanoseconds, error } in &self.steps {
            table.push([
                grouped(*size),
                short(nanoseconds.median),
                format!("{} - {}", short(nanoseconds.min), short(nanoseconds.max)),
                short(*error),
            ]);
        }
        table
    }

    /// In a sentence.
    pub fn verdict(&self) -> String {
        let name = self.kind.name();
        if self.kind == Kind::Threads {
            let threads = self.steps.last().map_or(1, |step| step.size);
            return format!("{threads} threads are {:.2} times as fast as one", self.speedup());
        }
        let [all, last] = self.powers();
        format!("a sample costs {name} ^ {all:.3} over all sizes, ^ {last:.3} over the last step")
    }
}

/// A size before it is measured.
struct Subject {
    size: u64,
    world: World,
    desc: SceneDesc,
    settings: Settings,
    pictures: Vec<Vec<f32>>,
}

/// Measures one kind of growth.
///
/// # Errors
/// What a render may fail with.
pub fn run(kind: Kind, options: &Options) -> Result<Growth> {
    let mut subjects = subjects(kind, options)?;
    let mut failure = None;
    let seconds = interleaved(options.rounds, &mut subjects, |subject| {
        let settings = Settings { seed: subject.pictures.len() as u64, ..subject.settings.clone() };
        match render(&subject.world, &subject.desc.camera, &settings, &Unwatched) {
            Ok(rendered) => {
                subject.pictures.push(linear_floats(&rendered.film));
                nanoseconds(&rendered)
            }
            Err(error) => {
                failure = Some(error);
                f64::NAN
            }
        }
    });
    if let Some(error) = failure {
        return Err(error);
    }
    let step = |(subject, values): (&Subject, Vec<f64>)| Step {
        size: subject.size,
        nanoseconds: Spread::of(&values),
        error: error(&subject.pictures) * subject.settings.samples as f64,
    };
    Ok(Growth { kind, steps: subjects.iter().zip(seconds).map(step).collect() })
}

fn nanoseconds(rendered: &Rendered) -> f64 {
    1e9 * rendered.render_seconds / rendered.samples().max(1.0)
}

/// The relative variance across pictures of one scene.
fn error(pictures: &[Vec<f32>]) -> f64 {
    let n = pictures.len() as f64;
    let values = pictures[0].len();
    let of_value = |i: usize| {
        let mean = pictures.iter().map(|picture| f64::from(picture[i])).sum::<f64>() / n;
        let squares = pictures.iter().map(|picture| (f64::from(picture[i]) - mean).powi(2)).sum::<f64>();
        squares / (n - 1.0) * relative_weight(mean)
    };
    (0..values).map(of_value).sum::<f64>() / values as f64
}

/// The sizes of a kind with their scenes.
fn subjects(kind: Kind, options: &Options) -> Result<Vec<Subject>> {
    let Options { threads, seed, quick, .. } = *options;
    let side = if quick { 4 } else { 1 };
    let frame = [320 / side, 180 / side];
    let settings = |[width, height]: [u32; 2], samples: u64, threads: usize| Settings {
        threads: Some(threads),
        isa: options.isa,
        ..Settings::new(width, height, samples, 4)
    };
    let scan = |triangles: usize| scenes::scan(triangles, seed);
    let scan_of_all = if quick { 2000 } else { 100_000 };
    let powers = |most: usize| {
        let most = if quick { most / 100 } else { most };
        std::iter::successors(Some(1usize), |n| n.checked_mul(10)).take_while(move |&n| n <= most)
    };
    let grown = |sizes: Vec<usize>, make: &dyn Fn(usize) -> Result<SceneDesc>| {
        let of = |n: usize| subject(n as u64, make(n)?, settings(frame, 4, threads));
        sizes.into_iter().map(of).collect::<Result<Vec<Subject>>>()
    };
    match kind {
        Kind::Threads => {
            let counts = std::iter::successors(Some(1), |n| Some(2 * n)).take_while(|&n| n <= threads);
            let of = |n: usize| subject(n as u64, scan(scan_of_all)?, settings(frame, 8, n));
            counts.map(of).collect()
        }
        Kind::Pixels => {
            let of = |step: u32| {
                let [width, height] = [32 << step, 18 << step].map(|side: u32| side);
                // As many samples in all, so that what a render costs by itself weighs alike.
                let most = if quick { 2 } else { 5 };
                let samples = 4u64.pow(most - step).max(1);
                let pixels = u64::from(width) * u64::from(height);
                subject(pixels, scan(scan_of_all)?, settings([width, height], samples, threads))
            };
            (0..=if quick { 2 } else { 5 }).map(of).collect()
        }
        Kind::Triangles => grown(powers(1_000_000).filter(|&n| n >= 100).collect(), &scan),
        Kind::ShiningTriangles => grown(powers(100_000).collect(), &|n| scenes::shining_triangles(n, seed)),
        Kind::ShiningBalls => grown(powers(10_000).collect(), &|n| scenes::shining_balls(n, seed)),
    }
}

fn subject(size: u64, desc: SceneDesc, settings: Settings) -> Result<Subject> {
    Ok(Subject { size, world: World::compile(&desc)?, desc, settings, pictures: Vec::new() })
}

/// All growths as charts.
pub fn sheet(growths: &[Growth], heading: [String; 2]) -> Sheet {
    let of = |kind: Kind| growths.iter().find(move |growth| growth.kind == kind);
    let costs: [(&str, &[Kind]); 4] = [
        ("Samples on more threads", &[Kind::Threads]),
        ("The cost of a sample in larger pictures", &[Kind::Pixels]),
        ("The cost of a sample with more triangles", &[Kind::Triangles]),
        ("The cost of a sample with more lights", &[Kind::ShiningTriangles, Kind::ShiningBalls]),
    ];
    let cost = |step: &Step| step.nanoseconds;
    let error = |step: &Step| Spread { median: step.error, min: step.error, max: step.error };
    let mut charts: Vec<Chart> = costs
        .iter()
        .filter_map(|(title, kinds)| {
            let growths: Vec<&Growth> = kinds.iter().filter_map(|&kind| of(kind)).collect();
            chart(title, "nanoseconds a sample", &growths, &cost)
        })
        .collect();
    let lights = [Kind::ShiningTriangles, Kind::ShiningBalls];
    let lights: Vec<&Growth> = lights.iter().filter_map(|&kind| of(kind)).collect();
    charts.extend(chart("The noise of a sample with more lights", "relMSE of a sample", &lights, &error));
    Sheet { heading: Some(heading), charts }
}

fn chart(title: &str, label: &str, growths: &[&Growth], value: &dyn Fn(&Step) -> Spread) -> Option<Chart> {
    let first = growths.first()?;
    let styles = [([35, 35, 220], Mark::Disk), ([222, 93, 20], Mark::Square)];
    let series = growths.iter().zip(styles).map(|(growth, (color, mark))| {
        let point = |step: &Step| {
            let (x, Spread { median, min, max }) = (step.size as f64, value(step));
            Point { at: [x, median], bars: [[x, x], [min, max]] }
        };
        let points = growth.steps.iter().map(point).collect();
        Series { name: growth.kind.name().into(), color, mark, line: 1, points }
    });
    let guide = |step: &Step| Guide {
        name: "half with twice as many".into(),
        power: -1.0,
        through: [step.size as f64, value(step).median],
    };
    let is_threads = first.kind == Kind::Threads;
    Some(Chart {
        title: format!("{title}; bars: all rounds"),
        labels: [if growths.len() == 1 { first.kind.name() } else { "lights" }.into(), label.into()],
        scales: [Scale::Log; 2],
        series: series.collect(),
        guides: first.steps.first().filter(|_| is_threads).map(guide).into_iter().collect(),
    })
}

/// All growths as CSV (RFC 4180, lines ended by a line feed), with a line of headings.
pub fn csv(growths: &[Growth]) -> String {
    let mut text = "kind,size,nanoseconds_per_sample,min,max,rel_mse_of_a_sample\n".to_owned();
    for growth in growths {
        for Step { size, nanoseconds: Spread { median, min, max }, error } in &growth.steps {
            text += &format!("{},{size},{median},{min},{max},{error}\n", growth.kind.name());
        }
    }
    text
}
