//! Which pixels of a picture a render takes samples of.

use super::BLOCK;
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::Range;

/// Pixels of a picture. Their samples are those of a render of the whole picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Region {
    /// The whole picture.
    #[default]
    All,
    /// The columns from `left` up to `right` and the rows from `top` up to `bottom`, both without the last; from the top
    /// left.
    Crop {
        /// First column.
        left: u32,
        /// First row.
        top: u32,
        /// Behind the last column.
        right: u32,
        /// Behind the last row.
        bottom: u32,
    },
    /// Every `count`th block of 16 x 16 pixels, row by row, from block `index` on.
    Part {
        /// 0 to `count` - 1.
        index: u32,
        /// The number of parts.
        count: u32,
    },
}

impl Region {
    /// Whether it is a region of a picture of this size; `whole_blocks` asks for blocks of 16 x 16 pixels that are not cut.
    ///
    /// # Errors
    /// A part or a crop that the picture does not have; one that cuts blocks where they must be whole.
    pub fn check(self, width: u32, height: u32, whole_blocks: bool) -> Result<()> {
        let blocks = u64::from(width.div_ceil(BLOCK)) * u64::from(height.div_ceil(BLOCK));
        let why = match self {
            Region::Part { index, count } if count == 0 || index >= count => {
                format!("parts are numbered from 0 to {}", count.saturating_sub(1))
            }
            Region::Part { count, .. } if u64::from(count) > blocks => {
                format!(
                    "the picture has {blocks} blocks of {BLOCK} x {BLOCK} pixels, which make as many parts at most"
                )
            }
            Region::Crop { left, top, right, bottom }
                if !(left < right && right <= width && top < bottom && bottom <= height) =>
            {
                format!("a crop has X0 < X1 <= {width} and Y0 < Y1 <= {height}")
            }
            Region::Crop { left, top, right, bottom } if whole_blocks => {
                let is_whole = |at: u32, side: u32| at.is_multiple_of(BLOCK) || at == side;
                if is_whole(left, 0) && is_whole(top, 0) && is_whole(right, width) && is_whole(bottom, height)
                {
                    return Ok(());
                }
                format!("with --noise a crop can't cut blocks of {BLOCK} x {BLOCK} pixels")
            }
            _ => return Ok(()),
        };
        Err(Error::Usage(format!("{self} can't be rendered: {why}")))
    }

    /// Whether it holds a pixel of a picture of this width.
    #[inline]
    pub fn contains(self, width: u32, x: u32, y: u32) -> bool {
        match self {
            Region::All => true,
            Region::Crop { left, top, right, bottom } => {
                (left..right).contains(&x) && (top..bottom).contains(&y)
            }
            Region::Part { index, count } => {
                let block = u64::from(y / BLOCK) * u64::from(width.div_ceil(BLOCK)) + u64::from(x / BLOCK);
                block % u64::from(count) == u64::from(index)
            }
        }
    }

    /// The numbers of its pixels, ascending; pixels are counted row by row from the top left.
    pub fn pixels(self, width: u32, height: u32) -> impl Iterator<Item = usize> {
        let row = move |y: u32| {
            let columns =
                (0..width.div_ceil(BLOCK)).flat_map(move |column| self.run(width, column * BLOCK, y));
            columns.map(move |x| y as usize * width as usize + x as usize)
        };
        (0..height).flat_map(row)
    }

    /// The columns of its pixels in the row `y` of the block that begins at the column `x`.
    fn run(self, width: u32, x: u32, y: u32) -> Range<u32> {
        let block = x..(x + BLOCK).min(width);
        match self {
            Region::All => block,
            Region::Crop { left, top, right, bottom } if (top..bottom).contains(&y) => {
                block.start.max(left)..block.end.min(right)
            }
            Region::Part { .. } if self.contains(width, x, y) => block,
            _ => 0..0,
        }
    }

    /// How many pixels it has.
    pub fn area(self, width: u32, height: u32) -> u64 {
        let side = |block: u32, side: u32| u64::from((block * BLOCK + BLOCK).min(side) - block * BLOCK);
        match self {
            Region::All => u64::from(width) * u64::from(height),
            Region::Crop { left, top, right, bottom } => {
                u64::from(right.saturating_sub(left)) * u64::from(bottom.saturating_sub(top))
            }
            Region::Part { .. } => {
                let blocks = (0..height.div_ceil(BLOCK))
                    .flat_map(|row| (0..width.div_ceil(BLOCK)).map(move |column| (column, row)));
                let own = blocks.filter(|&(x, y)| self.contains(width, x * BLOCK, y * BLOCK));
                own.map(|(x, y)| side(x, width) * side(y, height)).sum()
            }
        }
    }

    /// The option that asks for it.
    pub fn option(self) -> Option<[String; 2]> {
        match self {
            Region::All => None,
            Region::Crop { left, top, right, bottom } => {
                Some(["--crop".into(), format!("{left},{top},{right},{bottom}")])
            }
            Region::Part { index, count } => Some(["--part".into(), format!("{index}/{count}")]),
        }
    }
}

impl fmt::Display for Region {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Region::All => write!(f, "the whole picture"),
            Region::Crop { left, top, right, bottom } => {
                write!(f, "the crop {left},{top},{right},{bottom}")
            }
            Region::Part { index, count } => write!(f, "part {index}/{count}"),
        }
    }
}
