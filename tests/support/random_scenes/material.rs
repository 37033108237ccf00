//! Materials of scenes.

use super::{Files, Random, color, color_space, name};

/// The keys of a material; `shows` tells whether its object has places for pictures.
pub(super) fn any(files: &Files, shows: bool, random: &mut Random) -> String {
    let pictures: &[String] = if shows { &files.pictures } else { &[] };
    let shade = reflectance(pictures, random);
    let share = share(random);
    let keys = match random.index(7) {
        0 | 1 => format!("Type: Diffuse, Color: {shade}"),
        2 => {
            let (light, strength) = (color(1.0, random), random.power(-3.0, 4.0));
            format!("Type: Diffuse, Color: {shade}, EmissionColor: {light}, EmissionStrength: {strength:e}")
        }
        3 => format!("Type: Reflective, Color: {shade}, Specularity: {share}"),
        4 => {
            let (coat, smooth) = (reflectance(pictures, random), random.unit());
            format!(
                "Type: ClearCoat, Color: {shade}, ClearCoatColor: {coat}, ClearCoat: {share}, Specularity: {smooth}"
            )
        }
        5 => "Type: Diffuse".to_owned(),
        _ => format!("Type: Refractive, Color: {shade}, RefractionRatio: {:e}", ratio(random)),
    };
    format!("{{{keys}{}}}", name(random))
}

/// A colour, or a picture.
fn reflectance(pictures: &[String], random: &mut Random) -> String {
    if pictures.is_empty() || random.chance(0.4) {
        return color(1.0, random);
    }
    let (picture, space) = (&pictures[random.index(pictures.len())], color_space(random));
    format!("{{ Image: {picture}{space} }}")
}

/// 0 to 1, often one of both.
fn share(random: &mut Random) -> f64 {
    let any = random.unit();
    random.pick(&[0.0, 1.0, any])
}

/// Mostly of what there is, else none, or one that hardly is.
fn ratio(random: &mut Random) -> f64 {
    match random.index(6) {
        0 => 1.0,
        1 => random.power(-3.0, 3.0),
        _ => random.between(0.3, 2.0),
    }
}
