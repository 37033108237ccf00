//! What is known about the error of a render under way, and where it leads.

/// The error now and at the end, and the time until then.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outlook {
    /// The estimated relative error so far, as [`PictureError::relative`](crate::film::PictureError::relative).
    pub error: Option<f64>,
    /// What is expected of it at the end.
    pub error_at_end: Option<f64>,
    /// Seconds until the end; `None` where it goes by the share of samples taken.
    pub seconds_left: Option<f64>,
}

/// Errors at growing numbers of samples.
#[derive(Default)]
pub(super) struct History {
    /// Logarithms of samples and error.
    points: Vec<[f64; 2]>,
}

/// The powers of the number of samples with which errors fall: of plain Monte Carlo, and at best.
const SLOPES: [f64; 2] = [0.5, 0.75];
/// How far back the slope is fitted, as a factor of samples.
const FIT: f64 = 32.0;
/// How close points are joined, as a difference of logarithms.
const CLOSE: f64 = 0.2;

impl History {
    /// Remembers an error; of samples that are close together only the last.
    pub(super) fn add(&mut self, samples: u64, error: f64) {
        if samples == 0 || !(error > 0.0 && error.is_finite()) {
            return;
        }
        let point = [libm::log(samples as f64), libm::log(error)];
        match self.points.as_mut_slice() {
            [.., before, last] if point[0] - before[0] < CLOSE => *last = point,
            _ => self.points.push(point),
        }
    }

    /// With which power of the number of samples the error falls, by least squares.
    pub(super) fn slope(&self) -> f64 {
        let Some(last) = self.points.last() else { return SLOPES[0] };
        let recent = || self.points.iter().filter(|point| point[0] > last[0] - libm::log(FIT));
        let count = recent().count() as f64;
        let mean = |i: usize| recent().map(|point| point[i]).sum::<f64>() / count;
        let (x, y) = (mean(0), mean(1));
        let above = recent().map(|point| (point[0] - x) * (point[1] - y)).sum::<f64>();
        let below = recent().map(|point| (point[0] - x) * (point[0] - x)).sum::<f64>();
        let slope = if below > 0.0 { -above / below } else { SLOPES[0] };
        slope.clamp(SLOPES[0], SLOPES[1])
    }

    /// The error at another number of samples.
    pub(super) fn error_at(&self, samples: f64) -> Option<f64> {
        let [x, y] = *self.points.last()?;
        Some(libm::exp(y - self.slope() * (libm::log(samples.max(1.0)) - x)))
    }
}
