//! Furnaces at standard errors of 1e-3 and 1e-4, with as many samples as that takes.

use super::furnace::{EYE, convex_shapes, opaque_white};
use crate::support::build::*;
use crate::support::meshes;
use pathtracer::math::DVec3;
use pathtracer::scene::desc::{MaterialKind, SceneDesc, ShapeDesc};

/// [`assert_mean_of_light`] with the samples that a pilot finds necessary, and half as many again.
fn assert_narrow(
    what: &str,
    desc: &SceneDesc,
    bounces: u32,
    light_sampling: bool,
    expected: f64,
    width: f64,
    rare: f64,
) {
    let pilot = Measure { samples: 50_000, bounces, light_sampling };
    let variance = moments(desc, &pilot).variance();
    let needed = 1.5 * variance / (width * expected * width * expected);
    assert!(needed < 1e8, "{what}: {needed:e} samples");
    let measure = Measure { samples: (needed as u64).max(50_000), ..pilot };
    assert_mean_of_light(what, desc, &measure, expected, width, rare);
}

/// A closed body that a camera looks around in; [`super::furnace`] has the expected mean.
fn closed_furnace(name: &str, shape: ShapeDesc, light_sampling: bool) {
    for rho in [0.1, 0.5, 0.9, 0.99] {
        for bounces in [1, 2, 5, 16] {
            let body = (shape.clone(), glowing(grey(rho), grey(1.0 - rho)));
            let desc = scene(DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.4, 0.1, -0.2), vec![body]);
            let expected = 1.0 - f64::powi(rho, bounces);
            let what = format!("{name} rho {rho} bounces {bounces}");
            assert_narrow(&what, &desc, bounces as u32, light_sampling, expected, 1e-4, 0.0);
        }
    }
}

fn turned_box() -> ShapeDesc {
    cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 0.0, 17.0))
}

/// A closed mesh of 180 triangles around the camera.
fn closed_mesh() -> ShapeDesc {
    let part = meshes::sphere(1.0, 14, 0.1, 5);
    mesh(part.positions.iter().map(DVec3::to_array).collect(), part.triangles)
}

/// From inside a ball is never aimed at, so light sampling would be the same.
#[test]
#[ignore = "minutes"]
fn a_closed_ball_to_a_standard_error_of_1e_4() {
    closed_furnace("ball", ball(DVec3::ZERO, 1.0), false);
}

#[test]
#[ignore = "minutes"]
fn a_closed_box_to_a_standard_error_of_1e_4() {
    closed_furnace("box", turned_box(), false);
}

#[test]
#[ignore = "minutes"]
fn a_closed_box_with_light_sampling_to_a_standard_error_of_1e_4() {
    closed_furnace("box", turned_box(), true);
}

#[test]
#[ignore = "minutes"]
fn a_closed_mesh_to_a_standard_error_of_1e_4() {
    closed_furnace("mesh", closed_mesh(), false);
}

#[test]
#[ignore = "minutes"]
fn a_closed_mesh_with_light_sampling_to_a_standard_error_of_1e_4() {
    closed_furnace("mesh", closed_mesh(), true);
}

#[test]
fn white_furnaces_with_light_sampling_to_a_standard_error_of_1e_3() {
    for shape in convex_shapes() {
        for kind in opaque_white() {
            let mut desc = scene(EYE, DVec3::ZERO, vec![(shape.clone(), kind.clone())]);
            desc.environment = sky(1.0);
            // Not constant to the program: a gradient by a last bit, so that the sky is sampled.
            desc.environment.sky = grey(1.0 + 1e-15);
            // Rays aimed at the sky rarely meet a lobe, a cone with the sine (1 - s) / s, and carry that share.
            let rare = match kind {
                MaterialKind::Reflective { specularity, .. }
                | MaterialKind::ClearCoat { specularity, .. } => {
                    let sine = (1.0 - specularity) / specularity;
                    0.25 * (sine * sine) * (1.0 + sine * sine)
                }
                _ => 0.0,
            };
            assert_narrow(&format!("{kind:?}"), &desc, 8, true, 1.0, 1e-3, rare);
        }
    }
}
