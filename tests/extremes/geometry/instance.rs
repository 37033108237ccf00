//! Places of meshes that are shown several times.

use super::{config, direction, point, size};
use crate::support::exact::{corners, shown};
use pathtracer::geometry::{Instance, MeshPart, MeshSpace, PrimitiveId, Ray};
use pathtracer::math::{DMat3, DVec3, EPSILON};
use proptest::prelude::*;

/// A mesh of two triangles with corners of any size, shown turned, perhaps mirrored, at any place and scale.
fn instance() -> impl Strategy<Value = (MeshSpace, Instance)> {
    let mesh = prop::collection::vec(point(), 4).prop_map(|positions| MeshPart {
        object: 0,
        positions,
        triangles: vec![[0, 1, 2], [1, 3, 2]],
    });
    let turn = (direction(), direction(), any::<bool>())
        .prop_filter("has two directions", |(x, around, _)| x.cross(*around).length() > 1e-3)
        .prop_map(|(x, around, mirrored)| {
            let y = x.cross(around).normalize();
            DMat3::from_cols(x, y, x.cross(y) * if mirrored { -1.0 } else { 1.0 })
        });
    (mesh, turn, size(), point()).prop_map(|(mesh, rotation, scale, position)| {
        let space = MeshSpace::new(vec![mesh]);
        let instance = Instance::new(0, &space, rotation, scale, position);
        (space, instance)
    })
}

proptest! {
    #![proptest_config(config(20_000))]

    #[test]
    fn the_box_around_an_instance_holds_its_corners((space, instance) in instance()) {
        let bounds = instance.bounds(&space);
        for triangle in 0..2 {
            for corner in corners(&space, triangle) {
                let p = shown(&instance, corner).to_f64();
                prop_assert!(bounds.min.cmple(p).all() && p.cmple(bounds.max).all(), "{} in {:?}", p, bounds);
            }
        }
    }

    /// At a point of a triangle, from anywhere where the roundings of places leave the mesh a size.
    #[test]
    fn an_instance_is_never_passed_by_by_a_ray_that_hits_it(
        (space, instance) in instance(), triangle in 0..2u32, (u, v) in (0.0..1.0f64, 0.0..1.0f64),
        from in direction(), distance in size(), end in prop_oneof![Just(f64::INFINITY), Just(1.0 + 1e-6)],
    ) {
        let [a, b, c] = corners(&space, triangle).map(|corner| shown(&instance, corner).to_f64());
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let target = a + (b - a) * u + (c - a) * v;
        let bounds = space.frame.bounds;
        let radius = (bounds.max - bounds.min).length() * 0.5 / space.frame.scale * instance.scale;
        let origin = target + from * (distance * radius);
        let places: DVec3 =
            origin.abs() + target.abs() + instance.position.abs() + space.frame.pivot.abs() * instance.scale;
        // The ball that the frame is entered by is a hundredth larger than what is in it, and the way has a direction.
        prop_assume!(64.0 * EPSILON * places.element_sum() < 1e-3 * radius * distance.min(1.0));
        let ray = Ray::new(origin, (target - origin).normalize());
        let t_max = origin.distance(target) * end;
        let local = instance.localize(&space, 0, &ray, t_max, PrimitiveId::NONE);
        prop_assert!(local.is_some(), "passed by, aimed at {}", target);
    }
}
