//! Meshes as OBJ files, with materials of their own (MTL) or without.

use super::Random;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// A mesh file.
pub(super) struct Mesh {
    pub(super) name: String,
    /// Whether a picture has a place on it.
    pub(super) has_coordinates: bool,
}

/// What a corner of a face names beside its position.
#[derive(Clone, Copy, PartialEq)]
enum Corner {
    Position,
    Coordinates,
    Normal,
    All,
}

/// Corners in the order of the file, from 1 on.
type Face = Vec<usize>;

/// Writes a mesh, with materials that may show `pictures`.
pub(super) fn write(folder: &Path, number: usize, pictures: &[String], random: &mut Random) -> Mesh {
    let (mut text, corner) =
        (String::new(), random.pick(&[Corner::Position, Corner::Coordinates, Corner::Normal, Corner::All]));
    let materials = if random.chance(0.5) { 1 + random.index(4) } else { 0 };
    if materials > 0 {
        let _ = writeln!(text, "mtllib {number}.mtl");
        fs::write(folder.join(format!("{number}.mtl")), library(materials, pictures, random))
            .expect("a file");
    }
    let (points, faces) = if random.chance(0.5) { loose(random) } else { sheet(random) };
    vertices(&mut text, &points, random);
    for (index, face) in faces.iter().enumerate() {
        if materials > 0 && random.chance(0.1) {
            let _ = writeln!(text, "usemtl m{}", random.index(materials));
        }
        // The first face has all, so that the mesh has it.
        let named = if index > 0 && random.chance(0.05) { Corner::Position } else { corner };
        add_face(&mut text, face, points.len(), named, random);
    }
    let name = format!("{number}.obj");
    fs::write(folder.join(&name), text).expect("a file");
    Mesh { name, has_coordinates: matches!(corner, Corner::Coordinates | Corner::All) }
}

/// Triangles in a strip, or between any points; a few of them without area.
fn loose(random: &mut Random) -> (Vec<[f64; 3]>, Vec<Face>) {
    let count = 3 + random.index(200);
    let points = (0..count).map(|_| random.in_cube().to_array()).collect();
    let mut faces = vec![vec![1, 2, 3]];
    for first in 2..count - 1 {
        let other = if random.chance(0.8) { first + 2 } else { 1 + random.index(count) };
        faces.push(vec![first, first + 1, other]);
    }
    (points, faces)
}

/// A bumpy or flat sheet of faces with three to six corners that share their corners.
fn sheet(random: &mut Random) -> (Vec<[f64; 3]>, Vec<Face>) {
    let (columns, rows) = (2 + random.index(12), 2 + random.index(12));
    let bumps = if random.chance(0.3) { 0.0 } else { 0.2 };
    let place = |index: usize, count: usize| index as f64 / (count - 1) as f64 * 2.0 - 1.0;
    let mut points = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            points.push([place(column, columns), random.between(-bumps, bumps), place(row, rows)]);
        }
    }
    let corner = |column: usize, row: usize| row * columns + column + 1;
    let mut faces = Vec::new();
    for row in 0..rows - 1 {
        let mut column = 0;
        while column < columns - 1 {
            // One or two squares at once.
            let next = (column + 1 + random.index(2)).min(columns - 1);
            let lower = (column..=next).map(|column| corner(column, row));
            let upper = (column..=next).rev().map(|column| corner(column, row + 1));
            faces.push(lower.chain(upper).collect());
            column = next;
        }
    }
    (points, faces)
}

/// Positions, normals and places on pictures, as many of each.
fn vertices(text: &mut String, points: &[[f64; 3]], random: &mut Random) {
    let (scale, away) = (random.power(-3.0, 3.0), if random.chance(0.2) { 100.0 } else { 0.0 });
    let repeats = random.pick(&[0.0, 1.0, 7.5]);
    for &[x, y, z] in points {
        let [px, py, pz] = [x, y, z].map(|value| (value + away) * scale);
        let [nx, ny, nz] = random.direction().to_array();
        let (nx, ny, nz) = if random.chance(0.5) { (nx * 0.1, 1.0, nz * 0.1) } else { (nx, ny, nz) };
        let _ =
            writeln!(text, "v {px:e} {py:e} {pz:e}\nvn {nx} {ny} {nz}\nvt {} {}", x * repeats, z * repeats);
    }
}

/// One line, sometimes counted from the end.
fn add_face(text: &mut String, face: &[usize], count: usize, corner: Corner, random: &mut Random) {
    text.push('f');
    let from_end = random.chance(0.2);
    for &index in face {
        let i = if from_end { index as i64 - count as i64 - 1 } else { index as i64 };
        let _ = match corner {
            Corner::Position => write!(text, " {i}"),
            Corner::Coordinates => write!(text, " {i}/{i}"),
            Corner::Normal => write!(text, " {i}//{i}"),
            Corner::All => write!(text, " {i}/{i}/{i}"),
        };
    }
    text.push('\n');
}

/// A file of materials `m0`, `m1` and so on.
fn library(count: usize, pictures: &[String], random: &mut Random) -> String {
    let mut text = String::new();
    for number in 0..count {
        let _ = writeln!(text, "newmtl m{number}");
        let statements = ["Kd", "Ks", "Ke", "Tf", "Ns", "Ni", "d", "Tr", "illum", "map_Kd", "Ka"];
        for keyword in statements {
            if let Some(value) = statement(keyword, pictures, random) {
                let _ = writeln!(text, "{keyword} {value}");
            }
        }
    }
    text
}

/// What follows a keyword, if the material has it.
fn statement(keyword: &str, pictures: &[String], random: &mut Random) -> Option<String> {
    let often = if ["Kd", "map_Kd"].contains(&keyword) { 0.6 } else { 0.2 };
    if !random.chance(often) {
        return None;
    }
    let mut color =
        |most: f64| format!("{} {} {}", random.between(0.0, most), random.between(0.0, most), random.unit());
    Some(match keyword {
        "Ke" => color(20.0),
        "Kd" | "Ks" | "Tf" | "Ka" => color(1.1),
        "Ns" => random.between(0.0, 1000.0).to_string(),
        "Ni" => random.between(0.0, 3.0).to_string(),
        "illum" => random.index(11).to_string(),
        "map_Kd" if pictures.is_empty() => return None,
        "map_Kd" => {
            let options = random.pick(&["", "-s 1 1 1 ", "-clamp on "]);
            format!("{options}{}", pictures[random.index(pictures.len())])
        }
        _ => random.unit().to_string(),
    })
}
