//! A film in a file, node by node.

use super::{Reader, Writer};
use crate::error::Result;
use crate::film::{Film, Frame, Greys, Node, Sums};
use crate::math::Rgb;
use crate::sampling::SCRAMBLES;
use serde::{Deserialize, Serialize};
use std::io;

/// What the header says about the sums.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FilmRecord {
    chunk: u64,
    nodes: Vec<NodeRecord>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct NodeRecord {
    first: u64,
    chunks: u64,
    samples: u64,
    counts: [u64; SCRAMBLES],
    /// Whether the radiance is kept by halves.
    halves: bool,
    greys: GreysRecord,
    /// Whether the deviations are known.
    deviations: bool,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum GreysRecord {
    Unknown,
    One(usize),
    All,
}

/// The most nodes that a film of 2^32 chunks has.
const MOST_NODES: usize = 64;
/// The most chunks of a node.
const MOST_CHUNKS: u64 = 1 << 33;

impl FilmRecord {
    /// Of a film.
    pub fn new(film: &Film) -> FilmRecord {
        let node = |node: &Node| NodeRecord {
            first: node.first,
            chunks: node.chunks,
            samples: node.sums.samples,
            counts: node.sums.counts,
            halves: !node.sums.odd.is_empty(),
            greys: match node.sums.greys {
                Greys::Unknown => GreysRecord::Unknown,
                Greys::One(scramble, _) => GreysRecord::One(scramble),
                Greys::All(_) => GreysRecord::All,
            },
            deviations: !node.sums.deviations.is_empty(),
        };
        FilmRecord { chunk: film.chunk, nodes: film.nodes.iter().map(node).collect() }
    }

    /// Samples per pixel.
    pub fn samples(&self) -> u64 {
        self.nodes.iter().fold(0, |sum, node| node.samples.saturating_add(sum))
    }

    /// Writes the sums of a film.
    ///
    /// # Errors
    /// Those of writing the file.
    pub fn write(film: &Film, writer: &mut Writer) -> io::Result<()> {
        for Node { sums, .. } in &film.nodes {
            writer.doubles(sums.radiance.iter().flat_map(|sum| sum.to_array()))?;
            writer.doubles(sums.odd.iter().flat_map(|sum| sum.to_array()))?;
            match &sums.greys {
                Greys::Unknown => {}
                Greys::One(_, greys) => writer.floats(greys.iter().copied())?,
                Greys::All(greys) => writer.floats(greys.iter().flatten().copied())?,
            }
            writer.floats(sums.deviations.iter().copied())?;
        }
        Ok(())
    }

    /// Reads what was written of the pixels of a frame.
    ///
    /// # Errors
    /// A film that can't be: chunks that overlap, samples beyond a chunk's, sums that are no light; a file that ends before.
    pub fn read(&self, frame: Frame, reader: &mut Reader) -> Result<Film> {
        if self.chunk == 0 || self.chunk > u64::from(u32::MAX) || self.nodes.len() > MOST_NODES {
            return Err(reader.refuse("holds a film that can't be"));
        }
        let pixels = frame.pixels() as u64;
        let mut film = Film::of(frame, self.chunk);
        for record in &self.nodes {
            let node = record.read(self.chunk, pixels, reader)?;
            film.insert(node).map_err(|_| reader.refuse("holds a chunk twice"))?;
        }
        Ok(film)
    }
}

impl NodeRecord {
    fn read(&self, chunk: u64, count: u64, reader: &mut Reader) -> Result<Node> {
        let is_known = !matches!(self.greys, GreysRecord::Unknown);
        let counted = self.counts.iter().try_fold(0u64, |sum, &count| sum.checked_add(count));
        let can_be = self.chunks.is_power_of_two()
            && self.chunks <= MOST_CHUNKS
            && self.first <= MOST_CHUNKS
            && self.first.is_multiple_of(self.chunks)
            && (1..=self.chunks.saturating_mul(chunk)).contains(&self.samples)
            && (!is_known || counted == Some(self.samples))
            && !matches!(self.greys, GreysRecord::One(scramble) if scramble >= SCRAMBLES);
        if !can_be {
            return Err(reader.refuse("holds a node that can't be"));
        }
        let mut plane = || -> Result<Vec<Rgb>> {
            let values = reader.light(3 * count)?;
            Ok(values.chunks_exact(3).map(|rgb| Rgb::new(rgb[0], rgb[1], rgb[2])).collect())
        };
        let radiance = plane()?;
        let odd = if self.halves { plane()? } else { Vec::new() };
        let greys = match self.greys {
            GreysRecord::Unknown => Greys::Unknown,
            GreysRecord::One(scramble) => Greys::One(scramble, reader.floats(count)?),
            GreysRecord::All => {
                let values = reader.floats(SCRAMBLES as u64 * count)?;
                Greys::All(values.as_chunks::<SCRAMBLES>().0.to_vec())
            }
        };
        let deviations = if self.deviations { reader.floats(count)? } else { Vec::new() };
        let sums = Sums { samples: self.samples, radiance, odd, greys, deviations, counts: self.counts };
        Ok(Node { first: self.first, chunks: self.chunks, sums })
    }
}

/// Copies the film of a region to its places in the film of the whole picture. An empty film takes over its chunks; else
/// both must have the same. Whether they had.
pub fn copy_pixels(from: Film, to: &mut Film) -> bool {
    if from.frame == to.frame && to.nodes.is_empty() {
        to.nodes = from.nodes;
        return true;
    }
    let pixels = to.pixels();
    if to.nodes.is_empty() {
        to.nodes = from.nodes.iter().map(|node| node.spread(pixels)).collect();
    }
    let is_alike =
        to.nodes.len() == from.nodes.len() && to.nodes.iter().zip(&from.nodes).all(|(a, b)| a.is_like(b));
    if !is_alike {
        return false;
    }
    let own = from.frame.region();
    for (to_node, from) in to.nodes.iter_mut().zip(from.nodes) {
        for (source, pixel) in own.pixels(to.frame.width(), to.frame.height()).enumerate() {
            to_node.sums.set(pixel, &from.sums, source);
        }
    }
    true
}

impl Node {
    /// An empty node of the same chunks for so many pixels.
    fn spread(&self, pixels: usize) -> Node {
        let Node { first, chunks, sums } = self;
        let plane = |plane: &[Rgb]| if plane.is_empty() { Vec::new() } else { vec![Rgb::ZERO; pixels] };
        let greys = match sums.greys {
            Greys::Unknown => Greys::Unknown,
            Greys::One(scramble, _) => Greys::One(scramble, vec![0.0; pixels]),
            Greys::All(_) => Greys::All(vec![[0.0; SCRAMBLES]; pixels]),
        };
        let (radiance, odd) = (plane(&sums.radiance), plane(&sums.odd));
        let deviations = if sums.deviations.is_empty() { Vec::new() } else { vec![0.0; pixels] };
        let sums = Sums { samples: sums.samples, radiance, odd, greys, deviations, counts: sums.counts };
        Node { first: *first, chunks: *chunks, sums }
    }

    /// Whether another node holds the same samples, in the same form.
    fn is_like(&self, other: &Node) -> bool {
        let (a, b) = (&self.sums, &other.sums);
        let is_same_form = match (&a.greys, &b.greys) {
            (Greys::Unknown, Greys::Unknown) | (Greys::All(_), Greys::All(_)) => true,
            (Greys::One(a, _), Greys::One(b, _)) => a == b,
            _ => false,
        };
        is_same_form
            && (self.first, self.chunks, a.samples, a.counts)
                == (other.first, other.chunks, b.samples, b.counts)
            && a.odd.is_empty() == b.odd.is_empty()
            && a.deviations.is_empty() == b.deviations.is_empty()
    }
}

impl Sums {
    /// Takes over a pixel of sums of the same form.
    fn set(&mut self, pixel: usize, from: &Sums, source: usize) {
        self.radiance[pixel] = from.radiance[source];
        if !self.odd.is_empty() {
            self.odd[pixel] = from.odd[source];
        }
        if !self.deviations.is_empty() {
            self.deviations[pixel] = from.deviations[source];
        }
        match (&mut self.greys, &from.greys) {
            (Greys::One(_, to), Greys::One(_, from)) => to[pixel] = from[source],
            (Greys::All(to), Greys::All(from)) => to[pixel] = from[source],
            _ => {}
        }
    }
}

impl Film {
    /// Adds samples without light, until there are `samples`, as a render has them where its blocks have stopped; `counts`
    /// tells how many of the first so many samples lie in each scramble.
    ///
    /// # Errors
    /// Chunks that the film has already.
    pub fn extend(&mut self, samples: u64, counts: impl Fn(u64) -> [u64; SCRAMBLES]) -> Result<()> {
        let pixels = self.pixels();
        while self.samples() < samples {
            let before = self.samples();
            let first = before / self.chunk;
            let whole = (samples - before) / self.chunk;
            let aligned = if first == 0 { u64::MAX } else { 1 << first.trailing_zeros() };
            let chunks = whole.checked_ilog2().map_or(1, |log| (1 << log).min(aligned));
            let after = samples.min(before + chunks * self.chunk);
            let (low, high) = (counts(before), counts(after));
            let sums = Sums {
                samples: after - before,
                radiance: vec![Rgb::ZERO; pixels],
                odd: vec![Rgb::ZERO; pixels],
                greys: Greys::All(vec![[0.0; SCRAMBLES]; pixels]),
                deviations: Vec::new(),
                counts: std::array::from_fn(|i| high[i] - low[i]),
            };
            self.insert(Node { first, chunks, sums })?;
        }
        Ok(())
    }

    /// The runs of chunks that it has, ascending.
    pub fn runs(&self) -> Vec<std::ops::Range<u64>> {
        let mut runs: Vec<std::ops::Range<u64>> = Vec::new();
        for Node { first, chunks, .. } in &self.nodes {
            match runs.last_mut().filter(|run| run.end == *first) {
                Some(run) => run.end += chunks,
                None => runs.push(*first..first + chunks),
            }
        }
        runs
    }
}
