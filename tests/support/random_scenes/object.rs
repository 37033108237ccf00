//! The objects of a scene: of every shape, many of one mesh, some on top of others.

use super::{Files, Place, Random, material, name, vector};
use pathtracer::math::DVec3;

/// A shape on its way into the text.
#[derive(Clone)]
struct Shape {
    keys: String,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Solid,
    Mesh { has_coordinates: bool },
}

/// The keys of every object.
pub(super) fn list(place: &Place, files: &Files, random: &mut Random) -> Vec<String> {
    let mut shapes = Vec::new();
    for _ in 0..1 + random.index(30) {
        add(&mut shapes, place, files, random);
    }
    shapes.iter().map(|shape| with_material(shape, files, random)).collect()
}

/// Adds a shape, or several that have to do with each other.
fn add(shapes: &mut Vec<Shape>, place: &Place, files: &Files, random: &mut Random) {
    match random.index(20) {
        // On top of the one before, maybe of another material.
        0 | 1 if !shapes.is_empty() => shapes.push(shapes[shapes.len() - 1].clone()),
        2 => flush(shapes, place, random),
        3 if !files.meshes.is_empty() => {
            let number = random.index(files.meshes.len());
            for _ in 0..2 + random.index(20) {
                shapes.push(mesh(number, place, files, random));
            }
        }
        4..8 if !files.meshes.is_empty() => {
            let number = random.index(files.meshes.len());
            shapes.push(mesh(number, place, files, random));
        }
        _ => shapes.push(Shape { keys: solid(place, random), kind: Kind::Solid }),
    }
}

/// A box and a rectangle that lies in its side.
fn flush(shapes: &mut Vec<Shape>, place: &Place, random: &mut Random) {
    let middle = place.middle + random.in_cube() * place.size;
    let [depth, width, height] = [(); 3].map(|()| place.length(random));
    let side = DVec3::new(middle.x - depth * 0.5, middle.y, middle.z);
    let area = format!("Width: {width:e}, Height: {height:e}");
    let keys = format!("Type: Box, Position: {}, Depth: {depth:e}, {area}", vector(middle));
    shapes.push(Shape { keys, kind: Kind::Solid });
    shapes.push(Shape {
        keys: format!("Type: Rectangle, Position: {}, {area}", vector(side)),
        kind: Kind::Solid,
    });
}

fn solid(place: &Place, random: &mut Random) -> String {
    let at = place.point(1.0, random);
    let [a, b, c] = [(); 3].map(|()| place.length(random));
    match random.index(4) {
        0 => format!("Type: Ball, Position: {at}, Radius: {a:e}"),
        1 => {
            // Underfoot, and much larger than all the rest.
            let radius = place.size * random.power(1.0, 7.0);
            let center = place.middle - DVec3::new(0.0, 0.0, radius + place.size);
            format!("Type: Ball, Position: {}, Radius: {radius:e}", vector(center))
        }
        2 => format!(
            "Type: Box, Position: {at}, Width: {a:e}, Height: {b:e}, Depth: {c:e}{}",
            rotation(random)
        ),
        _ => format!("Type: Rectangle, Position: {at}, Width: {a:e}, Height: {b:e}{}", rotation(random)),
    }
}

fn mesh(number: usize, place: &Place, files: &Files, random: &mut Random) -> Shape {
    let file = &files.meshes[number];
    let axes = random.pick(&["", ", Axes: YUp", ", Axes: ZUp", ", Axes: SwapYZ"]);
    let smooth = random.pick(&["", ", Smooth: true", ", Smooth: false"]);
    let (at, scale) = (place.point(1.0, random), place.length(random));
    let keys = format!(
        "Type: TriangleMesh, Filepath: {}, Position: {at}, Scale: {scale:e}{axes}{smooth}{}",
        file.name,
        rotation(random)
    );
    Shape { keys, kind: Kind::Mesh { has_coordinates: file.has_coordinates } }
}

/// None, by right angles, or by any.
fn rotation(random: &mut Random) -> String {
    match random.index(3) {
        0 => String::new(),
        1 => {
            let mut right = || random.pick(&[0, 90, 180, -90]);
            format!(", Rotation: [{}, {}, {}]", right(), right(), right())
        }
        _ => format!(", Rotation: {}", vector(random.in_cube() * 180.0)),
    }
}

fn with_material(shape: &Shape, files: &Files, random: &mut Random) -> String {
    let material = match shape.kind {
        Kind::Mesh { .. } if random.chance(0.4) => "FromFile".to_owned(),
        Kind::Mesh { has_coordinates } => material::any(files, has_coordinates, random),
        Kind::Solid => material::any(files, true, random),
    };
    format!("{}, Material: {material}{}", shape.keys, name(random))
}
