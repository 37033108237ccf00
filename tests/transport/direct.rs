//! Direct light of every shape of light against its closed form.

use crate::support::build::*;
use pathtracer::math::DVec3;
use pathtracer::scene::desc::EnvironmentDesc;
use std::f64::consts::PI;

/// Reflected radiance of a white Lambertian patch with normal +z at the origin, from a polygon above the horizon that
/// emits 1 (Lambert's formula: 1 / 2 pi times the sum of the edges' angles times the cosines of their planes).
fn polygon(corners: &[DVec3]) -> f64 {
    let sum: f64 = (0..corners.len())
        .map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            a.angle_between(b) * a.cross(b).normalize().z
        })
        .sum();
    sum.abs() / (2.0 * PI)
}

const TWO_SEGMENTS: Measure = Measure { samples: 100_000, bounces: 2, light_sampling: true };

#[test]
fn balls_of_every_solid_angle_light_a_floor() {
    for ratio in [0.99, 0.1, 1e-3, 1e-5, 1e-7] {
        for cosine in [1.0f64, 0.5] {
            // Wholly above the horizon.
            if ratio > cosine {
                continue;
            }
            let direction = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
            let distance = 2.0;
            let desc = lit_floor(ball(direction * distance, ratio * distance), 3.0 / (ratio * ratio));
            let (what, by_material) = (format!("r/d {ratio} cosine {cosine}"), ratio * ratio * cosine);
            assert_mean_of_light(&what, &desc, &TWO_SEGMENTS, 3.0 * cosine, 1e-2, by_material);
        }
    }
}

#[test]
fn a_point_just_outside_a_ball_light_is_fully_lit_and_so_is_one_inside() {
    let distance = 1.0 + 1e-6;
    let desc = lit_floor(ball(DVec3::Z * distance, 1.0), 2.0);
    // The rare kind is what passes between the horizon and the light.
    let expected = 2.0 / (distance * distance);
    assert_mean_of_light("outside", &desc, &TWO_SEGMENTS, expected, 1e-2, 2.0 / expected - 1.0);
    let desc = lit_floor(ball(DVec3::Z * 0.5, 1.0), 2.0);
    assert_mean("inside", &desc, &TWO_SEGMENTS, 2.0, 1e-2);
}

#[test]
fn rectangles_of_every_solid_angle_light_a_floor() {
    for half in [30.0, 1.0, 1e-2, 1e-4] {
        let center = DVec3::new(0.4, 0.2, 1.5);
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| center + DVec3::new(x * half, y * half, 0.0));
        let desc = lit_floor(square(center, 2.0 * half), 1.0 / (half * half));
        let expected = if half >= 1e-3 {
            polygon(&corners)
        } else {
            // A patch so small that the integrand is constant to (half / distance)^2.
            4.0 * half * half * center.z * center.z / (center.length_squared() * center.length_squared()) / PI
        };
        let mean = expected / (half * half);
        assert_mean_of_light(&format!("half {half}"), &desc, &TWO_SEGMENTS, mean, 1e-2, expected);
    }
}

#[test]
fn a_box_lights_a_floor_by_its_visible_faces() {
    let center = DVec3::new(0.7, -0.4, 1.5);
    let size = DVec3::new(0.5, 0.8, 0.6);
    let desc = lit_floor(cuboid(center, size, DVec3::ZERO), 1.0);
    let at = |x: f64, y: f64, z: f64| center + size * 0.5 * DVec3::new(x, y, z);
    // From the origin the faces -x, +y and -z are seen.
    let faces = [
        [at(-1., -1., -1.), at(-1., 1., -1.), at(-1., 1., 1.), at(-1., -1., 1.)],
        [at(-1., 1., -1.), at(1., 1., -1.), at(1., 1., 1.), at(-1., 1., 1.)],
        [at(-1., -1., -1.), at(1., -1., -1.), at(1., 1., -1.), at(-1., 1., -1.)],
    ];
    let expected: f64 = faces.iter().map(|face| polygon(face)).sum();
    assert_mean("box", &desc, &TWO_SEGMENTS, expected, 1e-2);
}

#[test]
fn triangles_of_a_mesh_light_a_floor() {
    let corners = [[0.5, -0.2, 1.0], [1.5, 0.3, 1.2], [0.2, 1.0, 1.4], [-0.4, 0.2, 0.9]];
    let desc = lit_floor(mesh(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]), 1.0);
    let [a, b, c, d] = corners.map(DVec3::from_array);
    let expected = polygon(&[a, b, c]) + polygon(&[a, c, d]);
    assert_mean("mesh", &desc, &TWO_SEGMENTS, expected, 1e-2);
}

#[test]
fn many_lights_add_up() {
    let lights: Vec<DVec3> =
        (0..40).map(|i| DVec3::new(f64::from(i % 8) - 3.5, f64::from(i / 8) - 2.0, 2.0)).collect();
    for count in [2, 16, 17, 40] {
        let mut objects = vec![(square(DVec3::ZERO, 1e-3), diffuse(grey(1.0)))];
        objects.extend(lights[..count].iter().map(|&p| (ball(p, 0.05), glowing(grey(0.0), grey(100.0)))));
        let desc = scene(DVec3::new(-1e-4, 0.0, 1e-4), DVec3::ZERO, objects);
        let expected: f64 =
            lights[..count].iter().map(|p| 100.0 * 0.0025 / p.length_squared() * (p.z / p.length())).sum();
        assert_mean(&format!("{count} lights"), &desc, &TWO_SEGMENTS, expected, 1e-2);
    }
}

/// The integral of (horizon + (sky - horizon) z^0.8) cos over the hemisphere is horizon + (sky - horizon) 2 / 2.8.
#[test]
fn the_gradient_sky_lights_a_floor() {
    let mut desc =
        scene(DVec3::new(-1.0, 0.0, 1.0), DVec3::ZERO, vec![(square(DVec3::ZERO, 1.0), diffuse(grey(0.5)))]);
    desc.environment =
        EnvironmentDesc { sky: grey(4.0), horizon: grey(1.0), ground: grey(9.0), strength: 2.0 };
    let expected = 0.5 * 2.0 * (1.0 + 3.0 * 2.0 / 2.8);
    for light_sampling in [false, true] {
        let measure = Measure { samples: 100_000, bounces: 2, light_sampling };
        assert_mean(&format!("light sampling {light_sampling}"), &desc, &measure, expected, 1e-2);
    }
}

#[test]
fn light_sampling_changes_no_mean() {
    let light = ball(DVec3::new(0.5, 0.3, 1.0), 0.5);
    let desc = lit_floor(light, 2.0);
    let center = DVec3::new(0.5, 0.3, 1.0);
    let d2 = center.length_squared();
    let expected = 2.0 * 0.25 / d2 * (center.z / d2.sqrt());
    for light_sampling in [false, true] {
        let measure = Measure { samples: 400_000, bounces: 2, light_sampling };
        assert_mean(&format!("light sampling {light_sampling}"), &desc, &measure, expected, 1e-2);
    }
}

#[test]
fn one_segment_sees_lights_and_sky_only() {
    let mut desc = lit_floor(ball(DVec3::Z, 0.1), 5.0);
    let measure = Measure { samples: 16, bounces: 1, light_sampling: true };
    assert_mean("a lit floor", &desc, &measure, 0.0, 0.0);
    desc.camera.looking_at = DVec3::Z;
    assert_mean("a light", &desc, &measure, 5.0, 0.0);
}
