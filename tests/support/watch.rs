//! Renders that nobody follows.

use pathtracer::render::{Progress, Watch};

/// Sees nothing and stops nothing.
pub(crate) struct Unwatched;

impl Watch for Unwatched {
    fn progress(&self, _: &Progress) {}

    fn cancelled(&self) -> bool {
        false
    }
}
