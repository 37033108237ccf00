//! What numbers can't hold is said with the numbers: every message, and that ordinary scenes get none.

use crate::support::build::*;
use pathtracer::error::{Diagnostic, Error, Severity};
use pathtracer::math::DVec3;
use pathtracer::scene;
use pathtracer::scene::desc::{ApertureDesc, MaterialKind, SceneDesc, ShapeDesc};
use pathtracer::world::World;
use std::path::Path;

/// A view of the origin from 5 units away.
fn seen(objects: Vec<ShapeDesc>) -> SceneDesc {
    let grey_one = |shape| (shape, diffuse(grey(0.5)));
    let mut desc =
        scene(DVec3::new(-5.0, 0.5, 1.0), DVec3::ZERO, objects.into_iter().map(grey_one).collect());
    desc.camera.fov = 0.3;
    for (object, line) in desc.objects.iter_mut().zip(1..) {
        object.location.line = line;
    }
    desc
}

/// What is said of a scene, as (is an error, line of the object, message).
fn said(desc: &SceneDesc) -> Vec<(bool, Option<usize>, String)> {
    let world = World::compile(desc).expect("within the range of numbers");
    let diagnostics = match world.guards(desc, 1920) {
        Ok(warnings) => {
            assert!(warnings.iter().all(|diagnostic| diagnostic.severity == Severity::Warning));
            warnings
        }
        Err(Error::Scene(diagnostics)) => {
            assert!(diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error));
            diagnostics
        }
        Err(other) => panic!("{other}"),
    };
    assert!(diagnostics.iter().all(|diagnostic| diagnostic.help.is_some()));
    let line = |diagnostic: &Diagnostic| diagnostic.location.as_ref().map(|location| location.line);
    diagnostics.iter().map(|d| (d.severity == Severity::Error, line(d), d.message.clone())).collect()
}

#[track_caller]
fn assert_said(desc: &SceneDesc, expected: &[(bool, Option<usize>, &str)]) {
    let said = said(desc);
    let said: Vec<(bool, Option<usize>, &str)> =
        said.iter().map(|(error, line, message)| (*error, *line, message.as_str())).collect();
    assert_eq!(said, expected);
}

fn tetrahedron(at: DVec3, size: f64) -> ShapeDesc {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.1, 1.0, 0.0], [0.1, 0.2, 0.9]];
    let corners = corners.map(|p| (DVec3::from(p) * size + at).to_array());
    mesh(corners.to_vec(), vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
}

#[test]
fn ordinary_and_extreme_but_possible_scenes_are_not_warned_of() {
    assert_said(&seen(vec![ball(DVec3::ZERO, 1.0), tetrahedron(DVec3::X * 2.0, 1.0)]), &[]);
    // A ground ball of radius 1e7 under a mesh and a ball.
    let ground = ball(DVec3::new(0.0, 0.0, -1e7), 1e7);
    assert_said(&seen(vec![ground, ball(DVec3::Z, 1.0), tetrahedron(DVec3::X * 2.0, 1.0)]), &[]);
    assert_said(&seen(vec![square(DVec3::ZERO, 2e6), ball(DVec3::Z, 1.0)]), &[]);
    for size in [1e-9, 1e9] {
        let mut desc = seen(vec![ball(DVec3::ZERO, size), tetrahedron(DVec3::X * (2.0 * size), size)]);
        desc.camera.position *= size;
        assert_said(&desc, &[]);
    }
}

#[test]
fn the_committed_scenes_are_not_warned_of() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files =
        std::fs::read_dir(folder).expect("the folder of scenes").map(|file| file.expect("a file").path());
    for file in files.filter(|path| path.extension().is_some_and(|extension| extension == "yaml")) {
        let scene = scene::load(&file).expect("a scene that can be rendered");
        let world = World::compile(&scene.desc).expect("a scene that can be rendered");
        let warnings = world.guards(&scene.desc, 1920).expect("nothing meaningless in it");
        assert_eq!(warnings, [], "{}", file.display());
    }
}

#[test]
fn a_solid_near_its_position_error_is_warned_of_and_below_it_refused() {
    // The median of three positions is the middle one.
    let far =
        |radius| seen(vec![ball(DVec3::ZERO, 1.0), ball(DVec3::Y * 3.0, 1.0), ball(DVec3::X * 1e12, radius)]);
    assert_said(&far(10.0), &[]);
    let warning = "the object is 1.0e0 in size, but its points are known to within 1.8e-3, since it reaches 1.0e12 \
                   away from the middle of the scene";
    assert_said(&far(1.0), &[(false, Some(3), warning)]);
    let refusal = "the object is 1.0e-3 in size, but its points are known to within 1.8e-3, since it reaches 1.0e12 \
                   away from the middle of the scene";
    let digits = "the object is 1.0e-3 in size, but coordinates of 1.0e12 have steps of 2.2e-4";
    assert_said(&far(1e-3), &[(true, Some(3), refusal), (false, Some(3), digits)]);
}

#[test]
fn a_mesh_that_rounding_distorts_is_warned_of_and_refused_when_nothing_is_left() {
    // Of so many meshes in so many places some must share a space; most are in the middle, which keeps its digits.
    let scattered = |spread: f64| {
        let middle = (0..5).map(|_| tetrahedron(DVec3::ZERO, 1.0));
        let away = (0..10).map(|i| tetrahedron(DVec3::new(1.0, 0.3, 0.7) * spread * f64::from(i - 4), 1.0));
        said(&seen(middle.chain(away).collect()))
    };
    assert_eq!(scattered(10.0), []);
    let is_of_corners = |message: &str| {
        message.starts_with("the object is 1.0e0 in size, but its corners are rounded by up to")
    };
    let far = scattered(7e3);
    assert!(far.iter().any(|(_, _, message)| is_of_corners(message)), "{far:?}");
    assert!(far.iter().all(|(error, _, _)| !error), "{far:?}");
    let lost = scattered(1e10);
    assert!(lost.iter().any(|(error, _, message)| *error && is_of_corners(message)), "{lost:?}");
}

#[test]
fn a_small_part_of_a_large_mesh_is_warned_of() {
    let corners = |tip: f64| {
        let far = [[1e12, 0.0, 1e12], [0.0, 1e12, 1e12], [1e12, 1e12, 1e12]];
        let near = |x: f64| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]];
        let all = [near(0.0), near(0.0), near(tip), far].concat();
        mesh(all, vec![[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11]])
    };
    // Near the middle corners keep their digits.
    assert_said(&seen(vec![corners(0.0)]), &[]);
    for (tip, what) in [(1e8, "are not drawn right"), (4e5, "are bent")] {
        let all = said(&seen(vec![corners(tip)]));
        let expected = format!("1 of the 4 triangles of this mesh {what}");
        assert!(all.iter().any(|(error, _, text)| !error && text.starts_with(&expected)), "{all:?}");
    }
}

#[test]
fn many_warnings_are_summed_up() {
    let ground = ball(DVec3::new(0.0, 0.0, -1e7), 1e7);
    let small = (0..300).map(|i| ball(DVec3::new(f64::from(i), 0.0, 0.0) * 1e-5, 1e-6));
    let all = said(&seen([ground].into_iter().chain(small).collect()));
    assert_eq!(all.len(), 21, "{all:?}");
    assert_eq!(all[20].2, "280 more warnings about objects");
}

#[test]
fn a_fine_mesh_beside_a_huge_one_keeps_its_digits() {
    let at = DVec3::new(0.3, 0.2, 0.1);
    assert_said(
        &seen(vec![tetrahedron(DVec3::Z * -2e6, 1e6), tetrahedron(at, 1.0), tetrahedron(at, 1e-3)]),
        &[],
    );
}

#[test]
fn triangles_that_rounding_leaves_without_area_are_counted() {
    // Most corners are near the middle, which therefore keeps its digits.
    let mut corners = vec![[0.0, 0.0, 0.0], [1000.0, 0.0, 0.0], [0.0, 1000.0, 0.0]];
    corners.extend([[0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.1, 0.1, 0.0], [0.0, 0.0, 0.1], [0.0, 0.1, 0.1]]);
    // A fan of three triangles, far less than 2^-24 of the mesh in size.
    let tip = [900.1, 700.1, 0.1];
    corners.extend([
        tip,
        [tip[0] + 1e-7, tip[1], 0.1],
        [tip[0], tip[1] + 1e-12, 0.1],
        [tip[0], tip[1], 0.1 + 1e-12],
    ]);
    let triangles = vec![[0, 1, 2], [3, 4, 6], [5, 6, 7], [8, 9, 10], [8, 10, 11], [8, 11, 9]];
    let desc = seen(vec![mesh(corners, triangles)]);
    let all = said(&desc);
    let expected = "3 of the 6 triangles of this mesh are not drawn right: little or nothing is left of them when \
                    corners are rounded, by up to";
    assert!(
        all.iter().any(|(error, line, text)| !error && *line == Some(1) && text.starts_with(expected)),
        "{all:?}"
    );
}

#[test]
fn a_small_object_that_touches_a_coarse_one_is_warned_of() {
    let ground = || ball(DVec3::new(0.0, 0.0, -1e7), 1e7);
    let desc = seen(vec![ground(), ball(DVec3::Z * 1e-6, 1e-6), ball(DVec3::Z * 2.0, 1.0)]);
    let message = "the object is 1.0e-6 in size, but points of the object at scene.yaml:1:1, which it may touch, are \
                   known to within 3.6e-8";
    assert_said(&desc, &[(false, Some(2), message)]);
    // Not where it is out of reach.
    assert_said(&seen(vec![ground(), ball(DVec3::Z * 2.0, 1e-6), ball(DVec3::Z * 5.0, 1.0)]), &[]);
}

#[test]
fn a_camera_without_a_direction_is_refused() {
    let mut desc = seen(vec![ball(DVec3::ZERO, 1.0)]);
    desc.camera.position = DVec3::new(1e9, 0.0, 0.0);
    desc.camera.looking_at = desc.camera.position + DVec3::new(2e-7, 0.0, 0.0);
    let message = "the camera's direction is known to within 4.7e-1 radians and a pixel is 5.3e-4: coordinates of \
                   1.0e9 have steps of 2.2e-7, and LookingAt is 2.4e-7 away from Position";
    assert_said(&desc, &[(true, None, message)]);
    desc.camera.looking_at = desc.camera.position + DVec3::new(1e-5, 0.0, 0.0);
    let all = said(&desc);
    assert!(
        matches!(&all[..], [(false, None, text)] if text.starts_with("the camera's direction is known to within 1.1e-2")),
        "{all:?}"
    );
}

#[test]
fn a_view_so_narrow_that_pixels_are_equal_is_refused() {
    let mut desc = seen(vec![ball(DVec3::ZERO, 1.0)]);
    desc.camera.fov = 1e-13;
    let all = said(&desc);
    let message = "the camera sees the same in all pixels: a field of view of 1.0e-13 over 1920 pixels makes 1.6e-16 \
                   radians a pixel, and directions have steps of 1.1e-16";
    assert!(all.contains(&(true, None, message.to_owned())), "{all:?}");
    desc.camera.fov = 1e-9;
    assert_eq!(said(&desc), []);
}

#[test]
fn a_lens_that_reaches_into_things_is_warned_of() {
    let mut desc = seen(vec![ball(DVec3::ZERO, 1.0)]);
    desc.camera.aperture = ApertureDesc::Radius(2.0);
    let message = "the lens has a radius of 2.0e0, more than the distance of 1.0e0 it is focused at";
    assert_said(&desc, &[(false, None, message)]);
    desc.camera.aperture = ApertureDesc::Radius(0.5);
    desc.camera.position = DVec3::X * -1.25;
    let message = "the camera's lens, with a radius of 5.0e-1, reaches through the surface of this object";
    assert_said(&desc, &[(false, Some(1), message)]);
    desc.camera.position = DVec3::X * -1.75;
    assert_said(&desc, &[]);
}

#[test]
fn a_camera_on_or_in_an_opaque_body_is_warned_of() {
    let mut desc = seen(vec![ball(DVec3::ZERO, 1.0)]);
    desc.camera.position = DVec3::NEG_X;
    let message =
        "the camera is on the surface of this object (0.0e0 above it): rounding decides what it sees";
    assert_said(&desc, &[(false, Some(1), message)]);
    desc.camera.position = DVec3::X * -0.5;
    let dark =
        "the camera is inside this object, which is opaque and has no light in it: the picture is black";
    assert_said(&desc, &[(false, Some(1), dark)]);
    // Glass, a shining body, or a light in it.
    let mut other = desc.clone();
    other.objects[0].material.kind = MaterialKind::Refractive { color: grey(1.0), ratio: 1.5 };
    assert_said(&other, &[]);
    other.objects[0].material.kind = glowing(grey(0.5), grey(0.5));
    assert_said(&other, &[]);
    let lamp = seen(vec![ball(DVec3::ZERO, 1.0), ball(DVec3::Y * 0.5, 0.1)]);
    let mut lamp = SceneDesc { camera: desc.camera.clone(), ..lamp };
    lamp.objects[1].material.kind = glowing(grey(0.5), grey(0.5));
    assert_said(&lamp, &[]);
}

#[test]
fn a_camera_on_a_rectangle_or_a_mesh_is_warned_of() {
    let on = "the camera is on the surface of this object (0.0e0 above it): rounding decides what it sees";
    let lens = "the camera's lens, with a radius of 5.0e-1, reaches through the surface of this object";
    // An open mesh, of which the camera is neither inside nor outside.
    let corners = vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    let sheet = mesh(corners, vec![[0, 1, 2]]);
    let twice = [sheet.clone(), placed(sheet.clone(), DVec3::Z * 9.0, 1.0, DVec3::ZERO)];
    let far = ball(DVec3::X * 20.0, 1.0);
    for shapes in [vec![square(DVec3::ZERO, 2.0), far.clone()], vec![sheet, far], twice.to_vec()] {
        let mut desc = seen(shapes);
        desc.camera.position = DVec3::new(0.25, 0.125, 0.0);
        desc.camera.looking_at = DVec3::X * 5.0;
        assert_said(&desc, &[(false, Some(1), on)]);
        // Above it, and in its plane beside it.
        desc.camera.position.z = 0.25;
        assert_said(&desc, &[]);
        desc.camera.aperture = ApertureDesc::Radius(0.5);
        assert_said(&desc, &[(false, Some(1), lens)]);
        desc.camera.position = DVec3::new(0.0, 1.75, 0.0);
        assert_said(&desc, &[]);
    }
}

#[test]
fn surfaces_on_one_another_are_warned_of() {
    let lies = "the object lies on the one at scene.yaml:1:1: where both are, the one that comes first in the file is \
                seen, or, if they are not equal, the one that roundings bring nearer";
    let floor = square(DVec3::ZERO, 4.0);
    let block = cuboid(DVec3::ZERO, DVec3::splat(2.0), DVec3::new(0.0, 0.0, 30.0));
    for (below, above) in [
        (floor.clone(), floor.clone()),
        (floor.clone(), square(DVec3::new(1.5, 1.5, 1e-18), 4.0)),
        (
            floor.clone(),
            ShapeDesc::Rectangle {
                position: DVec3::ZERO,
                width: 1.0,
                height: 2.0,
                rotation: DVec3::new(0.0, -90.0, 20.0),
            },
        ),
        (ball(DVec3::Z, 1.0), ball(DVec3::new(1e-18, 0.0, 1.0), 1.0)),
        (block.clone(), block),
    ] {
        assert_said(&seen(vec![below, above]), &[(false, Some(2), lies)]);
    }
    // Side by side, a little above, across, on another; a box that stands on a floor.
    for other in [
        square(DVec3::X * 4.0, 4.0),
        square(DVec3::Z * 1e-9, 4.0),
        ShapeDesc::Rectangle { position: DVec3::ZERO, width: 4.0, height: 4.0, rotation: DVec3::ZERO },
        ball(DVec3::Z, 1.0),
        cuboid(DVec3::Z, DVec3::splat(2.0), DVec3::ZERO),
    ] {
        assert_said(&seen(vec![floor.clone(), other]), &[]);
    }
}

#[test]
fn a_camera_in_a_closed_opaque_mesh_is_warned_of() {
    let dark =
        "the camera is inside this object, which is opaque and has no light in it: the picture is black";
    let mut desc = seen(vec![tetrahedron(DVec3::ZERO, 1.0)]);
    desc.camera.position = DVec3::splat(0.2);
    desc.camera.looking_at = DVec3::X;
    assert_said(&desc, &[(false, Some(1), dark)]);
    // In its box, but not in it; in glass; in one with a hole.
    let mut other = desc.clone();
    other.camera.position = DVec3::splat(0.8);
    assert_said(&other, &[]);
    let mut other = desc.clone();
    other.objects[0].material.kind = MaterialKind::Refractive { color: grey(1.0), ratio: 1.5 };
    assert_said(&other, &[]);
    let ShapeDesc::TriangleMesh { mesh, .. } = &mut desc.objects[0].shape else { panic!("no mesh") };
    std::sync::Arc::make_mut(mesh).triangles.pop();
    assert_said(&desc, &[]);
}

#[test]
fn sizes_and_places_beyond_the_range_of_numbers_are_refused() {
    for (shape, problem) in [
        (
            ball(DVec3::X * 1e80, 1.0),
            "the object reaches farther than 1e75 units from the middle of the scene",
        ),
        (ball(DVec3::ZERO, 1e-80), "the object is smaller than 1e-75 units"),
        (
            cuboid(DVec3::ZERO, DVec3::new(1.0, 1e-80, 1.0), DVec3::ZERO),
            "the object is smaller than 1e-75 units",
        ),
    ] {
        let desc = seen(vec![ball(DVec3::ZERO, 1.0), ball(DVec3::ZERO, 1.0), shape]);
        let Err(Error::Scene(diagnostics)) = World::compile(&desc) else { panic!("{problem}") };
        assert_eq!(diagnostics.len(), 1);
        assert_eq!(diagnostics[0].message, problem);
        assert_eq!(diagnostics[0].location.as_ref().map(|location| location.line), Some(3));
    }
}
