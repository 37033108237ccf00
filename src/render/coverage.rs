//! Whether parts make a whole picture: which are there twice, and which are missing.

use super::recipe::Recipe;
use crate::film::Region;
use crate::words::shell_line;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A part.
pub(super) struct Listed<'p> {
    pub(super) path: &'p Path,
    pub(super) recipe: &'p Recipe,
}

/// The most missing pieces that are named.
const MOST_NAMED: usize = 16;

/// What keeps `parts` from being the picture of `whole`, one sentence each.
pub(super) fn problems(whole: &Recipe, parts: &[Listed<'_>]) -> Vec<String> {
    let mut groups: BTreeMap<Region, Vec<&Listed<'_>>> = BTreeMap::new();
    for part in parts {
        groups.entry(part.recipe.region()).or_default().push(part);
    }
    let mut problems = Vec::new();
    for (region, group) in &mut groups {
        problems.extend(chunk_problems(whole, *region, group, parts));
    }
    problems.extend(pixel_problems(whole, &groups, parts));
    problems
}

/// Of the parts with the same pixels.
fn chunk_problems(
    whole: &Recipe,
    region: Region,
    group: &mut [&Listed<'_>],
    all: &[Listed<'_>],
) -> Vec<String> {
    let total = whole.settings().chunk_range().end;
    let range = |part: &Listed<'_>| part.recipe.chunks().unwrap_or([0, total]);
    group.sort_by_key(|part| range(part));
    let mut problems = Vec::new();
    let mut done = 0;
    let mut before: Option<&Listed<'_>> = None;
    for part in group.iter() {
        let [start, end] = range(part);
        if let Some(before) = before.filter(|_| start < done) {
            problems.push(twice(
                before.path,
                part.path,
                &format!("{region}, chunks {start}..{}", done.min(end)),
            ));
        }
        if start > done {
            problems.push(missing(whole, region, Some([done, start]), all));
        }
        if end > done {
            (done, before) = (end, Some(*part));
        }
    }
    if done < total {
        problems.push(missing(whole, region, Some([done, total]), all));
    }
    problems
}

/// Of regions.
fn pixel_problems(
    whole: &Recipe,
    groups: &BTreeMap<Region, Vec<&Listed<'_>>>,
    all: &[Listed<'_>],
) -> Vec<String> {
    let (width, height) = (whole.width, whole.height);
    let paths: Vec<&Path> = groups.values().filter_map(|group| Some(group.first()?.path)).collect();
    let mut owners = vec![u32::MAX; width as usize * height as usize];
    let mut problems = Vec::new();
    for (number, region) in groups.keys().enumerate() {
        let mut other = None;
        for pixel in region.pixels(width, height) {
            match owners[pixel] {
                u32::MAX => owners[pixel] = number as u32,
                owner => other = Some(owner),
            }
        }
        if let Some(owner) = other {
            problems.push(twice(paths[owner as usize], paths[number], "some pixels"));
        }
    }
    for region in missing_parts(groups, &owners, width, height) {
        region.pixels(width, height).for_each(|pixel| owners[pixel] = 0);
        problems.push(missing(whole, region, None, all));
    }
    while problems.len() < MOST_NAMED
        && let Some(crop) = first_gap(&mut owners, width, height)
    {
        problems.push(missing(whole, crop, None, all));
    }
    problems
}

/// The parts of the same numbering of which no pixel is there.
fn missing_parts(
    groups: &BTreeMap<Region, Vec<&Listed<'_>>>,
    owners: &[u32],
    width: u32,
    height: u32,
) -> Vec<Region> {
    let counts = groups.keys().filter_map(|region| match region {
        Region::Part { count, .. } => Some(*count),
        _ => None,
    });
    let Some(count) = counts.max() else { return Vec::new() };
    let all = (0..count).map(|index| Region::Part { index, count });
    let is_free = |region: &Region| region.pixels(width, height).all(|pixel| owners[pixel] == u32::MAX);
    all.filter(|region| !groups.contains_key(region)).filter(is_free).collect()
}

/// The largest crop at the first pixel that is missing; it counts as there from now on.
fn first_gap(owners: &mut [u32], width: u32, height: u32) -> Option<Region> {
    let first = owners.iter().position(|&owner| owner == u32::MAX)?;
    let (left, top) = (first as u32 % width, first as u32 / width);
    let is_free =
        |owners: &[u32], x: u32, y: u32| owners[y as usize * width as usize + x as usize] == u32::MAX;
    let right = (left..width).find(|&x| !is_free(owners, x, top)).unwrap_or(width);
    let has_all = |y: u32| (left..right).all(|x| is_free(owners, x, y));
    let bottom = (top..height).find(|&y| !has_all(y)).unwrap_or(height);
    let crop = Region::Crop { left, top, right, bottom };
    crop.pixels(width, height).for_each(|pixel| owners[pixel] = 0);
    Some(crop)
}

fn twice(a: &Path, b: &Path, what: &str) -> String {
    format!("{} and {} both hold {what}: leave one out", a.display(), b.display())
}

/// What is missing, and the command that makes it.
fn missing(whole: &Recipe, region: Region, chunks: Option<[u64; 2]>, others: &[Listed<'_>]) -> String {
    let all = whole.settings().chunk_range();
    let chunks = chunks.filter(|&[start, end]| [start, end] != [all.start, all.end]);
    let recipe = whole.with_part(region, chunks);
    let what = chunks.map_or(region.to_string(), |[start, end]| format!("{region}, chunks {start}..{end}"));
    let path = like_others(region, chunks, others).unwrap_or_else(|| {
        let beside = others.first().and_then(|other| other.path.parent()).unwrap_or(Path::new(""));
        beside.join(name(region, chunks))
    });
    let words = recipe.arguments(&path.to_string_lossy());
    format!("{what} is missing; made by: {}", shell_line(["pathtracer".to_owned()].iter().chain(&words)))
}

fn name(region: Region, chunks: Option<[u64; 2]>) -> String {
    let name = match region {
        Region::All => "part".to_owned(),
        Region::Crop { left, top, right, bottom } => format!("crop-{left}-{top}-{right}-{bottom}"),
        Region::Part { index, .. } => format!("part-{index}"),
    };
    chunks.map_or(format!("{name}.film"), |[start, end]| format!("{name}-{start}-{end}.film"))
}

/// Where parts are numbered, and another one's name ends with its number: that name with this one's number, unless it is that
/// of yet another one.
fn like_others(region: Region, chunks: Option<[u64; 2]>, others: &[Listed<'_>]) -> Option<PathBuf> {
    let (Region::Part { index, .. }, None) = (region, chunks) else { return None };
    let others_are_not = |path: &Path| others.iter().all(|other| other.path != path);
    others.iter().find_map(|other| {
        let Region::Part { index: number, .. } = other.recipe.region() else { return None };
        let (stem, extension) = (other.path.file_stem()?.to_str()?, other.path.extension()?.to_str()?);
        let start = stem.trim_end_matches(|c: char| c.is_ascii_digit());
        let digits = &stem[start.len()..];
        let is_number = other.recipe.chunks().is_none() && digits.parse() == Ok(number);
        let name = format!("{start}{index:0width$}.{extension}", width = digits.len());
        let path = other.path.with_file_name(name);
        (is_number && others_are_not(&path)).then_some(path)
    })
}
