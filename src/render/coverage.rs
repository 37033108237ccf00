//! Whether parts make a whole picture: which are there twice, and which are missing.

use super::recipe::Recipe;
use crate::film::Region;
use std::collections::BTreeMap;
use std::path::Path;

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
        problems.extend(chunk_problems(whole, *region, group));
    }
    problems.extend(pixel_problems(whole, &groups));
    problems
}

/// Of the parts with the same pixels.
fn chunk_problems(whole: &Recipe, region: Region, group: &mut [&Listed<'_>]) -> Vec<String> {
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
            problems.push(missing(whole, region, Some([done, start])));
        }
        if end > done {
            (done, before) = (end, Some(*part));
        }
    }
    if done < total {
        problems.push(missing(whole, region, Some([done, total])));
    }
    problems
}

/// Of regions.
fn pixel_problems(whole: &Recipe, groups: &BTreeMap<Region, Vec<&Listed<'_>>>) -> Vec<String> {
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
        problems.push(missing(whole, region, None));
    }
    while problems.len() < MOST_NAMED
        && let Some(crop) = first_gap(&mut owners, width, height)
    {
        problems.push(missing(whole, crop, None));
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
fn missing(whole: &Recipe, region: Region, chunks: Option<[u64; 2]>) -> String {
    let all = whole.settings().chunk_range();
    let chunks = chunks.filter(|&[start, end]| [start, end] != [all.start, all.end]);
    let recipe = whole.with_part(region, chunks);
    let name = match region {
        Region::All => "part".to_owned(),
        Region::Crop { left, top, right, bottom } => format!("crop-{left}-{top}-{right}-{bottom}"),
        Region::Part { index, .. } => format!("part-{index}"),
    };
    let name = chunks.map_or(name.clone(), |[start, end]| format!("{name}-{start}-{end}"));
    let what = chunks.map_or(region.to_string(), |[start, end]| format!("{region}, chunks {start}..{end}"));
    let words: Vec<String> = recipe.arguments(&format!("{name}.film"));
    format!("{what} is missing; made by: pathtracer {}", words.join(" "))
}
