//! The predicate of the triangle.

use super::{config, direction};
use crate::support::double_double::DoubleDouble;
use pathtracer::geometry::{LocalFrame, LocalRay, PrimitiveId, Ray, TriangleBlock, any_in_block};
use pathtracer::geometry::{closest_in_block, intersect_triangle, plane_hit};
use pathtracer::math::{Bounds, DVec3, EPSILON};
use proptest::prelude::*;

/// A local corner: any f32 in [-1, 1], often with few digits or tiny.
fn corner() -> impl Strategy<Value = [f32; 3]> {
    let number = prop_oneof![
        6 => -1.0..1.0f32,
        2 => (-8..=8i8).prop_map(|i| f32::from(i) / 8.0),
        1 => (-100.0..0.0f64).prop_map(|e| libm::exp2(e) as f32),
        1 => Just(0f32),
    ];
    prop::array::uniform3(number)
}

fn f64s(corners: [[f32; 3]; 3]) -> [DVec3; 3] {
    corners.map(|[x, y, z]| DVec3::new(x.into(), y.into(), z.into()))
}

/// The ray in a frame that is the world: the cube [-1, 1) around the origin.
fn local(origin: DVec3, direction: DVec3) -> LocalRay {
    let frame = LocalFrame::new(DVec3::ZERO, Bounds { min: DVec3::splat(-0.9), max: DVec3::splat(0.9) });
    let ray = Ray::new(origin, direction);
    frame.localize(&ray, f64::INFINITY, [PrimitiveId::NO_TRIANGLE; 2]).expect("it starts inside")
}

/// Signed volumes of the ray with the edges opposite to the corners, in double-double, and the size of their terms.
fn volumes(origin: DVec3, direction: DVec3, corners: [DVec3; 3]) -> ([f64; 3], f64) {
    let dd = |v: DVec3| v.to_array().map(DoubleDouble::from);
    let (o, d) = (dd(origin), dd(direction));
    let [a, b, c] = corners.map(|corner| {
        let p = dd(corner);
        [p[0] - o[0], p[1] - o[1], p[2] - o[2]]
    });
    let volume = |p: [DoubleDouble; 3], q: [DoubleDouble; 3]| {
        let n = [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]).to_f64()
    };
    let reach = corners.iter().map(|&p| (p - origin).length()).fold(0.0, f64::max);
    ([volume(b, c), volume(c, a), volume(a, b)], reach * reach)
}

/// A ray from somewhere near through a point of the triangle's plane, often an edge or a corner.
fn aimed() -> impl Strategy<Value = (DVec3, f64, f64)> {
    let weight = || prop_oneof![3 => -0.2..1.2f64, 1 => Just(0.0), 1 => Just(1.0), 1 => -1e-12..1e-12f64];
    (direction(), weight(), weight())
}

fn ray_at(corners: [DVec3; 3], (from, u, v): (DVec3, f64, f64)) -> (DVec3, DVec3) {
    let [a, b, c] = corners;
    let target = a + (b - a) * u + (c - a) * v;
    let origin = from * 1.3;
    (origin, (target - origin).normalize_or_zero())
}

proptest! {
    #![proptest_config(config(40_000))]

    /// Right unless a volume is smaller than the roundings of the projected corners: a dozen times 2^-53 of its terms.
    #[test]
    fn a_triangle_is_hit_where_double_double_says(
        corners in prop::array::uniform3(corner()), aim in aimed(),
    ) {
        let corners = f64s(corners);
        let (origin, direction) = ray_at(corners, aim);
        prop_assume!(direction != DVec3::ZERO);
        let (volumes, terms) = volumes(origin, direction, corners);
        let doubt = 12.0 * EPSILON * terms;
        prop_assume!(volumes.iter().all(|v| v.abs() > doubt));
        let same_side = volumes.iter().all(|&v| v > 0.0) || volumes.iter().all(|&v| v < 0.0);
        let hit = intersect_triangle(&local(origin, direction), corners);
        prop_assert_eq!(hit.is_some(), same_side, "{:?}", volumes);
        if let Some((_, u, v)) = hit {
            let sum: f64 = volumes.iter().sum();
            let allowed = 4.0 * doubt / sum.abs();
            prop_assert!((u - volumes[1] / sum).abs() <= allowed && (v - volumes[2] / sum).abs() <= allowed);
        }
    }

    /// Two triangles beside each other and a point of their common edge, or a corner: one of them is hit.
    #[test]
    fn nothing_passes_between_triangles_that_share_an_edge(
        (a, b) in (corner(), corner()), aim in 0.0..1.0f64, (left, right) in (corner(), corner()), from in direction(),
    ) {
        let [a, b] = f64s([a, b, b])[..2] else { unreachable!("three corners") };
        let origin = from * 1.3;
        let direction = (a.lerp(b, aim) - origin).normalize_or_zero();
        prop_assume!(direction != DVec3::ZERO);
        // One on each side of the plane through the ray and the edge.
        let across = (b - a).cross(direction).normalize_or_zero();
        let [c, d] = f64s([left, right, right])[..2] else { unreachable!("three corners") };
        let beside = |p: DVec3, side: f64| {
            let away = (p - a).dot(across);
            (p + across * (side * away.abs().max(0.01) - away)).as_vec3().as_dvec3()
        };
        let (c, d) = (beside(c, 1.0), beside(d, -1.0));
        prop_assume!((b - a).length() > 1e-3);
        prop_assume!(aim > 1e-9 && aim < 1.0 - 1e-9);
        let ray = local(origin, direction);
        let hits = [[a, b, c], [b, a, d]].map(|corners| intersect_triangle(&ray, corners).is_some());
        prop_assert!(hits[0] || hits[1]);
    }

    /// A fan all around a corner that a ray is aimed at, with rounding: one of its triangles is hit.
    #[test]
    fn nothing_passes_through_the_corner_of_a_fan(
        tip in corner(), from in direction(), radii in prop::collection::vec(0.01..0.5f64, 3..12), turn in 0.0..6.0f64,
        heights in prop::collection::vec(-0.2..0.2f64, 12),
    ) {
        let tip = f64s([tip; 3])[0];
        let origin = tip + from * 1.1;
        let direction = (tip - origin).normalize();
        let x = direction.any_orthonormal_vector();
        let y = direction.cross(x);
        let spokes: Vec<DVec3> = radii.iter().enumerate().map(|(i, r)| {
            let (s, c) = libm::sincos(turn + std::f64::consts::TAU * i as f64 / radii.len() as f64);
            (tip + (x * c + y * s) * *r + direction * heights[i]).as_vec3().as_dvec3()
        }).collect();
        let ray = local(origin, direction);
        let hit = (0..spokes.len()).any(|i| {
            intersect_triangle(&ray, [tip, spokes[i], spokes[(i + 1) % spokes.len()]]).is_some()
        });
        prop_assert!(hit);
    }

    /// The f32 test before the decision excludes nothing that the decision accepts.
    #[test]
    fn the_block_finds_what_the_triangle_alone_does(
        triangles in prop::collection::vec(prop::array::uniform3(corner()), 1..9), which in 0..8usize, aim in aimed(),
        afar in any::<bool>(),
    ) {
        let corners = f64s(triangles[which % triangles.len()]);
        let (origin, direction) = ray_at(corners, aim);
        prop_assume!(direction != DVec3::ZERO);
        let origin = if afar { origin - direction * 4.0 } else { origin };
        let ray = local(origin, direction);
        let block = TriangleBlock::new((0..).zip(triangles.iter().copied()));
        let alone = |index: u32| {
            let (t, ..) = intersect_triangle(&ray, f64s(triangles[index as usize]))?;
            (t > 0.0 && t <= ray.t_max).then_some((t, index))
        };
        let expected = (0..triangles.len() as u32).filter_map(alone).min_by(|a, b| a.0.total_cmp(&b.0));
        let mut best = None;
        closest_in_block(&block, &ray, &mut best);
        prop_assert_eq!(best.map(|hit| (hit.t, hit.index)), expected);
        prop_assert_eq!(any_in_block(&block, &ray), expected.is_some());
        // What another kernel proposes is measured with the same bits.
        if let Some(hit) = best {
            let measured = plane_hit(&ray, f64s(triangles[hit.index as usize]));
            prop_assert_eq!(measured, Some((hit.t, hit.u, hit.v)));
        }
    }
}
