//! Materials of OBJ files (MTL), and what they become among the four of the scene format.

use super::desc::MaterialKind;
use super::obj::Fault;
use crate::error::Diagnostic;
use crate::math::Rgb;

/// A material as its file describes it; what is not given is `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Mtl {
    /// Behind `newmtl`.
    pub(crate) name: String,
    diffuse: Option<Rgb>,
    specular: Option<Rgb>,
    emission: Option<Rgb>,
    filter: Option<Rgb>,
    exponent: Option<f64>,
    index: Option<f64>,
    dissolve: Option<f64>,
    illumination: Option<f64>,
    /// The file behind `map_Kd`.
    pub(crate) picture: Option<String>,
}

/// What a file says.
#[derive(Debug, Default)]
pub(crate) struct Library {
    /// Its materials.
    pub(crate) materials: Vec<Mtl>,
    /// The names of statements that were not understood, each once.
    pub(crate) ignored: Vec<String>,
    /// What is wrong with it.
    pub(crate) faults: Vec<Fault>,
}

/// The largest component of a colour, as in scenes.
const MOST: f64 = 1e100;

/// The reflectance of what has no `Kd`.
const DEFAULT_DIFFUSE: f64 = 0.8;

impl Library {
    /// Reads the text of a file, whose encoding does not matter: statements are ASCII.
    pub(crate) fn parse(bytes: &[u8]) -> Library {
        let text = String::from_utf8_lossy(bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes));
        let mut library = Library::default();
        for (number, line) in text.lines().enumerate() {
            let statement = line.split('#').next().unwrap_or_default();
            let mut words = statement.split_whitespace();
            let Some(keyword) = words.next() else { continue };
            let rest: Vec<&str> = words.collect();
            if let Err(message) = library.add(keyword, &rest) {
                let column = line.find(keyword).map_or(1, |at| line[..at].chars().count() + 1);
                let excerpt = Diagnostic::excerpt(line, column);
                library.faults.push(Fault { message, line: number + 1, column, excerpt });
            }
        }
        library
    }

    fn add(&mut self, keyword: &str, rest: &[&str]) -> Result<(), String> {
        if keyword == "newmtl" {
            self.materials.push(Mtl { name: rest.join(" "), ..Mtl::default() });
            return Ok(());
        }
        if let Some(space) = rest.first().filter(|word| ["spectral", "xyz"].contains(*word)) {
            // Colours of other spaces.
            self.ignore(format!("{keyword} {space}"));
            return Ok(());
        }
        let Some(material) = self.materials.last_mut() else {
            return Err(format!("{keyword} stands before the first newmtl"));
        };
        match keyword {
            "Kd" => material.diffuse = Some(color(keyword, rest)?),
            "Ks" => material.specular = Some(color(keyword, rest)?),
            "Ke" => material.emission = Some(color(keyword, rest)?),
            "Tf" => material.filter = Some(color(keyword, rest)?),
            "Ns" => material.exponent = Some(number(keyword, rest)?),
            "Ni" => material.index = Some(number(keyword, rest)?),
            "d" => material.dissolve = Some(number(keyword, rest)?),
            "Tr" => material.dissolve = Some(1.0 - number(keyword, rest)?.min(1.0)),
            "illum" => material.illumination = Some(number(keyword, rest)?),
            "map_Kd" => material.picture = file_name(rest),
            other => self.ignore(other.to_owned()),
        }
        Ok(())
    }

    fn ignore(&mut self, statement: String) {
        if !self.ignored.contains(&statement) {
            self.ignored.push(statement);
        }
    }
}

/// Three numbers, or one for all three.
fn color(keyword: &str, rest: &[&str]) -> Result<Rgb, String> {
    let expected = || format!("{keyword} takes three numbers from 0 to {MOST:e}");
    let numbers = rest.iter().map(|word| word.parse().ok()).collect::<Option<Vec<f64>>>().unwrap_or_default();
    let color = match numbers[..] {
        [all] => Rgb::splat(all),
        [r, g, b] => Rgb::new(r, g, b),
        _ => return Err(expected()),
    };
    let is_good = color.min_element() >= 0.0 && color.max_element() <= MOST;
    if is_good { Ok(color) } else { Err(expected()) }
}

fn number(keyword: &str, rest: &[&str]) -> Result<f64, String> {
    let number = rest.last().and_then(|word| word.parse().ok());
    let number = number.filter(|number: &f64| number.is_finite() && *number >= 0.0);
    number.ok_or_else(|| format!("{keyword} takes a finite number >= 0"))
}

/// What follows the options of a map. Backslashes are those of another system.
fn file_name(mut words: &[&str]) -> Option<String> {
    while let [option, rest @ ..] = words
        && option.starts_with('-')
    {
        let is_value = |word: &&&str| word.parse::<f64>().is_ok() || ["on", "off"].contains(*word);
        let values = rest.iter().take_while(is_value).count();
        words = rest.get(values..).unwrap_or_default();
    }
    (!words.is_empty()).then(|| words.join(" ").replace('\\', "/"))
}

impl Mtl {
    /// What it becomes:
    /// - `d` below 1, or `illum` 4, 6, 7 or 9: refractive, with `Tf` and 1 / `Ni`.
    /// - `Ke`: diffuse and emitting.
    /// - `illum` 3 or 5, or `Ks` without `Kd`: reflective.
    /// - `Ks` beside `Kd` (`illum` 2 or not given): a coat with the share of `Ks`, both as bright as given.
    /// - else diffuse.
    pub(crate) fn kind(&self) -> MaterialKind {
        let white = |color: Rgb| color.min(Rgb::ONE);
        let specular = self.specular.unwrap_or(Rgb::ZERO);
        // Alone it is a mirror's.
        let missing = if specular == Rgb::ZERO { Rgb::splat(DEFAULT_DIFFUSE) } else { Rgb::ZERO };
        let diffuse = self.diffuse.unwrap_or(missing);
        let emission = self.emission.unwrap_or(Rgb::ZERO);
        let model = self.illumination.unwrap_or(2.0);
        let is_mirror = [3.0, 5.0].contains(&model);
        if self.dissolve.is_some_and(|d| d < 1.0) || [4.0, 6.0, 7.0, 9.0].contains(&model) {
            let index = self.index.filter(|index| *index > 0.0).unwrap_or(1.0);
            return MaterialKind::Refractive {
                color: white(self.filter.unwrap_or(Rgb::ONE)),
                ratio: 1.0 / index,
            };
        }
        if emission != Rgb::ZERO || (specular == Rgb::ZERO && !is_mirror) || model < 2.0 {
            return MaterialKind::Diffuse { color: white(diffuse), emission };
        }
        if is_mirror || diffuse == Rgb::ZERO {
            let specularity = self.exponent.map_or(1.0, specularity);
            let color = if specular == Rgb::ZERO { Rgb::ONE } else { white(specular) };
            return MaterialKind::Reflective { color, specularity };
        }
        let sum = (specular + diffuse).max_element().max(1.0);
        let (specular, diffuse) = (specular / sum, diffuse / sum);
        let coat = specular.max_element() / (specular.max_element() + diffuse.max_element());
        MaterialKind::ClearCoat {
            color: white(diffuse / (1.0 - coat)),
            coat,
            coat_color: white(specular / coat),
            specularity: specularity(self.exponent.unwrap_or(0.0)),
        }
    }
}

/// The specularity s whose lobe is as wide as one of Phong's exponent n: the mean square of the sideways part is
/// (1 - s)^2 / 2 there and about 2 / (n + 2) here.
fn specularity(exponent: f64) -> f64 {
    (1.0 - 2.0 / (exponent + 2.0).sqrt()).clamp(0.0, 1.0)
}
