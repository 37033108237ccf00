//! `noise`: blocks that stop when their error is small enough.
//!
//! A half of a block stops when the error that the other half sees is below the target; see [`crate::film::BLOCK`]. Each
//! half is sampled until both have stopped, since the other's end depends on it; what it takes after its own end enters no
//! picture. So the mean of the picture is that of a render without a target, whatever the scene.

use super::Settings;
use super::cells::{Cells, Layout};
use crate::error::Result;
use crate::film::file::{Reader, Writer};
use crate::film::{BLOCK, Frame, HALVES, Stops, relative_weight, samples_of_halves};
use crate::sampling::{SCRAMBLES, Scrambles};
use std::io;
use std::ops::Range;

/// Samples before which no block stops: with fewer, dark pixels have not met their light yet.
pub const NOISE_AFTER: u64 = 64;

/// The blocks of a picture on their way.
pub(super) struct Adaptive {
    target: f64,
    scrambles: Scrambles,
    frame: Frame,
    /// The cells of all samples, in the picture or not.
    sums: Cells,
    blocks: Vec<Block>,
    /// Samples that a pixel of a block which has not stopped has.
    samples: u64,
}

#[derive(Clone, Copy)]
struct Block {
    /// After how many samples the halves stopped.
    stops: [Option<u64>; HALVES],
    /// The error that each half saw last, squared.
    squares: [f64; HALVES],
}

impl Adaptive {
    pub(super) fn new(settings: &Settings, target: f64) -> Result<Adaptive> {
        let Settings { width, height, .. } = *settings;
        let count = width.div_ceil(BLOCK) as usize * height.div_ceil(BLOCK) as usize;
        let columns = width.div_ceil(BLOCK) as usize;
        let block = |number: usize| {
            let (x, y) = ((number % columns) as u32 * BLOCK, (number / columns) as u32 * BLOCK);
            Block::new(settings.region.contains(width, x, y))
        };
        Ok(Adaptive {
            target,
            scrambles: settings.scrambles(),
            frame: settings.frame(),
            sums: Cells::new(settings, 0)?,
            blocks: (0..count).map(block).collect(),
            samples: 0,
        })
    }

    /// Whether a pixel takes samples.
    pub(super) fn takes(&self, x: u32, y: u32) -> bool {
        let columns = self.frame.width().div_ceil(BLOCK) as usize;
        self.blocks[(y / BLOCK) as usize * columns + (x / BLOCK) as usize].is_open()
    }

    /// Whether all blocks have stopped.
    pub(super) fn is_done(&self) -> bool {
        !self.blocks.iter().any(Block::is_open)
    }

    /// The pixels that take samples.
    pub(super) fn open_pixels(&self) -> u64 {
        let open = self.blocks.iter().enumerate().filter(|(_, block)| block.is_open());
        open.map(|(number, _)| self.area(number)).sum()
    }

    /// The root of the mean of the blocks' squared errors, where all have been judged.
    pub(super) fn error(&self) -> Option<f64> {
        let own = self.blocks.iter().filter(|block| block.stops != NOT_THERE);
        let squares = own.map(|block| 0.5 * block.squares.iter().sum::<f64>());
        let (sum, count) = squares.fold((0.0, 0.0), |(sum, count), square| (sum + square, count + 1.0));
        let root = (sum / count).sqrt();
        root.is_finite().then_some(root)
    }

    /// Samples of all pixels until the target is reached, if errors fall as the number of samples to the power of `-slope`.
    pub(super) fn samples_left(&self, slope: f64) -> Option<f64> {
        let target = self.target * self.target;
        let open = self.blocks.iter().enumerate().filter(|(_, block)| block.is_open());
        let left = open.map(|(number, block)| {
            let square = block.squares.iter().fold(0.0, |a: f64, &b| a.max(b));
            let factor = libm::pow(square / target, 0.5 / slope).max(1.0);
            let samples = (factor * self.samples as f64).max(NOISE_AFTER as f64) - self.samples as f64;
            samples * self.area(number) as f64
        });
        Some(left.sum::<f64>()).filter(|left| left.is_finite())
    }

    /// Takes the samples of a chunk, leaves in it only what enters the picture, and decides, after a complete chunk, which
    /// halves stop now.
    pub(super) fn take(&mut self, cells: &mut Cells, is_complete: bool) {
        self.samples += cells.samples;
        for number in 0..self.blocks.len() {
            if !self.blocks[number].is_open() {
                continue;
            }
            let closed = self.blocks[number].stops.map(|stop| stop.is_some());
            for pixel in self.pixels(number) {
                let cell = cells.cell_mut(pixel);
                self.sums.cell_mut(pixel).iter_mut().zip(&*cell).for_each(|(sum, value)| *sum += value);
                (0..HALVES).filter(|&half| closed[half]).for_each(|half| Layout::clear_half(cell, half));
            }
            if is_complete && self.samples >= NOISE_AFTER {
                self.decide(number);
            }
        }
    }

    /// Where the blocks are.
    pub(super) fn stops(&self) -> Result<Stops> {
        let halves = self.blocks.iter().map(|block| block.stops.map(|stop| stop.unwrap_or(self.samples)));
        Stops::new(self.frame.width(), self.frame.height(), self.scrambles, halves.collect())
    }

    /// Stops the halves of a block by what their others see.
    fn decide(&mut self, number: usize) {
        let counts = self.scrambles.counts(self.samples);
        // Long scrambles have no samples yet; then nobody knows.
        let is_known = !counts.contains(&0);
        let square = |half| if is_known { self.square(number, half, &counts) } else { f64::INFINITY };
        let squares = std::array::from_fn(square);
        let (target, samples) = (self.target * self.target, self.samples);
        let block = &mut self.blocks[number];
        block.squares = squares;
        for (half, stop) in block.stops.iter_mut().enumerate() {
            if stop.is_none() && squares[1 - half] <= target {
                *stop = Some(samples);
            }
        }
    }

    /// The squared relative error of a block of the picture if it stopped now, as one half sees it.
    fn square(&self, number: usize, half: usize, counts: &[u64; SCRAMBLES]) -> f64 {
        let samples = samples_of_halves(counts).map(|samples| samples as f64);
        // The picture is the mean of both halves, whose samples vary alike.
        let share = 0.25 * (1.0 / samples[0] + 1.0 / samples[1]);
        let scrambles = || (half..SCRAMBLES).step_by(HALVES);
        let degrees = (SCRAMBLES / HALVES - 1) as f64;
        let (mut total, mut pixels) = (0.0, 0.0);
        for pixel in self.pixels(number) {
            let cell = self.sums.cell(pixel);
            let sums = &cell[Layout::Halved.greys()];
            let mean = scrambles().map(|r| sums[r]).sum::<f64>() / samples[half];
            let squares = scrambles().map(|r| {
                let apart = sums[r] / counts[r] as f64 - mean;
                counts[r] as f64 * (apart * apart)
            });
            let variance = share * (squares.sum::<f64>() / degrees);
            let radiance = Layout::Halved.radiance(cell)[half] * (1.0 / samples[half]);
            total += variance * relative_weight(radiance, mean);
            pixels += 1.0;
        }
        total / pixels
    }

    /// The pixels of a block that takes samples.
    fn pixels(&self, number: usize) -> impl Iterator<Item = usize> + use<> {
        let (columns, rows) = self.sides(number);
        let length = columns.len();
        let starts: Vec<usize> = rows.map(|y| self.frame.number(columns.start, y)).collect();
        starts.into_iter().flat_map(move |start| start..start + length)
    }

    /// The number of pixels of a block.
    fn area(&self, number: usize) -> u64 {
        let (columns, rows) = self.sides(number);
        u64::from(columns.end - columns.start) * u64::from(rows.end - rows.start)
    }

    /// The columns and rows of a block.
    fn sides(&self, number: usize) -> (Range<u32>, Range<u32>) {
        let (width, height) = (self.frame.width(), self.frame.height());
        let columns = width.div_ceil(BLOCK);
        let (left, top) = (number as u32 % columns * BLOCK, number as u32 / columns * BLOCK);
        (left..(left + BLOCK).min(width), top..(top + BLOCK).min(height))
    }
}

/// The stops of a block that takes no samples.
const NOT_THERE: [Option<u64>; HALVES] = [Some(0); HALVES];

/// What a file says of a half that has not stopped.
const OPEN: u64 = u64::MAX;

impl Adaptive {
    /// Samples that a pixel of a block which has not stopped has.
    pub(super) fn samples(&self) -> u64 {
        self.samples
    }

    /// Writes all that is known.
    pub(super) fn write(&self, writer: &mut Writer) -> io::Result<()> {
        writer.doubles(self.sums.values.iter().copied())?;
        let stops = self.blocks.iter().flat_map(|block| block.stops);
        writer.integers(stops.map(|stop| stop.unwrap_or(OPEN)))?;
        writer.doubles(self.blocks.iter().flat_map(|block| block.squares))
    }

    /// Reads what was written after so many samples.
    pub(super) fn read(&mut self, samples: u64, reader: &mut Reader) -> Result<()> {
        self.sums.values = reader.light(self.sums.values.len() as u64)?;
        let stops = reader.integers((HALVES * self.blocks.len()) as u64)?;
        let squares = reader.light((HALVES * self.blocks.len()) as u64)?;
        let read = stops.as_chunks::<HALVES>().0.iter().zip(squares.as_chunks::<HALVES>().0);
        for (block, (stops, &squares)) in self.blocks.iter_mut().zip(read) {
            let stops = stops.map(|stop| (stop != OPEN).then_some(stop));
            let is_absent = block.stops == NOT_THERE;
            if is_absent != (stops == NOT_THERE) || stops.iter().flatten().any(|&stop| stop > samples) {
                return Err(reader.refuse("holds blocks that can't have stopped there"));
            }
            *block = Block { stops, squares };
        }
        self.samples = samples;
        Ok(())
    }
}

impl Block {
    fn new(takes_samples: bool) -> Block {
        match takes_samples {
            true => Block { stops: [None; HALVES], squares: [f64::INFINITY; HALVES] },
            false => Block { stops: NOT_THERE, squares: [0.0; HALVES] },
        }
    }

    fn is_open(&self) -> bool {
        self.stops.contains(&None)
    }
}
