//! `pathtracer diff PICTURE REFERENCE`, as it was typed.

use crate::study::difference::Metrics;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
#[command(
    override_usage = "pathtracer diff [OPTIONS] PICTURE REFERENCE",
    after_help = "The metrics: rmse; relmse, the mean of (x - ref)^2 / (ref^2 + 0.01); trelmse, the same without the worst 0.1 % \
                  of the pixels; bias of the mean; flip, the perceived difference from 0 to 1; max, the largest difference of \
                  a value. All but flip see linear light, without a limit.\n\
                  Exit codes: 0 done, 1 a picture can't be read or the sizes differ, 4 a metric exceeds its limit."
)]
pub(in crate::cli) struct DiffArguments {
    /// A picture
    #[arg(value_name = "PICTURE")]
    pub(in crate::cli) picture: PathBuf,
    /// The picture that it should be
    #[arg(value_name = "REFERENCE")]
    pub(in crate::cli) reference: PathBuf,
    /// Write the difference: FLIP from black to white as .png, absolute values as .exr
    #[arg(long, short, value_name = "FILE")]
    pub(in crate::cli) output: Option<PathBuf>,
    /// End with exit code 4 if a metric is above a limit, such as relmse=0.01; may be given several times
    #[arg(long, value_name = "METRIC=X", value_parser = limit)]
    pub(in crate::cli) fail_above: Vec<(&'static str, f64)>,
    /// How many of the worst pixels to print
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub(in crate::cli) worst: usize,
    /// Print one JSON object instead of words
    #[arg(long)]
    pub(in crate::cli) json: bool,
}

/// Parses a metric and its limit.
fn limit(text: &str) -> Result<(&'static str, f64), String> {
    let (name, number) = text.split_once('=').ok_or("expected METRIC=X, such as relmse=0.01")?;
    let name = name.to_lowercase();
    let name = Metrics::NAMES.into_iter().find(|known| *known == name);
    let name = name.ok_or_else(|| format!("unknown metric; known are {}", Metrics::NAMES.join(", ")))?;
    let number = number.parse().ok().filter(|number: &f64| *number >= 0.0);
    Ok((name, number.ok_or("expected a number >= 0 after the =")?))
}
