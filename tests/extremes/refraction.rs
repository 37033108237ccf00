//! Glass that is almost no glass: ratios of the refractive indices within 1e-7 of 1.

use super::{kinds, picture, small};
use crate::support::build::*;
use crate::support::meshes;
use pathtracer::math::{DVec3, Rgb};
use pathtracer::render::Settings;
use pathtracer::scene::desc::{EnvironmentDesc, MaterialKind, SceneDesc, ShapeDesc};

/// A sky that differs from direction to direction above the horizon, and a body of glass before it, seen from below.
fn desc_with(shape: Option<ShapeDesc>, ratio: f64) -> SceneDesc {
    let glass = |shape| (shape, MaterialKind::Refractive { color: grey(1.0), ratio });
    let mut desc = scene(DVec3::new(-4.0, 0.3, -0.4), DVec3::ZERO, shape.into_iter().map(glass).collect());
    desc.camera.fov = 0.25;
    desc.environment = EnvironmentDesc { sky: Rgb::X, horizon: grey(0.5), ground: grey(0.5), strength: 1.0 };
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

/// The most that a pixel may differ. Each of the two crossings turns a ray by |ratio - 1| tan(angle), 1e-5 for all but the
/// outermost part in 1e4 of a ball's outline. The sky's colour moves from the horizon's by at most 1/2 times z^0.8, and so
/// by at most 1/2 (2e-5)^0.8 where z changes by 2e-5: 0.9e-4. On the outline itself a ray may be turned a hundred times as
/// much, and differ by 3.5e-3: one of the 16 samples of a pixel gives 2.2e-4.
const ALLOWED: f64 = 0.9e-4 + 2.2e-4;

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
                assert!(worst < ALLOWED, "{accel:?} {body:?} ratio {ratio}: differs by {worst:e}");
            }
        }
    }
}
