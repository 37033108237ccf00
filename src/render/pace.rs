//! `time`: how many samples still fit.

use std::time::{Duration, Instant};

/// Keeps a render within its time.
pub(super) struct Pace {
    start: Instant,
    deadline: Option<Instant>,
    /// Seconds for a sample of one pixel: in the last pass, and in all.
    last: f64,
    seconds: f64,
    samples: f64,
}

/// By how much a pass may take longer than the slower of what is known about passes.
const MARGIN: f64 = 1.05;
/// Seconds that a pass of more than one sample may take.
const LONGEST_PASS: f64 = 2.0;

impl Pace {
    pub(super) fn new(time: Option<Duration>) -> Pace {
        let start = Instant::now();
        let deadline = time.and_then(|time| start.checked_add(time));
        Pace { start, deadline, last: 0.0, seconds: 0.0, samples: 0.0 }
    }

    /// Goes on where another run was after so many seconds for so many samples.
    pub(super) fn resume(&mut self, seconds: f64, samples: f64) {
        (self.seconds, self.samples) = (seconds, samples);
    }

    /// The seconds and the samples of all passes.
    pub(super) fn passed(&self) -> [f64; 2] {
        [self.seconds, self.samples]
    }

    /// Seconds since the start.
    pub(super) fn elapsed(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Whether the time is up. The first pass is never cut off.
    pub(super) fn is_over(&self) -> bool {
        self.samples > 0.0 && self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// Seconds until the time is up.
    pub(super) fn left(&self) -> Option<f64> {
        self.deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()).as_secs_f64())
    }

    /// Seconds for a sample of one pixel, as far as is known.
    pub(super) fn seconds_per_sample(&self) -> Option<f64> {
        (self.samples > 0.0).then(|| self.last.max(self.seconds / self.samples))
    }

    /// How many of `wanted` samples of so many pixels fit: 0 if the time is up.
    pub(super) fn fitting(&self, wanted: u64, pixels: u64) -> u64 {
        match (self.left(), self.seconds_per_sample()) {
            (Some(left), Some(seconds)) => {
                let fit = left / (MARGIN * seconds * pixels.max(1) as f64);
                // Never more than wanted, so the conversion is exact enough; it truncates.
                wanted.min(fit as u64)
            }
            _ => wanted,
        }
    }

    /// How many of `wanted` > 0 samples of so many pixels a pass may take: a render that is interrupted loses it.
    pub(super) fn bearable(&self, wanted: u64, pixels: u64) -> u64 {
        let Some(seconds) = self.seconds_per_sample() else { return wanted };
        // As above, it truncates.
        wanted.min((LONGEST_PASS / (seconds * pixels.max(1) as f64)) as u64).max(1)
    }

    /// Learns what a pass of so many samples, of all pixels, took.
    pub(super) fn learn(&mut self, samples: u64, seconds: f64) {
        if samples > 0 {
            self.last = seconds / samples as f64;
            self.seconds += seconds;
            self.samples += samples as f64;
        }
    }
}
