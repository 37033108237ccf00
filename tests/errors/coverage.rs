//! How often the intervals hold the truth, on real scenes.

use super::scenes::Subject;
use crate::support::stats::Moments;
use pathtracer::film::ErrorBar;
use pathtracer::render::Settings;
use pathtracer::sampling::SamplerKind;

/// Relative errors below this are rounding, not noise: sums are kept in f32.
const NOISE: f64 = 1e-5;

/// Intervals, and how many of them hold the truth.
#[derive(Clone, Copy, Default)]
struct Held {
    held: u64,
    all: u64,
}

impl Held {
    fn add(&mut self, holds: bool) {
        self.held += u64::from(holds);
        self.all += 1;
    }

    fn percent(self) -> f64 {
        100.0 * self.held as f64 / self.all as f64
    }
}

/// Of the bars that are doubtful and of the others.
#[derive(Clone, Copy, Default)]
struct Coverage {
    sure: Held,
    doubtful: Held,
}

impl Coverage {
    fn all(self) -> Held {
        Held { held: self.sure.held + self.doubtful.held, all: self.sure.all + self.doubtful.all }
    }

    fn doubtful_percent(self) -> f64 {
        100.0 * self.doubtful.all as f64 / self.all().all as f64
    }
}

/// The pixels' bars at 1024 samples and so many seeds.
///
/// The truth is the mean over all seeds: a pixel's distance from it has 1 - 1 / seeds of the variance of its distance from
/// the truth.
fn pixels(subject: &Subject, sampler: SamplerKind, seeds: u64) -> Coverage {
    let (width, height) = (24, 18);
    let bars: Vec<Vec<ErrorBar>> = (0..seeds)
        .map(|seed| {
            let settings = Settings { sampler, seed, ..Settings::new(width, height, 1024, 8) };
            let film = subject.render(&settings).film;
            (0..(width * height) as usize).map(|pixel| film.error_bar(pixel).expect("8 scrambles")).collect()
        })
        .collect();
    let shrunk = (1.0 - 1.0 / seeds as f64).sqrt();
    let mut coverage = Coverage::default();
    for pixel in 0..(width * height) as usize {
        let bars: Vec<ErrorBar> = bars.iter().map(|bars| bars[pixel]).collect();
        let truth = Moments::of(bars.iter().map(|bar| bar.mean)).mean();
        for bar in bars.iter().filter(|bar| bar.standard_error > NOISE * bar.mean) {
            let held = if bar.is_doubtful { &mut coverage.doubtful } else { &mut coverage.sure };
            held.add((bar.mean - truth).abs() <= shrunk * bar.half_width());
        }
    }
    coverage
}

/// The mean of the picture at so many samples and seeds.
fn means(subject: &Subject, settings: &Settings, seeds: u64) -> Coverage {
    let errors: Vec<_> = (0..seeds)
        .map(|seed| subject.render(&Settings { seed, ..settings.clone() }).error.expect("an estimate"))
        .collect();
    let truth = Moments::of(errors.iter().map(|error| error.mean.value)).mean();
    let shrunk = (1.0 - 1.0 / seeds as f64).sqrt();
    let mut coverage = Coverage::default();
    for error in errors {
        let held = if error.is_doubtful { &mut coverage.doubtful } else { &mut coverage.sure };
        held.add((error.mean.value - truth).abs() <= shrunk * (error.mean.high - error.mean.value));
    }
    coverage
}

/// How the mean of the picture is asked for: by a few pixels, as by default; by eight scrambles of the film.
fn ways() -> [(&'static str, Settings); 3] {
    let few = Settings { error_estimate: true, ..Settings::new(32, 24, 64, 8) };
    let independent = Settings { sampler: SamplerKind::Independent, ..few.clone() };
    let short = Settings { scramble_length: Some(2), ..few.clone() };
    [("few pixels", few), ("8 scrambles, sobol", short), ("8 scrambles, independent", independent)]
}

/// 4 standard deviations of a binomial share around 95 %.
fn allowed(count: u64) -> f64 {
    400.0 * (0.95 * 0.05 / count as f64).sqrt()
}

#[test]
fn bars_of_pixels_hold_the_truth_in_19_of_20_without_caustics() {
    for name in ["A", "sky"] {
        for sampler in SamplerKind::ALL {
            let coverage = pixels(&Subject::new(name), sampler, 4).all();
            // Four seeds of 432 pixels. The seeds' mean is the truth of all four, so a pixel counts as three; beside the
            // chance, 93 to 97 % is what the bars promise.
            let range = 93.0 - allowed(coverage.all * 3 / 4)..97.0 + allowed(coverage.all * 3 / 4);
            assert!(range.contains(&coverage.percent()), "{name}, {sampler}: {} %", coverage.percent());
        }
    }
}

/// The seeds together have 2^16 samples, whose mean is the truth.
#[test]
#[ignore = "long: 64 seeds"]
fn bars_of_64_seeds_hold_the_truth_in_93_to_97_of_100_without_caustics() {
    for name in ["A", "sky"] {
        for sampler in SamplerKind::ALL {
            let percent = pixels(&Subject::new(name), sampler, 64).all().percent();
            assert!((93.0..=97.0).contains(&percent), "{name}, {sampler}: {percent} %");
        }
    }
}

#[test]
#[ignore = "long: 200 seeds of every scene"]
fn intervals_of_pictures_hold_the_truth_in_93_to_97_of_100() {
    let [(_, few), ..] = ways();
    for name in super::scenes::NAMES {
        let coverage = means(&Subject::new(name), &few, 200).all();
        // Beside the chance, 93 to 97 % is what the intervals promise.
        let range = 93.0 - allowed(200)..97.0 + allowed(200);
        assert!(range.contains(&coverage.percent()), "{name}: {} %", coverage.percent());
    }
}

#[test]
#[ignore = "a table: minutes"]
fn table_of_pixels() {
    println!("scene, sampler: all; sure; doubtful (share)");
    for name in super::scenes::NAMES {
        for sampler in SamplerKind::ALL {
            let coverage = pixels(&Subject::new(name), sampler, 32);
            println!(
                "{name}, {sampler}: {:.1} %; {:.1} %; {:.1} % ({:.1} %)",
                coverage.all().percent(),
                coverage.sure.percent(),
                coverage.doubtful.percent(),
                coverage.doubtful_percent()
            );
        }
    }
}

#[test]
#[ignore = "a table: minutes"]
fn table_of_pictures() {
    println!("scene, way: all; sure; doubtful (share)");
    for name in super::scenes::NAMES {
        for (way, settings) in ways() {
            let coverage = means(&Subject::new(name), &settings, 200);
            println!(
                "{name}, {way}: {:.1} %; {:.1} %; {:.1} % ({:.1} %)",
                coverage.all().percent(),
                coverage.sure.percent(),
                coverage.doubtful.percent(),
                coverage.doubtful_percent()
            );
        }
    }
}
