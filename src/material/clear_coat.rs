//! A reflective coat over a Lambertian base.

use super::{Pdf, Reflective, Scatter, diffuse, mirror};
use crate::material::Diffuse;
use crate::math::{DVec3, Rgb};

/// With a fixed probability the reflection of the coat, else that of the base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClearCoat {
    /// What lies under the coat.
    pub base: Diffuse,
    /// The coat's reflection.
    pub coat: Reflective,
    /// Probability of the coat, in 0..1. At 0 the material equals its base bit by bit.
    pub probability: f64,
}

impl ClearCoat {
    #[inline]
    pub(super) fn is_delta(&self) -> bool {
        self.coat.is_delta() && self.probability >= 1.0
    }

    #[inline]
    pub(super) fn sample(&self, wo: DVec3, n: DVec3, u: [f64; 3]) -> Scatter {
        let in_coat = u[0] < self.probability;
        let square = [u[1], u[2]];
        if self.coat.is_delta() {
            return match in_coat {
                true => self.coat.sample(wo, n, square),
                false => self.sample_base_beside_delta(n, square),
            };
        }
        let r = mirror(wo, n);
        let direction = match in_coat {
            true => self.coat.sample_direction(r, n, square),
            false => self.base.sample(n, square).direction,
        };
        let (share, pdf) = self.mixture(r, n, direction);
        // Written so that a share of 0 or 1 gives exactly one of the colours, and two white ones exactly white.
        let weight = self.coat.color * share + self.base.color * (1.0 - share);
        Scatter { direction, weight, pdf: Pdf::solid_angle(pdf) }
    }

    #[inline]
    pub(super) fn eval(&self, wo: DVec3, n: DVec3, wi: DVec3) -> (Rgb, f64) {
        if self.coat.is_delta() {
            let pdf = (1.0 - self.probability) * diffuse::pdf(n, wi);
            return (self.base.color * pdf, pdf);
        }
        let (share, pdf) = self.mixture(mirror(wo, n), n, wi);
        ((self.coat.color * share + self.base.color * (1.0 - share)) * pdf, pdf)
    }

    /// The base's part of a material whose coat is delta: f cos / pdf = base colour, the coat does not compete.
    fn sample_base_beside_delta(&self, n: DVec3, u: [f64; 2]) -> Scatter {
        let sample = self.base.sample(n, u);
        let pdf = (1.0 - self.probability) * diffuse::pdf(n, sample.direction);
        Scatter { pdf: Pdf::solid_angle(pdf), ..sample }
    }

    /// The share of the coat in the density at `w`, in 0..1, and the density, for a coat that is no delta.
    fn mixture(&self, r: DVec3, n: DVec3, w: DVec3) -> (f64, f64) {
        let coat = self.probability * self.coat.pdf(r, n, w);
        let base = (1.0 - self.probability) * diffuse::pdf(n, w);
        let pdf = coat + base;
        (coat / pdf.max(f64::MIN_POSITIVE), pdf)
    }
}
