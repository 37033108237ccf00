//! Unidirectional path tracing with next-event estimation; light and material sampling are joined by multiple
//! importance sampling (Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, ch. 9 and 10).

use super::Counters;
use super::caustic::{Caustics, Passage};
use super::numbers::{Numbers, SegmentNumbers};
use crate::accel::Accelerator;
use crate::geometry::{Hit, PrimitiveId, Ray, SurfacePoint};
use crate::material::{Material, Pdf};
use crate::math::{DVec3, Rgb};
use crate::sampling::Sampler;
use crate::world::light::{LightSample, LightTarget, Receiver};
use crate::world::{Camera, Cone, Interaction, World};

/// Estimates the radiance that arrives at the camera.
pub struct PathTracer<'a, A> {
    pub(super) world: &'a World,
    camera: &'a Camera,
    pub(super) accelerator: &'a A,
    /// Longest path in segments, at least 1.
    bounces: u32,
    light_sampling: bool,
    /// Whether there is more than one light to aim at.
    light_choice: bool,
    /// The balls by which light is sought.
    pub(super) caustics: Option<Caustics>,
    /// In how many directions a path goes on from the first surface that lights are aimed at from.
    branches: u32,
    /// One over the brightest light, 0 without lights.
    light_scale: f64,
    /// Whether surfaces show pictures.
    textured: bool,
}

/// How the last direction of a path was chosen: what weighs light that it meets.
#[derive(Clone, Copy)]
pub(super) enum Chosen {
    /// So that light sampling could not have found the same: the camera, a delta, or light sampling off.
    Alone,
    /// By a material with this density, where light sampling competes.
    ByMaterial { pdf: f64, receiver: Receiver },
    /// So, and then by way of a ball, where light is sought, too.
    Through { pdf: f64, receiver: Receiver, passage: Passage },
}

/// Where a path has arrived.
#[derive(Clone, Copy)]
pub(super) struct Surface {
    pub(super) at: Interaction,
    /// With the colours that it has there.
    pub(super) material: Material,
    /// Whether lights are aimed at from here.
    aims: bool,
}

/// A path on its way.
struct Path<'s, S> {
    numbers: Numbers<'s, S>,
    ray: Ray,
    /// How much the ray stands for; not kept without textures.
    cone: Cone,
    /// How far the ray's origin was moved off the surface that it left; 0 of the camera's.
    offset: f64,
    /// Factor on all light that the path still meets.
    throughput: Rgb,
    radiance: Rgb,
    /// Its part of the sample.
    share: f64,
    chosen: Chosen,
}

/// Paths of up to so many segments are never ended by chance.
const ROULETTE_AFTER: u32 = 3;
/// Nor are paths whose throughput is above this. A quarter instead of 1 gave a scene of diffuse walls a fifth less relMSE
/// at equal samples, and scenes of glass two fifths, for a tenth more time.
const ROULETTE_BELOW: f64 = 0.25;

impl<'a, A: Accelerator> PathTracer<'a, A> {
    /// Paths of up to `bounces` segments; `light_sampling` aims rays at lights where the scene has any.
    pub fn new(
        world: &'a World,
        camera: &'a Camera,
        accelerator: &'a A,
        bounces: u32,
        light_sampling: bool,
    ) -> PathTracer<'a, A> {
        let light_sampling = light_sampling && world.requires.light_sampling;
        let light_choice = world.lights.has_choice();
        let caustics = if light_sampling { Caustics::of(world) } else { None };
        let branches = if light_sampling { world.requires.branches } else { 1 };
        let brightest = world.brightest();
        let light_scale = if brightest > 0.0 { 1.0 / brightest } else { 0.0 };
        PathTracer {
            world,
            camera,
            accelerator,
            bounces,
            light_sampling,
            light_choice,
            caustics,
            branches,
            light_scale,
            textured: world.requires.textures > 0,
        }
    }

    /// The radiance of sample `index` of the pixel (x, y).
    pub fn sample<S: Sampler>(
        &self,
        sampler: &S,
        x: u32,
        y: u32,
        index: u64,
        counters: &mut Counters,
    ) -> Rgb {
        let numbers = Numbers::new(sampler, x, y, index);
        let [dx, dy] = numbers.pixel();
        let ray = self.camera.ray(f64::from(x) + dx, f64::from(y) + dy, || numbers.lens());
        let mut path = Path {
            numbers,
            ray,
            cone: self.camera.cone(ray.direction),
            offset: 0.0,
            throughput: Rgb::ONE,
            radiance: Rgb::ZERO,
            share: 1.0,
            chosen: Chosen::Alone,
        };
        for segment in 1..=self.bounces {
            let Some(surface) = self.arrive(&mut path, segment, counters) else { break };
            if surface.aims && self.branches > 1 {
                return self.split(&path, &surface, segment, counters);
            }
            if !self.turn(&mut path, &surface, segment) {
                break;
            }
        }
        path.radiance
    }

    /// The radiance of a path that goes on in several directions from here. What it costs to get here, and light that is
    /// aimed at, is worth more than one look at what arrives from elsewhere.
    fn split<S: Sampler>(
        &self,
        path: &Path<S>,
        surface: &Surface,
        segment: u32,
        counters: &mut Counters,
    ) -> Rgb {
        let share = 1.0 / f64::from(self.branches);
        let mut sum = Rgb::ZERO;
        for index in 0..self.branches {
            let numbers = path.numbers.branch(index, self.branches);
            let mut branch = Path { numbers, radiance: Rgb::ZERO, share, ..*path };
            let mut segment = segment;
            let mut surface = *surface;
            while self.turn(&mut branch, &surface, segment) {
                segment += 1;
                match self.arrive(&mut branch, segment, counters) {
                    Some(next) => surface = next,
                    None => break,
                }
            }
            sum += branch.radiance;
        }
        path.radiance + sum * share
    }

    /// Follows the path's ray to what it meets, and adds the light found there and by aiming at lights; `None` if it
    /// ends there.
    fn arrive<S: Sampler>(
        &self,
        path: &mut Path<S>,
        segment: u32,
        counters: &mut Counters,
    ) -> Option<Surface> {
        let before = path.radiance;
        let met = self.meet(path, counters);
        if segment == self.bounces {
            self.count_last(path, before, counters);
        }
        let (at, hit) = met?;
        if segment == self.bounces {
            counters.cut_paths += 1;
            counters.cut_throughput.add(path.part());
            return None;
        }
        let varied = self.world.varied_material(&hit, &at, path.cone.width);
        let material = varied.unwrap_or_else(|| *self.world.material(hit.object));
        let aims = self.light_sampling && !material.is_delta();
        let surface = Surface { at, material, aims };
        let before = path.radiance;
        if aims {
            let numbers = path.numbers.segment(segment);
            let mut light = self.direct(path.ray.direction, &surface, &numbers, counters);
            if let Some(caustics) = &self.caustics {
                let left = self.bounces - segment;
                light +=
                    self.by_way_of_balls(caustics, path.ray.direction, &surface, left, &numbers, counters);
            }
            path.radiance += path.throughput * light;
        }
        if segment + 1 == self.bounces {
            counters.last_throughput.add(path.part());
            self.count_last(path, before, counters);
        }
        Some(surface)
    }

    /// Counts what was added to a path's radiance by its last segment.
    fn count_last<S>(&self, path: &Path<S>, before: Rgb, counters: &mut Counters) {
        let light = (path.radiance - before).element_sum() / 3.0 * path.share;
        counters.last_light.add(light * self.light_scale);
    }

    /// Follows the path's ray to what it meets, and adds the light found there.
    #[inline(always)]
    fn meet<S: Sampler>(&self, path: &mut Path<S>, counters: &mut Counters) -> Option<(Interaction, Hit)> {
        counters.rays += 1;
        let Some(hit) = self.accelerator.intersect(&path.ray) else {
            // Asked only here, since nothing is hit by such a ray.
            if path.ray.is_finite() {
                self.add_sky(path);
            } else {
                counters.refused += 1;
            }
            return None;
        };
        counters.self_hits += u64::from(path.meets_itself(&hit));
        if self.textured {
            path.cone = path.cone.at(hit.t);
        }
        let at = self.world.interaction(&path.ray, &hit);
        let emission = self.world.emission(hit.object);
        if emission != Rgb::ZERO {
            path.radiance += path.throughput * emission * self.weight(path, &hit, &at);
        }
        Some((at, hit))
    }

    /// Turns the path to where it goes on. Whether it does.
    fn turn<S: Sampler>(&self, path: &mut Path<S>, surface: &Surface, segment: u32) -> bool {
        let numbers = path.numbers.segment(segment);
        self.scatter(path, surface, &numbers) && survives(path, segment, || numbers.roulette())
    }

    /// The weight of the light that is emitted where the path has arrived.
    fn weight<S>(&self, path: &Path<S>, hit: &Hit, at: &Interaction) -> f64 {
        match (&path.chosen, &self.caustics) {
            (Chosen::Through { pdf, receiver, passage }, Some(caustics)) => {
                let light = (&at.receiver.point, hit, path.ray.direction);
                caustics.weight(self.world, passage, (receiver, *pdf), light)
            }
            (chosen, _) => {
                chosen.weight(|receiver| self.world.lights.pdf_surface(receiver, hit, &at.receiver.point))
            }
        }
    }

    fn add_sky<S: Sampler>(&self, path: &mut Path<S>) {
        let direction = path.ray.direction;
        let radiance = self.world.sky.radiance(direction);
        if radiance != Rgb::ZERO {
            let weight = path.chosen.weight(|_| self.world.lights.pdf_sky(&self.world.sky, direction));
            path.radiance += path.throughput * radiance * weight;
        }
    }

    /// Light from a chosen point of a light, as it leaves towards where the path came from.
    fn direct(
        &self,
        arrived: DVec3,
        Surface { at, material, .. }: &Surface,
        numbers: &SegmentNumbers<impl Sampler>,
        counters: &mut Counters,
    ) -> Rgb {
        let (world, receiver) = (self.world, &at.receiver);
        let choice = if self.light_choice { numbers.light_choice() } else { 0.0 };
        let [u, v] = numbers.light();
        let Some(light) = world.lights.sample(&world.geometry, &world.sky, receiver, [choice, u, v]) else {
            return Rgb::ZERO;
        };
        let Some((ray, length, end)) = shadow_ray(receiver, &light) else {
            return Rgb::ZERO;
        };
        if ray.direction.dot(receiver.side) <= 0.0 {
            return Rgb::ZERO;
        }
        let (scattered, pdf) = material.eval(-arrived, at.normal, ray.direction);
        if scattered == Rgb::ZERO {
            return Rgb::ZERO;
        }
        counters.rays += 1;
        if !self.reaches(&ray, length, end) {
            return Rgb::ZERO;
        }
        if !ray.is_finite() {
            counters.refused += 1;
            return Rgb::ZERO;
        }
        // Balance heuristic; written so that an infinite density of the material gives 0, not Inf / Inf.
        scattered * light.radiance * (1.0 / (light.pdf + pdf))
    }

    /// Whether a ray of this length meets the point that it was aimed at (`None`: the sky), as a path would: of surfaces
    /// that lie on one another it meets one.
    #[inline]
    pub(super) fn reaches(&self, ray: &Ray, length: f64, end: Option<&SurfacePoint>) -> bool {
        let Some(point) = end else { return !self.accelerator.occluded(ray, length, PrimitiveId::NONE) };
        if self.world.lights.share_their_place(&self.world.geometry, point) {
            return self.accelerator.intersect(ray).is_some_and(|hit| hit.primitive == point.primitive);
        }
        !self.accelerator.occluded(ray, length, point.primitive)
    }

    /// Turns the path to a direction that the material chose. Whether it goes on.
    fn scatter<S>(
        &self,
        path: &mut Path<S>,
        Surface { at, material, aims }: &Surface,
        numbers: &SegmentNumbers<impl Sampler>,
    ) -> bool {
        let wo = -path.ray.direction;
        let lobe = if material.has_choice() { numbers.lobe() } else { 0.0 };
        let [u, v] = if material.is_spread() { numbers.direction() } else { [0.0; 2] };
        let Some(scatter) = material.sample(wo, at.normal, at.entering, [lobe, u, v]) else {
            return false;
        };
        // With interpolated normals a direction can lie on the other side of the surface than the material meant.
        let through = scatter.direction.dot(at.normal) < 0.0;
        if through != (scatter.direction.dot(at.receiver.side) < 0.0) {
            return false;
        }
        path.throughput *= scatter.weight;
        path.chosen = match scatter.pdf {
            Pdf::SolidAngle(pdf) if *aims => Chosen::ByMaterial { pdf, receiver: at.receiver },
            _ => self.by_way_of_ball(&path.chosen, path.ray.direction, at, scatter.direction),
        };
        if self.textured {
            let arrived = path.ray.direction;
            path.cone = self.world.cone_beyond(path.cone, arrived, at, material, &scatter);
        }
        let point = &at.receiver.point;
        path.ray = point.leave(scatter.direction);
        path.offset = point.error.dot(path.ray.side.abs());
        path.throughput != Rgb::ZERO
    }
}

impl<S> Path<'_, S> {
    /// The part of a sample's throughput that it carries, mean of the components.
    fn part(&self) -> f64 {
        self.throughput.element_sum() / 3.0 * self.share
    }

    /// Whether a hit is the surface that the ray left, as far as can be told: see [`Counters::self_hits`].
    fn meets_itself(&self, hit: &Hit) -> bool {
        if hit.primitive == self.ray.leaving { !self.ray.inward } else { hit.t <= self.offset }
    }
}

impl Chosen {
    /// The balance heuristic's weight of light that was met, given the density of meeting it by light sampling.
    fn weight(&self, light_pdf: impl FnOnce(&Receiver) -> f64) -> f64 {
        match self {
            Chosen::Alone | Chosen::Through { .. } => 1.0,
            Chosen::ByMaterial { pdf, receiver } => 1.0 / (1.0 + light_pdf(receiver) / pdf),
        }
    }
}

/// The ray to a chosen light, the distance within which nothing may stand, and the point at its end.
fn shadow_ray<'l>(at: &Receiver, light: &'l LightSample) -> Option<(Ray, f64, Option<&'l SurfacePoint>)> {
    match &light.target {
        LightTarget::Sky(direction) => Some((at.point.leave(*direction), f64::INFINITY, None)),
        LightTarget::Surface(point) => {
            let (ray, length) = at.point.leave_to(point)?;
            Some((ray, length, Some(point)))
        }
    }
}

/// Russian roulette by throughput relative to the camera's, which no scale of the lights changes. A path that goes on
/// carries what the ended ones would have.
fn survives<S>(path: &mut Path<S>, segment: u32, u: impl FnOnce() -> f64) -> bool {
    if segment <= ROULETTE_AFTER {
        return true;
    }
    let probability = path.throughput.max_element() / ROULETTE_BELOW;
    if probability >= 1.0 {
        return true;
    }
    if u() >= probability {
        return false;
    }
    path.throughput /= probability;
    true
}
