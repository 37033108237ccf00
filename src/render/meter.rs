//! The work of all threads, added up for those who follow a render.

use super::outlook::Outlook;
use super::tile::Work;
use super::{Progress, Settings};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Adds up the work of all threads for [`Watch::progress`](super::Watch::progress).
pub(super) struct Meter {
    total: u64,
    samples: AtomicU64,
    rays: AtomicU64,
    outlook: Mutex<Outlook>,
}

impl Meter {
    pub(super) fn new(settings: &Settings) -> Meter {
        let total = settings.area().saturating_mul(settings.samples_to_take());
        let outlook = Mutex::new(Outlook::default());
        Meter { total, samples: AtomicU64::new(0), rays: AtomicU64::new(0), outlook }
    }

    /// Counts what was done before.
    pub(super) fn resume(&self, work: &Work) {
        self.add(work);
    }

    /// Remembers what is known about the error.
    pub(super) fn tell(&self, outlook: Outlook) {
        *self.outlook.lock().unwrap_or_else(PoisonError::into_inner) = outlook;
    }

    /// Adds the work of a tile.
    pub(super) fn add(&self, work: &Work) -> Progress {
        let Work { samples, counters } = work;
        Progress {
            samples: self.samples.fetch_add(*samples, Ordering::Relaxed) + samples,
            total: self.total,
            rays: self.rays.fetch_add(counters.rays, Ordering::Relaxed) + counters.rays,
            outlook: *self.outlook.lock().unwrap_or_else(PoisonError::into_inner),
        }
    }
}
