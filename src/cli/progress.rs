//! How a render goes on: a bar on a terminal, else a line now and then; events with `--json`.

use super::arguments::Job;
use super::console::{digits, duration, say, with_prefix};
use super::event::{self, Event, eta, per_second};
use super::interrupt;
use crate::render::{Progress, Watch};
use indicatif::{ProgressBar, ProgressStyle};
use std::env;
use std::io::{self, IsTerminal, Write};
use std::sync::Mutex;
use std::time::{Duration, Instant};

const REDRAW: Duration = Duration::from_millis(100);
const EVERY_EVENT: Duration = Duration::from_secs(1);
const EVERY_LINE: Duration = Duration::from_secs(10);
/// Of the bar.
const STEPS: u64 = 10_000;

/// Follows a render for the command line.
pub(super) struct Reporter {
    start: Instant,
    bar: Option<(ProgressBar, Pace)>,
    lines: Option<Pace>,
    events: Option<Pace>,
    /// Lines for Open Job Description.
    openjd: Option<Pace>,
    /// Whether the number of samples is limited.
    limited: bool,
}

impl Reporter {
    /// Begins to show a render.
    pub(super) fn new(job: &Job) -> Reporter {
        let start = Instant::now();
        let is_smart = io::stderr().is_terminal() && env::var_os("TERM").is_none_or(|term| term != "dumb");
        let bar = (!job.quiet && is_smart).then(|| (new_bar(), Pace::new(REDRAW, start)));
        let lines = (!job.quiet && !is_smart).then(|| Pace::new(EVERY_LINE, start));
        let events = job.json.then(|| Pace::new(EVERY_EVENT, start));
        let openjd = job.openjd.then(|| Pace::new(EVERY_EVENT, start));
        Reporter { start, bar, lines, events, openjd, limited: job.settings.samples > 0 }
    }

    /// Takes the bar away.
    pub(super) fn finish(&self) {
        if let Some((bar, _)) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Watch for Reporter {
    fn progress(&self, progress: &Progress) {
        let elapsed = self.start.elapsed();
        if let Some((bar, pace)) = &self.bar
            && pace.is_due()
        {
            bar.set_length(STEPS);
            bar.set_position((share(progress, elapsed) * STEPS as f64) as u64);
            bar.set_message(line(progress, elapsed));
        }
        if self.lines.as_ref().is_some_and(Pace::is_due) {
            say(line(progress, elapsed));
        }
        if self.events.as_ref().is_some_and(Pace::is_due) {
            event::emit(&Event::progress(progress, elapsed, self.limited));
        }
        if self.openjd.as_ref().is_some_and(Pace::is_due) {
            openjd("progress", &format!("{:.1}", 100.0 * share(progress, elapsed)));
            openjd("status", &line(progress, elapsed));
        }
    }

    fn cancelled(&self) -> bool {
        interrupt::exit_code().is_some()
    }
}

/// Prints a line that a session of Open Job Description understands.
pub(super) fn openjd(kind: &str, text: &str) {
    let text = text.replace(['\n', '\r'], " ");
    let mut stdout = io::stdout().lock();
    // A reader that has gone away does not stop the render.
    let _ = writeln!(stdout, "openjd_{kind}: {text}").and_then(|()| stdout.flush());
}

fn new_bar() -> ProgressBar {
    let bar = ProgressBar::new(1);
    if let Ok(style) = ProgressStyle::with_template("{msg} [{wide_bar}]") {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}

/// The share that is done: of the time where that is forecast, else of the samples.
fn share(progress: &Progress, elapsed: Duration) -> f64 {
    match progress.outlook.seconds_left {
        Some(left) => elapsed.as_secs_f64() / (elapsed.as_secs_f64() + left).max(f64::MIN_POSITIVE),
        None => progress.samples as f64 / progress.total.max(1) as f64,
    }
}

/// The share that is done is rounded down: 100 % is the end.
fn line(progress: &Progress, elapsed: Duration) -> String {
    let percent = (100.0 * share(progress, elapsed)) as u64;
    let rate = |count: u64| with_prefix(per_second(count as f64, elapsed.as_secs_f64()));
    let outlook = &progress.outlook;
    let error = match (outlook.error, outlook.error_at_end) {
        (Some(now), Some(end)) => {
            format!(", error {} %, {} % at the end", digits(100.0 * now, 2), digits(100.0 * end, 2))
        }
        _ => String::new(),
    };
    format!(
        "{percent:3} %, {} passed, ETA {}, {}samples/s, {}rays/s{error}",
        duration(elapsed),
        duration(eta(progress, elapsed)),
        rate(progress.samples),
        rate(progress.rays)
    )
}

/// Lets something happen once in a while.
struct Pace {
    every: Duration,
    last: Mutex<Instant>,
}

impl Pace {
    fn new(every: Duration, start: Instant) -> Pace {
        Pace { every, last: Mutex::new(start) }
    }

    /// Whether the time has come; true for one of the threads that ask. None of them waits.
    fn is_due(&self) -> bool {
        let Ok(mut last) = self.last.try_lock() else { return false };
        let is_due = last.elapsed() >= self.every;
        if is_due {
            *last = Instant::now();
        }
        is_due
    }
}
