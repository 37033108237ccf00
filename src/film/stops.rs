//! Pictures whose blocks have different numbers of samples, without the bias of stopping when it looks good.
//!
//! The scrambles of a pixel form two halves, those of even and those of odd numbers. When one half stops is decided by the
//! other alone, so its mean is that of a number of samples it had no say in; the picture is the mean of both means.

use super::Film;
use crate::error::{Error, Result};
use crate::math::Rgb;
use crate::sampling::{SCRAMBLES, Scrambles};

/// Side of a block in pixels. Blocks are aligned to the picture's top left corner, whatever the tiles.
pub const BLOCK: u32 = 16;

/// The halves of the scrambles, by whose numbers are even and odd.
pub const HALVES: usize = 2;

/// After how many samples the halves of every block took no more.
#[derive(Clone, Debug, PartialEq)]
pub struct Stops {
    scrambles: Scrambles,
    columns: usize,
    halves: Vec<[u64; HALVES]>,
}

impl Stops {
    /// `halves` has an entry a block, row by row from the top left: how far in the order of [`Scrambles`] each half went.
    ///
    /// # Errors
    /// There are not as many blocks as a picture of this size has.
    pub fn new(width: u32, height: u32, scrambles: Scrambles, halves: Vec<[u64; HALVES]>) -> Result<Stops> {
        let (columns, rows) = (width.div_ceil(BLOCK) as usize, height.div_ceil(BLOCK) as usize);
        if halves.len() != columns * rows {
            return Err(Error::Usage("the blocks of another picture can't be those of this film".into()));
        }
        Ok(Stops { scrambles, columns, halves })
    }

    /// Samples of each scramble in the pixel of a column and a row.
    fn counts(&self, (x, y): (u32, u32)) -> [u64; SCRAMBLES] {
        let block = (y / BLOCK) as usize * self.columns + (x / BLOCK) as usize;
        let both = self.halves[block].map(|samples| self.scrambles.counts(samples));
        std::array::from_fn(|scramble| both[scramble % HALVES][scramble])
    }
}

impl Film {
    /// Says where the blocks have stopped so far. From now on the film's sums are those of two halves.
    pub fn set_stops(&mut self, stops: Stops) {
        self.stops = Some(stops);
    }

    /// After how many samples the halves of every block stopped, row by row, where blocks stop.
    pub fn stopped(&self) -> Option<&[[u64; HALVES]]> {
        self.stops.as_ref().map(|stops| stops.halves.as_slice())
    }

    /// Samples of each scramble in a pixel of a film with blocks.
    pub(super) fn stopped_counts(&self, pixel: usize) -> Option<[u64; SCRAMBLES]> {
        self.stops.as_ref().map(|stops| stops.counts(self.frame.place(pixel)))
    }

    /// The mean of a pixel whose scrambles hold so many samples: that of the means of both halves, or of the first where
    /// the second has none.
    pub(super) fn mean_of_halves(&self, pixel: usize, counts: &[u64; SCRAMBLES]) -> Rgb {
        let sums = |odd: bool| {
            let sums = self.nodes.iter().rev().map(|node| node.sums.half(odd)[pixel]);
            sums.reduce(|sum, node| sum + node).unwrap_or(Rgb::ZERO)
        };
        let [even, odd] = samples_of_halves(counts).map(|samples| samples as f64);
        if odd == 0.0 {
            return sums(false) * (1.0 / even.max(1.0));
        }
        sums(false) * (0.5 / even) + sums(true) * (0.5 / odd)
    }
}

/// Samples of the even and of the odd scrambles.
pub fn samples_of_halves(counts: &[u64; SCRAMBLES]) -> [u64; HALVES] {
    std::array::from_fn(|half| counts.iter().skip(half).step_by(HALVES).sum())
}
