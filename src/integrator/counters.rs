//! What is counted while paths are traced.

use std::ops::AddAssign;

/// Counts of one or more samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Rays given to the accelerator, shadow rays included.
    pub rays: u64,
    /// Samples that were not finite and were left out.
    pub dropped: u64,
}

impl AddAssign for Counters {
    fn add_assign(&mut self, other: Counters) {
        self.rays += other.rays;
        self.dropped += other.dropped;
    }
}
