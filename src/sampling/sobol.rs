//! Sobol points, shuffled and scrambled by hashing (Burley, "Practical Hash-based Owen Scrambling",
//! JCGT 9(4) 2020), in padded sets.
//!
//! An Owen scramble is a hash on integers whose bits stand in reverse order, lowest bit first: there a bit depends on
//! lower bits alone, which multiplication gives for free. So points are kept in reversed bits until they are numbers.

use super::{GOLDEN, NumberSet, PixelSeed, Sampler, mix, stream};

/// Owen-scrambled Sobol points of two dimensions: any aligned power of two of successive samples of a pixel is a (0, m,
/// 2)-net in every use, so stratified in every way that two dimensions can be; the sets of a pixel are independent of
/// each other.
///
/// The uses of a set are scrambles of their own of the same points, which are made once. So at one sample a use says
/// nothing about the others, but over the samples of a pixel it does.
///
/// Blocks of 2^32 samples are independent of each other too.
#[derive(Clone, Copy, Debug)]
pub struct Sobol {
    mixed_seed: u64,
}

/// A point before it is scrambled, in reversed bits.
#[derive(Clone, Copy, Debug)]
pub struct SobolSet {
    key: u64,
    x: u32,
    y: u32,
}

impl Sampler for Sobol {
    type Set = SobolSet;

    fn new(seed: u64) -> Self {
        Sobol { mixed_seed: mix(seed.wrapping_add(GOLDEN)) }
    }

    fn pixel(&self, x: u32, y: u32) -> PixelSeed {
        PixelSeed::new(self.mixed_seed, x, y)
    }

    #[inline]
    fn set(&self, pixel: PixelSeed, index: u64, set: u32) -> SobolSet {
        let block = index & 0xffff_ffff_0000_0000;
        let key = stream(pixel.0, block | u64::from(set));
        let shuffled =
            owen_hash((index as u32).reverse_bits(), key as u32, (key >> 32) as u32).reverse_bits();
        // The first Sobol dimension is the reversed index, so in reversed bits the index.
        SobolSet { key, x: shuffled, y: second_dimension(shuffled) }
    }
}

impl NumberSet for SobolSet {
    #[inline]
    fn pair(&self, usage: u32) -> [f64; 2] {
        let (add, factors) = self.scramble(usage);
        let x = owen_hash(self.x, add as u32, factors & 0xffff);
        let y = owen_hash(self.y, (add >> 32) as u32, factors >> 16);
        // One reversal of 64 bits costs as much as one of 32, and exchanges the halves.
        let reversed = (u64::from(y) << 32 | u64::from(x)).reverse_bits();
        [unit((reversed >> 32) as u32), unit(reversed as u32)]
    }

    #[inline]
    fn one(&self, usage: u32) -> f64 {
        let (add, factors) = self.scramble(usage);
        unit(owen_hash(self.x, add as u32, factors & 0xffff).reverse_bits())
    }
}

impl SobolSet {
    /// The numbers that scramble a use: two to add, two factors of 16 bits.
    ///
    /// Each dimension has 32 bits to add of its own; for given factors the numbers are uniform by them alone, so the
    /// factors may come from the bits that have shuffled the index.
    #[inline]
    fn scramble(&self, usage: u32) -> (u64, u32) {
        (stream(self.key, u64::from(usage) + 1), self.key.rotate_right(32 * (usage & 1)) as u32)
    }
}

/// The second Sobol dimension at an index, in reversed bits.
///
/// Bit j of the number is the sum of the bits k of the index for which the binomial coefficient (k over j) is odd, that
/// is (Lucas), k has all bits that j has. Such a sum over supersets falls into one step for every bit of j and k.
#[inline]
fn second_dimension(mut index: u32) -> u32 {
    index ^= index >> 1 & 0x5555_5555;
    index ^= index >> 2 & 0x3333_3333;
    index ^= index >> 4 & 0x0f0f_0f0f;
    index ^= index >> 8 & 0x00ff_00ff;
    index ^ index >> 16
}

/// A hash of `x` in which each bit of the result is the bit of `x`, flipped depending on lower bits and on the
/// two random numbers: an Owen scramble of reversed bits. For random `add` the result is exactly uniform.
/// The structure is Laine and Karras's ("Stratified Sampling for Stochastic Transparency", EGSR 2011), the
/// constants are Vegdahl's ("Building a Better LK Hash", 2021), who takes the factor from the bits of `add`.
#[inline]
fn owen_hash(x: u32, add: u32, factor: u32) -> u32 {
    let x = x ^ x.wrapping_mul(0x3d20_adea);
    let x = x.wrapping_add(add).wrapping_mul(factor | 1);
    let x = x ^ x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// The middle of one of 2^32 equal cells of (0, 1): exact in f64, never 0, never 1.
#[inline]
fn unit(bits: u32) -> f64 {
    (f64::from(bits) + 0.5) * (1.0 / (1u64 << 32) as f64)
}
