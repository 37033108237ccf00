//! All that shines: choosing a light, a point of it, and the density of both together.

mod alias;
mod area;
mod spherical_rectangle;
mod tree;

pub use area::Receiver;
pub use tree::{LightTree, TreeItem};

use super::coincident::Coincidences;
use super::sky::Sky;
use crate::geometry::{Geometry, Hit, PrimitiveId, SurfacePoint};
use crate::math::{DVec3, Rgb};
use area::AreaLight;

/// A choice made towards the lights.
#[derive(Clone, Copy, Debug)]
pub struct LightSample {
    /// The chosen point, or the direction of the sky.
    pub target: LightTarget,
    /// Radiance that would arrive if nothing were in the way.
    pub radiance: Rgb,
    /// Density per solid angle at the receiver, of choosing the light and the point; > 0 and finite.
    pub pdf: f64,
}

/// Where a [`LightSample`] lies.
#[derive(Clone, Copy, Debug)]
pub enum LightTarget {
    /// A point of a surface that emits.
    Surface(SurfacePoint),
    /// A unit direction of the sky.
    Sky(DVec3),
}

/// The emitting objects and the sky, as they are sampled.
#[derive(Clone, Debug)]
pub struct Lights {
    lights: Vec<AreaLight>,
    /// Index of the light of an object, or `u32::MAX`.
    of_object: Vec<u32>,
    /// Share of the samples that go to the sky: 0 unless it is sampled, 1 if nothing else shines.
    sky_share: f64,
    /// Chooses when there are too many lights to weigh each one at every point.
    tree: LightTree,
    coincidences: Coincidences,
}

/// Up to this many lights, or triangles of a light, are weighed one by one; beyond, a tree does.
const WEIGHED: usize = 16;

impl Lights {
    /// The lights among the objects; `emission` holds the radiance that each object emits. A constant sky is left to
    /// the sampling of materials, and so is what another surface hides that is equal and comes first.
    pub(super) fn new(geometry: &Geometry, emission: &[Rgb], sky: &Sky) -> Lights {
        let coincidences = Coincidences::of(geometry, |object| emission[object as usize] != Rgb::ZERO);
        let mut lights = Vec::new();
        let mut of_object = vec![u32::MAX; emission.len()];
        let mut add = |object: u32, light: AreaLight| {
            of_object[object as usize] = lights.len() as u32;
            lights.push(light);
        };
        for (index, solid) in geometry.solids.iter().enumerate() {
            let radiance = emission[solid.object as usize];
            if radiance != Rgb::ZERO
                && !coincidences.hides(PrimitiveId::solid(index as u32))
                && let Some(light) = AreaLight::of_solid(geometry, index as u32, radiance)
            {
                add(solid.object, light);
            }
        }
        for (space, mesh) in geometry.world_spaces() {
            for (entry, triangles) in mesh.mesh_ranges() {
                let radiance = emission[entry.object as usize];
                let hidden = |index| coincidences.hides(PrimitiveId::triangle(space, index));
                if radiance != Rgb::ZERO
                    && let Some(light) = AreaLight::of_mesh(mesh, space, triangles, radiance, hidden)
                {
                    add(entry.object, light);
                }
            }
        }
        let items: Vec<TreeItem> = match lights.len() {
            0..=WEIGHED => Vec::new(),
            _ => lights.iter().map(AreaLight::item).collect(),
        };
        let sky_share = match (sky.kind().is_sampled(), lights.is_empty()) {
            (true, true) => 1.0,
            (true, false) => SKY_SHARE,
            (false, _) => 0.0,
        };
        Lights { lights, of_object, sky_share, tree: LightTree::new(&items), coincidences }
    }

    /// Number of objects that emit and can be met.
    pub fn count(&self) -> usize {
        self.lights.len()
    }

    /// Whether sampling lights can find anything.
    pub fn can_sample(&self) -> bool {
        !self.lights.is_empty() || self.sky_share > 0.0
    }

    /// Whether there is more than one light to choose from, so that the first number of [`Lights::sample`] matters.
    pub fn has_choice(&self) -> bool {
        self.lights.len() + usize::from(self.sky_share > 0.0) > 1
    }

    /// Chooses a light and a point of it, from `u` in [0, 1)^3: the first chooses the light.
    #[inline]
    pub fn sample(&self, geometry: &Geometry, sky: &Sky, at: &Receiver, u: [f64; 3]) -> Option<LightSample> {
        let (square, select) = ([u[1], u[2]], u[0]);
        let sample = if select < self.sky_share {
            let (direction, pdf) = sky.sample(square);
            LightSample {
                target: LightTarget::Sky(direction),
                radiance: sky.radiance(direction),
                pdf: pdf * self.sky_share,
            }
        } else {
            let select = (select - self.sky_share) / (1.0 - self.sky_share);
            let (point, radiance, pdf) = self.sample_area(geometry, at, [select, u[1], u[2]])?;
            LightSample { target: LightTarget::Surface(point), radiance, pdf: pdf * (1.0 - self.sky_share) }
        };
        (sample.pdf > 0.0 && sample.pdf.is_finite()).then_some(sample)
    }

    /// Chooses an object that emits and a point of it, as [`Lights::sample`] does with what is left for them: the point,
    /// its radiance, and its density per solid angle, > 0 and finite.
    pub fn sample_area(
        &self,
        geometry: &Geometry,
        at: &Receiver,
        u: [f64; 3],
    ) -> Option<(SurfacePoint, Rgb, f64)> {
        let (light, probability) = self.choose(at, u[0])?;
        let (point, pdf) = self.lights[light].sample(geometry, at, [u[1], u[2]])?;
        let pdf = pdf * probability;
        (pdf > 0.0 && pdf.is_finite()).then(|| (point, self.lights[light].radiance, pdf))
    }

    /// Density per solid angle with which [`Lights::sample_area`] would have chosen a point of an emitting object.
    pub fn pdf_area(&self, at: &Receiver, hit: &Hit, point: &SurfacePoint) -> f64 {
        let light = self.of_object[hit.object as usize] as usize;
        if light >= self.lights.len() || self.coincidences.hides(hit.primitive) {
            return 0.0;
        }
        self.lights[light].pdf(at, point, hit.part) * self.probability(at, light)
    }

    /// Density per solid angle with which [`Lights::sample`] would have chosen a point of an emitting object.
    pub fn pdf_surface(&self, at: &Receiver, hit: &Hit, point: &SurfacePoint) -> f64 {
        self.pdf_area(at, hit, point) * (1.0 - self.sky_share)
    }

    /// Whether the face of a light that a chosen point is on shares some of its place with another surface, so that only
    /// the closest hit of a ray tells whether it is met. Else it is met where nothing is in the way.
    #[inline]
    pub fn share_their_place(&self, geometry: &Geometry, point: &SurfacePoint) -> bool {
        self.coincidences.share(geometry, point)
    }

    /// Density per solid angle with which [`Lights::sample`] would have chosen a direction of the sky.
    pub fn pdf_sky(&self, sky: &Sky, direction: DVec3) -> f64 {
        if self.sky_share > 0.0 { sky.pdf(direction) * self.sky_share } else { 0.0 }
    }

    /// A light and its probability.
    #[inline]
    fn choose(&self, at: &Receiver, u: f64) -> Option<(usize, f64)> {
        match self.lights.len() {
            0 => None,
            1 => Some((0, 1.0)),
            2..=WEIGHED => {
                let (weights, total) = self.weights(at);
                let mut rest = u * total;
                let mut chosen = None;
                for (light, &weight) in weights[..self.lights.len()].iter().enumerate() {
                    if weight > 0.0 {
                        chosen = Some((light, weight / total));
                        if rest < weight {
                            break;
                        }
                        rest -= weight;
                    }
                }
                chosen
            }
            _ => self.tree.sample(at, u).map(|(light, probability, _)| (light as usize, probability)),
        }
    }

    fn probability(&self, at: &Receiver, light: usize) -> f64 {
        match self.lights.len() {
            1 => 1.0,
            2..=WEIGHED => {
                let (weights, total) = self.weights(at);
                if total > 0.0 { weights[light] / total } else { 0.0 }
            }
            _ => self.tree.probability(at, light as u32),
        }
    }

    fn weights(&self, at: &Receiver) -> ([f64; WEIGHED], f64) {
        let mut weights = [0.0; WEIGHED];
        for (weight, light) in weights.iter_mut().zip(&self.lights) {
            *weight = light.importance(at);
        }
        (weights, weights.iter().sum())
    }
}

/// Share of the samples that a sampled sky gets beside other lights.
const SKY_SHARE: f64 = 0.5;
