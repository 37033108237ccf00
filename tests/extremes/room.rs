//! A room with everything in it, for tests of what may not change a picture.

use crate::support::build::*;
use pathtracer::math::DVec3;
use pathtracer::scene::desc::{ApertureDesc, MaterialKind, SceneDesc, ShapeDesc};

/// Walls, glass, mirror, clear coat, a box light, a mesh, two instances of another and a lens; lengths are `unit` times dyadic numbers.
pub(super) fn room(unit: f64) -> SceneDesc {
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) * unit;
    let wall = |position: DVec3, rotation: DVec3, color: DVec3| {
        let shape = ShapeDesc::Rectangle { position, width: 8.0 * unit, height: 8.0 * unit, rotation };
        (shape, diffuse(color))
    };
    let (white, red, green) = (grey(0.75), DVec3::new(0.75, 0.25, 0.25), DVec3::new(0.25, 0.75, 0.25));
    let tetrahedron = [[0.5, -1.0, 0.0], [1.25, -0.75, 0.0], [0.75, -0.25, 0.0], [0.75, -0.75, 0.875]];
    let tetrahedron = mesh(
        tetrahedron.iter().map(|p| p.map(|x| x * unit)).collect(),
        vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    );
    let gem = mesh(
        [[-0.25, 0.0, 0.0], [0.25, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0, -0.25, 0.125], [0.0, 0.0, 0.5]]
            .iter()
            .map(|p: &[f64; 3]| p.map(|x| x * unit))
            .collect(),
        vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [0, 3, 2], [3, 1, 2]],
    );
    let coat =
        MaterialKind::ClearCoat { color: grey(0.5), coat: 0.5, coat_color: grey(0.75), specularity: 0.75 };
    let glass = MaterialKind::Refractive { color: grey(1.0), ratio: 0.625 };
    let mirror = MaterialKind::Reflective { color: grey(0.875), specularity: 0.75 };
    let objects = vec![
        wall(at(0.0, 0.0, 0.0), DVec3::new(0.0, 90.0, 0.0), white),
        wall(at(0.0, 0.0, 4.0), DVec3::new(0.0, -90.0, 0.0), white),
        wall(at(0.0, 4.0, 2.0), DVec3::new(0.0, 0.0, 90.0), red),
        wall(at(0.0, -4.0, 2.0), DVec3::new(0.0, 0.0, -90.0), green),
        wall(at(4.0, 0.0, 2.0), DVec3::ZERO, white),
        (ball(at(0.0, 0.75, 0.5), 0.5 * unit), glass),
        (ball(at(1.0, 2.0, 0.5), 0.5 * unit), mirror),
        (cuboid(at(2.0, 0.5, 0.5), at(1.0, 0.5, 1.0), DVec3::new(0.0, 0.0, 30.0)), coat),
        (tetrahedron, diffuse(white)),
        (placed(gem.clone(), at(-0.5, -1.5, 0.0), 2.0, DVec3::new(0.0, 0.0, 45.0)), diffuse(red)),
        (placed(gem, at(-1.0, 1.5, 0.5), 1.0, DVec3::new(90.0, 0.0, 20.0)), diffuse(green)),
        (cuboid(at(0.0, 0.0, 3.875), at(1.0, 1.0, 0.25), DVec3::ZERO), glowing(grey(0.25), grey(8.0))),
    ];
    let mut desc = scene(at(-3.5, 0.25, 1.5), at(0.0, 0.0, 1.0), objects);
    desc.camera.fov = 0.375;
    desc.camera.focus_distance = 4.0 * unit;
    desc.camera.aperture = ApertureDesc::Radius(0.0625 * unit);
    desc
}
