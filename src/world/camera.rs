//! The camera: a thin lens in front of a plane of square pixels.

use super::cone::Cone;
use crate::geometry::Ray;
use crate::math::{DVec3, sin_cos_degrees};
use crate::sampling::warp::square_to_disk;
use crate::scene::desc::{ApertureDesc, CameraDesc};

/// A camera for a picture of a certain size.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Centre of the lens, in world space.
    pub position: DVec3,
    /// Unit viewing direction.
    pub forward: DVec3,
    /// Unit vector to the right in the picture.
    pub right: DVec3,
    /// Unit vector upwards in the picture.
    pub up: DVec3,
    /// Radius of the lens; 0 is a pinhole.
    pub lens_radius: f64,
    focus_distance: f64,
    /// Half of the picture's width and height at distance 1.
    half_view: [f64; 2],
    /// Width and height of a pixel at distance 1.
    pixel: [f64; 2],
}

impl Camera {
    /// The camera of a scene whose world space has its origin at `origin`.
    pub(super) fn new(desc: &CameraDesc, origin: DVec3, width: u32, height: u32) -> Camera {
        let forward = unit(desc.looking_at - desc.position);
        // Where the view is vertical, left is the limit of tilting down from +y.
        let flat = DVec3::new(-forward.y, forward.x, 0.0);
        let level = if flat == DVec3::ZERO { DVec3::NEG_X } else { unit(flat) };
        let (sin, cos) = sin_cos_degrees(desc.angle);
        let left = level * cos + forward.cross(level) * sin;
        let half_width = libm::tan(desc.fov * std::f64::consts::FRAC_PI_2);
        let lens_radius = match desc.aperture {
            ApertureDesc::Radius(radius) => radius,
            ApertureDesc::DepthOfField(strength) => {
                strength * (2.0 * desc.focus_distance * half_width) / 1920.0
            }
        };
        let half_height = half_width * (f64::from(height) / f64::from(width));
        Camera {
            position: desc.position - origin,
            forward,
            right: -left,
            up: forward.cross(left),
            lens_radius,
            focus_distance: desc.focus_distance,
            half_view: [half_width, half_height],
            pixel: [2.0 * half_width / f64::from(width), 2.0 * half_height / f64::from(height)],
        }
    }

    /// The ray through the picture's point (x, y), in pixels from the top left corner, and the lens' point that `lens`
    /// selects, two numbers in [0, 1); not asked by a pinhole.
    #[inline]
    pub fn ray(&self, x: f64, y: f64, lens: impl FnOnce() -> [f64; 2]) -> Ray {
        let across = x * self.pixel[0] - self.half_view[0];
        let upwards = self.half_view[1] - y * self.pixel[1];
        let toward = self.forward + self.right * across + self.up * upwards;
        if self.lens_radius == 0.0 {
            return Ray::new(self.position, toward.normalize());
        }
        let [a, b] = square_to_disk(lens());
        let offset = (self.right * a + self.up * b) * self.lens_radius;
        Ray::new(self.position + offset, (toward * self.focus_distance - offset).normalize())
    }

    /// The cone of a ray in this direction. Towards the edges of the picture a pixel is seen under a smaller angle.
    #[inline]
    pub fn cone(&self, direction: DVec3) -> Cone {
        let cosine = direction.dot(self.forward);
        Cone { width: 0.0, spread: Cone::CAMERA_PIXELS * self.pixel[0] * cosine * cosine }
    }
}

/// The unit vector along `v`, also where the squares of its components would leave the range of numbers.
fn unit(v: DVec3) -> DVec3 {
    (v / v.abs().max_element()).normalize()
}
