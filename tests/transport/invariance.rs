//! What may not change a picture: where the scene lies, how large it is, features that are switched to nothing.

use crate::support::build::*;
use pathtracer::math::DVec3;
use pathtracer::scene::desc::{ApertureDesc, MaterialKind, SceneDesc};

const MEASURE: Measure = Measure { samples: 4000, bounces: 6, light_sampling: true };

/// Glass, mirror, coat, lens, light, box, mesh; all coordinates are dyadic.
fn dyadic_room() -> SceneDesc {
    let white = diffuse(grey(0.75));
    let tetrahedron = mesh(
        vec![[0.5, -1.0, 0.0], [1.25, -0.75, 0.0], [0.75, -0.25, 0.0], [0.75, -0.75, 0.875]],
        vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    );
    let coat =
        MaterialKind::ClearCoat { color: grey(0.5), coat: 0.5, coat_color: grey(0.75), specularity: 0.75 };
    let objects = vec![
        (square(DVec3::ZERO, 16.0), white.clone()),
        (ball(DVec3::new(0.0, 0.5, 0.5), 0.5), MaterialKind::Refractive { color: grey(1.0), ratio: 0.625 }),
        (
            ball(DVec3::new(1.0, 1.0, 0.5), 0.5),
            MaterialKind::Reflective { color: grey(0.875), specularity: 0.75 },
        ),
        (cuboid(DVec3::new(2.0, 0.0, 0.5), DVec3::new(1.0, 0.5, 1.0), DVec3::new(0.0, 0.0, 30.0)), coat),
        (tetrahedron, white),
        (square(DVec3::new(0.0, 0.0, 4.0), 1.0), glowing(grey(0.25), grey(8.0))),
    ];
    let mut desc = scene(DVec3::new(-4.0, 0.25, 1.5), DVec3::new(0.0, 0.0, 0.5), objects);
    desc.camera.fov = 0.25;
    desc.camera.focus_distance = 4.0;
    desc.camera.aperture = ApertureDesc::Radius(0.125);
    desc.environment.sky = grey(0.5);
    desc
}

#[test]
fn lengths_times_a_power_of_two_change_no_bit() {
    let expected = samples(&dyadic_room(), &MEASURE);
    for exponent in [-30, -20, -10, 10, 20, 30] {
        let factor = 2f64.powi(exponent);
        let mut desc = dyadic_room();
        edit_lengths(&mut desc, |p| p * factor, |l| l * factor);
        assert!(samples(&desc, &MEASURE) == expected, "2^{exponent}");
    }
}

#[test]
fn a_dyadic_translation_changes_no_bit() {
    let offset = DVec3::new(8_388_608.0, -4_194_304.0, 1_048_576.0);
    let mut desc = dyadic_room();
    edit_lengths(&mut desc, |p| p + offset, |l| l);
    assert!(samples(&desc, &MEASURE) == samples(&dyadic_room(), &MEASURE));
}

#[test]
fn emission_times_a_power_of_two_scales_every_sample_exactly() {
    let mut desc = dyadic_room();
    let factor = 2f64.powi(9);
    desc.environment.strength = factor;
    for object in &mut desc.objects {
        if let MaterialKind::Diffuse { emission, .. } = &mut object.material.kind {
            *emission *= factor;
        }
    }
    let expected: Vec<f64> = samples(&dyadic_room(), &MEASURE).into_iter().map(|v| v * factor).collect();
    assert!(samples(&desc, &MEASURE) == expected);
}
