//! How the samples of a pixel are spread over independent scrambles of the points, whose means tell the error.

use std::ops::Range;

/// The scrambles of a pixel.
pub const SCRAMBLES: usize = 8;

/// The order in which a pixel's samples visit its scrambles.
///
/// First every scramble gets `length` points, one scramble after the other; then each gets as many again, and so on. So
/// the points of a scramble are always the first ones of its sequence, whose convergence goes on, and after `length` x 8 x
/// 2^k samples all scrambles have equally many. Until `length` samples there is one scramble, and nothing is lost by the
/// others; from `length` x 8 on there are error bars.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scrambles {
    length: u64,
}

/// A point of a scramble.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// 0 to 7, or more in another set of eight.
    pub scramble: usize,
    /// In the sequence of the scramble.
    pub index: u64,
}

impl Scrambles {
    /// Scrambles of `length` points in the first round, from 1 to 2^32.
    pub fn new(length: u64) -> Scrambles {
        Scrambles { length: length.clamp(1, 1 << 32) }
    }

    /// Points of each scramble in the first round.
    pub fn length(self) -> u64 {
        self.length
    }

    /// From so many samples on every scramble has its first points.
    pub fn first_round(self) -> u64 {
        SCRAMBLES as u64 * self.length
    }

    /// Where sample `sample` < 2^32 of a pixel lies.
    pub fn place(self, sample: u64) -> Place {
        let (start, length) = self.round(sample);
        let into = sample - start;
        let before = if start == 0 { 0 } else { length };
        Place { scramble: (into / length) as usize, index: before + into % length }
    }

    /// How many points of each scramble the first `samples` samples hold.
    pub fn counts(self, samples: u64) -> [u64; SCRAMBLES] {
        let Some(last) = samples.checked_sub(1) else { return [0; SCRAMBLES] };
        let (start, length) = self.round(last);
        let before = if start == 0 { 0 } else { length };
        std::array::from_fn(|scramble| {
            let first = start + scramble as u64 * length;
            before + samples.saturating_sub(first).min(length)
        })
    }

    /// The scramble that all of these samples lie in, if there is one.
    pub fn only(self, samples: Range<u64>) -> Option<usize> {
        let (first, last) = (self.place(samples.start), self.place(samples.end.saturating_sub(1)));
        let is_one =
            first.scramble == last.scramble && first.index + samples.end == last.index + samples.start + 1;
        is_one.then_some(first.scramble)
    }

    /// The first sample of the round that a sample belongs to, and how many points each scramble gets in it.
    fn round(self, sample: u64) -> (u64, u64) {
        match (sample / self.first_round()).checked_ilog2() {
            None => (0, self.length),
            Some(doublings) => (self.first_round() << doublings, self.length << doublings),
        }
    }
}

impl Place {
    /// The index by which a [`Sampler`](super::Sampler) knows the point: its blocks of 2^32 are unrelated.
    pub fn sample_index(self) -> u64 {
        (self.scramble as u64) << 32 | self.index
    }

    /// The same point in another set of eight scrambles, unrelated to that of number 0.
    pub fn in_set(self, set: usize) -> Place {
        Place { scramble: self.scramble + SCRAMBLES * set, ..self }
    }
}
