//! Random numbers as pure functions of (seed, pixel, sample, dimension), and the maps from them to shapes.

mod independent;
mod scrambles;
mod sobol;
pub mod warp;

pub use independent::{Independent, IndependentSet};
pub use scrambles::{Place, SCRAMBLES, Scrambles};
pub use sobol::{Sobol, SobolSet};

use serde::{Deserialize, Serialize};
use std::fmt;

/// A source of random numbers. It holds no state but the seed: equal arguments give equal numbers on every machine, in
/// every order, on every thread.
pub trait Sampler: Copy + Send + Sync {
    /// What [`Sampler::set`] returns.
    type Set: NumberSet;

    /// The sampler of a seed. Different seeds give unrelated numbers.
    fn new(seed: u64) -> Self;

    /// The part of the hash that samples of one pixel share, to be computed once a pixel.
    fn pixel(&self, x: u32, y: u32) -> PixelSeed;

    /// The numbers of sample `index` of a pixel for one step of its path. Sets are unrelated to each other; so are
    /// pixels.
    fn set(&self, pixel: PixelSeed, index: u64, set: u32) -> Self::Set;
}

/// Numbers strictly between 0 and 1 for the uses of one set, made when they are asked for: a use that a path does not
/// need costs nothing. Uses are numbered from 0.
///
/// Each use is even by itself, but over the samples of a pixel the uses of a set may be functions of each other: their
/// results may be added, not multiplied.
pub trait NumberSet: Copy {
    /// Two numbers, for a use of two dimensions.
    fn pair(&self, usage: u32) -> [f64; 2];

    /// One number; the first of [`NumberSet::pair`].
    fn one(&self, usage: u32) -> f64;
}

/// A seed and the coordinates of a pixel, mixed to 64 bits; for one seed no two pixels share it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelSeed(u64);

impl PixelSeed {
    /// Mixes the coordinates of a pixel into an already mixed seed.
    fn new(mixed_seed: u64, x: u32, y: u32) -> PixelSeed {
        let coordinates = u64::from(y) << 32 | u64::from(x);
        PixelSeed(mix(mixed_seed.wrapping_add(mix(coordinates))))
    }
}

/// The samplers that a user can choose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SamplerKind {
    /// [`Sobol`]: less noise at equal samples.
    #[default]
    Sobol,
    /// [`Independent`]: plain Monte Carlo, whose error bars are the textbook's.
    Independent,
}

impl SamplerKind {
    /// All kinds, the default first.
    pub const ALL: [SamplerKind; 2] = [SamplerKind::Sobol, SamplerKind::Independent];

    /// The name on the command line and in metadata.
    pub const fn name(self) -> &'static str {
        match self {
            SamplerKind::Sobol => "sobol",
            SamplerKind::Independent => "independent",
        }
    }
}

impl fmt::Display for SamplerKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The odd number nearest to 2^64 / golden ratio: successive multiples of it differ in many bits.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// A bijection of 64 bits in which every bit of the input changes about half of the output's: the finaliser of
/// SplitMix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014; constants of
/// Stafford's variant 13).
#[inline]
fn mix(x: u64) -> u64 {
    let x = (x ^ x >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ x >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ x >> 31
}

/// Element `i` of the SplitMix64 stream that starts at `state`.
#[inline]
pub(crate) fn stream(state: u64, i: u64) -> u64 {
    mix(state.wrapping_add(i.wrapping_mul(GOLDEN)))
}
