//! Lights of any solid angle: a white floor under each against its closed form, to a standard error of 1e-3.

use crate::support::build::*;
use pathtracer::math::DVec3;
use pathtracer::scene::desc::{SceneDesc, ShapeDesc};
use std::f64::consts::PI;

const WIDTH: f64 = 1e-3;

fn measure(samples: u64) -> Measure {
    Measure { samples, bounces: 2, light_sampling: true }
}

/// The share of a white floor's light that a convex polygon above the horizon gives (Lambert's formula). The angles of
/// the edges cancel to second order in the size of the polygon, so it is for large ones.
fn polygon(corners: &[DVec3]) -> f64 {
    let sum: f64 = (0..corners.len())
        .map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            let across = a.cross(b);
            libm::atan2(across.length(), a.dot(b)) * across.normalize().z
        })
        .sum();
    sum.abs() / (2.0 * PI)
}

#[test]
fn balls_of_radius_over_distance_from_one_to_1e_7_light_a_floor() {
    for ratio in [0.99, 0.5, 0.1, 1e-3, 1e-5, 1e-7] {
        for cosine in [1.0, 0.6] {
            // Wholly above the horizon.
            if ratio > cosine {
                continue;
            }
            let direction = DVec3::new(libm::sqrt(1.0 - cosine * cosine), 0.0, cosine);
            let desc = lit_floor(ball(direction * 2.0, ratio * 2.0), 3.0 / (ratio * ratio));
            let samples = if ratio > 0.05 { 400_000 } else { 20_000 };
            let what = format!("r/d {ratio} cosine {cosine}");
            // The solid angle is pi ratio^2 for a small one; a large one is not rare.
            let by_material = ratio * ratio * cosine;
            assert_mean_of_light(&what, &desc, &measure(samples), 3.0 * cosine, WIDTH, by_material);
        }
    }
}

/// Both 1e-6 radii from the surface: just outside, where the ball fills the hemisphere, and just inside.
#[test]
fn a_floor_beside_the_surface_of_a_ball_light_is_fully_lit() {
    for radius in [1e-3, 1.0, 1e3] {
        for beside in [1e-6, 1e-9, -1e-6, -0.3, -1.0] {
            let distance = radius * (1.0 + beside);
            let mut desc = lit_floor(ball(DVec3::Z * distance, radius), 2.0);
            // The eye is inside or outside with the floor's point.
            let near = radius * 1e-8;
            desc.camera.position = DVec3::new(-near, 0.0, near);
            let Some(floor) = desc.objects.first_mut() else { continue };
            floor.shape = square(DVec3::ZERO, radius * 1e-7);
            let expected = if beside > 0.0 { 2.0 / ((1.0 + beside) * (1.0 + beside)) } else { 2.0 };
            // What passes between the horizon and the light.
            let missed = 2.0 / expected - 1.0;
            let what = format!("R {radius} beside {beside:e}");
            assert_mean_of_light(&what, &desc, &measure(400_000), expected, WIDTH, missed);
        }
    }
}

/// From 1e-9 sr, where the light is a point to the eye, to 6 sr, where it fills the sky.
#[test]
fn rectangles_from_1e_9_to_6_steradians_light_a_floor() {
    let center = DVec3::new(0.3, -0.2, 1.0);
    for half in [1.7e-5, 1e-3, 0.016, 0.2, 1.0, 20.0] {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| center + DVec3::new(x * half, y * half, 0.0));
        // Where the patch is small its cosines and distance are constant to about half^2 * 2.
        let d2 = center.length_squared();
        let small = 4.0 * half * half * center.z * center.z / (d2 * d2 * PI);
        let expected = if half < 0.01 { small } else { polygon(&corners) };
        let desc = lit_floor(square(center, 2.0 * half), 1.0 / expected);
        let samples = if half > 0.01 { 600_000 } else { 20_000 };
        assert_mean_of_light(&format!("half {half}"), &desc, &measure(samples), 1.0, WIDTH, expected);
    }
}

/// The faces of a box that the origin sees, as polygons.
fn box_faces(center: DVec3, size: DVec3) -> f64 {
    let at = |x: f64, y: f64, z: f64| center + size * 0.5 * DVec3::new(x, y, z);
    let faces = [
        [at(-1., -1., -1.), at(-1., 1., -1.), at(-1., 1., 1.), at(-1., -1., 1.)],
        [at(-1., 1., -1.), at(1., 1., -1.), at(1., 1., 1.), at(-1., 1., 1.)],
        [at(-1., -1., -1.), at(1., -1., -1.), at(1., 1., -1.), at(-1., 1., -1.)],
    ];
    faces.iter().map(|face| polygon(face)).sum()
}

#[test]
fn boxes_of_every_solid_angle_light_a_floor() {
    let direction = DVec3::new(0.7, -0.5, 1.5);
    for size in [0.03, 0.2, 0.9] {
        let size = DVec3::new(0.5, 0.8, 0.6) * size;
        let expected = box_faces(direction, size);
        let desc = lit_floor(cuboid(direction, size, DVec3::ZERO), 1.0 / expected);
        assert_mean(&format!("box {size}"), &desc, &measure(400_000), 1.0, WIDTH);
    }
    // So small that its faces are flat to the eye: half a unit of solid angle is 1e-9.
    let size = DVec3::new(0.5, 0.8, 0.6) * 1e-4;
    let (d2, faces) =
        (direction.length_squared(), DVec3::new(size.y * size.z, size.z * size.x, size.x * size.y));
    let seen = (faces * direction.abs()).element_sum() / (d2 * d2.sqrt());
    let expected = seen * direction.z / (d2.sqrt() * PI);
    let desc = lit_floor(cuboid(direction, size, DVec3::ZERO), 1.0 / expected);
    assert_mean_of_light("tiny box", &desc, &measure(100_000), 1.0, WIDTH, expected);
}

#[test]
fn triangles_of_every_solid_angle_light_a_floor() {
    let center = DVec3::new(0.3, -0.2, 1.0);
    let offsets = [DVec3::new(-0.5, -0.3, 0.1), DVec3::new(0.5, -0.4, -0.1), DVec3::new(0.1, 0.6, 0.05)];
    for size in [1e-4, 0.05, 1.0] {
        let corners = offsets.map(|offset| center + offset * size);
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a) * 0.5;
        let middle = (a + b + c) / 3.0;
        let d2 = middle.length_squared();
        let small = normal.dot(middle).abs() * middle.z / (d2 * d2 * PI);
        let expected = if size < 0.01 { small } else { polygon(&corners) };
        let desc = lit_floor(mesh(corners.map(|p| p.to_array()).to_vec(), vec![[0, 1, 2]]), 1.0 / expected);
        let samples = if size > 0.01 { 400_000 } else { 20_000 };
        assert_mean_of_light(&format!("triangle {size}"), &desc, &measure(samples), 1.0, WIDTH, expected);
    }
}

/// Above the floor's point, each filling more than 5 of the 6.28 steradians there.
#[test]
fn boxes_and_triangles_of_more_than_5_steradians_light_a_floor() {
    let (center, size) = (DVec3::new(1.0, -2.0, 10.5), DVec3::new(40.0, 30.0, 20.0));
    let low = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| center + size * 0.5 * DVec3::new(x, y, -1.0));
    let corners = [DVec3::new(-30.0, -20.0, 0.4), DVec3::new(30.0, -25.0, 0.5), DVec3::new(2.0, 35.0, 0.6)];
    let triangle = mesh(corners.map(|p| p.to_array()).to_vec(), vec![[0, 1, 2]]);
    for (what, shape, seen) in
        [("box", cuboid(center, size, DVec3::ZERO), &low[..]), ("triangle", triangle, &corners[..])]
    {
        assert!(solid_angle(seen) > 5.0, "{what}: {}", solid_angle(seen));
        let expected = polygon(seen);
        let desc = lit_floor(shape, 1.0 / expected);
        assert_mean_of_light(what, &desc, &measure(1_000_000), 1.0, WIDTH, 1.0 - expected);
    }
}

/// Of a polygon, in triangles (van Oosterom and Strackee).
fn solid_angle(corners: &[DVec3]) -> f64 {
    let unit: Vec<DVec3> = corners.iter().map(|corner| corner.normalize()).collect();
    let of_triangle = |[a, b, c]: [DVec3; 3]| {
        2.0 * libm::atan2(a.dot(b.cross(c)), 1.0 + a.dot(b) + b.dot(c) + c.dot(a)).abs()
    };
    (1..unit.len() - 1).map(|i| of_triangle([unit[0], unit[i], unit[i + 1]])).sum()
}

/// Every direction above the floor's point ends at the box.
#[test]
fn a_floor_inside_a_box_light_is_fully_lit() {
    let turn = DVec3::new(20.0, -35.0, 50.0);
    for (center, size) in [
        (DVec3::new(0.1, -0.2, 0.3), DVec3::new(2.0, 3.0, 1.0)),
        (DVec3::new(0.0, 0.0, 5e5), DVec3::new(1e6, 1.0, 1.1e6)),
        (DVec3::new(0.0, 0.0, 2.4e-3), DVec3::splat(5e-3)),
    ] {
        for rotation in [DVec3::ZERO, turn] {
            // The floor is inside of the turned box, too.
            let center = if rotation == turn { DVec3::splat(0.1 * size.min_element()) } else { center };
            let shape = cuboid(center, size, rotation);
            let mut desc = lit_floor(shape, 2.0);
            desc.camera.position *= 0.1;
            assert_mean(&format!("box {size} {rotation}"), &desc, &measure(200_000), 2.0, WIDTH);
        }
    }
}

/// A floor so small, and an eye so near, that a light 1e-6 away is above both or beside both.
fn at_a_millionth(light: ShapeDesc) -> SceneDesc {
    let mut desc = lit_floor(light, 1.0);
    desc.objects[0].shape = square(DVec3::ZERO, 1e-7);
    desc.camera.position = DVec3::new(-1e-8, 0.0, 1e-8);
    desc
}

/// 1e-6 below a light, which fills the sky but for a strip at the horizon, and 1e-6 beside one that stands upright and goes
/// on below the floor: its upper half is what lights it.
#[test]
fn a_floor_at_a_millionth_of_a_light_is_lit_as_by_its_outline() {
    let gap = 1e-6;
    let above = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, y)| DVec3::new(x, y, gap));
    let beside = [(-0.5, 0.0), (0.5, 0.0), (0.5, 0.5), (-0.5, 0.5)].map(|(y, z)| DVec3::new(gap, y, z));
    let whole = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(y, z)| DVec3::new(gap, y, z));
    let quad = |corners: [DVec3; 4]| mesh(corners.map(|p| p.to_array()).to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
    let upright =
        ShapeDesc::Rectangle { position: DVec3::X * gap, width: 1.0, height: 1.0, rotation: DVec3::ZERO };
    for (what, shape, seen) in [
        ("rectangle above", square(DVec3::Z * gap, 1.0), above),
        ("box above", cuboid(DVec3::Z * (gap + 0.5), DVec3::ONE, DVec3::ZERO), above),
        ("mesh above", quad(above), above),
        ("rectangle beside", upright, beside),
        ("box beside", cuboid(DVec3::X * (gap + 0.5), DVec3::ONE, DVec3::ZERO), beside),
        ("mesh beside", quad(whole), beside),
    ] {
        let expected = polygon(&seen);
        let samples = if what.starts_with("mesh") { 2_000_000 } else { 600_000 };
        let rare = if what.ends_with("above") { 1.0 - expected } else { 0.0 };
        assert_mean_of_light(what, &at_a_millionth(shape), &measure(samples), expected, WIDTH, rare);
    }
}
