//! Where the pixels of a region lie in planes that hold no others: so a part of a picture takes the memory of its own
//! pixels.

use super::{BLOCK, Region};
use std::ops::Range;

/// The pixels of a region of a picture, numbered row by row from the top left; pixels between them have no number.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    width: u32,
    height: u32,
    region: Region,
    /// Of a part: the number of the first pixel of each row of blocks, and behind the last.
    bands: Vec<usize>,
}

/// Pixels side by side, whose numbers follow one another.
pub struct Run {
    /// Columns.
    pub x: Range<u32>,
    /// The row.
    pub y: u32,
}

/// The blocks of a part in one row of blocks.
struct Band {
    /// The first one's column of blocks.
    first: u32,
    /// How many.
    count: u32,
    /// Their pixels in one row of pixels.
    width: usize,
}

impl Frame {
    /// Of a picture of this size. The region must be one of such a picture: see [`Region::check`].
    pub fn new(width: u32, height: u32, region: Region) -> Frame {
        let mut frame = Frame { width, height, region, bands: Vec::new() };
        if let Region::Part { .. } = region {
            let mut bands = vec![0];
            for row in 0..height.div_ceil(BLOCK) {
                let rows = (row * BLOCK + BLOCK).min(height) - row * BLOCK;
                bands.push(bands[row as usize] + rows as usize * frame.band(row).width);
            }
            frame.bands = bands;
        }
        frame
    }

    /// Columns of the picture.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows of the picture.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The region.
    pub fn region(&self) -> Region {
        self.region
    }

    /// How many pixels it has.
    pub fn pixels(&self) -> usize {
        match self.region {
            Region::All | Region::Crop { .. } => self.region.area(self.width, self.height) as usize,
            Region::Part { .. } => self.bands.last().copied().unwrap_or(0),
        }
    }

    /// The number of a pixel of the region.
    pub fn number(&self, x: u32, y: u32) -> usize {
        match self.region {
            Region::All => y as usize * self.width as usize + x as usize,
            Region::Crop { left, top, right, .. } => {
                (y - top) as usize * (right - left) as usize + (x - left) as usize
            }
            Region::Part { count, .. } => {
                let band = self.band(y / BLOCK);
                let before = (x / BLOCK - band.first) / count * BLOCK + x % BLOCK;
                self.bands[(y / BLOCK) as usize] + (y % BLOCK) as usize * band.width + before as usize
            }
        }
    }

    /// The column and the row of the pixel with a number.
    pub fn place(&self, number: usize) -> (u32, u32) {
        let at =
            |number: usize, width: u32| ((number % width as usize) as u32, (number / width as usize) as u32);
        match self.region {
            Region::All => at(number, self.width),
            Region::Crop { left, top, right, .. } => {
                let (x, y) = at(number, right - left);
                (left + x, top + y)
            }
            Region::Part { count, .. } => {
                // Rows of blocks without any begin where the next one does, so the last that begins here has the pixel.
                let row = self.bands.partition_point(|&start| start <= number) - 1;
                let band = self.band(row as u32);
                let (x, y) = at(number - self.bands[row], band.width as u32);
                ((band.first + x / BLOCK * count) * BLOCK + x % BLOCK, row as u32 * BLOCK + y)
            }
        }
    }

    /// All pixels in the order of their numbers.
    pub fn runs(&self) -> impl Iterator<Item = Run> + '_ {
        (0..self.height).flat_map(move |y| {
            let (first, step, count) = match self.region {
                Region::All => (0..self.width, 0, 1),
                Region::Crop { left, top, right, bottom } => {
                    (left..right, 0, u32::from((top..bottom).contains(&y)))
                }
                Region::Part { count, .. } => {
                    let band = self.band(y / BLOCK);
                    let start = band.first * BLOCK;
                    (start..start + BLOCK, count.saturating_mul(BLOCK), band.count)
                }
            };
            (0..count).map(move |i| {
                let start = first.start + i * step;
                Run { x: start..(start + (first.end - first.start)).min(self.width), y }
            })
        })
    }

    /// The blocks of a part in a row of blocks.
    fn band(&self, row: u32) -> Band {
        let Region::Part { index, count } = self.region else { return Band { first: 0, count: 0, width: 0 } };
        let columns = self.width.div_ceil(BLOCK);
        let before = u64::from(row) * u64::from(columns) % u64::from(count);
        let first = (u64::from(index) + u64::from(count) - before) % u64::from(count);
        if first >= u64::from(columns) {
            return Band { first: 0, count: 0, width: 0 };
        }
        let first = first as u32;
        let own = (columns - 1 - first) / count + 1;
        let missing =
            if (columns - 1 - first).is_multiple_of(count) { columns * BLOCK - self.width } else { 0 };
        Band { first, count: own, width: (own * BLOCK - missing) as usize }
    }
}
