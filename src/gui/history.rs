//! Undo and redo.

use crate::scene::edit::Editable;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Changes that follow each other faster than this are one: a drag of the mouse, a typed number.
const TOGETHER: Duration = Duration::from_millis(500);
/// The most steps that are remembered.
const MOST: usize = 200;

/// The states before and after the present one.
#[derive(Debug, Default)]
pub struct History {
    past: Vec<Arc<Editable>>,
    future: Vec<Arc<Editable>>,
    last: Option<Instant>,
}

impl History {
    /// Remembers the state before a change.
    pub fn push(&mut self, before: Arc<Editable>) {
        let is_more = self.last.is_some_and(|last| last.elapsed() < TOGETHER) && !self.past.is_empty();
        self.last = Some(Instant::now());
        self.future.clear();
        if !is_more {
            self.past.push(before);
            let too_many = self.past.len().saturating_sub(MOST);
            self.past.drain(..too_many);
        }
    }

    /// The state before the present one, or after it.
    pub fn step(&mut self, present: Arc<Editable>, is_back: bool) -> Option<Arc<Editable>> {
        let (from, to) =
            if is_back { (&mut self.past, &mut self.future) } else { (&mut self.future, &mut self.past) };
        let other = from.pop()?;
        to.push(present);
        self.last = None;
        Some(other)
    }
}
