//! Pictures as means of blocks of 8 x 8 pixels with their errors, and what two of them say about each other.

use crate::support::stats::two_sided_tail;
use pathtracer::math::Rgb;

/// Side of a picture in pixels.
pub(super) const SIDE: usize = 512;
/// Side of a block in pixels.
const BLOCK: usize = 8;
/// Blocks in a row.
pub(super) const BLOCKS: usize = SIDE / BLOCK;

/// One number a channel of a block: R G B, row by row from the top left.
pub(super) type Channels = Vec<f64>;

/// Means of blocks with the variances of these means.
#[derive(Clone, Debug)]
pub(super) struct Blocks {
    pub(super) mean: Channels,
    pub(super) variance: Channels,
}

impl Blocks {
    /// From the pixels of independent renders of equal numbers of samples.
    ///
    /// Pixels are independent of each other, so a block's variance is the sum of its pixels' variances: of K renders it
    /// has 64 (K - 1) degrees of freedom, and the quotient below is normal but for the tails of the samples themselves.
    pub(super) fn of_renders(renders: &[Vec<Rgb>]) -> Blocks {
        let count = renders.len() as f64;
        let mut mean = vec![0.0; BLOCKS * BLOCKS * 3];
        let mut variance = mean.clone();
        for pixel in 0..SIDE * SIDE {
            let of_pixel = || renders.iter().map(|render| render[pixel]);
            let average = of_pixel().sum::<Rgb>() / count;
            let squares: Rgb = of_pixel().map(|value| (value - average) * (value - average)).sum();
            let of_average = squares / ((count - 1.0) * count);
            for channel in 0..3 {
                let at = block_of(pixel) * 3 + channel;
                mean[at] += average[channel] / (BLOCK * BLOCK) as f64;
                variance[at] += of_average[channel] / (BLOCK * BLOCK * BLOCK * BLOCK) as f64;
            }
        }
        Blocks { mean, variance }
    }
}

/// The block that holds a pixel.
fn block_of(pixel: usize) -> usize {
    pixel / SIDE / BLOCK * BLOCKS + pixel % SIDE / BLOCK
}

/// Means of the blocks of one picture.
pub(super) fn block_means(pixels: impl Iterator<Item = Rgb>) -> Channels {
    let mut mean = vec![0.0; BLOCKS * BLOCKS * 3];
    for (pixel, value) in pixels.enumerate() {
        for channel in 0..3 {
            mean[block_of(pixel) * 3 + channel] += value[channel] / (BLOCK * BLOCK) as f64;
        }
    }
    mean
}

/// What separates a picture from its reference.
#[derive(Clone, Copy, Debug)]
pub(super) struct Verdict {
    /// The factor, less 1, that fits the picture to the reference best, and its standard error.
    pub(super) scale: f64,
    pub(super) scale_error: f64,
    /// Mean of the squares of the blocks' z: 1 where nothing but noise separates the two.
    pub(super) chi2: f64,
    /// Shares of the blocks' z beyond 3 and beyond 4.
    pub(super) beyond: [f64; 2],
    /// The largest |z|.
    pub(super) worst: f64,
}

impl Verdict {
    /// The scale is weighed by the reference and its errors, never by the picture's own variances: blocks that happen to
    /// lack their rare bright samples have small ones, and would pull the scale down.
    pub(super) fn of(picture: &Blocks, reference: &Blocks) -> Verdict {
        let (mut difference, mut weight, mut variance) = (0.0, 0.0, 0.0);
        let mut z = Vec::new();
        for i in 0..picture.mean.len() {
            let (expected, own) = (reference.mean[i], reference.variance[i]);
            let (off, both) = (picture.mean[i] - expected, picture.variance[i] + own);
            if both == 0.0 {
                assert!(off.abs() <= 1e-6 * expected, "a block without noise that is {off} off");
                continue;
            }
            z.push(off / both.sqrt());
            if own > 0.0 {
                let w = expected / own;
                difference += w * off;
                weight += w * expected;
                variance += w * w * both;
            }
        }
        let share = |limit: f64| z.iter().filter(|z| z.abs() > limit).count() as f64 / z.len() as f64;
        Verdict {
            scale: difference / weight,
            scale_error: variance.sqrt() / weight,
            chi2: z.iter().map(|z| z * z).sum::<f64>() / z.len() as f64,
            beyond: [share(3.0), share(4.0)],
            worst: z.iter().fold(0.0, |worst, z| worst.max(z.abs())),
        }
    }
}
