//! `pathtracer diff PICTURE REFERENCE`: how far are two pictures from each other?

use super::arguments::DiffArguments;
use super::compare::DIFFERENT;
use super::console::{printable, say};
use super::event;
use crate::error::Error;
use crate::output::same_file;
use crate::picture::{self, Destination};
use crate::study::difference::{Difference, Metrics, Worst};
use serde::Serialize;
use std::fmt::Write as _;
use std::io::{self, Write as _};

/// The comparison for `--json`.
#[derive(Serialize)]
struct Record<'r> {
    picture: String,
    reference: String,
    width: u32,
    height: u32,
    #[serde(flatten)]
    metrics: &'r Metrics,
    worst: &'r [Worst],
    /// The metrics above their limits.
    exceeded: Vec<&'static str>,
}

/// Compares and prints; returns the exit code.
pub(super) fn run(job: &DiffArguments) -> anyhow::Result<u8> {
    if let Some(output) = &job.output
        && let Some(input) = [&job.picture, &job.reference].into_iter().find(|input| same_file(input, output))
    {
        return Err(
            Error::Usage(format!("{} is compared: choose another name for -o", input.display())).into()
        );
    }
    let destination = job.output.as_deref().map(Destination::new).transpose()?;
    let [picture, reference] = [picture::read(&job.picture)?, picture::read(&job.reference)?];
    let difference = Difference::new(&picture, &reference)?;
    let (width, height) = (picture.width, picture.height);
    if let Some(destination) = &destination {
        destination.write(width, height, &difference.pixels(destination.depth()))?;
    }
    let metrics = &difference.metrics;
    // Written so that NaN exceeds every limit.
    let is_within = |&(name, limit): &(&str, f64)| metrics.get(name).is_some_and(|value| value <= limit);
    let exceeded: Vec<(&'static str, f64)> =
        job.fail_above.iter().filter(|limit| !is_within(limit)).copied().collect();
    let worst = difference.worst(job.worst);
    let names = [&job.picture, &job.reference].map(|path| path.to_string_lossy().into_owned());
    if job.json {
        let exceeded = exceeded.iter().map(|(name, _)| *name).collect();
        let [picture, reference] = names;
        event::emit(&Record { picture, reference, width, height, metrics, worst: &worst, exceeded });
    } else {
        let pixels = u64::from(width) * u64::from(height);
        let heading = format!("{} against {}: {width} x {height} pixels", names[0], names[1]);
        // A reader that has gone away does not change the answer.
        let _ = write!(io::stdout(), "{}\n{}", printable(&heading), report(metrics, pixels, &worst));
    }
    for (name, limit) in &exceeded {
        say(format_args!("error: {name} is {}, above {limit}", metrics.get(name).unwrap_or(f64::NAN)));
    }
    Ok(if exceeded.is_empty() { 0 } else { DIFFERENT })
}

fn report(metrics: &Metrics, pixels: u64, worst: &[Worst]) -> String {
    let Metrics { rmse, relmse, trelmse, bias, flip, max, differing, not_finite } = metrics;
    let mut text = format!(
        "rmse     {rmse:.6}\nrelmse   {relmse:.6}\ntrelmse  {trelmse:.6}\nbias     {:+.4} %\nflip     {flip:.6}\nmax      \
         {max:.6}\npixels that differ: {differing} of {pixels}\n",
        100.0 * bias
    );
    if *not_finite > 0 {
        let _ = writeln!(text, "pixels with NaN or infinity: {not_finite}");
    }
    if !worst.is_empty() {
        text.push_str("the worst pixels\n");
    }
    for Worst { x, y, error, picture, reference } in worst {
        let _ = writeln!(text, "  ({x}, {y})  {error:.6}  {picture:?} against {reference:?}");
    }
    text
}
