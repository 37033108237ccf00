//! How far a picture is from another one.
//!
//! Pictures are linear R G B in f32, row by row from the top left, as an EXR holds them.

pub mod flip;

use crate::error::{Error, Result};

/// What is added to the square of the reference in relative errors, so that black pixels count and do not rule.
pub const RELATIVE_FLOOR: f64 = 0.01;

/// The share of the pixels that trimmed errors leave out: the worst ones, where single bright samples rule the mean.
pub const TRIMMED_SHARE: f64 = 0.001;

/// A picture and the one that it should be, of one size.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'p> {
    picture: &'p [f32],
    reference: &'p [f32],
    /// Pixels in a row.
    width: usize,
}

impl<'p> Pair<'p> {
    /// Two pictures of `width` x `height` pixels.
    ///
    /// # Errors
    /// [`Error::Usage`] if one of them has another number of values, or both have none.
    pub fn new(picture: &'p [f32], reference: &'p [f32], width: usize, height: usize) -> Result<Pair<'p>> {
        let values = 3 * width * height;
        if values == 0 || picture.len() != values || reference.len() != values {
            return Err(Error::Usage(format!(
                "pictures of {} and {} values can't be compared as {width} x {height} pixels",
                picture.len(),
                reference.len()
            )));
        }
        Ok(Pair { picture, reference, width })
    }

    /// The mean square error over all pixels and channels, in squares of radiance.
    pub fn mse(&self) -> f64 {
        mean(self.values().map(|(x, r)| (x - r) * (x - r)))
    }

    /// The mean of (x - r)^2 / (r^2 + 0.01) over all pixels and channels.
    pub fn rel_mse(&self) -> f64 {
        mean(self.values().map(relative))
    }

    /// [`Pair::rel_mse`] without the worst 0.1 % of the pixels.
    pub fn trimmed_rel_mse(&self) -> f64 {
        let errors: Vec<f64> = self.values().map(relative).collect();
        trimmed_mean(errors.chunks_exact(3).map(|pixel| pixel.iter().sum::<f64>() / 3.0).collect())
    }

    /// The mean of the picture beside that of the reference, less one; NaN beside a black reference.
    pub fn bias(&self) -> f64 {
        let (picture, reference) = self.values().fold((0.0, 0.0), |(a, b), (x, r)| (a + x, b + r));
        picture / reference - 1.0
    }

    /// The perceived difference of every pixel, 0 to 1, as [`flip`] describes it.
    pub fn flip(&self) -> Vec<f32> {
        let prepared = |pixels| flip::Prepared::new(pixels, self.width);
        prepared(self.picture).difference(&prepared(self.reference))
    }

    /// Values of both, in f64.
    fn values(&self) -> impl ExactSizeIterator<Item = (f64, f64)> + '_ {
        self.picture.iter().zip(self.reference).map(|(&x, &r)| (f64::from(x), f64::from(r)))
    }
}

/// The weight of a squared error beside a reference of `r`.
pub fn relative_weight(r: f64) -> f64 {
    1.0 / (r * r + RELATIVE_FLOOR)
}

fn relative((x, r): (f64, f64)) -> f64 {
    (x - r) * (x - r) * relative_weight(r)
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// The mean of the errors of all pixels but the worst 0.1 %; of few pixels all count. Not finite if one of them is not,
/// however few: such a pixel is a fault, not a bright sample.
pub fn trimmed_mean(mut errors: Vec<f64>) -> f64 {
    if !errors.iter().all(|error| error.is_finite()) {
        return mean(errors.iter().copied());
    }
    // As many as round the kept share down, by which numpy cuts an array.
    let kept = (errors.len() as f64 * (1.0 - TRIMMED_SHARE)) as usize;
    errors.sort_by(f64::total_cmp);
    errors.truncate(kept.max(1));
    mean(errors.iter().copied())
}
