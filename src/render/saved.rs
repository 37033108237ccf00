//! Checkpoints and parts: what a file holds of a render.

use super::adaptive::Adaptive;
use super::cells::Cells;
use super::error_pixels::ErrorPixels;
use super::recipe::{RESUMABLE, Recipe};
use super::tile::Work;
use super::view::View;
use super::{Ended, Rendered, Settings};
use crate::error::{Error, Result};
use crate::film::file::{FilePlace, FilmRecord, Reader, Writer};
use crate::film::{BLOCK, Film, HALVES, Region, Stops};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::Path;

/// Whose sums a file holds.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Origin {
    /// What determines them.
    pub recipe: Recipe,
    /// What the picture's file will say about the camera.
    pub view: View,
    /// The brightest light of the scene, the unit of some counts.
    pub brightest: f64,
}

/// What a film file is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FileKind {
    /// A render on its way.
    Checkpoint,
    /// All samples of some pixels, or some chunks of them.
    Part,
}

#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Header {
    kind: FileKind,
    pub(super) origin: Origin,
    pub(super) film: FilmRecord,
    pub(super) work: Work,
    /// How many numbers the error pixels have.
    pub(super) error_sums: u64,
    /// Samples in the cells of the chunk under way.
    cells: Option<u64>,
    /// Samples after which the blocks were judged.
    blocks: Option<u64>,
    /// Whether where the blocks stopped is told.
    pub(super) has_stops: bool,
    pub(super) has_features: bool,
    /// Whether there is more noise in a part than was asked for.
    pub(super) noise_missed: bool,
    /// The seconds and the samples of all passes.
    passed: [f64; 2],
}

/// A render between two passes.
pub struct Snapshot<'r> {
    pub(super) film: &'r Film,
    pub(super) cells: Option<&'r Cells>,
    pub(super) work: Work,
    pub(super) error_pixels: Option<&'r ErrorPixels>,
    pub(super) blocks: Option<&'r Adaptive>,
    pub(super) passed: [f64; 2],
    pub(super) is_last: bool,
}

impl Snapshot<'_> {
    /// Whether no other will follow from which as much could be had.
    pub fn is_last(&self) -> bool {
        self.is_last
    }

    /// Samples that every pixel has.
    pub fn samples(&self) -> u64 {
        self.film.samples() + self.cells.map_or(0, |cells| cells.samples)
    }

    /// Writes a checkpoint.
    ///
    /// # Errors
    /// As [`FilePlace::write`].
    pub fn write(&self, place: &FilePlace, origin: &Origin) -> Result<()> {
        let header = Header {
            kind: FileKind::Checkpoint,
            origin: origin.clone(),
            film: FilmRecord::new(self.film),
            work: self.work,
            error_sums: self.error_pixels.map_or(0, ErrorPixels::count),
            cells: self.cells.map(|cells| cells.samples),
            blocks: self.blocks.map(Adaptive::samples),
            has_stops: false,
            has_features: false,
            noise_missed: false,
            passed: self.passed,
        };
        place.write(&header, |writer| {
            FilmRecord::write(self.film, writer)?;
            if let Some(pixels) = self.error_pixels {
                writer.doubles(pixels.numbers())?;
            }
            if let Some(cells) = self.cells {
                writer.doubles(cells.values.iter().copied())?;
            }
            self.blocks.map_or(Ok(()), |blocks| blocks.write(writer))
        })
    }
}

impl Rendered {
    /// Writes all that was rendered as a part, from which `merge` makes the picture.
    ///
    /// # Errors
    /// As [`FilePlace::write`].
    pub fn write_part(&self, place: &FilePlace, origin: &Origin) -> Result<()> {
        let header = Header {
            kind: FileKind::Part,
            origin: origin.clone(),
            film: FilmRecord::new(&self.film),
            work: Work { samples: self.samples, counters: self.counters },
            error_sums: self.error_sums.len() as u64,
            cells: None,
            blocks: None,
            has_stops: self.film.stopped().is_some(),
            has_features: self.features.is_some(),
            noise_missed: self.film.stopped().is_some() && self.ended != Ended::Complete,
            passed: [0.0; 2],
        };
        place.write(&header, |writer| self.write_sums(writer))
    }

    fn write_sums(&self, writer: &mut Writer) -> io::Result<()> {
        FilmRecord::write(&self.film, writer)?;
        writer.doubles(self.error_sums.iter().copied())?;
        if let Some(stops) = self.film.stopped() {
            writer.integers(stops.iter().flatten().copied())?;
        }
        self.features.as_ref().map_or(Ok(()), |features| features.write(writer))
    }
}

/// A checkpoint or part whose checksum is right.
pub struct FilmFile {
    pub(super) header: Header,
    pub(super) reader: Reader,
}

impl FilmFile {
    /// Opens it.
    ///
    /// # Errors
    /// [`Error::Io`] if it can't be read, [`Error::Film`] if it is no film file, is damaged, or of another version.
    pub fn open(path: &Path) -> Result<FilmFile> {
        let (header, reader): (Header, Reader) = Reader::open(path)?;
        let recipe = &header.origin.recipe;
        if recipe.version != env!("CARGO_PKG_VERSION") {
            let why = format!("is of version {}, not {}", recipe.version, env!("CARGO_PKG_VERSION"));
            return Err(reader.refuse(&why));
        }
        if !recipe.can_be() {
            return Err(reader.refuse("is of a render that can't be"));
        }
        Ok(FilmFile { header, reader })
    }

    /// What the file at a path says that it is, if it is one; its content is not looked at.
    pub fn kind_of(path: &Path) -> Option<FileKind> {
        #[derive(Deserialize)]
        struct Kind {
            kind: FileKind,
        }
        Reader::header(path).map(|Kind { kind }| kind)
    }

    /// What it is.
    pub fn kind(&self) -> FileKind {
        self.header.kind
    }

    /// Whose sums it holds.
    pub fn origin(&self) -> &Origin {
        &self.header.origin
    }

    /// An error about this file; `why` goes on after its name.
    pub fn refuse(&self, why: &str) -> Error {
        self.reader.refuse(why)
    }

    /// The sums of the pixels of its region.
    pub(super) fn read_film(&mut self, settings: &Settings) -> Result<Film> {
        self.header.film.read(settings.frame(), &mut self.reader)
    }

    /// Where the blocks of a part stopped, in the order of the picture's blocks.
    pub(super) fn read_stops(&mut self, settings: &Settings) -> Result<Vec<[u64; HALVES]>> {
        let blocks = u64::from(settings.width.div_ceil(BLOCK)) * u64::from(settings.height.div_ceil(BLOCK));
        let stops = self.reader.integers(HALVES as u64 * blocks)?;
        let samples = self.header.film.samples();
        Ok(stops.as_chunks::<HALVES>().0.iter().map(|stops| stops.map(|stop| stop.min(samples))).collect())
    }

    /// The render that made a finished part, but for what is seen and what its error is.
    ///
    /// # Errors
    /// [`Error::Film`] if it does not hold what its header says.
    pub fn rendered(mut self) -> Result<Rendered> {
        let settings = self.origin().recipe.settings();
        let mut film = self.read_film(&settings)?;
        let error_sums = self.reader.doubles(self.header.error_sums)?;
        if self.header.has_stops {
            let stops = self.read_stops(&settings)?;
            film.set_stops(Stops::new(settings.width, settings.height, settings.scrambles(), stops)?);
        }
        let Header { origin, work, noise_missed, .. } = self.header;
        Ok(Rendered {
            film,
            samples: work.samples,
            counters: work.counters,
            features: None,
            clamp: settings.clamp,
            brightest: origin.brightest,
            error: None,
            error_sums,
            ended: if noise_missed { Ended::OutOfSamples } else { Ended::Complete },
            build_seconds: 0.0,
            render_seconds: 0.0,
        })
    }

    /// Where a render of `recipe` goes on.
    ///
    /// # Errors
    /// [`Error::Film`] if it is no checkpoint, of anything else than `recipe` is, or has more samples than that wants.
    pub fn state(mut self, settings: &Settings, recipe: &Recipe) -> Result<State> {
        if self.kind() != FileKind::Checkpoint {
            return Err(self.refuse("is a finished part, not a checkpoint"));
        }
        let differences = self.origin().recipe.differences(recipe, &RESUMABLE);
        if !differences.is_empty() {
            return Err(
                self.refuse(&format!("is of another render: it differs in {}", differences.join(", ")))
            );
        }
        let (mut film, range) = (self.read_film(settings)?, settings.chunk_range());
        let taken = film.samples();
        let is_run = match film.runs().as_slice() {
            [] => true,
            [run] => run.start == range.start && (run.end - run.start) * u64::from(settings.chunk) == taken,
            _ => false,
        };
        if !is_run {
            return Err(self.refuse("does not hold the first chunks"));
        }
        let Header { work, error_sums, cells, blocks, passed, .. } = self.header;
        let mut reader = self.reader;
        let count = ErrorPixels::wanted(settings).map_or(0, |pixels| pixels.count());
        if error_sums != count
            || blocks.is_some() != settings.noise.is_some()
            || blocks.is_some_and(|n| n != taken)
        {
            return Err(reader.refuse("holds other sums than such a render has"));
        }
        let error_sums = reader.doubles(error_sums)?;
        let first = range.start * u64::from(settings.chunk) + taken;
        let cells = cells.map(|samples| Cells::read(settings, first, samples, &mut reader)).transpose()?;
        let blocks = match (settings.noise, blocks) {
            (Some(target), Some(samples)) => {
                let mut blocks = Adaptive::new(settings, target)?;
                blocks.read(samples, &mut reader)?;
                film.set_stops(blocks.stops()?);
                Some(blocks)
            }
            _ => None,
        };
        let all = taken + cells.as_ref().map_or(0, |cells| cells.samples);
        if all > settings.samples_to_take() {
            let why = format!("has {all} samples already, more than {}", settings.samples_to_take());
            return Err(reader.refuse(&why));
        }
        reader.finish()?;
        let passed = passed.map(|number| if number.is_finite() { number.max(0.0) } else { 0.0 });
        Ok(State { film, cells, work, error_sums, blocks, passed })
    }
}

/// A render between two passes, on its way back.
pub struct State {
    pub(super) film: Film,
    pub(super) cells: Option<Cells>,
    pub(super) work: Work,
    pub(super) error_sums: Vec<f64>,
    pub(super) blocks: Option<Adaptive>,
    pub(super) passed: [f64; 2],
}

impl State {
    /// Samples that every pixel has.
    pub fn samples(&self) -> u64 {
        self.film.samples() + self.cells.as_ref().map_or(0, |cells| cells.samples)
    }
}

/// Whether a part's sums are those of the whole picture.
pub(super) fn is_whole(settings: &Settings) -> bool {
    settings.region == Region::All && settings.chunks.is_none()
}
