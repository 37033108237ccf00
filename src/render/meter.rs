//! The work of all threads, added up for those who follow a render.

use super::{Progress, Settings};
use std::sync::atomic::{AtomicU64, Ordering};

/// Adds up the work of all threads for [`Watch::progress`](super::Watch::progress).
pub(super) struct Meter {
    total: u64,
    samples: AtomicU64,
    rays: AtomicU64,
}

impl Meter {
    pub(super) fn new(settings: &Settings) -> Meter {
        let pixels = u64::from(settings.width) * u64::from(settings.height);
        let total = pixels.saturating_mul(settings.samples);
        Meter { total, samples: AtomicU64::new(0), rays: AtomicU64::new(0) }
    }

    pub(super) fn add(&self, samples: u64, rays: u64) -> Progress {
        Progress {
            samples: self.samples.fetch_add(samples, Ordering::Relaxed) + samples,
            total: self.total,
            rays: self.rays.fetch_add(rays, Ordering::Relaxed) + rays,
        }
    }
}
