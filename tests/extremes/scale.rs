//! A picture depends neither on the unit of length nor on where the scene lies.

use super::room::room;
use super::{kinds, kinds_and_precisions, picture, rel_mse, small};
use crate::support::build::edit_lengths;
use pathtracer::math::DVec3;
use pathtracer::picture::{Decoded, Pixels};
use pathtracer::render::{Settings, Unwatched, render};
use pathtracer::scene::desc::{MeshDesc, PictureDesc, SceneDesc, ShapeDesc};
use pathtracer::world::World;
use std::collections::HashMap;
use std::sync::Arc;

/// Powers of two that leave every number of the room in range.
const EXPONENTS: [i32; 12] = [-100, -40, -30, -20, -10, -1, 1, 10, 20, 30, 40, 100];

#[test]
fn lengths_times_a_power_of_two_change_no_bit() {
    for (accel, precision) in kinds_and_precisions() {
        let settings = Settings { accel, precision, ..small(32, 24, 8, 8) };
        let expected = picture(&room(1.0), &settings);
        for exponent in EXPONENTS {
            let mut desc = room(1.0);
            let factor = libm::ldexp(1.0, exponent);
            edit_lengths(&mut desc, |p| p * factor, |l| l * factor);
            assert!(picture(&desc, &settings) == expected, "{accel:?} {precision:?} 2^{exponent}");
        }
    }
}

/// The room with a picture on a wall, a box, a ball, a mesh and the instances of another.
fn textured_room(unit: f64) -> SceneDesc {
    let mut desc = room(unit);
    let pixels = (0..3 * 32 * 20u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 8) as f32 / 16_777_216.0);
    let picture =
        Decoded { width: 32, height: 20, pixels: Pixels::Floats(pixels.collect()), is_encoded: false };
    let picture = PictureDesc { file: "a.exr".into(), picture: Arc::new(picture), is_encoded: false };
    let mut meshes: HashMap<*const MeshDesc, Arc<MeshDesc>> = HashMap::new();
    for object in &mut desc.objects {
        object.material.textures.color = Some(picture.clone());
        if let ShapeDesc::TriangleMesh { mesh, .. } = &mut object.shape {
            let shared = meshes.entry(Arc::as_ptr(mesh)).or_insert_with(|| {
                let texcoords =
                    mesh.positions.iter().map(|p| [1.5, 2.25].map(|k: f32| k * (p[0] + 0.3 * p[2]) as f32));
                let texcoords = texcoords.enumerate().map(|(i, [u, v])| [u, v + i as f32]).collect();
                let texcoord_indices = mesh.triangles.clone();
                Arc::new(MeshDesc { texcoords, texcoord_indices, ..(**mesh).clone() })
            });
            *mesh = shared.clone();
        }
    }
    desc
}

#[test]
fn textures_do_not_know_the_unit_of_length_or_the_accelerator() {
    let settings = small(32, 24, 8, 6);
    let expected = picture(&textured_room(1.0), &settings);
    assert!(expected != picture(&room(1.0), &settings));
    for accel in kinds() {
        let settings = Settings { accel, ..settings.clone() };
        for exponent in EXPONENTS.into_iter().chain([-HELD, HELD]) {
            let mut desc = textured_room(1.0);
            let factor = libm::ldexp(1.0, exponent);
            edit_lengths(&mut desc, |p| p * factor, |l| l * factor);
            assert!(picture(&desc, &settings) == expected, "{accel:?} 2^{exponent}");
        }
    }
}

/// Sizes up to this power of two, and down to its inverse, must be rendered; from 1e75 and 1e-75 on the guards refuse.
const HELD: i32 = 200;

/// Beyond the range of numbers there is an error, never another picture.
#[test]
fn lengths_beyond_the_range_of_numbers_are_refused_or_change_no_bit() {
    let settings = small(16, 12, 2, 6);
    let expected = picture(&room(1.0), &settings);
    for exponent in (-1000..=1000).step_by(50) {
        let mut desc = room(1.0);
        let factor = libm::ldexp(1.0, exponent);
        edit_lengths(&mut desc, |p| p * factor, |l| l * factor);
        let compiled = World::compile(&desc);
        assert_eq!(compiled.is_ok(), exponent.abs() <= HELD, "2^{exponent}");
        let Ok(world) = compiled else { continue };
        let rendered = render(&world, &desc.camera, &settings, &Unwatched).expect("a render");
        let pixels: Vec<DVec3> = rendered.film.means().collect();
        assert!(pixels == expected, "2^{exponent}");
    }
}

#[test]
fn a_dyadic_translation_changes_no_bit() {
    let offset = DVec3::new(8_388_608.0, -4_194_304.0, 1_048_576.0);
    for accel in kinds() {
        let settings = Settings { accel, ..small(32, 24, 8, 8) };
        let mut desc = room(1.0);
        edit_lengths(&mut desc, |p| p + offset, |l| l);
        assert!(picture(&desc, &settings) == picture(&room(1.0), &settings), "{accel:?}");
    }
}

/// At 1e7 the last digit of a coordinate is 2e-9: positions change by 1e-9, and with them a few in 1e9 of the paths.
#[test]
fn a_decimal_scene_at_1e7_renders_as_at_the_origin() {
    let unit = 0.7;
    let reference = room(unit);
    for accel in kinds() {
        let settings = Settings { accel, ..small(64, 48, 16, 6) };
        let expected = picture(&reference, &settings);
        for offset in [DVec3::splat(1e7), DVec3::new(-1e7, 1e7 / 3.0, 1e6), DVec3::new(0.1, 1e7, 0.3)] {
            let mut desc = reference.clone();
            edit_lengths(&mut desc, |p| p + offset, |l| l);
            let error = rel_mse(&picture(&desc, &settings), &expected);
            assert!(error < 1e-6, "{accel:?} at {offset}: relMSE {error:e}");
        }
    }
}
