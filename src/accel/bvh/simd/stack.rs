//! What a traversal has yet to visit.
#![allow(unsafe_code)]

use std::mem::MaybeUninit;

use super::super::node::{Child, MAX_DEPTH, WIDTH};

/// Bits of an entry's distance that are not part of it.
pub(super) const LANE_BITS: u32 = 7;

/// A child and the distance at which its box begins, less its lowest three bits. Entries compare by distance first: the
/// bits of floating point numbers that are not negative are ordered like the numbers.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
#[repr(transparent)]
pub(in super::super) struct Entry(u64);

impl Entry {
    /// `near` is not negative.
    #[inline(always)]
    pub(in super::super) fn new(near: f32, child: Child) -> Entry {
        Entry(u64::from(near.to_bits()) << 32 | u64::from(child.bits()))
    }

    #[inline(always)]
    pub(in super::super) fn child(self) -> Child {
        Child::from_bits(self.0 as u32)
    }

    #[inline(always)]
    fn near(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32 & !LANE_BITS)
    }
}

/// Every node on the way down leaves at most all of its children here; [`Stack::push_many`] needs room for as many more.
const CAPACITY: usize = (MAX_DEPTH + 1) * WIDTH;

/// Children yet to be visited: last in, first out.
///
/// The entries before `len` are written; the others are left as they are, because to clear 2 kB a ray takes longer than
/// to visit a node.
pub(in super::super) struct Stack {
    entries: [MaybeUninit<Entry>; CAPACITY],
    len: usize,
}

impl Stack {
    #[inline(always)]
    pub(in super::super) fn new() -> Stack {
        Stack { entries: [const { MaybeUninit::uninit() }; CAPACITY], len: 0 }
    }

    /// How many there are.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.len
    }

    #[inline(always)]
    pub(in super::super) fn push(&mut self, entry: Entry) {
        self.entries[self.len].write(entry);
        self.len += 1;
    }

    /// Pushes the first `count` of these, at most eight.
    #[inline(always)]
    pub(super) fn push_many(&mut self, entries: [Entry; WIDTH], count: u32) {
        let room = &mut self.entries[self.len..self.len + WIDTH];
        room.copy_from_slice(&entries.map(MaybeUninit::new));
        self.len += (count as usize).min(WIDTH);
    }

    /// The last one.
    #[inline(always)]
    pub(in super::super) fn pop(&mut self) -> Option<Entry> {
        self.len = self.len.checked_sub(1)?;
        // SAFETY: it was written when `len` rose above it.
        Some(unsafe { self.entries[self.len].assume_init() })
    }

    /// The next child whose box begins within `limit`.
    #[inline(always)]
    pub(in super::super) fn pop_within(&mut self, limit: f32) -> Option<Child> {
        while let Some(entry) = self.pop() {
            if entry.near() <= limit {
                return Some(entry.child());
            }
        }
        None
    }

    /// Brings the entries from `bottom` on into order, the nearest last.
    #[inline(always)]
    pub(super) fn sort_from(&mut self, bottom: usize) {
        // SAFETY: everything before `len` has been written.
        let at = |entries: &[MaybeUninit<Entry>], place: usize| unsafe { entries[place].assume_init() };
        for end in bottom + 1..self.len {
            let mut place = end;
            while place > bottom && at(&self.entries, place - 1) < at(&self.entries, place) {
                self.entries.swap(place - 1, place);
                place -= 1;
            }
        }
    }
}
