//! Parts become the picture: the sums of a render on one machine, whatever the split and the order.

use super::coverage::{self, Listed};
use super::error_pixels::ErrorPixels;
use super::features::FeaturePlanes;
use super::recipe::{OF_PARTS, Recipe};
use super::saved::{FileKind, FilmFile, Header, Origin};
use super::tile::Work;
use super::{Ended, Rendered, Settings};
use crate::error::{Error, Result};
use crate::film::file::{copy_pixels, refused};
use crate::film::{BLOCK, Film, HALVES, Region, Stops};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A picture of parts.
pub struct Merged {
    /// As if it had been rendered in one go.
    pub rendered: Rendered,
    /// Of the whole picture.
    pub origin: Origin,
}

/// A part that was found to be whole. Its sums are read when their turn comes, so that neither memory nor open files grow
/// with the number of parts.
struct Part {
    path: PathBuf,
    header: Header,
}

impl Part {
    /// Reads its header, and compares its checksum.
    fn find(path: &Path) -> Result<Part> {
        let FilmFile { header, .. } = FilmFile::open(path).and_then(only_part)?;
        Ok(Part { path: path.into(), header })
    }

    fn recipe(&self) -> &Recipe {
        &self.header.origin.recipe
    }

    /// Opens it again, for its sums.
    fn open(&self) -> Result<FilmFile> {
        let file = FilmFile::open(&self.path).and_then(only_part)?;
        match file.origin().recipe == *self.recipe() {
            true => Ok(file),
            false => Err(file.refuse("was replaced while the parts were read")),
        }
    }
}

/// Puts parts together. `mixed`: whether Embree's own kernels may have had different instruction sets.
///
/// # Errors
/// [`Error::Film`] names every part that is damaged, of another render, or there twice, and the commands that make those
/// which are missing.
pub fn merge(paths: &[PathBuf], mixed: bool) -> Result<Merged> {
    let mut problems = Vec::new();
    let mut parts: Vec<Part> = Vec::new();
    for path in paths {
        match Part::find(path) {
            Ok(part) => parts.push(part),
            Err(error) => problems.push(error.to_string()),
        }
    }
    let Some(origin) = most_common(&parts) else { return Err(Error::Film(problems.join("\n"))) };
    let but: Vec<&str> = OF_PARTS.into_iter().chain(mixed.then_some("instruction set")).collect();
    parts.retain(|part| {
        let differences = part.recipe().differences(&origin.recipe, &but);
        if !differences.is_empty() {
            let why =
                format!("is of another render than most parts: it differs in {}", differences.join(", "));
            problems.push(refused(&part.path, &why).to_string());
        }
        differences.is_empty()
    });
    let settings = origin.recipe.settings();
    settings.check()?;
    let listed = parts.iter().map(|part| Listed { path: &part.path, recipe: part.recipe() });
    problems.extend(coverage::problems(&origin.recipe, &listed.collect::<Vec<_>>()));
    if !problems.is_empty() {
        return Err(Error::Film(problems.join("\n")));
    }
    let mut groups: BTreeMap<Region, Vec<Part>> = BTreeMap::new();
    for part in parts {
        groups.entry(part.recipe().region()).or_default().push(part);
    }
    let rendered = Merge::new(&settings, &groups)?.all(groups)?;
    let rendered = Rendered { brightest: origin.brightest, ..rendered };
    Ok(Merged { rendered, origin })
}

fn only_part(file: FilmFile) -> Result<FilmFile> {
    match file.kind() {
        FileKind::Part => Ok(file),
        FileKind::Checkpoint => {
            Err(file.refuse("is an unfinished render, not a part: its command goes on with it"))
        }
    }
}

/// The whole picture of which most files are parts.
fn most_common(parts: &[Part]) -> Option<Origin> {
    let mut counts: BTreeMap<String, (usize, Origin)> = BTreeMap::new();
    for origin in parts.iter().map(|part| &part.header.origin) {
        let whole = Origin { recipe: origin.recipe.with_part(Region::All, None), ..origin.clone() };
        let (count, first) = counts.entry(whole.recipe.key()).or_insert_with(|| (0, whole.clone()));
        *count += 1;
        // The same scene under several names has the same name in the picture, whatever the order of the parts.
        if whole.recipe.scene < first.recipe.scene {
            *first = whole;
        }
    }
    counts.into_values().max_by_key(|(count, _)| *count).map(|(_, origin)| origin)
}

/// A picture as it grows.
struct Merge<'s> {
    settings: &'s Settings,
    samples: u64,
    film: Film,
    work: Work,
    error_pixels: Option<ErrorPixels>,
    stops: Vec<[u64; HALVES]>,
    features: Option<FeaturePlanes>,
    noise_missed: bool,
}

impl<'s> Merge<'s> {
    fn new(settings: &'s Settings, groups: &BTreeMap<Region, Vec<Part>>) -> Result<Merge<'s>> {
        let firsts = || groups.values().flatten().filter(|part| part.recipe().is_first());
        let has_features = firsts().all(|part| part.header.has_features);
        let samples = groups.values().flatten().map(|part| part.header.film.samples()).max();
        let blocks = settings.width.div_ceil(BLOCK) as usize * settings.height.div_ceil(BLOCK) as usize;
        Ok(Merge {
            settings,
            samples: if settings.noise.is_some() { samples.unwrap_or(0) } else { settings.samples },
            film: Film::new(settings.width, settings.height, settings.chunk.into()),
            work: Work::default(),
            error_pixels: ErrorPixels::wanted(settings),
            stops: if settings.noise.is_some() { vec![[0; HALVES]; blocks] } else { Vec::new() },
            features: has_features.then(|| FeaturePlanes::new(settings)).transpose()?,
            noise_missed: false,
        })
    }

    fn all(mut self, groups: BTreeMap<Region, Vec<Part>>) -> Result<Rendered> {
        for (region, mut parts) in groups {
            parts.sort_by_key(|part| part.recipe().chunks());
            let mut film: Option<Film> = None;
            for part in &parts {
                let sums = self.part(region, part.open()?)?;
                match &mut film {
                    Some(film) => film.merge(sums)?,
                    None => film = Some(sums),
                }
            }
            let Some(mut film) = film else { continue };
            if self.settings.noise.is_some() {
                let scrambles = self.settings.scrambles();
                film.extend(self.samples, |samples| scrambles.counts(samples))?;
            }
            if film.samples() != self.samples || !copy_pixels(film, &mut self.film) {
                let last = parts.last().map(|part| part.path.as_path()).unwrap_or(Path::new(""));
                return Err(refused(last, "does not hold the samples that it should"));
            }
        }
        self.finish()
    }

    /// Takes over all but the film of a part, and returns that.
    fn part(&mut self, region: Region, mut part: FilmFile) -> Result<Film> {
        let own = part.header.origin.recipe.settings();
        let film = part.read_film(&own)?;
        let Header { work, error_sums, has_stops, has_features, noise_missed, .. } = part.header;
        self.work += work;
        self.noise_missed |= noise_missed;
        if has_stops != self.settings.noise.is_some() {
            return Err(part.refuse("holds other sums than such a part has"));
        }
        let numbers = part.reader.doubles(error_sums)?;
        let is_right =
            self.error_pixels.as_mut().is_none_or(|pixels| pixels.add(&numbers, region, own.width));
        if !is_right {
            return Err(part.refuse("holds other sums than such a part has"));
        }
        if has_stops {
            let stops = part.read_stops(&own)?;
            let columns = own.width.div_ceil(BLOCK) as usize;
            for (number, stops) in stops.into_iter().enumerate() {
                let (x, y) = ((number % columns) as u32 * BLOCK, (number / columns) as u32 * BLOCK);
                if region.contains(own.width, x, y) {
                    self.stops[number] = stops;
                }
            }
        }
        if has_features {
            match &mut self.features {
                Some(features) => features.read(self.settings, region, &mut part.reader)?,
                None => FeaturePlanes::new(self.settings)?.read(self.settings, region, &mut part.reader)?,
            }
        }
        part.reader.finish()?;
        Ok(film)
    }

    fn finish(self) -> Result<Rendered> {
        let Merge { settings, mut film, work, error_pixels, stops, features, noise_missed, .. } = self;
        if settings.noise.is_some() {
            film.set_stops(Stops::new(settings.width, settings.height, settings.scrambles(), stops)?);
        }
        let has_scrambles = film.samples() >= settings.scrambles().first_round();
        let error = match &error_pixels {
            _ if has_scrambles => film.picture_error(),
            Some(pixels) => pixels.error(&film, None),
            None => None,
        };
        Ok(Rendered {
            film,
            samples: work.samples,
            counters: work.counters,
            features,
            clamp: settings.clamp,
            brightest: 1.0,
            error,
            error_sums: error_pixels.iter().flat_map(ErrorPixels::numbers).collect(),
            ended: if noise_missed { Ended::OutOfSamples } else { Ended::Complete },
            build_seconds: 0.0,
            render_seconds: 0.0,
        })
    }
}
