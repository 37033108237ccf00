//! A material as it is written: strength and colour of a light apart, and the values of other types kept.

use super::Written;
use crate::math::{DVec3, Rgb};
use crate::scene::desc::{MaterialDesc, MaterialKind};
use crate::scene::yaml::node::{Kind, Node};

/// The types of materials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceKind {
    /// `Diffuse`.
    Diffuse,
    /// `Reflective`.
    Reflective,
    /// `ClearCoat`.
    ClearCoat,
    /// `Refractive`.
    Refractive,
}

impl SurfaceKind {
    /// In the order of the list in the window.
    pub const ALL: [SurfaceKind; 4] =
        [SurfaceKind::Diffuse, SurfaceKind::Reflective, SurfaceKind::ClearCoat, SurfaceKind::Refractive];

    /// The name in the file.
    pub const fn name(self) -> &'static str {
        match self {
            SurfaceKind::Diffuse => "Diffuse",
            SurfaceKind::Reflective => "Reflective",
            SurfaceKind::ClearCoat => "ClearCoat",
            SurfaceKind::Refractive => "Refractive",
        }
    }
}

/// The keys of a material, those of all types. Ranges as in [`MaterialKind`].
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// `Type`.
    pub kind: SurfaceKind,
    /// `Color`; a factor on the picture if there is one.
    pub color: Rgb,
    /// Whether `Color` is a picture, which is left as it is.
    pub has_color_picture: bool,
    /// `EmissionStrength`, >= 0.
    pub emission_strength: f64,
    /// `EmissionColor`, >= 0.
    pub emission_color: Rgb,
    /// `Specularity`.
    pub specularity: f64,
    /// `ClearCoat`.
    pub coat: f64,
    /// `ClearCoatColor`.
    pub coat_color: Rgb,
    /// Whether `ClearCoatColor` is a picture.
    pub has_coat_picture: bool,
    /// `RefractionRatio`, > 0.
    pub ratio: f64,
}

impl Surface {
    /// Reads the values of a material that was found to be right. What its type does not use was not checked, and is read only
    /// if it makes sense.
    pub(super) fn read(node: &Node<'_>, desc: &MaterialDesc) -> Option<Surface> {
        let number = |key: &str, default: f64, is_right: fn(f64) -> bool| {
            let found = node.entry(key).and_then(Node::number);
            found.filter(|&number| is_right(number)).unwrap_or(default)
        };
        let color = |key: &str, is_right: fn(f64) -> bool| {
            let found = node.entry(key).and_then(vector);
            found.filter(|color| color.to_array().into_iter().all(is_right)).unwrap_or(Rgb::ONE)
        };
        let unit = |x: f64| (0.0..=1.0).contains(&x);
        let not_negative = |x: f64| x.is_finite() && x >= 0.0;
        let name = node.entry("Type")?.text()?;
        Some(Surface {
            kind: SurfaceKind::ALL.into_iter().find(|kind| kind.name() == name)?,
            color: color("Color", unit),
            has_color_picture: desc.textures.color.is_some(),
            emission_strength: number("EmissionStrength", 0.0, not_negative),
            emission_color: color("EmissionColor", not_negative),
            specularity: number("Specularity", 1.0, unit),
            coat: number("ClearCoat", 0.5, unit),
            coat_color: color("ClearCoatColor", unit),
            has_coat_picture: desc.textures.coat_color.is_some(),
            ratio: number("RefractionRatio", 1.0, |x| x.is_finite() && x > 0.0),
        })
    }

    /// What it does with light.
    pub fn material(&self) -> MaterialKind {
        let &Surface { color, specularity, coat, coat_color, ratio, .. } = self;
        match self.kind {
            SurfaceKind::Diffuse => {
                MaterialKind::Diffuse { color, emission: self.emission_color * self.emission_strength }
            }
            SurfaceKind::Reflective => MaterialKind::Reflective { color, specularity },
            SurfaceKind::ClearCoat => MaterialKind::ClearCoat { color, coat, coat_color, specularity },
            SurfaceKind::Refractive => MaterialKind::Refractive { color, ratio },
        }
    }

    /// The keys whose values differ from those of `old`. Pictures stay.
    pub(super) fn changes_since(&self, old: &Surface) -> Vec<(&'static str, Written)> {
        let numbers = |s: &Surface| {
            [
                ("EmissionStrength", s.emission_strength),
                ("Specularity", s.specularity),
                ("ClearCoat", s.coat),
                ("RefractionRatio", s.ratio),
            ]
        };
        let colors = |s: &Surface| {
            [
                ("Color", s.color, s.has_color_picture),
                ("EmissionColor", s.emission_color, false),
                ("ClearCoatColor", s.coat_color, s.has_coat_picture),
            ]
        };
        let mut changes = Vec::new();
        if self.kind != old.kind {
            changes.push(("Type", Written::Word(self.kind.name())));
        }
        for ((key, new, has_picture), (_, old, _)) in colors(self).into_iter().zip(colors(old)) {
            if new != old && !has_picture {
                changes.push((key, Written::Vector(new)));
            }
        }
        for ((key, new), (_, old)) in numbers(self).into_iter().zip(numbers(old)) {
            if new != old {
                changes.push((key, Written::Number(new)));
            }
        }
        changes
    }
}

fn vector(node: &Node<'_>) -> Option<DVec3> {
    let Kind::List(items) = &node.kind else { return None };
    let [x, y, z] = items.as_slice() else { return None };
    Some(DVec3::new(x.number()?, y.number()?, z.number()?))
}
