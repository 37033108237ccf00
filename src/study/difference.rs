//! How far a picture is from another one: the figures, the worst pixels, and a picture of the difference.

use super::metrics::{Pair, relative_weight};
use crate::error::{Error, Result};
use crate::picture::{Decoded, Depth, Pixels, quantize};
use serde::Serialize;

/// Two pictures compared.
#[derive(Clone, Debug)]
pub struct Difference {
    width: u32,
    picture: Vec<f32>,
    reference: Vec<f32>,
    flip: Vec<f32>,
    /// The figures.
    pub metrics: Metrics,
}

/// The figures of a comparison. Pictures are linear; see [`super::metrics`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Metrics {
    /// Root of the mean square error, in units of radiance.
    pub rmse: f64,
    /// Mean of (x - ref)^2 / (ref^2 + 0.01).
    pub relmse: f64,
    /// The same without the worst 0.1 % of the pixels.
    pub trelmse: f64,
    /// Mean of the picture beside that of the reference, less one; 0 if both are black.
    pub bias: f64,
    /// Mean of FLIP, 0 to 1.
    pub flip: f64,
    /// The largest difference of a value.
    pub max: f64,
    /// Pixels with any difference.
    pub differing: u64,
    /// Pixels with a value in one of the pictures that is not finite.
    pub not_finite: u64,
}

/// A pixel that differs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Worst {
    /// Column, from 0 at the left.
    pub x: u32,
    /// Row, from 0 at the top.
    pub y: u32,
    /// Its part of relMSE: the mean of its three values'.
    pub error: f64,
    /// The picture there.
    pub picture: [f32; 3],
    /// The reference there.
    pub reference: [f32; 3],
}

impl Metrics {
    /// The names by which one metric can be asked for.
    pub const NAMES: [&'static str; 6] = ["rmse", "relmse", "trelmse", "bias", "flip", "max"];

    /// A metric by its name; the bias without its sign.
    pub fn get(&self, name: &str) -> Option<f64> {
        Some(match name {
            "rmse" => self.rmse,
            "relmse" => self.relmse,
            "trelmse" => self.trelmse,
            "bias" => self.bias.abs(),
            "flip" => self.flip,
            "max" => self.max,
            _ => return None,
        })
    }
}

impl Difference {
    /// Compares a picture with what it should be.
    ///
    /// # Errors
    /// Their sizes differ.
    pub fn new(picture: &Decoded, reference: &Decoded) -> Result<Difference> {
        let sizes = [picture, reference].map(|picture| (picture.width, picture.height));
        if sizes[0] != sizes[1] {
            let [(w, h), (v, g)] = sizes;
            return Err(Error::Picture(format!("the sizes differ: {w} x {h} and {v} x {g} pixels")));
        }
        let (width, height) = sizes[0];
        let [picture, reference] = [picture, reference].map(|p| p.to_linear(p.is_encoded));
        let pair = Pair::new(&picture, &reference, width as usize, height as usize)?;
        let flip = pair.flip();
        let pixels = || picture.chunks_exact(3).zip(reference.chunks_exact(3));
        let count = |is: fn(&[f32], &[f32]) -> bool| pixels().filter(|(a, b)| is(a, b)).count() as u64;
        let values = || picture.iter().zip(&reference);
        let is_black = values().all(|(&a, &b)| a == 0.0 && b == 0.0);
        let metrics = Metrics {
            rmse: pair.mse().sqrt(),
            relmse: pair.rel_mse(),
            trelmse: pair.trimmed_rel_mse(),
            bias: if is_black { 0.0 } else { pair.bias() },
            flip: flip.iter().map(|&x| f64::from(x)).sum::<f64>() / flip.len() as f64,
            max: values().map(|(&a, &b)| (f64::from(a) - f64::from(b)).abs()).fold(0.0, largest),
            differing: count(|a, b| a != b),
            not_finite: count(|a, b| !a.iter().chain(b).all(|value| value.is_finite())),
        };
        Ok(Difference { width, picture, reference, flip, metrics })
    }

    /// The pixels that add most to relMSE, at most `count`, the worst first.
    pub fn worst(&self, count: usize) -> Vec<Worst> {
        let pixels = self.picture.chunks_exact(3).zip(self.reference.chunks_exact(3)).enumerate();
        let mut errors: Vec<(f64, usize)> =
            pixels.map(|(i, (a, b))| (pixel_error(a, b), i)).filter(|(error, _)| *error != 0.0).collect();
        let order = |a: &(f64, usize), b: &(f64, usize)| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1));
        if count < errors.len() {
            errors.select_nth_unstable_by(count, order);
            errors.truncate(count);
        }
        errors.sort_by(order);
        let at = |values: &[f32], i: usize| [values[3 * i], values[3 * i + 1], values[3 * i + 2]];
        let found = errors.into_iter().map(|(error, i)| Worst {
            x: i as u32 % self.width,
            y: i as u32 / self.width,
            error,
            picture: at(&self.picture, i),
            reference: at(&self.reference, i),
        });
        found.collect()
    }

    /// The difference as a picture: FLIP from black over red and yellow to white in 8 bits, the absolute differences in
    /// floats.
    pub fn pixels(&self, depth: Depth) -> Pixels {
        if depth.is_linear() {
            let values = self.picture.iter().zip(&self.reference);
            return Pixels::Floats(values.map(|(a, b)| (a - b).abs()).collect());
        }
        let heat = |&error: &f32| {
            [0.0, 1.0, 2.0].map(|from| quantize(f64::from(3.0 * error - from).clamp(0.0, 1.0)))
        };
        Pixels::Bytes(self.flip.iter().flat_map(heat).collect())
    }
}

/// A pixel's part of relMSE; infinite where a number is not finite.
fn pixel_error(picture: &[f32], reference: &[f32]) -> f64 {
    let values = picture.iter().zip(reference).map(|(&x, &r)| (f64::from(x), f64::from(r)));
    let sum: f64 = values.map(|(x, r)| (x - r) * (x - r) * relative_weight(r)).sum();
    if sum.is_nan() { f64::INFINITY } else { sum / 3.0 }
}

/// The larger of two numbers; NaN if one is.
fn largest(a: f64, b: f64) -> f64 {
    if b.is_nan() || b > a { b } else { a }
}
