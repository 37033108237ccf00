//! What is counted while paths are traced.

use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// Counts of one or more samples. All are integers, so that their sums do not depend on the order of adding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counters {
    /// Rays given to the accelerator, shadow rays included.
    pub rays: u64,
    /// Samples that were not finite or negative and were left out.
    pub dropped: u64,
    /// Rays with a number that is not finite: they hit nothing, see no sky and bring no light.
    pub refused: u64,
    /// Closest hits of paths that can't be told from the surface that the ray left: on the same primitive though the ray
    /// did not go into it (into a body it meets the far side, however near), or on another one no farther from the
    /// ray's origin than that was moved off its surface (the error bound of the point). Shadow rays don't know theirs.
    pub self_hits: u64,
    /// Paths, or branches of them, that met a surface with their last segment and would have gone on.
    pub cut_paths: u64,
    /// Throughput (mean of the components, 1 at the camera, a branch's part of it) with which the cut paths arrived at that
    /// surface.
    pub cut_throughput: FixedSum,
    /// The same of all paths, at the surface before that.
    pub last_throughput: FixedSum,
    /// Light that was found by the last segment of paths of full length, or by a ray at a light in its place (mean of the
    /// components), in units of the brightest light of the scene.
    pub last_light: FixedSum,
    /// Samples that were far brighter than those before them in their pixel and chunk; see
    /// [`FIREFLY`](crate::render::FIREFLY).
    pub fireflies: u64,
    /// Samples with a component above the limit of [`Settings::clamp`](crate::render::Settings::clamp).
    pub clamped: u64,
    /// What was cut off them (mean of the components), in units of the limit.
    pub clamp_removed: FixedSum,
}

impl AddAssign for Counters {
    fn add_assign(&mut self, other: Counters) {
        self.rays += other.rays;
        self.dropped += other.dropped;
        self.refused += other.refused;
        self.self_hits += other.self_hits;
        self.cut_paths += other.cut_paths;
        self.cut_throughput += other.cut_throughput;
        self.last_throughput += other.last_throughput;
        self.last_light += other.last_light;
        self.fireflies += other.fireflies;
        self.clamped += other.clamped;
        self.clamp_removed += other.clamp_removed;
    }
}

/// A sum of numbers >= 0 in steps of 2^-32, the same for every order of adding: each number is rounded to the nearest
/// step, the rest is exact up to 2^96, where it stays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FixedSum(u128);

impl FixedSum {
    /// 2^32.
    const STEPS: f64 = (1u64 << 32) as f64;

    /// Adds a number; NaN and negative ones count as 0.
    pub fn add(&mut self, value: f64) {
        // The conversion truncates and keeps to the range of u128.
        *self += FixedSum((value * Self::STEPS + 0.5) as u128);
    }

    /// The sum.
    pub fn value(self) -> f64 {
        self.0 as f64 / Self::STEPS
    }
}

impl AddAssign for FixedSum {
    fn add_assign(&mut self, other: FixedSum) {
        self.0 = self.0.saturating_add(other.0);
    }
}
