//! Materials: what they sample is what they say, and no energy appears or is lost.

mod agreement;
mod chi_square;
mod extremes;
mod fresnel;
mod lobe_grid;
mod refractive;

use crate::support::random::Sample4;
use pathtracer::material::{ClearCoat, Diffuse, Material, Reflective, Refractive};
use pathtracer::math::{DVec3, Frame, Rgb};
use pathtracer::sampling::{Independent, Sampler};

const COLOR: Rgb = Rgb::new(0.8, 0.35, 0.1);
const COAT_COLOR: Rgb = Rgb::new(0.9, 0.7, 0.95);

/// Specularities on both sides of every place where the lobe changes its form.
const SPECULARITIES: [f64; 11] = [0.0, 0.1, 0.25, 0.3, 0.49, 0.5, 0.51, 0.6, 0.75, 0.9, 0.99];

/// Angles of incidence in degrees; the last is 0.01 degrees above the surface.
const ANGLES: [f64; 4] = [0.0, 45.0, 80.0, 89.99];

fn diffuse() -> Material {
    Material::Diffuse(Diffuse { color: COLOR })
}

fn reflective(specularity: f64) -> Material {
    Material::Reflective(Reflective { color: COLOR, specularity })
}

fn clear_coat(probability: f64, specularity: f64) -> Material {
    let coat = Reflective { color: COAT_COLOR, specularity };
    Material::ClearCoat(ClearCoat { base: Diffuse { color: COLOR }, coat, probability })
}

fn refractive(ratio: f64) -> Material {
    Material::Refractive(Refractive { color: COLOR, ratio })
}

/// A normal along no axis.
fn normal() -> DVec3 {
    DVec3::new(0.3, -0.5, 0.8).normalize()
}

/// A direction above `n` at an angle in degrees from it.
fn direction_at(n: DVec3, degrees: f64) -> DVec3 {
    let angle = degrees.to_radians();
    Frame::around(n).to_world(DVec3::new(libm::sin(angle) * 0.6, libm::sin(angle) * -0.8, libm::cos(angle)))
}

/// Independent points of the unit cube.
fn cube(seed: u64, count: u64) -> impl Iterator<Item = [f64; 3]> {
    let sampler = Independent::new(seed);
    let pixel = sampler.pixel(0, 0);
    (0..count).map(move |i| {
        let [a, b, c, _] = sampler.sample4(pixel, i, 0);
        [a, b, c]
    })
}
