//! The sums of all samples.
//!
//! Samples are counted in chunks of a fixed number. Inside a chunk a pixel's samples are summed in f64 in sample order.
//! Chunk sums are combined in a binary tree that is fixed by the index of the chunk: the chunks `[i 2^k, (i + 1) 2^k)`
//! form a node, the sum of its two halves. A film keeps the largest nodes that are complete, as a binary counter keeps
//! its digits; so the order in which chunks arrive, and any split of a render at chunk borders, make the same bits.

mod error_bar;
pub mod file;
mod frame;
mod halving;
mod picture_error;
mod ratio;
mod region;
mod stops;
mod student;
mod sums;

pub use error_bar::ErrorBar;
pub use frame::{Frame, Run};
pub use halving::{Halving, Pair};
pub(crate) use picture_error::relative_weight;
pub use picture_error::{Estimate, PictureError, PictureErrorSum, Pixels};
pub(crate) use ratio::{Chosen, Measures, Whole};
pub use region::Region;
pub use stops::{BLOCK, HALVES, Stops, samples_of_halves};
pub use student::quantile;
pub(crate) use sums::grey;
pub use sums::{Greys, Sums};

use crate::error::{Error, Result};
use crate::math::Rgb;
use crate::sampling::SCRAMBLES;

/// The sum of an aligned run of chunks.
#[derive(Clone, Debug, PartialEq)]
struct Node {
    /// Index of the first chunk, a multiple of `chunks`.
    first: u64,
    /// Number of chunks, a power of two.
    chunks: u64,
    /// Fewer samples than the chunks have room for where sampling ended inside a chunk.
    sums: Sums,
}

/// The sums of a picture's samples, one a pixel; every pixel has the same number of samples, unless blocks have stopped.
///
/// The film of a part of a picture holds the pixels of its region alone, and counts only them.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    frame: Frame,
    chunk: u64,
    /// Ascending by `first`, without overlap.
    nodes: Vec<Node>,
    /// Where blocks have stopped.
    stops: Option<Stops>,
}

impl Film {
    /// A film without samples, of `width` x `height` pixels and `chunk` > 0 samples a chunk.
    pub fn new(width: u32, height: u32, chunk: u64) -> Film {
        Film::of(Frame::new(width, height, Region::All), chunk)
    }

    /// A film without samples, of the pixels of a frame.
    pub fn of(frame: Frame, chunk: u64) -> Film {
        Film { frame, chunk, nodes: Vec::new(), stops: None }
    }

    /// Pixels in a row of the picture.
    pub fn width(&self) -> u32 {
        self.frame.width()
    }

    /// Rows of the picture.
    pub fn height(&self) -> u32 {
        self.frame.height()
    }

    /// Samples of a chunk.
    pub fn chunk(&self) -> u64 {
        self.chunk
    }

    /// The pixels that it holds.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// How many they are.
    pub fn pixels(&self) -> usize {
        self.frame.pixels()
    }

    /// Samples that every pixel has, or the most that one has where blocks have stopped.
    pub fn samples(&self) -> u64 {
        self.nodes.iter().map(|node| node.sums.samples).sum()
    }

    /// Samples of a pixel, counted row by row from the top left.
    pub fn samples_of(&self, pixel: usize) -> u64 {
        self.stopped_counts(pixel).map_or_else(|| self.samples(), |counts| counts.iter().sum())
    }

    /// Samples that every pixel has in each scramble, where no block has stopped; none where that is not known.
    pub fn counts(&self) -> [u64; SCRAMBLES] {
        if self.nodes.iter().any(|node| node.sums.greys == Greys::Unknown) {
            return [0; SCRAMBLES];
        }
        std::array::from_fn(|scramble| self.nodes.iter().map(|node| node.sums.counts[scramble]).sum())
    }

    /// Adds the sums of one chunk, of at most the chunk's samples. Chunks may come in any order.
    ///
    /// # Errors
    /// The film has this chunk already; sums of another size, or of more samples than a chunk has.
    pub fn add(&mut self, chunk: u64, sums: Sums) -> Result<()> {
        if sums.radiance.len() != self.pixels() || sums.samples > self.chunk {
            return Err(Error::Usage("a chunk of another size can't be added to this film".into()));
        }
        self.insert(Node { first: chunk, chunks: 1, sums })
    }

    /// Adds the chunks of another part of the same render.
    ///
    /// # Errors
    /// The sizes differ, or a chunk is in both.
    pub fn merge(&mut self, other: Film) -> Result<()> {
        if (&self.frame, self.chunk) != (&other.frame, other.chunk) {
            return Err(Error::Usage("films of different sizes can't be merged".into()));
        }
        other.nodes.into_iter().try_for_each(|node| self.insert(node))
    }

    /// The mean of every pixel, row by row from the top left; zero before the first sample.
    pub fn means(&self) -> impl Iterator<Item = Rgb> + '_ {
        let pixels = if self.nodes.is_empty() { 0 } else { self.pixels() };
        let weight = 1.0 / self.samples().max(1) as f64;
        (0..pixels).map(move |pixel| self.mean(pixel, weight))
    }

    /// The mean of a pixel, given one over the number of samples.
    fn mean(&self, pixel: usize, weight: f64) -> Rgb {
        match self.stopped_counts(pixel) {
            Some(counts) => self.mean_of_halves(pixel, &counts),
            None => self.sum(pixel) * weight,
        }
    }

    /// The sum of a pixel's samples, counted row by row from the top left.
    pub fn sum(&self, pixel: usize) -> Rgb {
        self.sum_after(None, pixel)
    }

    /// The same with the sum of a chunk that is still to be added, `last`.
    pub(crate) fn sum_after(&self, last: Option<Rgb>, pixel: usize) -> Rgb {
        let sums = self.nodes.iter().rev().map(|node| node.sums.radiance[pixel]);
        last.into_iter().chain(sums).reduce(|sum, node| sum + node).unwrap_or(Rgb::ZERO)
    }

    /// How many sums a pixel are held at once, at most, while `chunks` chunks arrive in order.
    pub fn most_nodes(chunks: u64) -> u64 {
        u64::from(chunks.checked_ilog2().unwrap_or(0)) + 1
    }

    fn insert(&mut self, node: Node) -> Result<()> {
        let at = self.nodes.partition_point(|other| other.first < node.first);
        let before = at.checked_sub(1).and_then(|i| self.nodes.get(i));
        let overlaps = before.is_some_and(|other| other.first + other.chunks > node.first)
            || self.nodes.get(at).is_some_and(|other| node.first + node.chunks > other.first);
        if overlaps {
            return Err(Error::Usage(format!("the film has the samples of chunk {} already", node.first)));
        }
        self.nodes.insert(at, node);
        self.carry(at);
        Ok(())
    }

    /// Combines the node at `at` with its other half, and the result again, as long as both are complete.
    fn carry(&mut self, mut at: usize) {
        loop {
            let node = &self.nodes[at];
            let is_left = (node.first / node.chunks).is_multiple_of(2);
            let left = if is_left { Some(at) } else { at.checked_sub(1) };
            let Some(left) = left.filter(|&left| self.are_halves(left)) else { return };
            let right = self.nodes.remove(left + 1);
            let Node { first, chunks, sums } = self.nodes.remove(left);
            self.nodes.insert(left, Node { first, chunks: 2 * chunks, sums: sums.join(right.sums) });
            at = left;
        }
    }

    /// Whether the nodes at `left` and after it are the complete halves of a node.
    fn are_halves(&self, left: usize) -> bool {
        let (Some(a), Some(b)) = (self.nodes.get(left), self.nodes.get(left + 1)) else { return false };
        let is_complete = |node: &Node| node.sums.samples == node.chunks * self.chunk;
        let fit =
            a.chunks == b.chunks && (a.first / a.chunks).is_multiple_of(2) && a.first + a.chunks == b.first;
        fit && is_complete(a) && is_complete(b)
    }
}
