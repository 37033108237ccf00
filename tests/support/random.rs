//! Random numbers of the tests, independent of the library's samplers, and a short way to those.

use pathtracer::math::DVec3;
use pathtracer::sampling::{NumberSet, PixelSeed, Sampler};

/// The numbers of two uses of a set.
pub(crate) trait Sample4: Sampler {
    fn sample4(&self, pixel: PixelSeed, index: u64, set: u32) -> [f64; 4] {
        let numbers = self.set(pixel, index, set);
        let ([a, b], [c, d]) = (numbers.pair(0), numbers.pair(1));
        [a, b, c, d]
    }
}

impl<S: Sampler> Sample4 for S {}

/// SplitMix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", 2014).
#[derive(Clone)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random(seed)
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Below `count`.
    pub(crate) fn index(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// Whether something that happens so often, of 1, does.
    pub(crate) fn chance(&mut self, often: f64) -> bool {
        self.unit() < often
    }

    /// One of some.
    pub(crate) fn pick<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.index(items.len())]
    }

    /// A power of ten with an exponent between these.
    pub(crate) fn power(&mut self, low: f64, high: f64) -> f64 {
        libm::pow(10.0, self.between(low, high))
    }

    /// Each component in [-1, 1).
    pub(crate) fn in_cube(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A unit vector, evenly over the sphere.
    pub(crate) fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.in_cube();
            let length = p.length();
            if length > 0.1 && length <= 1.0 {
                return p / length;
            }
        }
    }

    pub(crate) fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.index(i + 1));
        }
    }
}
