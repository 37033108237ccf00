//! A smooth dielectric: reflects or refracts by the exact Fresnel equations.

use super::{Interface, Pdf, Scatter, lift, mirror};
use crate::math::{DVec3, Rgb};

/// A dielectric against vacuum. Paths carry radiance over n squared, so refraction does not scale them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refractive {
    /// Factor at every interface, reflected or refracted, in 0..1.
    pub color: Rgb,
    /// n outside / n inside, > 0.
    pub ratio: f64,
}

impl Refractive {
    #[inline]
    pub(super) fn sample(&self, wo: DVec3, n: DVec3, entering: bool, u: f64) -> Scatter {
        let interface = Interface::new(self.ratio, entering);
        let cos = wo.dot(n).min(1.0);
        let fresnel = interface.at(cos);
        let direction = match fresnel.cos_transmitted {
            Some(cos_t) if u >= fresnel.reflectance => refract(&interface, wo, n, cos, cos_t),
            _ => mirror(wo, n),
        };
        Scatter { direction, weight: self.color, pdf: Pdf::Delta }
    }
}

/// The refracted direction, below the plane of `n`. Snell's law gives -m wo + (m cos - cos_t) n with m = n_i / n_t;
/// the difference is taken as -(1 - m^2) / (m cos + cos_t), which does not cancel.
#[inline]
fn refract(interface: &Interface, wo: DVec3, n: DVec3, cos: f64, cos_t: f64) -> DVec3 {
    if interface.contrast() == 0.0 {
        return -wo;
    }
    let m = interface.ratio();
    let w = -(m * wo + interface.contrast() / (m * cos + cos_t) * n);
    lift(w.normalize(), -n)
}
