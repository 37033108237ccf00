//! The lerp lobe: directions between the mirror's and a Lambertian one.
//!
//! With r the mirror direction, d cosine-distributed about n and s the specularity, the new direction is
//! v = (1 - s) d + s r, normalised. The material is defined by this rule: f cos is colour times the density of the
//! rule, so that every sampled path is multiplied by exactly the colour. It is not reciprocal.

use super::{Pdf, Scatter, lift, mirror};
use crate::math::{DVec3, EPSILON, Frame, INV_PI, Rgb};
use crate::sampling::warp;

/// Above this specularity the lobe is narrower than 0.6 degrees and counts as delta: light samples would almost
/// never fall into it. Estimates stay unbiased, because the sampled directions then have MIS weight 1.
const DELTA_SPECULARITY: f64 = 0.99;

/// Reflects into a lobe about the mirror direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflective {
    /// Reflectance, in 0..1.
    pub color: Rgb,
    /// From 0, Lambertian, to 1, a perfect mirror.
    pub specularity: f64,
}

impl Reflective {
    #[inline]
    pub(super) fn is_delta(&self) -> bool {
        self.specularity > DELTA_SPECULARITY
    }

    #[inline]
    pub(super) fn sample(&self, wo: DVec3, n: DVec3, u: [f64; 2]) -> Scatter {
        let r = mirror(wo, n);
        let direction = self.sample_direction(r, n, u);
        let pdf = match self.is_delta() {
            true => Pdf::Delta,
            false => Pdf::solid_angle(self.pdf(r, n, direction)),
        };
        Scatter { direction, weight: self.color, pdf }
    }

    #[inline]
    pub(super) fn eval(&self, wo: DVec3, n: DVec3, wi: DVec3) -> (Rgb, f64) {
        if self.is_delta() {
            return (Rgb::ZERO, 0.0);
        }
        let pdf = self.pdf(mirror(wo, n), n, wi);
        (self.color * pdf, pdf)
    }

    /// A direction of the lobe about the mirror direction `r`, above the plane of `n`.
    #[inline]
    pub(super) fn sample_direction(&self, r: DVec3, n: DVec3, u: [f64; 2]) -> DVec3 {
        let s = self.specularity;
        if s == 1.0 {
            return r;
        }
        let d = Frame::around(n).to_world(warp::square_to_cosine_hemisphere(u));
        // Only zero if d = -r, both along the surface, and s = 1/2: then every direction of the limit is as good.
        let v = (1.0 - s) * d + s * r;
        lift(v.try_normalize().unwrap_or(r), n)
    }

    /// The density of [`Self::sample_direction`] at `w`, for specularities below 1.
    ///
    /// v lies on the sphere of radius a = 1 - s about s r, whose points d are cosine-distributed. The ray along w
    /// meets it at the distances rho, the roots of rho^2 - 2 s c rho + (s^2 - a^2) with c = w . r; each
    /// contributes the density (n . d) / pi times d(omega_d) / d(omega_w) = rho^2 / (a q), where q is the root of
    /// the discriminant and a d = rho w - s r.
    #[inline]
    pub(super) fn pdf(&self, r: DVec3, n: DVec3, w: DVec3) -> f64 {
        let (a, s) = (1.0 - self.specularity, self.specularity);
        // The squared sine from the cross product: 1 - c^2 would lose all digits in a narrow lobe.
        let (sin2, c) = (w.cross(r).length_squared(), w.dot(r));
        let discriminant = a * a - s * s * sin2;
        // At the rim of the lobe the discriminant is zero and the density has an integrable pole. There s sin = a,
        // unit vectors and their cross product are good to 4 EPSILON each, and so this much may be missing; as a
        // floor it keeps every sampled direction inside.
        let error = 16.0 * EPSILON * a * s;
        if discriminant < -error {
            return 0.0;
        }
        let q = discriminant.max(error).sqrt();
        // The larger root is free of cancellation, the other follows from their product.
        let product = (s - a) * (s + a);
        let larger = s * c + q.copysign(c);
        let (n_w, n_r) = (n.dot(w), n.dot(r));
        let term = |rho: f64| if rho > 0.0 { rho * rho * (rho * n_w - s * n_r).max(0.0) } else { 0.0 };
        INV_PI * (term(larger) + term(product / larger)) / (a * a * q)
    }
}
