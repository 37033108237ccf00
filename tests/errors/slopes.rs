//! How the error falls with the number of samples.

use super::scenes::Subject;
use pathtracer::math::Rgb;
use pathtracer::render::Settings;
use pathtracer::sampling::SamplerKind;

/// A floor under a large lamp, seen so that no edge is in the picture: direct light only, smooth in all dimensions.
const SMOOTH: &str = "\
Camera: { Position: [0, 0, 6], LookingAt: [0.5, 0.2, 0], Fov: 0.1, FocusDistance: 6 }
Environment: { SkyColor: [0, 0, 0], HorizonColor: [0, 0, 0], GroundColor: [0, 0, 0] }
Objects:
  - Object: { Type: Rectangle, Position: [0, 0, 0], Width: 100, Height: 100, Rotation: [0, 90, 0], Material: { Type: Diffuse, Color: [0.8, 0.6, 0.4] } }
  - Object: { Type: Rectangle, Position: [8, 0, 6], Width: 6, Height: 6, Rotation: [0, -60, 0], Material: { Type: Diffuse, EmissionStrength: 5 } }
";

/// Samples of the pictures whose errors are compared, and of the picture that is taken for the truth: its own error adds at
/// most a sixteenth to the last mean square, which moves the slope by 0.013 at most.
const SAMPLES: [u64; 4] = [16, 64, 256, 1024];
const TRUTH: u64 = 1 << 14;
const SEEDS: u64 = 16;
const SIZE: [u32; 2] = [12, 9];

fn picture(subject: &Subject, settings: Settings) -> Vec<Rgb> {
    subject.render(&settings).film.means().collect()
}

/// The slope of ln MSE over ln samples, by least squares.
fn slope(subject: &Subject, truth: &[Rgb], sampler: SamplerKind) -> f64 {
    let [width, height] = SIZE;
    let points = SAMPLES.map(|samples| {
        let squares = (0..SEEDS).map(|seed| {
            let settings = Settings::new(width, height, samples, 2);
            let settings = Settings { sampler, seed: seed + 1, ..settings };
            let error = |(x, truth): (Rgb, &Rgb)| (x - *truth).length_squared();
            picture(subject, settings).into_iter().zip(truth).map(error).sum::<f64>()
        });
        ((samples as f64).ln(), (squares.sum::<f64>() / (SEEDS * u64::from(width * height)) as f64).ln())
    });
    let count = points.len() as f64;
    let [x, y] = [points.map(|p| p.0), points.map(|p| p.1)].map(|values| values.iter().sum::<f64>() / count);
    let over: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    over / points.iter().map(|p| (p.0 - x) * (p.0 - x)).sum::<f64>()
}

/// 1728 squares of errors that are nearly normal have a mean that is right to sqrt(2 / 1728) = 3.4 %, which moves the slope
/// over four points a factor of 4 apart by 3.4 % / (ln 4 sqrt 5) = 0.011: the width of 0.05 is four of that.
#[test]
fn the_error_of_plain_monte_carlo_falls_with_slope_minus_one() {
    for (name, subject) in [("smooth", Subject::of_text(SMOOTH)), ("sky", Subject::new("sky"))] {
        let [width, height] = SIZE;
        let truth = picture(&subject, Settings::new(width, height, TRUTH, 2));
        let slope = slope(&subject, &truth, SamplerKind::Independent);
        assert!((slope + 1.0).abs() <= 0.05, "{name}: {slope}");
    }
}

#[test]
fn owen_scrambled_points_converge_faster_on_smooth_light() {
    let subject = Subject::of_text(SMOOTH);
    let [width, height] = SIZE;
    let truth = picture(&subject, Settings::new(width, height, TRUTH, 2));
    let [sobol, independent] =
        [SamplerKind::Sobol, SamplerKind::Independent].map(|sampler| slope(&subject, &truth, sampler));
    assert!(sobol <= independent - 0.15, "{sobol} against {independent}");
}
