//! Values of options: names of choices, numbers in ranges.

use crate::film::Region;
use crate::render::MIN_TIME;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap_complete::Shell;
use std::time::Duration;

/// Parses a whole number from 1 to `most`.
pub(super) fn whole(most: u64) -> impl Fn(&str) -> Result<u64, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|number| (1..=most).contains(number));
        number.ok_or_else(|| format!("expected a whole number from 1 to {most}"))
    }
}

/// Parses a whole number from 0 to `most`.
pub(super) fn whole_or_none(most: u64) -> impl Fn(&str) -> Result<u64, String> + Clone {
    move |text| if text == "0" { Ok(0) } else { whole(most)(text) }
}

/// Parses a time such as `90`, `1.5s`, `500ms`, `2m` or `1h`; seconds without a unit.
pub(super) fn time(text: &str) -> Result<Duration, String> {
    const UNITS: [(&str, f64); 4] = [("ms", 1e-3), ("s", 1.0), ("m", 60.0), ("h", 3600.0)];
    let unit = UNITS.iter().find_map(|(unit, seconds)| Some((text.strip_suffix(unit)?, *seconds)));
    let (number, seconds) = unit.unwrap_or((text, 1.0));
    let time = number.parse().ok().and_then(|number: f64| Duration::try_from_secs_f64(number * seconds).ok());
    time.filter(|&time| time >= MIN_TIME)
        .ok_or_else(|| format!("expected a time of at least {MIN_TIME:?}, such as 30, 1.5s, 500ms, 2m or 1h"))
}

/// Parses a whole number from 1 to `most`, maybe in thousands (`50k`) or millions (`1M`).
pub(super) fn amount(most: u64) -> impl Fn(&str) -> Result<u64, String> + Clone {
    move |text| {
        let number = with_suffix(text).filter(|number| (1..=most).contains(number));
        number.ok_or_else(|| format!("expected a whole number from 1 to {most}, such as 5000, 50k or 1M"))
    }
}

/// A whole number with an optional `k` or `M` behind it.
fn with_suffix(text: &str) -> Option<u64> {
    let (digits, factor) = match text.strip_suffix(['k', 'K']) {
        Some(digits) => (digits, 1000),
        None => text.strip_suffix('M').map_or((text, 1), |digits| (digits, 1_000_000)),
    };
    // "+5" would parse too.
    let is_number = digits.bytes().all(|byte| byte.is_ascii_digit());
    digits.parse::<u64>().ok().filter(|_| is_number)?.checked_mul(factor)
}

/// Numbers of triangles: from one size to another in steps of ten, both included.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Ladder(pub(super) Vec<usize>);

/// The fewest and the most triangles of a generated mesh.
const TRIANGLES: std::ops::RangeInclusive<u64> = 100..=100_000_000;

/// Parses a [`Ladder`]: `1k..10M`, or `100k` for one size.
pub(super) fn ladder(text: &str) -> Result<Ladder, String> {
    let (first, last) = text.split_once("..").unwrap_or((text, text));
    let ends = [first, last].map(|end| with_suffix(end).filter(|end| TRIANGLES.contains(end)));
    let [Some(first), Some(last)] = ends else {
        return Err("expected a number of triangles from 100 to 100M, or a range such as 1k..10M".to_owned());
    };
    if first > last {
        return Err(format!("the range ends before it begins; did you mean {last}..{first}?"));
    }
    let steps =
        std::iter::successors(Some(first), |size| size.checked_mul(10)).take_while(|&size| size < last);
    Ok(Ladder(steps.chain([last]).map(|size| size as usize).collect()))
}

/// Parses a picture's size, such as `320x180`.
pub(super) fn size(most: u32) -> impl Fn(&str) -> Result<[u32; 2], String> + Clone {
    move |text| {
        let sides = text.split_once('x').map(|(width, height)| [width, height].map(|side| side.parse().ok()));
        match sides {
            Some([Some(width), Some(height)])
                if [width, height].iter().all(|side| (1..=most).contains(side)) =>
            {
                Ok([width, height])
            }
            _ => Err(format!("expected a width and a height from 1 to {most}, such as 320x180")),
        }
    }
}

/// Parses `I/N`.
pub(super) fn part(text: &str) -> Result<Region, String> {
    let numbers =
        text.split_once('/').and_then(|(index, count)| Some((index.parse().ok()?, count.parse().ok()?)));
    match numbers {
        Some((index, count)) if index < count => Ok(Region::Part { index, count }),
        _ => Err("expected I/N, with I from 0 to N - 1, such as 0/8".to_owned()),
    }
}

/// Parses `X0,Y0,X1,Y1`.
pub(super) fn crop(text: &str) -> Result<Region, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|number| number.parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[left, top, right, bottom]) => Ok(Region::Crop { left, top, right, bottom }),
        _ => Err("expected X0,Y0,X1,Y1 in pixels, such as 0,0,64,48".to_owned()),
    }
}

/// Parses `A..B`.
pub(super) fn chunks(text: &str) -> Result<[u64; 2], String> {
    let numbers =
        text.split_once("..").and_then(|(start, end)| Some([start.parse().ok()?, end.parse().ok()?]));
    numbers.ok_or_else(|| "expected A..B, such as 0..4".to_owned())
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0);
    number.ok_or_else(|| "expected a finite number > 0".to_owned())
}

pub(super) fn stops(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.abs() <= 100.0);
    number.ok_or_else(|| "expected a number from -100 to 100".to_owned())
}

/// Parses the name of one of the values `all`.
pub(super) fn choice<T: Copy + Send + Sync + 'static>(
    all: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(all.iter().map(move |&value| name(value))).try_map(move |text| {
        let found = all.iter().find(|&&value| name(value) == text);
        found.copied().ok_or("unknown name")
    })
}

/// Parses `on` and `off`.
pub(super) fn switch() -> impl TypedValueParser<Value = bool> {
    choice(&[true, false], |is_on| if is_on { "on" } else { "off" })
}

/// Parses the name of a shell that completions can be made for.
pub(super) fn shell() -> impl TypedValueParser<Value = Shell> {
    PossibleValuesParser::new(["bash", "zsh", "fish"]).try_map(|name| name.parse::<Shell>())
}
