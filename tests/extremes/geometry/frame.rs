//! The way of a ray into the space of a mesh.

use super::{config, direction, number, point, size};
use crate::support::double_double::DoubleDouble;
use pathtracer::geometry::{LocalFrame, PrimitiveId, Ray};
use pathtracer::math::{Bounds, DVec3, EPSILON};
use proptest::prelude::*;

/// A frame around a box of any size at any place.
fn frame() -> impl Strategy<Value = LocalFrame> {
    (point(), size(), direction(), 0.0..1.0f64).prop_map(|(center, size, d, inside)| {
        let half = d.abs() * size;
        let world = Bounds { min: center - half, max: center + half };
        LocalFrame::new(center + half * (2.0 * inside - 1.0), world)
    })
}

proptest! {
    #![proptest_config(config(4096))]

    #[test]
    fn the_f32_ray_is_within_its_rounding_and_never_behind_the_surface(
        frame in frame(), from in point(), side in direction(), along in direction(),
    ) {
        // The box may have vanished in the digits of its place.
        prop_assume!((frame.bounds.max - frame.bounds.min).max_element() >= 0.5);
        // Near the frame, in its own units, so that the ray is taken as it is.
        let start = frame.to_world((frame.bounds.min + frame.bounds.max) * 0.5 + from.normalize_or_zero() * 0.3);
        let ray = Ray { side, ..Ray::new(start, along) };
        let local = frame.localize(&ray, f64::INFINITY, [PrimitiveId::NO_TRIANGLE; 2]).expect("it starts inside");
        prop_assert_eq!(local.shift, 0.0);
        prop_assert_eq!(local.direction64(), along);
        let (exact, rounded) = (local.origin64(), local.origin.as_dvec3());
        prop_assert_eq!(exact, frame.to_local(start));
        for axis in 0..3 {
            let step = rounded[axis] - exact[axis];
            // Round to nearest is 2^-24; away from the surface up to twice that; 2^-149 is the smallest number.
            prop_assert!(step.abs() <= exact[axis].abs() * 2f64.powi(-23) + 2f64.powi(-149));
            prop_assert!(step * side[axis] >= 0.0, "axis {}: {} from {}", axis, step, exact[axis]);
        }
        let turned = (local.direction.as_dvec3() - along).abs();
        prop_assert!(turned.cmple(along.abs() * 2f64.powi(-24) + 2f64.powi(-150)).all());
    }

    #[test]
    fn a_ray_from_afar_is_moved_along_itself(
        frame in frame(), from in direction(), distance in 10.0..1e12f64, aim in point(),
    ) {
        prop_assume!((frame.bounds.max - frame.bounds.min).max_element() >= 0.5);
        let middle = frame.to_world((frame.bounds.min + frame.bounds.max) * 0.5);
        let reach = (frame.bounds.max - frame.bounds.min).length() / frame.scale;
        let target = middle + aim.normalize_or_zero() * (0.4 * reach);
        let origin = middle + from * (distance * reach);
        let ray = Ray::new(origin, (target - origin).normalize());
        let Some(local) = frame.localize(&ray, f64::INFINITY, [PrimitiveId::NO_TRIANGLE; 2]) else {
            // What the roundings of the way hide may be lost.
            prop_assert!(distance * reach + middle.length() > reach * 2f64.powi(46));
            return Ok(());
        };
        // In double-double: start + shift along the direction, less the pivot.
        for axis in 0..3 {
            let dd = DoubleDouble::from;
            let moved = dd(origin[axis]) + dd(local.shift) * dd(ray.direction[axis]) - dd(frame.pivot[axis]);
            let local_origin = dd(local.origin64()[axis]) / dd(frame.scale);
            // The start less the pivot, the way, and their sum are rounded once each, the shift once more.
            let allowed = 4.0 * EPSILON * (origin.abs()[axis] + frame.pivot.abs()[axis] + local.shift);
            prop_assert!((moved - local_origin).to_f64().abs() <= allowed);
        }
    }

    #[test]
    fn places_survive_the_way_into_the_frame_and_back(frame in frame(), u in 0.0..1.0f64, v in 0.0..1.0f64) {
        let local = frame.bounds.min.lerp(frame.bounds.max, u) * DVec3::new(1.0, v, 1.0 - v);
        let world = frame.to_world(local);
        // Out: one rounding of a sum; in: one of a difference. Scaling by powers of two is exact.
        let allowed = 2.0 * EPSILON * (world.abs() + frame.pivot.abs()) * frame.scale;
        prop_assert!((frame.to_local(world) - local).abs().cmple(allowed).all());
    }

    #[test]
    fn scale_brings_the_extent_into_one_to_two(frame in frame(), _x in number()) {
        let extent = (frame.bounds.max - frame.bounds.min).max_element();
        // The bounds are rounded relative to the place of the box; a box far out may vanish in that.
        prop_assert!(extent < 2.0 + 1e-9 || extent.is_nan());
        prop_assert_eq!(libm::log2(frame.scale).fract(), 0.0);
    }
}
