//! Random numbers for meshes and rays: one stream a seed, the same on every machine.

use crate::math::DVec3;
use crate::sampling::stream;

/// The SplitMix64 stream of a seed.
#[derive(Clone, Debug)]
pub(super) struct Random {
    seed: u64,
    next: u64,
}

impl Random {
    pub(super) fn new(seed: u64) -> Random {
        Random { seed, next: 0 }
    }

    pub(super) fn bits(&mut self) -> u64 {
        self.next += 1;
        stream(self.seed, self.next)
    }

    /// In [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In [low, high).
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Below `count`, which is not 0.
    pub(super) fn index(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// Each component in [-1, 1).
    pub(super) fn in_cube(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A unit vector, evenly over the sphere.
    pub(super) fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.in_cube();
            let length = p.length();
            if length > 0.1 && length <= 1.0 {
                return p / length;
            }
        }
    }

    pub(super) fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.index(i + 1));
        }
    }
}
