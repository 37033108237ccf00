//! What a render holds while it goes on.

use super::cells::Cells;
use crate::film::Film;
use crate::math::Rgb;
use rayon::prelude::*;

/// The picture after a pass.
#[derive(Clone, Copy)]
pub struct SoFar<'r> {
    film: &'r Film,
    /// Of the chunk under way.
    cells: Option<&'r Cells>,
}

impl<'r> SoFar<'r> {
    pub(super) fn new(film: &'r Film, cells: Option<&'r Cells>) -> SoFar<'r> {
        SoFar { film, cells }
    }

    /// The complete chunks.
    pub fn film(&self) -> &'r Film {
        self.film
    }

    /// Samples that every pixel has, or the most that one has where blocks have stopped.
    pub fn samples(&self) -> u64 {
        self.film.samples() + self.cells.map_or(0, |cells| cells.samples)
    }

    /// Adds to `means` the mean of every pixel, row by row from the top left, after clearing it. It has the bits of
    /// [`Film::means`] after a render of as many samples.
    pub fn means(&self, means: &mut Vec<Rgb>) {
        means.clear();
        let Some(cells) = self.cells else { return means.extend(self.film.means()) };
        let weight = 1.0 / self.samples().max(1) as f64;
        let mean = |pixel| self.film.sum_after(Some(cells.sum(pixel)), pixel) * weight;
        (0..self.film.pixels()).into_par_iter().map(mean).collect_into_vec(means);
    }
}
