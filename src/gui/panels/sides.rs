//! The panels beside the picture: unfolded, or folded away where the window is too narrow for them.

use crate::gui::settings::Kept;

/// Points of the window's width below which two panels would leave the picture less than half: there, only one is unfolded,
/// and that only if it was asked for.
pub const NARROW: f32 = 1000.0;

/// A panel beside the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The fields, on the left.
    Fields,
    /// The pixel, the objects and their materials, on the right.
    Objects,
}

impl Side {
    /// Both.
    pub const ALL: [Side; 2] = [Side::Fields, Side::Objects];

    /// The name in the window.
    pub const fn name(self) -> &'static str {
        match self {
            Side::Fields => "Fields",
            Side::Objects => "Objects",
        }
    }
}

/// Which panels are unfolded.
#[derive(Debug, Default)]
pub struct Sides {
    is_narrow: bool,
    /// The one that is unfolded while the window is narrow; of a wide window [`Kept::folded`] says which.
    alone: Option<Side>,
}

impl Sides {
    /// Follows the window's width, in points.
    pub(super) fn follow(&mut self, width: f32) {
        self.is_narrow = width < NARROW;
    }

    /// Whether there is place for one panel at most.
    pub fn is_narrow(&self) -> bool {
        self.is_narrow
    }

    /// Whether a panel is unfolded.
    pub fn is_shown(&self, side: Side, kept: &Kept) -> bool {
        if self.is_narrow { self.alone == Some(side) } else { !kept.folded[side as usize] }
    }

    /// Folds a panel away, or unfolds it.
    pub(super) fn toggle(&mut self, side: Side, kept: &mut Kept) {
        if self.is_narrow {
            self.alone = if self.alone == Some(side) { None } else { Some(side) };
        } else {
            kept.folded[side as usize] ^= true;
        }
    }
}
