//! The ray sets of a mesh without a scene: what a camera sees of it, and where light would go from there.

use super::random::Random;
use super::rays::{Query, RayKind, RaySet, Sphere};
use crate::accel::Accelerator;
use crate::geometry::{Geometry, PrimitiveId, Ray, SurfacePoint};
use crate::math::{DVec3, Frame};
use crate::sampling::warp::square_to_cosine_hemisphere;

/// A pinhole camera, z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where it stands.
    pub eye: DVec3,
    /// What it looks at.
    pub target: DVec3,
    /// Horizontal field of view as a fraction of pi.
    pub fov: f64,
}

/// A point that was seen, with the normal on the side of the eye.
type Seen = (SurfacePoint, DVec3);

impl View {
    /// From outside at a sphere.
    pub fn onto(sphere: &Sphere) -> View {
        let direction = DVec3::new(-0.78, -0.51, 0.36).normalize();
        View { eye: sphere.center + direction * (2.2 * sphere.radius), target: sphere.center, fov: 0.25 }
    }

    /// About `count` rays of every kind: primary ones through the pixels of a 16:9 picture; from where they hit,
    /// bounces with the cosine's distribution and shadow rays to random points of the sphere around the geometry; and
    /// chords of that sphere.
    pub fn ray_sets(
        &self,
        geometry: &Geometry,
        accelerator: &dyn Accelerator,
        count: usize,
        seed: u64,
    ) -> Vec<RaySet> {
        let Some(sphere) = Sphere::around(geometry) else { return Vec::new() };
        let primary = self.primary(count);
        let seen: Vec<Seen> = primary.iter().filter_map(|ray| seen(geometry, accelerator, ray)).collect();
        let mut random = Random::new(seed);
        let each = |mut from: Box<dyn FnMut(&Seen) -> Query + '_>| {
            // Where fewer were seen than are wanted, from each several.
            let points = seen.iter().cycle().take(if seen.is_empty() { 0 } else { count });
            points.map(&mut from).collect()
        };
        let bounce = each(Box::new(|&(point, side)| {
            let local = square_to_cosine_hemisphere([random.unit(), random.unit()]);
            Query::closest(point.leave(Frame::around(side).to_world(local)))
        }));
        let shadow = each(Box::new(|&(point, _)| {
            let target = sphere.center + random.direction() * sphere.radius;
            let way = target - point.position;
            Query { ray: point.leave(way.normalize()), t_max: way.length(), target: PrimitiveId::NONE }
        }));
        vec![
            RaySet { kind: RayKind::Primary, queries: primary.into_iter().map(Query::closest).collect() },
            RaySet { kind: RayKind::Bounce, queries: bounce },
            RaySet { kind: RayKind::Shadow, queries: shadow },
            sphere.chords(count, seed ^ 1),
        ]
    }

    /// Rays through the middles of the pixels, row by row.
    fn primary(&self, count: usize) -> Vec<Ray> {
        let height = ((count as f64 * 9.0 / 16.0).sqrt().round() as usize).max(1);
        let width = count.div_ceil(height);
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(DVec3::Z).normalize();
        let up = right.cross(forward);
        let half = libm::tan(self.fov * std::f64::consts::FRAC_PI_2);
        let ray = |i: usize| {
            let x = (2.0 * (i % width) as f64 + 1.0) / width as f64 - 1.0;
            let y = (height as f64 - 2.0 * (i / width) as f64 - 1.0) / width as f64;
            Ray::new(self.eye, (forward + (right * x + up * y) * half).normalize())
        };
        (0..count).map(ray).collect()
    }
}

fn seen(geometry: &Geometry, accelerator: &dyn Accelerator, ray: &Ray) -> Option<Seen> {
    let hit = accelerator.intersect(ray)?;
    let point = geometry.surface(ray, &hit);
    let side = if point.normal.dot(ray.direction) > 0.0 { -point.normal } else { point.normal };
    Some((point, side))
}
