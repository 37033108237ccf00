//! Valid scenes of any kind, as text and meshes in a folder.

use super::random::Random;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Writes a scene and its meshes into `folder`; where the scene is.
pub(crate) fn write(folder: &Path, random: &mut Random) -> PathBuf {
    // The whole scene is as large as this.
    let size = libm::pow(10.0, random.between(-6.0, 6.0));
    let meshes = random.index(3);
    for number in 0..meshes {
        fs::write(folder.join(format!("{number}.obj")), mesh(random)).expect("a file");
    }
    let mut text = camera(size, random);
    if random.unit() < 0.7 {
        let color = |random: &mut Random| color(random, 2.0);
        let (sky, horizon, ground) = (color(random), color(random), color(random));
        let _ = writeln!(
            text,
            "Environment: {{SkyColor: {sky}, HorizonColor: {horizon}, GroundColor: {ground}}}"
        );
    }
    text.push_str("Objects:\n");
    for _ in 0..1 + random.index(40) {
        object(&mut text, size, meshes, random);
    }
    let path = folder.join("scene.yaml");
    fs::write(&path, text).expect("a file");
    path
}

fn camera(size: f64, random: &mut Random) -> String {
    let (from, to) = (vector(size * 3.0, random), vector(size * 0.5, random));
    let fov = random.between(0.05, 0.9);
    let focus = size * random.between(0.1, 5.0);
    let lens = if random.unit() < 0.5 { 0.0 } else { random.between(0.0, 50.0) };
    let angle = random.between(-180.0, 180.0);
    format!(
        "Camera: {{Position: {from}, LookingAt: {to}, Fov: {fov}, FocusDistance: {focus:e}, DepthOfField: {lens}, Angle: {angle}}}\n"
    )
}

fn object(text: &mut String, size: f64, meshes: usize, random: &mut Random) {
    let at = vector(size, random);
    let side = |random: &mut Random| size * libm::pow(10.0, random.between(-2.0, 0.0));
    let turn = if random.unit() < 0.5 { "[0, 0, 0]".to_owned() } else { vector(180.0, random) };
    let shape = match random.index(if meshes > 0 { 5 } else { 4 }) {
        0 => format!("Type: Ball, Position: {at}, Radius: {:e}", side(random)),
        1 => {
            // Underfoot, and much larger than all the rest.
            let radius = size * libm::pow(10.0, random.between(1.0, 6.0));
            format!("Type: Ball, Position: [0, 0, {:e}], Radius: {radius:e}", -radius - size)
        }
        2 => {
            let [width, height, depth] = [side(random), side(random), side(random)];
            format!(
                "Type: Box, Position: {at}, Width: {width:e}, Height: {height:e}, Depth: {depth:e}, Rotation: {turn}"
            )
        }
        3 => {
            let [width, height] = [side(random), side(random)];
            format!("Type: Rectangle, Position: {at}, Width: {width:e}, Height: {height:e}, Rotation: {turn}")
        }
        _ => {
            let axes = ["YUp", "ZUp", "SwapYZ"][random.index(3)];
            let (file, smooth) = (random.index(meshes), random.unit() < 0.5);
            format!(
                "Type: TriangleMesh, Filepath: {file}.obj, Position: {at}, Scale: {:e}, Rotation: {turn}, Axes: {axes}, Smooth: {smooth}",
                side(random)
            )
        }
    };
    let _ = writeln!(text, "  - Object: {{{shape}, Material: {{{}}}}}", material(random));
}

fn material(random: &mut Random) -> String {
    let color = color(random, 1.0);
    let share = [0.0, 1.0, random.unit()][random.index(3)];
    match random.index(6) {
        0 | 1 => format!("Type: Diffuse, Color: {color}"),
        2 => {
            format!("Type: Diffuse, EmissionColor: {color}, EmissionStrength: {}", random.between(0.1, 30.0))
        }
        3 => format!("Type: Reflective, Color: {color}, Specularity: {share}"),
        4 => format!("Type: ClearCoat, Color: {color}, ClearCoat: {share}, Specularity: {}", random.unit()),
        _ => format!("Type: Refractive, Color: {color}, RefractionRatio: {}", random.between(0.3, 2.0)),
    }
}

/// Loose triangles, or a sheet whose triangles share corners, with normals and texture coordinates or without.
fn mesh(random: &mut Random) -> String {
    let (mut text, count) = (String::new(), 3 + random.index(200));
    let all = random.unit() < 0.5;
    for _ in 0..count {
        let (x, y, z) = (random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0));
        let _ = writeln!(text, "v {x} {y} {z}\nvn {y} {z} {x}\nvt {x} {y}");
    }
    let corner = |index: usize| if all { format!("{index}/{index}/{index}") } else { index.to_string() };
    for first in 1..count - 1 {
        let other = if random.unit() < 0.8 { first + 2 } else { 1 + random.index(count) };
        let _ = writeln!(text, "f {} {} {}", corner(first), corner(first + 1), corner(other));
    }
    text
}

/// Each number in [-size, size).
fn vector(size: f64, random: &mut Random) -> String {
    let [x, y, z] = (random.in_cube() * size).to_array();
    format!("[{x:e}, {y:e}, {z:e}]")
}

fn color(random: &mut Random, most: f64) -> String {
    let mut part = || if random.unit() < 0.1 { most } else { random.between(0.0, most) };
    format!("[{}, {}, {}]", part(), part(), part())
}
