//! Writes checkpoints while a render goes on.

use super::console::say;
use super::progress::Reporter;
use crate::error::Error;
use crate::film::file::FilePlace;
use crate::render::{FileKind, FilmFile, Origin, Progress, Snapshot, SoFar, Watch};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Follows a render, and keeps what it takes to go on with it.
pub(super) struct Keeper<'k> {
    pub(super) reporter: &'k Reporter,
    /// Where checkpoints go.
    pub(super) place: Option<&'k FilePlace>,
    pub(super) origin: &'k Origin,
    pub(super) every: Duration,
    last: Mutex<Instant>,
    failure: Mutex<Option<Error>>,
}

impl<'k> Keeper<'k> {
    pub(super) fn new(
        reporter: &'k Reporter,
        place: Option<&'k FilePlace>,
        origin: &'k Origin,
        every: Duration,
    ) -> Keeper<'k> {
        let (last, failure) = (Mutex::new(Instant::now()), Mutex::new(None));
        Keeper { reporter, place, origin, every, last, failure }
    }

    /// Why the last checkpoint could not be written.
    pub(super) fn failure(&self) -> Option<Error> {
        self.failure.lock().ok()?.take()
    }
}

impl Watch for Keeper<'_> {
    fn progress(&self, progress: &Progress) {
        self.reporter.progress(progress);
    }

    fn cancelled(&self) -> bool {
        self.reporter.cancelled()
    }

    fn pass(&self, so_far: &SoFar<'_>) {
        self.reporter.pass(so_far);
    }

    fn keep(&self, snapshot: &Snapshot<'_>) {
        let (Some(place), Ok(mut last), Ok(mut failure)) =
            (self.place, self.last.lock(), self.failure.lock())
        else {
            return;
        };
        if snapshot.samples() == 0 || !(snapshot.is_last() || last.elapsed() >= self.every) {
            return;
        }
        // Another run of the same task may have finished the part meanwhile.
        if FilmFile::kind_of(place.path()) == Some(FileKind::Part) {
            return;
        }
        // A render does not end because its checkpoint can't be written: there may be room later.
        let error = snapshot.write(place, self.origin).err();
        if let (Some(error), None) = (&error, &*failure) {
            say(format_args!("warning: no checkpoint: {error}; the render goes on"));
        }
        *failure = error;
        *last = Instant::now();
    }
}
