//! Pictures as means of blocks of 8 x 8 pixels with their errors, and what two of them say about each other.

use pathtracer::math::Rgb;

/// Side of a picture in pixels.
pub(super) const SIDE: usize = 512;
/// Side of a block in pixels.
pub(super) const BLOCK: usize = 8;
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
    /// From the pixels of independent renders of equal numbers of samples, `width` pixels wide.
    ///
    /// Pixels are independent of each other, so a block's variance is the sum of its pixels' variances: of K renders it
    /// has 64 (K - 1) degrees of freedom, and the quotient below is normal but for the tails of the samples themselves.
    pub(super) fn of_renders(renders: &[Vec<Rgb>], width: usize) -> Blocks {
        let count = renders.len() as f64;
        let pixels = renders[0].len();
        let mut mean = vec![0.0; pixels / (BLOCK * BLOCK) * 3];
        let mut variance = mean.clone();
        for pixel in 0..pixels {
            let of_pixel = || renders.iter().map(|render| render[pixel]);
            let average = of_pixel().sum::<Rgb>() / count;
            let squares: Rgb = of_pixel().map(|value| (value - average) * (value - average)).sum();
            let of_average = squares / ((count - 1.0) * count);
            for channel in 0..3 {
                let at = block_of(pixel, width) * 3 + channel;
                mean[at] += average[channel] / (BLOCK * BLOCK) as f64;
                variance[at] += of_average[channel] / (BLOCK * BLOCK * BLOCK * BLOCK) as f64;
            }
        }
        Blocks { mean, variance }
    }
}

/// The block that holds a pixel of a picture.
fn block_of(pixel: usize, width: usize) -> usize {
    pixel / width / BLOCK * (width / BLOCK) + pixel % width / BLOCK
}

/// Of the blocks of one picture: means, and variances of the pixels within the block.
pub(super) fn within_blocks(pixels: &[Rgb]) -> (Channels, Channels) {
    let size = (BLOCK * BLOCK) as f64;
    let mut mean = vec![0.0; BLOCKS * BLOCKS * 3];
    let mut variance = mean.clone();
    let each = || (0..SIDE * SIDE * 3).map(|i| (block_of(i / 3, SIDE) * 3 + i % 3, pixels[i / 3][i % 3]));
    each().for_each(|(at, value)| mean[at] += value / size);
    each().for_each(|(at, value)| variance[at] += (value - mean[at]) * (value - mean[at]) / (size - 1.0));
    (mean, variance)
}

/// What separates a picture from its reference.
#[derive(Clone, Copy, Debug)]
pub(super) struct Verdict {
    /// Mean of the picture over that of the reference, less 1, and its standard error.
    pub(super) bias: f64,
    pub(super) bias_error: f64,
    /// Shares of the blocks' z beyond 3 and beyond 4.
    pub(super) beyond: [f64; 2],
}

impl Verdict {
    /// z is taken with the larger of two variances of the picture: its own, and the reference's times the ratio of both
    /// over the whole picture. A block that happens to lack its rare bright samples has a small variance of its own.
    pub(super) fn of(picture: &Blocks, reference: &Blocks) -> Verdict {
        let sum = |values: &Channels| values.iter().sum::<f64>();
        let ratio = sum(&picture.variance) / sum(&reference.variance);
        let (mut z, mut variance) = (Vec::new(), 0.0);
        for (i, &of_reference) in reference.variance.iter().enumerate() {
            let own = picture.variance[i];
            variance += own + of_reference;
            let error = (own.max(ratio * of_reference) + of_reference).sqrt();
            let off = picture.mean[i] - reference.mean[i];
            // Black in both: nothing to compare.
            z.push(if off == 0.0 { 0.0 } else { off / error });
        }
        let share = |limit: f64| z.iter().filter(|z| z.abs() > limit).count() as f64 / z.len() as f64;
        let total = sum(&reference.mean);
        Verdict {
            bias: sum(&picture.mean) / total - 1.0,
            bias_error: variance.sqrt() / total,
            beyond: [share(3.0), share(4.0)],
        }
    }
}
