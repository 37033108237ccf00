//! Valid scenes of any kind, as text, meshes with materials, and pictures in a folder.

mod material;
mod mesh;
mod object;
mod picture;

use super::random::Random;
use mesh::Mesh;
use pathtracer::math::DVec3;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The files that a scene may name.
struct Files {
    pictures: Vec<String>,
    meshes: Vec<Mesh>,
}

/// Where a scene is, and how large.
struct Place {
    middle: DVec3,
    size: f64,
}

impl Place {
    /// Mostly around the origin, sometimes far from it.
    fn any(random: &mut Random) -> Place {
        let size = random.power(-9.0, 9.0);
        let far = if random.chance(0.2) { size * random.power(0.0, 7.0) } else { 0.0 };
        Place { middle: random.direction() * far, size }
    }

    /// A point at most `reach` times the size from the middle along every axis.
    fn point(&self, reach: f64, random: &mut Random) -> String {
        vector(self.middle + random.in_cube() * (reach * self.size))
    }

    /// A length from a hundredth of the size to all of it.
    fn length(&self, random: &mut Random) -> f64 {
        self.size * random.power(-2.0, 0.0)
    }
}

/// Writes a scene and its files into `folder`; where the scene is.
pub(crate) fn write(folder: &Path, random: &mut Random) -> PathBuf {
    let place = Place::any(random);
    let pictures = if random.chance(0.5) { 1 + random.index(3) } else { 0 };
    let pictures = (0..pictures).map(|number| picture::texture(folder, number, random)).collect();
    let mut files = Files { pictures, meshes: Vec::new() };
    for number in 0..random.index(4) {
        files.meshes.push(mesh::write(folder, number, &files.pictures, random));
    }
    let mut text = camera(&place, random);
    text.push_str(&environment(folder, random));
    text.push_str("Objects:\n");
    for object in object::list(&place, &files, random) {
        let _ = writeln!(text, "  - Object: {{{object}}}");
    }
    let path = folder.join("scene.yaml");
    fs::write(&path, text).expect("a file");
    path
}

fn camera(place: &Place, random: &mut Random) -> String {
    let (from, to) = (place.point(3.0, random), place.point(0.5, random));
    let fov = if random.chance(0.1) { random.pick(&[0.001, 0.99]) } else { random.between(0.05, 0.9) };
    let focus = place.size * random.power(-1.0, 1.0);
    let lens = match random.index(4) {
        0 => format!("DepthOfField: {}, ", random.between(0.0, 50.0)),
        1 => format!("ApertureRadius: {:e}, ", random.between(0.0, 0.2) * place.size),
        2 => "DepthOfField: 0, ".to_owned(),
        _ => String::new(),
    };
    let angle = if random.chance(0.5) {
        format!("Angle: {}, ", random.between(-180.0, 180.0))
    } else {
        String::new()
    };
    format!(
        "Camera: {{{lens}{angle}Position: {from}, LookingAt: {to}, Fov: {fov}, FocusDistance: {focus:e}}}\n"
    )
}

/// Three colours, a picture, or nothing.
fn environment(folder: &Path, random: &mut Random) -> String {
    let kind = random.index(5);
    let look = match kind {
        0 | 1 => {
            let [sky, horizon, ground] = [(); 3].map(|()| color(2.0, random));
            format!("SkyColor: {sky}, HorizonColor: {horizon}, GroundColor: {ground}")
        }
        2 | 3 => {
            let (name, space) = (picture::sky(folder, random), color_space(random));
            format!("Image: {name}, Rotation: {}{space}", random.between(-360.0, 360.0))
        }
        _ => return String::new(),
    };
    let strength = match random.index(4) {
        0 => format!(", Strength: {:e}", random.power(-3.0, 3.0)),
        1 if random.chance(0.3) => ", Strength: 0".to_owned(),
        _ => String::new(),
    };
    format!("Environment: {{{look}{strength}}}\n")
}

/// How the values of a picture are said to be read, if at all.
fn color_space(random: &mut Random) -> &'static str {
    random.pick(&["", "", ", ColorSpace: sRGB", ", ColorSpace: Linear"])
}

/// Three numbers that are read again as they are.
fn vector(v: DVec3) -> String {
    format!("[{:e}, {:e}, {:e}]", v.x, v.y, v.z)
}

/// Of components up to `most`, some of them the least or the most.
fn color(most: f64, random: &mut Random) -> String {
    let mut part = || match random.index(12) {
        0 => most,
        1 => 0.0,
        _ => random.between(0.0, most),
    };
    format!("[{}, {}, {}]", part(), part(), part())
}

/// A name, if there is one.
fn name(random: &mut Random) -> String {
    if random.chance(0.2) { format!(", Name: N{}", random.index(5)) } else { String::new() }
}
