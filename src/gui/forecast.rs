//! What a render costs and where it leads, in words.

use super::session::Status;
use super::settings::Knobs;
use crate::cli::console::{digits, duration, with_prefix};
use crate::render::Settings;
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

/// When the render ends and how noisy it will be; of a preview, how long the final render would take to the noise target, and
/// what error it would have within its time. Errors fall with the root of the samples, at least.
pub fn forecasts(status: &Status, settings: &Settings, knobs: &Knobs) -> Vec<String> {
    let outlook = &status.outlook;
    let time = |seconds: f64| duration(Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
    let percent = |error: f64| digits(100.0 * error, 2);
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
    let pixels = |width: u32, height: u32| f64::from(width) * f64::from(height);
    let larger = pixels(knobs.width, knobs.height) / pixels(settings.width, settings.height);
    let Some(error) = outlook.error.filter(|_| status.seconds > 0.0) else { return texts };
    let spent = status.seconds * larger;
    if let Some(target) = knobs.noise {
        let factor = (error / target) * (error / target);
        texts.push(format!("final: {} % after about {}", percent(target), time(spent * factor)));
    }
    if let Some(budget) = knobs.time {
        texts.push(format!("final: {} % after {}", percent(error * (spent / budget).sqrt()), time(budget)));
    }
    if knobs.noise.is_none() && knobs.time.is_none() && knobs.samples > 0 && status.samples > 0 {
        let all = knobs.samples as f64 * pixels(knobs.width, knobs.height);
        texts.push(format!("final: about {}", time(status.seconds * all / status.samples as f64)));
    }
    texts
}
