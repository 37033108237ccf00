//! What a render costs and where it leads, in words.

use super::session::{BlockErrors, Status};
use super::settings::Knobs;
use crate::cli::console::{digits, duration, with_prefix};
use crate::render::{NOISE_AFTER, Settings};
use std::time::Duration;

/// The share that is done.
pub fn share(status: &Status) -> f64 {
    match status.outlook.seconds_left {
        Some(left) if status.is_final => status.seconds / (status.seconds + left).max(f64::MIN_POSITIVE),
        _ => status.samples as f64 / status.total.max(1) as f64,
    }
}

/// Rays and samples a second, the error now.
pub fn costs(status: &Status) -> Vec<String> {
    let mut texts = Vec::new();
    if status.seconds > 0.0 {
        let rate = |count: u64| with_prefix(count as f64 / status.seconds);
        texts.push(format!("{}rays/s, {}samples/s", rate(status.rays), rate(status.samples)));
    }
    if let Some(error) = status.outlook.error {
        texts.push(format!("error {} %", digits(100.0 * error, 2)));
    }
    texts
}

/// The powers of the number of samples with which errors fall: at best, and of plain Monte Carlo.
const SLOPES: [f64; 2] = [0.75, 0.5];

/// When the render ends and how noisy it will be; of a preview, between which times the final render would reach the noise
/// target in every block, and what error it would have within its time.
pub fn forecasts(
    status: &Status,
    settings: &Settings,
    blocks: Option<&BlockErrors>,
    knobs: &Knobs,
) -> Vec<String> {
    let outlook = &status.outlook;
    let mut texts = Vec::new();
    if status.is_busy()
        && let Some(left) = outlook.seconds_left
    {
        texts.push(format!("{} left", time(left)));
    }
    if status.is_final {
        if let Some(error) = outlook.error_at_end.filter(|_| status.is_busy()) {
            texts.push(format!("{} % at the end", percent(error)));
        }
        return texts;
    }
    if status.samples == 0 || status.seconds <= 0.0 {
        return texts;
    }
    let pixels = |width: u32, height: u32| f64::from(width) * f64::from(height);
    let all = pixels(knobs.width, knobs.height);
    let per_sample = status.seconds / status.samples as f64;
    // With fewer samples, dark pixels have not met their light yet.
    let blocks = blocks.filter(|blocks| blocks.samples >= NOISE_AFTER);
    if let (Some(target), Some(blocks)) = (knobs.noise, blocks) {
        texts.push(of_target(blocks, target, knobs.samples, |samples| samples * all * per_sample));
    }
    if let (Some(budget), Some(error)) = (knobs.time, outlook.error) {
        let spent = status.seconds * all / pixels(settings.width, settings.height);
        texts.push(format!("final: {} % after {}", percent(error * (spent / budget).sqrt()), time(budget)));
    }
    if knobs.noise.is_none() && knobs.time.is_none() && knobs.samples > 0 {
        texts.push(format!("final: about {}", time(per_sample * knobs.samples as f64 * all)));
    }
    texts
}

/// When every block will have reached a target, or that not all will; `seconds` of so many samples a pixel.
fn of_target(blocks: &BlockErrors, target: f64, most: u64, seconds: impl Fn(f64) -> f64) -> String {
    let limited = samples_to(blocks, target, most);
    let [least, longest] = limited.map(|samples| time(seconds(samples)));
    let [may, will] = [0, 1].map(|end| limited[end] == samples_to(blocks, target, 0)[end]);
    let percent = percent(target);
    if !may {
        return format!("final: {percent} % not in every block with {most} samples, after {longest}");
    }
    let whether = if will { "" } else { "perhaps " };
    let when = if least == longest { least } else { format!("{least} to {longest}") };
    format!("final: {percent} % {whether}in every block after {when}")
}

/// Between which numbers of samples a pixel, on average, all blocks will have reached a target, if each takes at most `most`
/// (0: no limit). Blocks that are far from it take long, and all take some.
pub fn samples_to(blocks: &BlockErrors, target: f64, most: u64) -> [f64; 2] {
    let most = if most == 0 { f64::INFINITY } else { most as f64 };
    let of = |slope: f64, square: f64| {
        let factor = libm::pow(square / (target * target), 0.5 / slope);
        (factor * blocks.samples as f64).max(NOISE_AFTER as f64).min(most)
    };
    let pixels: f64 = blocks.squares.iter().map(|(_, pixels)| pixels).sum();
    let mean = |slope| {
        blocks.squares.iter().map(|(square, pixels)| pixels * of(slope, *square)).sum::<f64>() / pixels
    };
    let [a, b] = SLOPES.map(mean);
    [a.min(b), a.max(b)]
}

fn time(seconds: f64) -> String {
    duration(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX))
}

fn percent(error: f64) -> String {
    digits(100.0 * error, 2)
}
