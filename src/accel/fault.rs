//! Faults that can be put into an accelerator: a test of identity that finds none of them is worth nothing.

use crate::geometry::TriangleBlock;

/// What is broken about the triangles of an accelerator at exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Boxes are a little smaller than what is in them.
    Padding,
    /// The fourth triangle of every leaf is not tried.
    Lane,
}

/// By how much boxes are too small, as a part of their size.
pub(super) const SHRINK: f32 = 1e-4;

impl Fault {
    /// Breaks the leaves, if that is the fault.
    pub(super) fn spoil(self, blocks: &mut [TriangleBlock]) {
        if self == Fault::Lane {
            blocks.iter_mut().for_each(|block| *block = block.without(3));
        }
    }
}
