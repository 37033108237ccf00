//! What has no area or no number in it is refused with a message, or left out of the picture without a trace.

use super::{accelerators, kinds, picture, small};
use crate::support::build::*;
use crate::support::random::Random;
use crate::support::scenes::scene as test_scene;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::error::Error;
use pathtracer::geometry::{Geometry, Hit, MeshPart, Ray};
use pathtracer::math::{DVec3, Rgb};
use pathtracer::render::Settings;
use pathtracer::scene;
use std::fs;
use std::path::Path;

const SCENE: &str = "\
Camera:
  Position: [-4, 0.5, 1]
  LookingAt: [0, 0, 0.3]
  Fov: 0.2
  FocusDistance: 4
Objects:
  - Object:
      Type: TriangleMesh
      Filepath: mesh.obj
      Axes: ZUp
      Position: [0, 0, 0]
      Material: {Type: Diffuse, Color: [0.8, 0.6, 0.4]}
";

const MESH: &str = "\
v -1 -1 0
v 1 -1 0
v 1 1 0
v -1 1 0
v 0 0 1
f 1 2 5
f 2 3 5
f 3 4 5
f 4 1 5
";

/// The picture of [`SCENE`] with this mesh.
fn picture_of(obj: &str, settings: &Settings) -> Vec<Rgb> {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("mesh.obj"), obj).expect("a file in a temporary folder");
    let scene = scene::parse(SCENE, &folder.path().join("scene.yaml")).expect("a scene that can be rendered");
    picture(&scene.desc, settings)
}

#[test]
fn a_mesh_with_degenerate_parts_renders_as_without_them() {
    for accel in kinds() {
        let settings = Settings { accel, ..small(32, 32, 4, 4) };
        let expected = picture_of(MESH, &settings);
        assert!(expected.iter().any(|&pixel| pixel != expected[0]), "something is seen");
        for (what, added) in [
            ("a face of one corner", "f 1 1 1\n"),
            ("a face with a corner twice", "f 1 2 2\n"),
            ("a face on a line", "v 3 3 0\nf 1 3 6\n"),
            ("a corner that no face uses", "v 1e9 1e9 1e9\n"),
            ("the same corner again", "v 1 1 0\n"),
            ("a face on a line of far corners", "v 1e9 0 0\nv 2e9 0 0\nv 3e9 0 0\nf 6 7 8\n"),
        ] {
            assert!(picture_of(&format!("{MESH}{added}"), &settings) == expected, "{accel:?}: {what}");
        }
        let twice = MESH.replace("f 3 4 5", "v 1 1 0\nf 6 4 5");
        assert!(picture_of(&twice, &settings) == expected, "{accel:?}: a corner written twice");
    }
}

#[test]
fn shapes_without_extent_are_refused() {
    for (old, new) in [
        ("Radius: 1", "Radius: 0"),
        ("Radius: 1", "Radius: -1"),
        ("Radius: 1", "Radius: .nan"),
        ("Radius: 1", "Radius: .inf"),
        ("[0, 0, 0]", "[0, .nan, 0]"),
        ("Type: Ball", "{Type: Box, Width: 0, Height: 1, Depth: 1}"),
        ("Type: Ball", "{Type: Box, Width: 1, Height: -1, Depth: 1}"),
        ("Type: Ball", "{Type: Rectangle, Width: 1, Height: 0}"),
    ] {
        let object =
            "{Type: Ball, Position: [0, 0, 0], Radius: 1, Material: {Type: Diffuse, Color: [1, 1, 1]}}";
        let object = match new.strip_prefix('{').and_then(|new| new.strip_suffix('}')) {
            Some(new) => object.replace("Type: Ball", new).replace(" Radius: 1,", ""),
            None => object.replace(old, new),
        };
        let text = format!(
            "Camera: {{Position: [-4, 0, 0], LookingAt: [0, 0, 0], Fov: 0.2, FocusDistance: 4}}\n\
             Objects:\n  - Object: {object}\n"
        );
        let result = scene::parse(&text, Path::new("scene.yaml"));
        assert!(matches!(result, Err(Error::Scene(_))), "{text}");
    }
}

#[test]
fn an_empty_scene_shows_the_sky() {
    let mut desc = scene(DVec3::ZERO, DVec3::X, Vec::new());
    desc.environment = sky(0.5);
    for accel in kinds() {
        let pixels = picture(&desc, &Settings { accel, ..small(8, 8, 4, 4) });
        assert!(pixels.iter().all(|&pixel| pixel == grey(0.5)));
    }
}

#[test]
fn a_hundred_thousand_equal_triangles_render_as_one() {
    let corners = vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.1], [0.0, 1.0, 0.2]];
    let copies = |count| {
        let lamp = mesh(corners.clone(), vec![[0, 1, 2]; count]);
        let floor = square(DVec3::new(0.0, 0.0, -1.0), 4.0);
        let objects = vec![(lamp, glowing(grey(0.5), grey(1.0))), (floor, diffuse(grey(0.8)))];
        let mut desc = scene(DVec3::new(-2.0, 0.3, 3.0), DVec3::ZERO, objects);
        desc.camera.fov = 0.8;
        desc.environment = sky(0.25);
        desc
    };
    for accel in kinds() {
        let settings = Settings { accel, ..small(16, 16, 4, 3) };
        assert!(picture(&copies(100_000), &settings) == picture(&copies(1), &settings), "{accel:?}");
    }
}

fn bits(hit: Option<Hit>) -> Option<([u64; 3], u32, u32)> {
    hit.map(|h| ([h.t, h.u, h.v].map(f64::to_bits), h.object, h.part))
}

/// Behind the reader of files: triangles without area between those with it change no hit.
#[test]
fn triangles_without_area_change_no_hit() {
    let base = test_scene("terrain", DVec3::ZERO);
    let clean = &base.parts[0];
    let mut dirty = clean.clone();
    let mut random = Random::new(161);
    for _ in 0..500 {
        let mut corner = || random.index(clean.positions.len()) as u32;
        let (a, b) = (corner(), corner());
        dirty.triangles.extend([[a, a, a], [a, b, b]]);
    }
    let dirty = MeshPart { object: 0, ..dirty };
    let (clean, dirty) =
        (Geometry::new(Vec::new(), std::slice::from_ref(clean)), Geometry::new(Vec::new(), &[dirty]));
    for precision in [Precision::Exact, Precision::Robust, Precision::Fast] {
        for (one, other) in accelerators(&clean, precision).iter().zip(accelerators(&dirty, precision)) {
            for _ in 0..10_000 {
                let target = random.in_cube() * DVec3::new(1.0, 1.0, 0.1);
                let origin = target + random.direction() * 3.0;
                let ray = Ray::new(origin, (target - origin).normalize());
                assert_eq!(bits(one.intersect(&ray)), bits(other.intersect(&ray)), "{} {ray:?}", one.name);
            }
        }
    }
}
