//! How a surface scatters light. Each material samples directions and evaluates the density of what it sampled;
//! colours come resolved, emission is not its business.
//!
//! Conventions: `wo` points from the surface to where the path came from, `wi` to where it goes on, `n` is the
//! shading normal on the side of `wo`; all are unit vectors. Densities are per solid angle.

mod clear_coat;
mod diffuse;
mod fresnel;
mod reflective;
mod refractive;

pub use clear_coat::ClearCoat;
pub use diffuse::Diffuse;
pub use fresnel::{Fresnel, Interface};
pub use reflective::Reflective;
pub use refractive::Refractive;

use crate::math::{DVec3, Rgb};

/// The materials of the scene format, with their colours at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Material {
    /// Lambertian.
    Diffuse(Diffuse),
    /// The lerp lobe between Lambertian and mirror.
    Reflective(Reflective),
    /// A reflective coat over a Lambertian base.
    ClearCoat(ClearCoat),
    /// A smooth dielectric.
    Refractive(Refractive),
}

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatter {
    /// Where the path goes on, unit. On the side of `wo` (direction . n > 0) unless it was refracted.
    pub direction: DVec3,
    /// What the path's throughput is multiplied by: f cos / pdf.
    pub weight: Rgb,
    /// How probable the direction was.
    pub pdf: Pdf,
}

/// The density of a sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pdf {
    /// Per solid angle, positive and finite; the density of [`Material::eval`] at this direction.
    SolidAngle(f64),
    /// From a part that no light sample can meet, or that is too narrow for it to pay: its MIS weight is 1.
    Delta,
}

impl Pdf {
    /// A density that came out as 0, by rounding at the border of its support, becomes the smallest one, so that
    /// a MIS weight 1 / (1 + other / this) is a number.
    fn solid_angle(pdf: f64) -> Pdf {
        Pdf::SolidAngle(pdf.max(f64::MIN_POSITIVE))
    }
}

impl Material {
    /// Samples the direction in which a path goes on, from three numbers in [0, 1): the first selects a part of
    /// the material, the others the direction. `entering` says whether `wo` is on the outer side of the geometry.
    /// None only if `wo` is not above the shading surface (`wo . n <= 0`).
    #[inline]
    pub fn sample(&self, wo: DVec3, n: DVec3, entering: bool, u: [f64; 3]) -> Option<Scatter> {
        if wo.dot(n) <= 0.0 {
            return None;
        }
        let square = [u[1], u[2]];
        Some(match self {
            Material::Diffuse(diffuse) => diffuse.sample(n, square),
            Material::Reflective(reflective) => reflective.sample(wo, n, square),
            Material::ClearCoat(coat) => coat.sample(wo, n, u),
            Material::Refractive(refractive) => refractive.sample(wo, n, entering, u[0]),
        })
    }

    /// Whether the first number of [`Material::sample`] matters.
    #[inline]
    pub fn has_choice(&self) -> bool {
        matches!(self, Material::ClearCoat(_) | Material::Refractive(_))
    }

    /// Whether the other two numbers of [`Material::sample`] matter.
    #[inline]
    pub fn is_spread(&self) -> bool {
        match self {
            Material::Diffuse(_) | Material::ClearCoat(_) => true,
            Material::Reflective(reflective) => reflective.specularity < 1.0,
            Material::Refractive(_) => false,
        }
    }

    /// (f cos, density) for light from `wi`, of the parts that are no delta. Both are zero for directions that
    /// these parts can't produce.
    #[inline]
    pub fn eval(&self, wo: DVec3, n: DVec3, wi: DVec3) -> (Rgb, f64) {
        if wo.dot(n) <= 0.0 || wi.dot(n) <= 0.0 {
            return (Rgb::ZERO, 0.0);
        }
        match self {
            Material::Diffuse(diffuse) => diffuse.eval(n, wi),
            Material::Reflective(reflective) => reflective.eval(wo, n, wi),
            Material::ClearCoat(coat) => coat.eval(wo, n, wi),
            Material::Refractive(_) => (Rgb::ZERO, 0.0),
        }
    }

    /// Whether all of it is delta, so that no light sample can contribute.
    #[inline]
    pub fn is_delta(&self) -> bool {
        match self {
            Material::Diffuse(_) => false,
            Material::Reflective(reflective) => reflective.is_delta(),
            Material::ClearCoat(coat) => coat.is_delta(),
            Material::Refractive(_) => true,
        }
    }
}

/// The mirror image of `wo` about `n`.
#[inline]
fn mirror(wo: DVec3, n: DVec3) -> DVec3 {
    lift(2.0 * wo.dot(n) * n - wo, n)
}

/// Brings a unit vector that rounding took to the wrong side of the plane of `n` back above it. The step is larger
/// than the error of a dot product of unit vectors, 3 (1 + 2^-52) 2^-53 < 2^-51, and no larger than such an error
/// of the direction itself would be after a few bounces.
#[inline]
fn lift(w: DVec3, n: DVec3) -> DVec3 {
    const STEP: f64 = 4.0 * f64::EPSILON;
    let height = w.dot(n);
    if height > 0.0 { w } else { w + (STEP - height) * n }
}
