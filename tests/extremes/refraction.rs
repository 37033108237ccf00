//! Glass that is almost no glass: ratios of the refractive indices within 1e-7 of 1.

use super::{kinds, picture, small};
use crate::support::build::*;
use crate::support::meshes;
use pathtracer::math::{DVec3, Rgb};
use pathtracer::render::Settings;
use pathtracer::scene::desc::{EnvironmentDesc, MaterialKind, SceneDesc, ShapeDesc};

/// A sky that differs from direction to direction, and a body of glass before it.
fn desc_with(shape: Option<ShapeDesc>, ratio: f64) -> SceneDesc {
    let glass = |shape| (shape, MaterialKind::Refractive { color: grey(1.0), ratio });
    let mut desc = scene(DVec3::new(-4.0, 0.3, 0.4), DVec3::ZERO, shape.into_iter().map(glass).collect());
    desc.camera.fov = 0.25;
    desc.environment =
        EnvironmentDesc { sky: Rgb::X, horizon: grey(0.5), ground: Rgb::new(0.0, 0.5, 1.0), strength: 1.0 };
    desc
}

fn bodies() -> Vec<ShapeDesc> {
    let mesh_of = |part: pathtracer::geometry::MeshPart| {
        mesh(part.positions.iter().map(|p| p.to_array()).collect(), part.triangles)
    };
    vec![
        ball(DVec3::ZERO, 1.0),
        cuboid(DVec3::ZERO, DVec3::new(1.0, 1.5, 2.0), DVec3::new(10.0, 20.0, 30.0)),
        mesh_of(meshes::sphere(1.0, 30, 0.0, 1)),
    ]
}

/// A ray is turned by |ratio - 1| tan(angle), at most 1e-7 but for the outermost part in 1e7 of the outline, where it
/// may be reflected instead; the sky's steepest part, |z|^0.1 near the horizon, turns 1e-7 of z into 2e-2 of a sample
/// on the horizon itself, which is a millionth of the directions.
#[test]
fn a_body_of_glass_with_a_ratio_near_one_is_not_seen() {
    for accel in kinds() {
        let settings = Settings { accel, ..small(48, 48, 16, 8) };
        let expected = picture(&desc_with(None, 1.0), &settings);
        for body in bodies() {
            for ratio in [1.0 - 1e-7, 1.0 - 1e-9, 1.0 - 1e-15, 1.0, 1.0 + 1e-15, 1.0 + 1e-9, 1.0 + 1e-7] {
                let pixels = picture(&desc_with(Some(body.clone()), ratio), &settings);
                let error = |(a, b): (&Rgb, &Rgb)| (*a - *b).abs().max_element();
                let worst = pixels.iter().zip(&expected).map(error).fold(0.0, f64::max);
                assert!(worst < 2e-3, "{accel:?} {body:?} ratio {ratio}: differs by {worst:e}");
            }
        }
    }
}
