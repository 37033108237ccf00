//! How much the two halves of a pixel's samples differ.

/// The halves of the first samples of a pixel, as sums of a number.
///
/// Their difference tells the variance of the sum of both. For independent samples it is unbiased; for points that are spread
/// better together than each half of them alone, it is too large.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// The sums of both.
    pub sums: [f64; 2],
    /// The samples of both.
    pub counts: [u64; 2],
}

/// The numbers of samples whose halves are compared: powers of two inside the first chunk, then the chunk times powers of two,
/// as the nodes of the film have them.
#[derive(Clone, Copy, Debug)]
pub struct Halving {
    chunk: u64,
}

impl Pair {
    /// A standard deviation whose square is an estimate of the variance of the sum of both halves: their means differ by the
    /// variances of both, of which the sum's is n_1 n_2 times. Zero where one has no samples.
    pub fn deviation(&self) -> f64 {
        let [n1, n2] = self.counts.map(|count| count as f64);
        if n1 == 0.0 || n2 == 0.0 {
            return 0.0;
        }
        // Sums beyond the range of numbers have no difference.
        ((self.sums[0] / n1 - self.sums[1] / n2).abs() * (n1 * n2).sqrt()).min(f64::MAX)
    }
}

impl Halving {
    /// Of films with so many samples a chunk, at least one.
    pub fn new(chunk: u64) -> Halving {
        Halving { chunk }
    }

    /// The largest number of samples whose halves are compared that is not above `samples`; zero for none.
    pub fn largest(&self, samples: u64) -> u64 {
        match (samples / self.chunk).checked_ilog2() {
            Some(doublings) => self.chunk << doublings,
            None => samples.checked_ilog2().map_or(0, |doublings| 1 << doublings),
        }
    }

    /// Which half a sample is of the number that has it in the second: 0 for the first sample, then counted upward.
    pub fn level(&self, sample: u64) -> usize {
        let of_chunk = (self.chunk - 1).checked_ilog2().map_or(0, |doublings| doublings + 1);
        let level = match (sample / self.chunk).checked_ilog2() {
            Some(doublings) => of_chunk + doublings + 1,
            None => sample.checked_ilog2().map_or(0, |doublings| doublings + 1),
        };
        level as usize
    }
}
