//! Where a path meets a surface: the light that comes by way of a ball, and paths that go that way by themselves.

use super::{Caustics, LightEnd};
use crate::accel::Accelerator;
use crate::geometry::{Ray, SurfacePoint};
use crate::integrator::Counters;
use crate::integrator::numbers::SegmentNumbers;
use crate::integrator::path::{Chosen, PathTracer, Surface};
use crate::math::{DVec3, Rgb};
use crate::sampling::Sampler;
use crate::world::Interaction;

impl<A: Accelerator> PathTracer<'_, A> {
    /// Light from a chosen point of a light by way of a chosen ball, in at most `left` segments, as it leaves towards
    /// where the path came from.
    pub(in crate::integrator) fn by_way_of_balls(
        &self,
        caustics: &Caustics,
        arrived: DVec3,
        Surface { at, material, .. }: &Surface,
        left: u32,
        numbers: &SegmentNumbers<impl Sampler>,
        counters: &mut Counters,
    ) -> Rgb {
        let (world, receiver) = (self.world, &at.receiver);
        let [ball, light] = numbers.caustic_choice();
        let Some(choice) =
            caustics.choose(receiver, ball).filter(|choice| Caustics::segments(choice) <= left)
        else {
            return Rgb::ZERO;
        };
        let center = caustics.center(&choice);
        let [u, v] = numbers.caustic_light();
        let Some((point, radiance, pdf)) = world.lights.sample_area(&world.geometry, &center, [light, u, v])
        else {
            return Rgb::ZERO;
        };
        let way = (point.position - center.point.position).normalize();
        let end = LightEnd { pdf, cosine: point.normal.dot(way).abs() };
        let mut sum = Rgb::ZERO;
        caustics.paths(world, &choice, receiver.point.position, point.position, |found| {
            let points = found.points();
            let Some((ray, length)) = receiver.point.leave_to(&points[0]) else { return };
            if ray.direction.dot(receiver.side) <= 0.0 {
                return;
            }
            let (scattered, pdf) = material.eval(-arrived, at.normal, ray.direction);
            if scattered == Rgb::ZERO {
                return;
            }
            let last = &points[points.len() - 1];
            let cosine = (point.position - last.position).normalize().dot(point.normal).abs();
            let arriving = scattered * radiance * found.factor(&choice, &end, cosine, pdf);
            let mut clear = |ray: &Ray, length: f64, end: &SurfacePoint| {
                counters.rays += 1;
                ray.is_finite() && self.reaches(ray, length, Some(end))
            };
            let free = clear(&ray, length, &points[0])
                && points.windows(2).all(|ends| {
                    let chord = ends[0].leave_to(&ends[1]);
                    chord.is_some_and(|(ray, length)| clear(&ray, length, &ends[1]))
                })
                && last.leave_to(&point).is_some_and(|(ray, length)| clear(&ray, length, &point));
            if free {
                sum += arriving;
            }
        });
        sum
    }
}

impl<A> PathTracer<'_, A> {
    /// How a path is chosen that arrived in the direction `arrived` and goes on from a mirror or glass in `direction`.
    pub(in crate::integrator) fn by_way_of_ball(
        &self,
        chosen: &Chosen,
        arrived: DVec3,
        at: &Interaction,
        direction: DVec3,
    ) -> Chosen {
        let Some(caustics) = &self.caustics else { return Chosen::Alone };
        let (met, inside) = (at.receiver.point.primitive, direction.dot(at.receiver.point.normal) < 0.0);
        match chosen {
            Chosen::ByMaterial { pdf, receiver } if at.entering => {
                let passage = caustics.enter(met, arrived, inside);
                passage.map_or(Chosen::Alone, |passage| Chosen::Through {
                    pdf: *pdf,
                    receiver: *receiver,
                    passage,
                })
            }
            Chosen::Through { pdf, receiver, passage } if !at.entering => {
                let passage = caustics.go_on(passage, met, inside);
                passage.map_or(Chosen::Alone, |passage| Chosen::Through {
                    pdf: *pdf,
                    receiver: *receiver,
                    passage,
                })
            }
            _ => Chosen::Alone,
        }
    }
}
