//! What is seen, beside its light: the colours and shapes that denoisers and compositors want.

use super::numbers::Numbers;
use crate::accel::Accelerator;
use crate::material::Material;
use crate::math::{DVec3, Rgb};
use crate::sampling::Sampler;
use crate::world::{Camera, World};
use std::ops::AddAssign;

/// Features of one or more samples of a pixel, summed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Features {
    /// Samples.
    pub samples: u64,
    /// Samples that met a surface.
    pub hits: u64,
    /// Reflectance of the first surface that is no mirror and no glass, times the colours of those before it; of the sky and
    /// of lights their light, at most 1.
    pub albedo: Rgb,
    /// Normal of that surface, on the viewer's side; zero for the sky.
    pub normal: DVec3,
    /// Distance of the first surface along the viewing direction.
    pub depth: f64,
    /// The first surface's point, in the scene.
    pub position: DVec3,
    /// Index of the first surface's object plus one, of the first sample that met one.
    pub object: u32,
}

/// The most mirrors and glasses that are looked through.
const MOST_SPECULAR: u32 = 16;

impl AddAssign for Features {
    fn add_assign(&mut self, other: Features) {
        self.samples += other.samples;
        self.hits += other.hits;
        self.albedo += other.albedo;
        self.normal += other.normal;
        self.depth += other.depth;
        self.position += other.position;
        if self.object == 0 {
            self.object = other.object;
        }
    }
}

/// Finds what is seen.
pub struct FeatureTracer<'a, A> {
    /// The scene.
    pub world: &'a World,
    /// Its camera.
    pub camera: &'a Camera,
    /// What finds hits.
    pub accelerator: &'a A,
}

impl<A: Accelerator> FeatureTracer<'_, A> {
    /// The features of sample `index` of the pixel (x, y), seen by the same ray as the light of that sample.
    pub fn sample<S: Sampler>(&self, sampler: &S, x: u32, y: u32, index: u64) -> Features {
        let numbers = Numbers::new(sampler, x, y, index);
        let [dx, dy] = numbers.pixel();
        let mut ray = self.camera.ray(f64::from(x) + dx, f64::from(y) + dy, || numbers.lens());
        let mut features = Features { samples: 1, ..Features::default() };
        let mut cone = self.camera.cone(ray.direction);
        let mut throughput = Rgb::ONE;
        for segment in 1..=MOST_SPECULAR {
            let Some(hit) = self.accelerator.intersect(&ray) else {
                features.albedo = throughput * self.world.sky.radiance(ray.direction).min(Rgb::ONE);
                return features;
            };
            let at = self.world.interaction(&ray, &hit);
            if segment == 1 {
                let position = at.receiver.point.position;
                features.hits = 1;
                features.depth = (position - self.camera.position).dot(self.camera.forward);
                features.position = position + self.world.origin;
                features.object = hit.object + 1;
            }
            cone = cone.at(hit.t);
            let varied = self.world.varied_material(&hit, &at, cone.width);
            let material = varied.as_ref().unwrap_or_else(|| self.world.material(hit.object));
            features.normal = at.normal;
            features.albedo = throughput * albedo(material, self.world.emission(hit.object));
            if !material.is_delta() {
                return features;
            }
            let numbers = numbers.segment(segment);
            let lobe = if material.has_choice() { numbers.lobe() } else { 0.0 };
            let Some(scatter) = material.sample(-ray.direction, at.normal, at.entering, [lobe, 0.5, 0.5])
            else {
                return features;
            };
            throughput *= scatter.weight;
            cone = self.world.cone_beyond(cone, ray.direction, &at, material, &scatter);
            ray = at.receiver.point.leave(scatter.direction);
        }
        features
    }
}

/// The share of light that a material gives back, and what it emits, at most 1.
fn albedo(material: &Material, emission: Rgb) -> Rgb {
    let reflected = match material {
        Material::Diffuse(diffuse) => diffuse.color,
        Material::Reflective(reflective) => reflective.color,
        Material::Refractive(refractive) => refractive.color,
        Material::ClearCoat(coated) => coated.base.color.lerp(coated.coat.color, coated.probability),
    };
    (reflected + emission).min(Rgb::ONE)
}
