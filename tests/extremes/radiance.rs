//! A picture scales with its lights, and lights of strength 0 are none.

use super::room::room;
use super::{kinds, kinds_and_precisions, picture, small};
use crate::support::build::sky;
use pathtracer::math::{DVec3, Rgb};
use pathtracer::render::Settings;
use pathtracer::scene::{
    self,
    desc::{EnvironmentDesc, MaterialKind, SceneDesc},
};
use pathtracer::world::World;
use std::path::Path;

/// The room with its back open to a sky, all lights `factor` times as strong.
fn lit_room(factor: f64) -> SceneDesc {
    let mut desc = room(1.0);
    desc.environment = EnvironmentDesc { sky: DVec3::new(0.25, 0.5, 1.0), strength: factor, ..sky(0.5) };
    for object in &mut desc.objects {
        if let MaterialKind::Diffuse { emission, .. } = &mut object.material.kind {
            *emission *= factor;
        }
    }
    desc
}

#[test]
fn lights_times_a_power_of_two_scale_every_pixel_exactly() {
    for (accel, precision) in kinds_and_precisions() {
        let settings = Settings { accel, precision, ..small(32, 24, 8, 8) };
        let reference = picture(&lit_room(1.0), &settings);
        for exponent in [-30, -9, 9, 30] {
            let factor = libm::ldexp(1.0, exponent);
            let expected: Vec<Rgb> = reference.iter().map(|&pixel| pixel * factor).collect();
            let what = format!("{accel:?} {precision:?} 2^{exponent}");
            assert!(picture(&lit_room(factor), &settings) == expected, "{what}");
        }
    }
}

/// A floor, a ball with these keys of its material and a light, under a sky.
fn with_emission(keys: &str) -> SceneDesc {
    let text = format!(
        "Camera: {{Position: [-4, 0, 1.5], LookingAt: [0, 0, 0.5], Fov: 0.4, FocusDistance: 4}}
Environment: {{SkyColor: [0.2, 0.4, 0.8], HorizonColor: [0.5, 0.5, 0.5], GroundColor: [0.1, 0.1, 0.1]}}
Objects:
  - Object: {{Type: Rectangle, Position: [0, 0, 0], Width: 9, Height: 9, Rotation: [0, 90, 0], Material: {{Type: Diffuse}}}}
  - Object: {{Type: Ball, Position: [0, 0, 0.5], Radius: 0.5, Material: {{Type: Diffuse, Color: [0.7, 0.5, 0.3]{keys}}}}}
  - Object: {{Type: Ball, Position: [0, 2, 2], Radius: 0.5, Material: {{Type: Diffuse, EmissionStrength: 4}}}}
"
    );
    scene::parse(&text, Path::new("scene.yaml")).unwrap_or_else(|error| panic!("{error}")).desc
}

#[test]
fn an_emission_of_strength_zero_is_none() {
    let (without, with) =
        (with_emission(""), with_emission(", EmissionStrength: 0, EmissionColor: [1, 0.5, 0.2]"));
    for desc in [&without, &with] {
        assert_eq!(World::compile(desc).expect("a valid scene").requires.area_lights, 1);
    }
    for accel in kinds() {
        let settings = Settings { accel, ..small(32, 24, 8, 6) };
        assert!(picture(&with, &settings) == picture(&without, &settings), "{accel:?}");
    }
}
