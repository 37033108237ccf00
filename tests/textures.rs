//! Pictures as colours: where their points go on every shape, means, encodings, no cost without.

use crate::support::build::{
    Measure, assert_mean, ball, cuboid, diffuse, grey, mesh, placed, samples, scene, sky, square,
};
use pathtracer::accel::{Accelerator, brute_force::BruteForce};
use pathtracer::geometry::Ray;
use pathtracer::material::Material;
use pathtracer::math::{DVec3, Rgb};
use pathtracer::picture::{Decoded, Pixels, srgb_decode};
use pathtracer::scene::desc::{MaterialKind, PictureDesc, SceneDesc, ShapeDesc};
use pathtracer::world::World;
use std::sync::Arc;

/// A linear picture of 2 x 2 pixels: upper left 0.1, upper right 0.2, lower left 0.3, lower right 0.4.
fn quarters() -> PictureDesc {
    picture(2, 2, [0.1, 0.2, 0.3, 0.4].into_iter().flat_map(|value| [value; 3]).collect())
}

fn picture(width: u32, height: u32, rgb: Vec<f32>) -> PictureDesc {
    let picture = Decoded { width, height, pixels: Pixels::Floats(rgb), is_encoded: false };
    PictureDesc { file: "a.exr".into(), picture: Arc::new(picture), is_encoded: false }
}

fn textured(shape: ShapeDesc, kind: MaterialKind, picture: PictureDesc) -> SceneDesc {
    let mut desc = scene(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, vec![(shape, kind)]);
    desc.objects[0].material.textures.color = Some(picture);
    desc.environment = sky(1.0);
    desc
}

/// The colour of a diffuse shape that a ray from `eye` to `target` sees.
fn seen(shape: &ShapeDesc, picture: &PictureDesc, eye: DVec3, target: DVec3) -> f64 {
    let desc = textured(shape.clone(), diffuse(grey(1.0)), picture.clone());
    let world = World::compile(&desc).expect("a valid scene");
    let ray = Ray::new(eye - world.origin, (target - eye).normalize());
    let hit = BruteForce::new(&world.geometry).intersect(&ray).expect("a hit");
    let at = world.interaction(&ray, &hit);
    let Some(Material::Diffuse(diffuse)) = world.varied_material(&hit, &at, 0.0) else {
        panic!("a varied material")
    };
    diffuse.color.x
}

#[track_caller]
fn assert_seen(shape: &ShapeDesc, eye: DVec3, target: DVec3, expected: f64) {
    let value = seen(shape, &quarters(), eye, target);
    // The values of the picture are f32.
    assert!((value - expected).abs() < 1e-6, "{value} instead of {expected}");
}

#[test]
fn a_rectangle_shows_the_picture_upright_to_who_looks_along_x() {
    let shape =
        ShapeDesc::Rectangle { position: DVec3::ZERO, width: 4.0, height: 4.0, rotation: DVec3::ZERO };
    // The right is -y. Middles of the pixels are a quarter from the edges.
    for (y, z, expected) in [(1.0, 1.0, 0.1), (-1.0, 1.0, 0.2), (1.0, -1.0, 0.3), (-1.0, -1.0, 0.4)] {
        assert_seen(&shape, DVec3::new(-5.0, y, z), DVec3::new(0.0, y, z), expected);
    }
    // Half way between the four middles: their mean.
    assert_seen(&shape, DVec3::new(-5.0, 0.0, 0.0), DVec3::ZERO, 0.25);
}

#[test]
fn every_face_of_a_box_shows_the_picture_from_outside() {
    let shape = cuboid(DVec3::ZERO, DVec3::splat(4.0), DVec3::ZERO);
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    // Outwards, to the right, up.
    for (out, right, up) in [(-x, -y, z), (x, y, z), (-y, x, z), (y, -x, z), (z, -y, x), (-z, -y, x)] {
        for (r, u, expected) in [(-1.0, 1.0, 0.1), (1.0, 1.0, 0.2), (-1.0, -1.0, 0.3), (1.0, -1.0, 0.4)] {
            let beside = right * r + up * u;
            assert_seen(&shape, out * 9.0 + beside, out * 2.0 + beside, expected);
        }
    }
}

#[test]
fn a_ball_takes_azimuth_and_height() {
    // Columns of 0.1 to 0.4, around from +x; bilinear between their middles at 45, 135, 225, 315 degrees.
    let around = picture(4, 1, [0.1, 0.2, 0.3, 0.4].into_iter().flat_map(|value| [value; 3]).collect());
    let shape = ball(DVec3::ZERO, 1.0);
    for (x, y, expected) in [(1.0, 1.0, 0.1), (-1.0, 1.0, 0.2), (-1.0, -1.0, 0.3), (1.0, -1.0, 0.4)] {
        let value = seen(&shape, &around, DVec3::new(x, y, 0.0) * 5.0, DVec3::ZERO);
        assert!((value - expected).abs() < 1e-6, "{value} {expected}");
    }
    // Rows of 0.1 above and 0.3 below: the middles are at 45 degrees of colatitude.
    let above = picture(1, 2, [0.1, 0.3].into_iter().flat_map(|value| [value; 3]).collect());
    for (z, expected) in [(1.0, 0.1), (-1.0, 0.3), (0.0, 0.2)] {
        let value = seen(&shape, &above, DVec3::new(1.0, 0.0, z) * 5.0, DVec3::ZERO);
        assert!((value - expected).abs() < 1e-6, "{value} {expected}");
    }
}

/// A square of two triangles in the plane z = 0 with the picture upright seen from above, +x to the right.
fn square_mesh() -> ShapeDesc {
    let corners = vec![[-2.0, -2.0, 0.0], [2.0, -2.0, 0.0], [2.0, 2.0, 0.0], [-2.0, 2.0, 0.0]];
    let ShapeDesc::TriangleMesh { file, mesh, scale, position, rotation, axes, smooth } =
        mesh(corners, vec![[0, 1, 2], [0, 2, 3]])
    else {
        panic!("a mesh")
    };
    let mut mesh = (*mesh).clone();
    mesh.texcoords = vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    mesh.texcoord_indices = mesh.triangles.clone();
    ShapeDesc::TriangleMesh { file, mesh: Arc::new(mesh), scale, position, rotation, axes, smooth }
}

#[test]
fn a_mesh_takes_its_texture_coordinates() {
    for (x, y, expected) in [(-1.0, 1.0, 0.1), (1.0, 1.0, 0.2), (-1.0, -1.0, 0.3), (1.0, -1.0, 0.4)] {
        assert_seen(&square_mesh(), DVec3::new(x, y, 5.0), DVec3::new(x, y, 0.0), expected);
    }
}

#[test]
fn instances_and_mirrored_meshes_keep_their_pictures() {
    use pathtracer::scene::desc::Axes;
    let swapped = |shape: ShapeDesc| match shape {
        ShapeDesc::TriangleMesh { file, mesh, scale, position, rotation, smooth, .. } => {
            ShapeDesc::TriangleMesh { file, mesh, scale, position, rotation, axes: Axes::SwapYZ, smooth }
        }
        other => other,
    };
    let plain = square_mesh();
    // (x, y, 0) of the file becomes (x, 0, y).
    for (x, y, expected) in [(-1.0, 1.0, 0.1), (1.0, -1.0, 0.4)] {
        assert_seen(&swapped(plain.clone()), DVec3::new(x, 5.0, y), DVec3::new(x, 0.0, y), expected);
    }
    let copies: Vec<(ShapeDesc, MaterialKind)> = [0.0, 10.0]
        .map(|x| (placed(plain.clone(), DVec3::new(x, 0.0, 0.0), 1.0, DVec3::ZERO), diffuse(grey(1.0))))
        .into();
    let mut desc = scene(DVec3::new(11.0, 1.0, 5.0), DVec3::new(11.0, 1.0, 0.0), copies);
    desc.objects.iter_mut().for_each(|object| object.material.textures.color = Some(quarters()));
    desc.environment = sky(1.0);
    let measure = Measure { samples: 16, bounces: 2, light_sampling: true };
    assert_mean("the upper right of a copy", &desc, &measure, f64::from(0.2f32), 1e-6);
}

#[test]
fn a_plain_picture_is_a_plain_colour_on_every_material() {
    let color = Rgb::new(0.25, 0.5, 0.75);
    let plain = picture(3, 2, color.to_array().map(|value| value as f32).repeat(6));
    let kinds = |color| {
        [
            diffuse(color),
            MaterialKind::Reflective { color, specularity: 0.3 },
            MaterialKind::ClearCoat { color, coat: 0.5, coat_color: Rgb::ONE, specularity: 0.9 },
            MaterialKind::Refractive { color, ratio: 0.67 },
        ]
    };
    let measure = Measure { samples: 200, bounces: 6, light_sampling: true };
    for (white, colored) in kinds(Rgb::ONE).into_iter().zip(kinds(color)) {
        let shape = ball(DVec3::ZERO, 1.0);
        let varied = textured(shape.clone(), white, plain.clone());
        let mut expected = textured(shape, colored.clone(), plain.clone());
        expected.objects[0].material.textures.color = None;
        let (varied, expected) = (samples(&varied, &measure), samples(&expected, &measure));
        let near = varied.iter().zip(&expected).all(|(a, b)| (a - b).abs() <= 1e-12 * b.abs());
        assert!(near, "{colored:?}");
    }
}

/// A floor under a constant sky of 1 shows the mean of its picture where the view covers whole squares of it.
#[test]
fn a_checkerboard_has_the_mean_of_its_squares() {
    let squares: Vec<f32> =
        (0..64u32).map(|i| if (i / 8 + i) % 2 == 0 { 0.9 } else { 0.1 }).flat_map(|v| [v; 3]).collect();
    let mut desc = textured(square(DVec3::ZERO, 2.0), diffuse(grey(1.0)), picture(8, 8, squares));
    // From a height of 100 the view is 1 wide: half of the board in each direction.
    desc.camera.position = DVec3::new(0.0, 0.0, 100.0);
    desc.camera.fov = 2.0 / std::f64::consts::PI * (0.5f64 / 100.0).atan();
    let measure = Measure { samples: 50_000, bounces: 2, light_sampling: true };
    assert_mean("a checkerboard", &desc, &measure, 0.5, 1e-2);
}

#[test]
fn bytes_are_decoded_as_srgb_or_taken_as_they_are() {
    for is_encoded in [true, false] {
        let pixels = Pixels::Bytes(vec![128; 3]);
        let picture = Arc::new(Decoded { width: 1, height: 1, pixels, is_encoded: true });
        let picture = PictureDesc { file: "a.png".into(), picture, is_encoded };
        let value = seen(&ball(DVec3::ZERO, 1.0), &picture, DVec3::Z * 3.0, DVec3::ZERO);
        let expected = if is_encoded { srgb_decode(128.0 / 255.0) } else { 128.0 / 255.0 };
        assert!((value - expected).abs() < 1e-7, "{value} {expected}");
    }
}

#[test]
fn a_scene_without_pictures_has_none() {
    let desc = scene(DVec3::X, DVec3::ZERO, vec![(ball(DVec3::ZERO, 0.5), diffuse(grey(1.0)))]);
    let requires = World::compile(&desc).expect("a valid scene").requires;
    assert_eq!(requires.textures, 0);
    assert!(!requires.to_string().contains("texture"));
}
