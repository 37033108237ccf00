//! The camera's geometry against the scene format's definition.

use crate::support::build::*;
use pathtracer::math::DVec3;
use pathtracer::scene::desc::{ApertureDesc, SceneDesc};
use pathtracer::world::{Camera, World};

fn camera_of(edit: impl FnOnce(&mut SceneDesc), width: u32, height: u32) -> Camera {
    let mut desc = scene(DVec3::ZERO, DVec3::X, vec![(ball(DVec3::ZERO, 1.0), diffuse(grey(0.5)))]);
    desc.camera.fov = 0.5;
    edit(&mut desc);
    World::compile(&desc).expect("a valid scene").camera(&desc.camera, width, height)
}

fn assert_near(a: DVec3, b: DVec3) {
    // A handful of roundings of numbers up to 1.
    assert!((a - b).abs().max_element() < 1e-15, "{a} is not {b}");
}

#[test]
fn the_field_of_view_is_horizontal_between_outer_edges() {
    let camera = camera_of(|_| (), 200, 100);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    assert_near(camera.ray(0.0, 50.0, || [0.5; 2]).direction, DVec3::new(half, half, 0.0));
    assert_near(camera.ray(200.0, 50.0, || [0.5; 2]).direction, DVec3::new(half, -half, 0.0));
    assert_near(camera.ray(100.0, 0.0, || [0.5; 2]).direction, DVec3::new(1.0, 0.0, 0.5).normalize());
}

#[test]
fn a_vertical_view_is_the_limit_of_tilting_from_y() {
    let down = camera_of(|desc| desc.camera.looking_at = -DVec3::Z, 1, 1);
    assert_near(down.right, DVec3::X);
    assert_near(down.up, DVec3::Y);
    let up = camera_of(|desc| desc.camera.looking_at = DVec3::Z, 1, 1);
    assert_near(up.right, DVec3::X);
    assert_near(up.up, -DVec3::Y);
}

#[test]
fn the_roll_turns_about_the_viewing_direction() {
    let camera = camera_of(|desc| desc.camera.angle = 90.0, 1, 1);
    // Right-handed about +x: left (+y) goes to +z, so right points down.
    assert_near(camera.right, -DVec3::Z);
    assert_near(camera.up, -DVec3::Y);
}

#[test]
fn rays_through_all_points_of_the_lens_meet_in_the_sharp_plane() {
    let edit = |desc: &mut SceneDesc| {
        desc.camera.focus_distance = 3.0;
        desc.camera.aperture = ApertureDesc::Radius(0.2);
    };
    let camera = camera_of(edit, 200, 100);
    let meet = |lens: [f64; 2]| {
        let ray = camera.ray(37.5, 12.25, || lens);
        ray.at(3.0 / ray.direction.x * (1.0 - ray.origin.x / 3.0))
    };
    let first = meet([0.5, 0.5]);
    for lens in [[0.1, 0.2], [0.9, 0.3], [0.0, 0.99]] {
        // Numbers up to 5, a dozen roundings.
        assert!((meet(lens) - first).length() < 1e-14);
        assert!((camera.ray(37.5, 12.25, || lens).origin - camera.position).length() <= 0.2 * (1.0 + 1e-15));
    }
}

#[test]
fn depth_of_field_is_a_share_of_the_view_at_the_focus() {
    let edit = |desc: &mut SceneDesc| {
        desc.camera.focus_distance = 3.0;
        desc.camera.aperture = ApertureDesc::DepthOfField(30.0);
    };
    // Field of view 90 degrees: the view is 6 wide at distance 3.
    let radius = camera_of(edit, 640, 480).lens_radius;
    assert!((radius - 30.0 * 6.0 / 1920.0).abs() < 1e-15);
}
