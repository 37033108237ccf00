//! Independent uniform numbers by a counter-based hash.

use super::{GOLDEN, PixelSeed, Sampler, mix, stream};

/// Plain Monte Carlo: every number is the hash of its place, unrelated to all others.
#[derive(Clone, Copy, Debug)]
pub struct Independent {
    mixed_seed: u64,
}

impl Sampler for Independent {
    fn new(seed: u64) -> Self {
        Independent { mixed_seed: mix(seed.wrapping_add(GOLDEN)) }
    }

    fn pixel(&self, x: u32, y: u32) -> PixelSeed {
        PixelSeed::new(self.mixed_seed, x, y)
    }

    #[inline]
    fn sample4(&self, pixel: PixelSeed, index: u64, set: u32) -> [f64; 4] {
        // Each sample has its own stream, in which the sets follow each other.
        let state = stream(pixel.0, index);
        let first = 4 * u64::from(set) + 1;
        std::array::from_fn(|i| unit(stream(state, first + i as u64)))
    }
}

/// The middle of one of 2^52 equal cells of (0, 1): exact in f64, never 0, never 1.
#[inline]
fn unit(bits: u64) -> f64 {
    ((bits >> 12) as f64 + 0.5) * (1.0 / (1u64 << 52) as f64)
}
