//! Parts become the picture: the sums of a render on one machine, whatever the split and the order.

use super::coverage::{self, Listed};
use super::error_pixels::ErrorPixels;
use super::features::FeaturePlanes;
use super::recipe::OF_PARTS;
use super::saved::{FileKind, FilmFile, Origin};
use super::tile::Work;
use super::{Ended, Rendered, Settings};
use crate::error::{Error, Result};
use crate::film::file::copy_pixels;
use crate::film::{BLOCK, Film, HALVES, Region, Stops};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A picture of parts.
pub struct Merged {
    /// As if it had been rendered in one go.
    pub rendered: Rendered,
    /// Of the whole picture.
    pub origin: Origin,
}

/// Puts parts together. `mixed`: whether Embree's own kernels may have had different instruction sets.
///
/// # Errors
/// [`Error::Film`] names every part that is damaged, of another render, or there twice, and the commands that make those
/// which are missing.
pub fn merge(paths: &[PathBuf], mixed: bool) -> Result<Merged> {
    let mut problems = Vec::new();
    let mut parts: Vec<FilmFile> = Vec::new();
    for path in paths {
        match FilmFile::open(path).and_then(only_part) {
            Ok(part) => parts.push(part),
            Err(error) => problems.push(error.to_string()),
        }
    }
    let Some(origin) = most_common(&parts) else { return Err(Error::Film(problems.join("\n"))) };
    let but: Vec<&str> = OF_PARTS.into_iter().chain(mixed.then_some("instruction set")).collect();
    parts.retain(|part| {
        let differences = part.origin().recipe.differences(&origin.recipe, &but);
        if !differences.is_empty() {
            let why =
                format!("is of another render than most parts: it differs in {}", differences.join(", "));
            problems.push(part.refuse(&why).to_string());
        }
        differences.is_empty()
    });
    let settings = origin.recipe.settings();
    settings.check()?;
    let listed = parts.iter().map(|part| Listed { path: part.reader.path(), recipe: &part.origin().recipe });
    problems.extend(coverage::problems(&origin.recipe, &listed.collect::<Vec<_>>()));
    if !problems.is_empty() {
        return Err(Error::Film(problems.join("\n")));
    }
    let mut groups: BTreeMap<Region, Vec<FilmFile>> = BTreeMap::new();
    for part in parts {
        groups.entry(part.origin().recipe.region()).or_default().push(part);
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
fn most_common(parts: &[FilmFile]) -> Option<Origin> {
    let mut counts: BTreeMap<String, (usize, Origin)> = BTreeMap::new();
    for origin in parts.iter().map(FilmFile::origin) {
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
}

impl<'s> Merge<'s> {
    fn new(settings: &'s Settings, groups: &BTreeMap<Region, Vec<FilmFile>>) -> Result<Merge<'s>> {
        let firsts = || groups.values().flatten().filter(|part| part.header.origin.recipe.is_first());
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
        })
    }

    fn all(mut self, groups: BTreeMap<Region, Vec<FilmFile>>) -> Result<Rendered> {
        for (region, mut parts) in groups {
            parts.sort_by_key(|part| part.origin().recipe.chunks());
            let mut film: Option<Film> = None;
            let mut last = None;
            for part in parts {
                last = Some(part.reader.path().to_path_buf());
                let sums = self.part(region, part)?;
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
            if film.samples() != self.samples || !copy_pixels(film, region, &mut self.film) {
                let name = last.unwrap_or_default();
                return Err(Error::Film(format!(
                    "{} does not hold the samples that it should",
                    name.display()
                )));
            }
        }
        self.finish()
    }

    /// Takes over all but the film of a part, and returns that.
    fn part(&mut self, region: Region, mut part: FilmFile) -> Result<Film> {
        let own = part.header.origin.recipe.settings();
        let film = part.read_film(&own)?;
        let header = &part.header;
        self.work += header.work;
        let (error_sums, has_stops, has_features) =
            (header.error_sums, header.has_stops, header.has_features);
        if has_stops != self.settings.noise.is_some() {
            return Err(part.refuse("holds other sums than such a part has"));
        }
        let mut reader = part.reader;
        let numbers = reader.doubles(error_sums)?;
        let is_right =
            self.error_pixels.as_mut().is_none_or(|pixels| pixels.add(&numbers, region, own.width));
        if !is_right {
            return Err(reader.refuse("holds other sums than such a part has"));
        }
        if has_stops {
            let stops = reader.integers((HALVES * self.stops.len()) as u64)?;
            let columns = own.width.div_ceil(BLOCK) as usize;
            for (number, stops) in stops.as_chunks::<HALVES>().0.iter().enumerate() {
                let (x, y) = ((number % columns) as u32 * BLOCK, (number / columns) as u32 * BLOCK);
                if region.contains(own.width, x, y) {
                    self.stops[number] = stops.map(|stop| stop.min(self.samples));
                }
            }
        }
        if has_features {
            match &mut self.features {
                Some(features) => features.read(self.settings, region, &mut reader)?,
                None => FeaturePlanes::new(self.settings)?.read(self.settings, region, &mut reader)?,
            }
        }
        reader.finish()?;
        Ok(film)
    }

    fn finish(self) -> Result<Rendered> {
        let Merge { settings, mut film, work, error_pixels, stops, features, .. } = self;
        if settings.noise.is_some() {
            film.set_stops(Stops::new(settings.width, settings.height, settings.scrambles(), stops)?);
        }
        let has_scrambles = film.samples() >= settings.scrambles().first_round();
        let error = match &error_pixels {
            _ if has_scrambles => film.picture_error(),
            Some(pixels) => pixels.error(&film),
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
            ended: Ended::Complete,
            build_seconds: 0.0,
            render_seconds: 0.0,
        })
    }
}
