//! Sobol points, shuffled and scrambled by hashing (Burley, "Practical Hash-based Owen Scrambling",
//! JCGT 9(4) 2020), in padded sets of four dimensions.
//!
//! Everything between the index and the numbers happens on integers whose bits stand in reverse order, lowest
//! bit first: there an Owen scramble is a hash in which a bit depends on lower bits alone, which multiplication
//! gives for free, and the reversals before and after the shuffle cancel against those of the generator matrices.

use super::{GOLDEN, PixelSeed, Sampler, mix, stream};

/// Owen-scrambled Sobol points: any aligned power of two of successive samples of a pixel is stratified in every
/// dimension of a set and in the plane of its first two; the sets of a pixel are independent of each other.
///
/// Blocks of 2^32 samples are independent of each other too.
#[derive(Clone, Copy, Debug)]
pub struct Sobol {
    mixed_seed: u64,
}

impl Sampler for Sobol {
    fn new(seed: u64) -> Self {
        Sobol { mixed_seed: mix(seed.wrapping_add(GOLDEN)) }
    }

    fn pixel(&self, x: u32, y: u32) -> PixelSeed {
        PixelSeed::new(self.mixed_seed, x, y)
    }

    #[inline]
    fn sample4(&self, pixel: PixelSeed, index: u64, set: u32) -> [f64; 4] {
        let block = index & 0xffff_ffff_0000_0000;
        let key = stream(pixel.0, block | u64::from(set));
        let shuffled = owen_hash((index as u32).reverse_bits(), key as u32, (key >> 32) as u32);

        // Each dimension has 32 bits to add of its own; for given factors the numbers are uniform by them alone,
        // so the factors may come from the bits that have shuffled the index.
        let [xy, zw] = reversed_sobol(shuffled);
        let (add_xy, add_zw) = (stream(key, 1), stream(key, 2));
        let [x, y] = numbers(xy, add_xy, key as u32);
        let [z, w] = numbers(zw, add_zw, (key >> 32) as u32);
        [x, y, z, w]
    }
}

/// Scrambles two dimensions in reversed bits, the first in the lower half of `points`, and makes numbers of them.
#[inline]
fn numbers(points: u64, add: u64, factors: u32) -> [f64; 2] {
    let low = owen_hash(points as u32, add as u32, factors & 0xffff);
    let high = owen_hash((points >> 32) as u32, (add >> 32) as u32, factors >> 16);
    // One reversal of 64 bits costs as much as one of 32, and exchanges the halves.
    let reversed = (u64::from(high) << 32 | u64::from(low)).reverse_bits();
    [unit((reversed >> 32) as u32), unit(reversed as u32)]
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

/// The first four Sobol dimensions at an index, two a word, the earlier one in the lower half; index and result in
/// reversed bits.
#[inline]
fn reversed_sobol(index: u32) -> [u64; 2] {
    let mut points = [0; 2];
    for (digit, table) in GENERATORS.iter().enumerate() {
        let [xy, zw] = table[(index >> (4 * digit)) as usize & 15];
        points[0] ^= xy;
        points[1] ^= zw;
    }
    points
}

/// The four generator matrices, multiplied by each value of each hexadecimal digit of a reversed index.
static GENERATORS: [[[u64; 2]; 16]; 8] = generators();

const fn generators() -> [[[u64; 2]; 16]; 8] {
    let directions = reversed_directions();
    let mut tables = [[[0; 2]; 16]; 8];
    let mut i = 0;
    while i < 8 * 16 * 4 * 4 {
        let (digit, value, dimension, bit) = (i / 256, i / 16 % 16, i / 4 % 4, i % 4);
        if value >> bit & 1 == 1 {
            // Bit j of the reversed index is bit 31 - j of the index.
            let direction = directions[dimension][31 - (4 * digit + bit)] as u64;
            tables[digit][value][dimension / 2] ^= direction << (dimension % 2 * 32);
        }
        i += 1;
    }
    tables
}

/// Direction numbers by the recurrence of Bratley and Fox (Algorithm 659, ACM TOMS 14(1) 1988), in reversed bits,
/// from the first rows of the table `new-joe-kuo-6.21201` (Joe and Kuo, SIAM J. Sci. Comput. 30(5) 2008).
const fn reversed_directions() -> [[u32; 32]; 4] {
    // Degree and inner coefficients of the primitive polynomial, and the first odd numbers m.
    const ROWS: [(usize, u32, [u32; 3]); 3] = [(1, 0, [1, 0, 0]), (2, 1, [1, 3, 0]), (3, 1, [1, 3, 1])];

    let mut directions = [[0; 32]; 4];
    let mut bit = 0;
    while bit < 32 {
        directions[0][bit] = 1 << bit;
        bit += 1;
    }
    let mut dimension = 1;
    while dimension < 4 {
        let (degree, coefficients, first) = ROWS[dimension - 1];
        let mut v = [0u32; 32];
        let mut k = 0;
        while k < 32 {
            if k < degree {
                v[k] = first[k] << (31 - k);
            } else {
                v[k] = v[k - degree] ^ v[k - degree] >> degree;
                let mut i = 1;
                while i < degree {
                    if coefficients >> (degree - 1 - i) & 1 == 1 {
                        v[k] ^= v[k - i];
                    }
                    i += 1;
                }
            }
            directions[dimension][k] = v[k].reverse_bits();
            k += 1;
        }
        dimension += 1;
    }
    directions
}

/// The middle of one of 2^32 equal cells of (0, 1): exact in f64, never 0, never 1.
#[inline]
fn unit(bits: u32) -> f64 {
    (f64::from(bits) + 0.5) * (1.0 / (1u64 << 32) as f64)
}
