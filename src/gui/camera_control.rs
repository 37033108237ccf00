//! The camera by mouse: movements of a [`CameraDesc`], in shares of the picture's width and height.

use crate::math::DVec3;
use crate::scene::desc::CameraDesc;
use std::f64::consts::{FRAC_PI_2, PI};

/// The closest to the vertical that orbiting comes, in radians.
const POLE: f64 = 0.01;
/// The closest that a dolly comes, as a share of the distance before.
const CLOSEST: f64 = 0.02;

/// Right, up and forward of a camera, unit vectors.
pub fn axes(camera: &CameraDesc) -> [DVec3; 3] {
    let forward = (camera.looking_at - camera.position).normalize_or(DVec3::X);
    let flat = DVec3::new(-forward.y, forward.x, 0.0);
    let level = flat.normalize_or(DVec3::NEG_X);
    let (sin, cos) = (libm::sin(camera.angle.to_radians()), libm::cos(camera.angle.to_radians()));
    let left = level * cos + forward.cross(level) * sin;
    [-left, forward.cross(left), forward]
}

/// Turns the camera about the point that it looks at: half a turn for the width of the picture.
pub fn orbit(camera: &mut CameraDesc, [dx, dy]: [f64; 2]) {
    let arm = camera.position - camera.looking_at;
    let distance = arm.length();
    if distance == 0.0 {
        return;
    }
    let azimuth = libm::atan2(arm.y, arm.x) - dx * PI;
    let height = libm::asin((arm.z / distance).clamp(-1.0, 1.0)) + dy * PI;
    let limit = FRAC_PI_2 - POLE;
    let height = height.clamp(-limit, limit);
    let flat = libm::cos(height);
    let arm = DVec3::new(flat * libm::cos(azimuth), flat * libm::sin(azimuth), libm::sin(height)) * distance;
    camera.position = camera.looking_at + arm;
}

/// Moves the camera sideways, so that the point that it looks at follows the mouse. `aspect` is height / width.
pub fn pan(camera: &mut CameraDesc, [dx, dy]: [f64; 2], aspect: f64) {
    let [right, up, _] = axes(camera);
    let distance = (camera.looking_at - camera.position).length();
    let width = 2.0 * distance * libm::tan(camera.fov * FRAC_PI_2);
    let by = up * (dy * width * aspect) - right * (dx * width);
    camera.position += by;
    camera.looking_at += by;
}

/// Moves the camera towards the point that it looks at, or away from it: by `factor` of the distance.
pub fn dolly(camera: &mut CameraDesc, factor: f64) {
    let arm = camera.position - camera.looking_at;
    let position = camera.looking_at + arm * factor.max(CLOSEST);
    if position.is_finite() && position != camera.looking_at {
        camera.position = position;
    }
}

/// Rolls the camera about its viewing direction, in degrees; the picture turns the other way.
pub fn roll(camera: &mut CameraDesc, degrees: f64) {
    let angle = camera.angle + degrees;
    camera.angle = angle - 360.0 * (angle / 360.0).round();
}

/// Makes a point sharp, if it is in front of the camera.
pub fn focus(camera: &mut CameraDesc, point: DVec3) {
    let [_, _, forward] = axes(camera);
    let distance = (point - camera.position).dot(forward);
    if distance > 0.0 && distance.is_finite() {
        camera.focus_distance = distance;
    }
}

/// Looks at a point.
pub fn look_at(camera: &mut CameraDesc, point: DVec3) {
    if point != camera.position && point.is_finite() {
        camera.looking_at = point;
    }
}
