//! Of surfaces at the same distance, that of the object with the lowest index is seen, whatever the order in which an
//! accelerator finds them.

use super::{accelerators, kinds, picture, small};
use crate::support::build::*;
use crate::support::random::Random;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{
    Ball, Cuboid, Geometry, Instance, MeshPart, MeshSpace, Ray, Rectangle, Shape, Solid,
};
use pathtracer::math::{DMat3, DVec3, Rgb};
use pathtracer::render::Settings;

const TRIANGLE: [DVec3; 3] =
    [DVec3::new(-1.0, -1.0, 0.1), DVec3::new(1.0, -1.0, 0.2), DVec3::new(0.0, 1.0, 0.3)];

/// Rays that meet the middle of [`TRIANGLE`] at an angle.
fn rays(count: usize, random: &mut Random) -> Vec<Ray> {
    let ray = |_| {
        let target = DVec3::new(random.between(-0.2, 0.2), random.between(-0.3, 0.2), 0.2);
        let origin = target + DVec3::new(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 3.0);
        Ray::new(origin, (target - origin).normalize())
    };
    (0..count).map(ray).collect()
}

#[test]
fn of_equal_triangles_the_first_object_is_hit() {
    let mut random = Random::new(71);
    for count in [2, 3, 8, 9, 17, 64, 100, 1000] {
        // Copies and others in a random order; the others lie farther away.
        let mut is_copy: Vec<bool> = (0..2 * count).map(|i| i < count).collect();
        random.shuffle(&mut is_copy);
        let mesh = |(object, &copy): (usize, &bool)| {
            let behind = if copy { DVec3::ZERO } else { random.in_cube() - DVec3::Z * 3.0 };
            MeshPart {
                object: object as u32,
                positions: TRIANGLE.map(|p| p + behind).to_vec(),
                triangles: vec![[0, 1, 2]],
            }
        };
        let meshes: Vec<MeshPart> = is_copy.iter().enumerate().map(mesh).collect();
        let first = is_copy.iter().position(|&copy| copy).expect("there are copies") as u32;
        let geometry = Geometry::new(Vec::new(), &meshes);
        for accelerator in accelerators(&geometry, Precision::Exact) {
            for ray in rays(1000, &mut random) {
                let hit = accelerator.intersect(&ray).map(|hit| hit.object);
                assert_eq!(hit, Some(first), "{}, {count} copies, {ray:?}", accelerator.name);
            }
        }
    }
}

/// A copy of `shape` for every true of `is_copy`, and other bodies farther away for the rest.
fn among_others(shape: Shape, is_copy: &[bool], random: &mut Random) -> Vec<Solid> {
    let other = |random: &mut Random| {
        let center = random.in_cube() - DVec3::Z * 4.0;
        match random.index(3) {
            0 => Shape::Ball(Ball { center, radius: 0.3 }),
            1 => Shape::Cuboid(Cuboid { center, half: DVec3::splat(0.2), rotation: DMat3::IDENTITY }),
            _ => Shape::Rectangle(Rectangle::new(center, DVec3::X, DVec3::Y)),
        }
    };
    let solid =
        |(object, &copy): (u32, &bool)| Solid { object, shape: if copy { shape } else { other(random) } };
    (0..).zip(is_copy).map(solid).collect()
}

#[test]
fn of_equal_solids_and_instances_the_first_object_is_hit() {
    let mut random = Random::new(72);
    let center = DVec3::new(0.0, -0.1, 0.2);
    let mesh = MeshPart { object: 0, positions: TRIANGLE.to_vec(), triangles: vec![[0, 1, 2]] };
    let space = MeshSpace::new(vec![mesh]);
    let (sin, cos) = libm::sincos(0.3);
    let turned = DMat3::from_cols(DVec3::new(cos, sin, 0.0), DVec3::new(-sin, cos, 0.0), DVec3::Z);
    let shapes = [
        Shape::Ball(Ball { center, radius: 1.0 }),
        Shape::Cuboid(Cuboid { center, half: DVec3::ONE, rotation: turned }),
        Shape::Rectangle(Rectangle::new(center, DVec3::X, DVec3::Y)),
        Shape::Instance(Instance::new(0, &space, turned, 1.25, DVec3::new(0.0, 0.0, 0.1))),
    ];
    for shape in shapes {
        for count in [2, 8, 9, 100, 1000] {
            let mut is_copy: Vec<bool> = (0..2 * count).map(|i| i < count).collect();
            random.shuffle(&mut is_copy);
            let first = is_copy.iter().position(|&copy| copy).expect("there are copies") as u32;
            let solids = among_others(shape, &is_copy, &mut random);
            let geometry = Geometry::with_instances(solids, Vec::new(), vec![space.clone()]);
            for accelerator in accelerators(&geometry, Precision::Exact) {
                for ray in rays(200, &mut random) {
                    let hit = accelerator.intersect(&ray).map(|hit| hit.object);
                    assert_eq!(hit, Some(first), "{}, {count} copies of {shape:?}", accelerator.name);
                }
            }
        }
    }
}

/// A floor in two colours, one on the other: of the same kind, and a rectangle and a mesh in either order. All its numbers
/// are dyadic, so that the two kinds find the same distance to the last bit.
#[test]
fn a_picture_of_coincident_surfaces_has_one_colour() {
    let corners = vec![[-8.0, -8.0, 0.0], [8.0, -8.0, 0.0], [8.0, 8.0, 0.0], [-8.0, 8.0, 0.0]];
    let meshes = || mesh(corners.clone(), vec![[0, 1, 2], [0, 2, 3]]);
    let (red, blue) = (Rgb::X, Rgb::Z);
    let glow = |shape, color: Rgb| (shape, glowing(Rgb::ZERO, color));
    let orders = [
        vec![glow(meshes(), red), glow(meshes(), blue)],
        vec![glow(square(DVec3::ZERO, 16.0), red), glow(square(DVec3::ZERO, 16.0), blue)],
        vec![glow(square(DVec3::ZERO, 16.0), red), glow(meshes(), blue)],
        vec![glow(meshes(), red), glow(square(DVec3::ZERO, 16.0), blue)],
    ];
    for objects in orders {
        let mut desc = scene(DVec3::new(-3.0, 0.3, 2.0), DVec3::ZERO, objects);
        desc.camera.fov = 0.2;
        for accel in kinds() {
            let pixels = picture(&desc, &Settings { accel, ..small(64, 64, 4, 1) });
            assert!(pixels.iter().all(|&pixel| pixel == red), "{accel:?}");
        }
    }
}
