//! The stack of a traversal: children yet to be visited, of fixed size.

use super::node::{Child, MAX_DEPTH, WIDTH};

/// A child and the distance at which its box begins. Entries compare by distance first: the bits of floating point
/// numbers that are not negative are ordered like the numbers.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
pub(super) struct Entry(u64);

impl Entry {
    /// `near` is not negative.
    #[inline(always)]
    pub(super) fn new(near: f32, child: Child) -> Entry {
        Entry(u64::from(near.to_bits()) << 32 | u64::from(child.bits()))
    }

    #[inline(always)]
    pub(super) fn child(self) -> Child {
        Child::from_bits(self.0 as u32)
    }

    #[inline(always)]
    fn near(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }
}

/// Every node on the way down leaves at most all of its children here.
const CAPACITY: usize = MAX_DEPTH * WIDTH;

/// Last in, first out.
pub(super) struct Stack {
    entries: [Entry; CAPACITY],
    len: usize,
}

impl Stack {
    #[inline(always)]
    pub(super) fn new() -> Stack {
        Stack { entries: [Entry(0); CAPACITY], len: 0 }
    }

    #[inline(always)]
    pub(super) fn push(&mut self, entry: Entry) {
        self.entries[self.len] = entry;
        self.len += 1;
    }

    /// The next child whose box begins within `limit`.
    #[inline(always)]
    pub(super) fn pop_within(&mut self, limit: f32) -> Option<Child> {
        while self.len > 0 {
            self.len -= 1;
            let entry = self.entries[self.len];
            if entry.near() <= limit {
                return Some(entry.child());
            }
        }
        None
    }

    /// Brings the last `count` entries into order, the nearest last, and takes that one.
    #[inline(always)]
    pub(super) fn sort_top(&mut self, count: usize) -> Child {
        let top = &mut self.entries[self.len - count..self.len];
        for i in 1..top.len() {
            let entry = top[i];
            let mut place = i;
            while place > 0 && top[place - 1] < entry {
                top[place] = top[place - 1];
                place -= 1;
            }
            top[place] = entry;
        }
        self.len -= 1;
        self.entries[self.len].child()
    }
}
