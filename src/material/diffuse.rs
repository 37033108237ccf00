//! The Lambertian material.

use super::{Pdf, Scatter, lift};
use crate::math::{DVec3, Frame, Rgb};
use crate::sampling::warp;

/// Reflects equally into all directions on the side of the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diffuse {
    /// Reflectance, in 0..1.
    pub color: Rgb,
}

impl Diffuse {
    #[inline]
    pub(super) fn sample(&self, n: DVec3, u: [f64; 2]) -> Scatter {
        let direction = lift(Frame::around(n).to_world(warp::square_to_cosine_hemisphere(u)), n);
        Scatter { direction, weight: self.color, pdf: Pdf::solid_angle(pdf(n, direction)) }
    }

    #[inline]
    pub(super) fn eval(&self, n: DVec3, wi: DVec3) -> (Rgb, f64) {
        let pdf = pdf(n, wi);
        (self.color * pdf, pdf)
    }
}

/// The density of cosine-distributed directions.
#[inline]
pub(super) fn pdf(n: DVec3, wi: DVec3) -> f64 {
    warp::cosine_hemisphere_pdf(n.dot(wi))
}
