//! Balls, boxes and rectangles.

use super::{config, direction, point, size, turn};
use crate::support::double_double::DoubleDouble;
use pathtracer::geometry::{Ball, Cuboid, Geometry, Ray, Rectangle, Shape, Solid};
use pathtracer::math::{DMat3, DVec3, EPSILON};
use proptest::prelude::*;

type Vector = [DoubleDouble; 3];

fn dd(v: DVec3) -> Vector {
    v.to_array().map(DoubleDouble::from)
}

fn sub(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Vector, b: Vector) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The two roots of |o + t d - c| = r with d as it is, and r^2 - p^2 where p is the distance of the line from c.
fn ball_reference(ball: &Ball, origin: DVec3, direction: DVec3) -> (Option<(f64, f64)>, f64) {
    let (f, d, r) = (sub(dd(origin), dd(ball.center)), dd(direction), DoubleDouble::from(ball.radius));
    let (a, b) = (dot(d, d), -dot(f, d));
    let along = b / a;
    let q = [f[0] + along * d[0], f[1] + along * d[1], f[2] + along * d[2]];
    let inside = r * r - dot(q, q);
    if inside.to_f64() < 0.0 {
        return (None, inside.to_f64());
    }
    let root = (inside / a).sqrt();
    (Some(((along - root).to_f64(), (along + root).to_f64())), inside.to_f64())
}

proptest! {
    #![proptest_config(config(20_000))]

    /// The roundings of the origin's offset f, of its part along the ray and of the perpendicular add up to a dozen
    /// times 2^-53 |f|; so much the line may be moved, and the roots with it.
    #[test]
    fn the_roots_of_a_ball_are_those_of_a_line_moved_by_a_dozen_roundings(
        center in point(), radius in size(), offset in direction(), distance in size(), across in 0.0..1.1f64,
        around in direction(),
    ) {
        let ball = Ball { center, radius };
        let origin = center + offset * (distance * radius);
        let side = offset.cross(around).normalize_or_zero();
        let direction = (center + side * (radius * across) - origin).normalize_or_zero();
        prop_assume!(direction != DVec3::ZERO);
        let f = (origin - center).length();
        let moved = 12.0 * EPSILON * f;
        let (expected, inside) = ball_reference(&ball, origin, direction);
        let doubt = moved * (2.0 * radius + moved);
        match (ball.roots(origin, direction), expected) {
            (Some((near, far)), Some((t0, t1))) => {
                // The half chord is the root of `inside`, which is wrong by `doubt`.
                let chord = inside.max(0.0).sqrt();
                let error = moved + (doubt / chord.max(doubt.sqrt())) + 4.0 * EPSILON * (t0.abs() + t1.abs());
                prop_assert!((near - t0).abs() <= error, "near {} instead of {}, allowed {:e}", near, t0, error);
                prop_assert!((far - t1).abs() <= error, "far {} instead of {}, allowed {:e}", far, t1, error);
                prop_assert!(near <= far);
            }
            (None, None) => {}
            (found, _) => prop_assert!(inside.abs() <= doubt, "{:?} instead of {:?}", found, expected),
        }
    }

    /// Far relative accuracy where a box is entered from outside and aligned: three roundings a plane.
    #[test]
    fn the_slabs_of_a_box_are_those_of_double_double(
        center in point(), half in (size(), size(), size()), origin in point(), d in direction(),
    ) {
        let half = DVec3::from(half);
        let cuboid = Cuboid { center, half, rotation: DMat3::IDENTITY };
        let o = sub(dd(origin), dd(center));
        let (mut enter, mut leave, mut slack) = (f64::NEG_INFINITY, f64::INFINITY, 0f64);
        let mut outside = false;
        for axis in 0..3 {
            let h = DoubleDouble::from(half[axis]);
            if d[axis] == 0.0 {
                let place = o[axis].to_f64().abs();
                prop_assume!((place - half[axis]).abs() > 2.0 * EPSILON * (place + origin[axis].abs()));
                outside |= place > half[axis];
                continue;
            }
            let planes = [-h, h].map(|h| ((h - o[axis]) / DoubleDouble::from(d[axis])).to_f64());
            enter = enter.max(planes[0].min(planes[1]));
            leave = leave.min(planes[0].max(planes[1]));
            slack = slack.max(4.0 * EPSILON * (o[axis].to_f64().abs() + half[axis]) / d[axis].abs());
        }
        match cuboid.slabs(origin, d) {
            Some(((t0, _), (t1, _))) => {
                prop_assert!(!outside && enter <= leave + 2.0 * slack);
                prop_assert!((t0 - enter).abs() <= slack, "enters at {} instead of {}", t0, enter);
                prop_assert!((t1 - leave).abs() <= slack, "leaves at {} instead of {}", t1, leave);
            }
            None => prop_assert!(outside || enter + 2.0 * slack >= leave, "{} to {}", enter, leave),
        }
    }

    /// The same of a turned box. Each product with an axis is rounded four times, relative to the sizes of its terms.
    #[test]
    fn the_slabs_of_a_turned_box_are_those_of_double_double(
        center in point(), half in (size(), size(), size()), rotation in turn(), aim in (-1.3..1.3f64, -1.3..1.3f64, -1.3..1.3f64),
        from in direction(), distance in 0.01..1e4f64,
    ) {
        let half = DVec3::from(half);
        let cuboid = Cuboid { center, half, rotation };
        let target = center + rotation * (half * DVec3::from(aim));
        let origin = target + from * (distance * half.max_element());
        let d = (target - origin).normalize_or_zero();
        prop_assume!(d != DVec3::ZERO);
        let f = sub(dd(origin), dd(center));
        let (mut enter, mut leave, mut slack) = (f64::NEG_INFINITY, f64::INFINITY, 0f64);
        for axis in 0..3 {
            let (o, along) = (dot(f, dd(rotation.col(axis))), dot(dd(d), dd(rotation.col(axis))));
            // Of rays nearly along a slab nothing is known of where they pass its planes.
            prop_assume!(along.to_f64().abs() > 1e-6);
            let h = DoubleDouble::from(half[axis]);
            let planes = [-h, h].map(|h| ((h - o) / along).to_f64());
            enter = enter.max(planes[0].min(planes[1]));
            leave = leave.min(planes[0].max(planes[1]));
            let places = origin.abs().element_sum() + center.abs().element_sum() + half[axis];
            let farther = planes[0].abs().max(planes[1].abs());
            slack = slack.max(8.0 * EPSILON * (places + farther) / along.to_f64().abs());
        }
        match cuboid.slabs(origin, d) {
            Some(((t0, _), (t1, _))) => {
                prop_assert!(enter <= leave + 2.0 * slack);
                prop_assert!((t0 - enter).abs() <= slack, "enters at {} instead of {}", t0, enter);
                prop_assert!((t1 - leave).abs() <= slack, "leaves at {} instead of {}", t1, leave);
            }
            None => prop_assert!(enter + 2.0 * slack >= leave, "{} to {}", enter, leave),
        }
    }

    /// The point of a hit is on the surface, to within the error that it states.
    #[test]
    fn points_of_solids_are_on_their_surface_within_the_stated_error(
        kind in 0..3, center in point(), half in (size(), size(), size()), rotation in turn(),
        aim in (-0.9..0.9f64, -0.9..0.9f64, -0.9..0.9f64), from in direction(), distance in 0.01..1e4f64,
    ) {
        let half = DVec3::from(half);
        let shape = match kind {
            0 => Shape::Ball(Ball { center, radius: half.x }),
            1 => Shape::Cuboid(Cuboid { center, half, rotation }),
            _ => Shape::Rectangle(Rectangle::new(center, rotation.x_axis * half.x, rotation.y_axis * half.y)),
        };
        let reach = match kind {
            0 => DVec3::splat(0.5 * half.x),
            1 => half,
            _ => DVec3::new(half.x, half.y, 0.0),
        };
        let target = center + rotation * (reach * DVec3::from(aim));
        let origin = target + from * (distance * reach.max_element());
        let geometry = Geometry::new(vec![Solid { object: 0, shape }], &[]);
        let ray = Ray::new(origin, (target - origin).normalize_or_zero());
        let hit = geometry.intersect_solid(0, &ray, f64::INFINITY);
        prop_assume!(hit.is_some() && ray.direction != DVec3::ZERO);
        let hit = hit.expect("a hit");
        let point = geometry.surface(&ray, &hit);
        // Where the roundings of places leave it a size.
        let least = reach.to_array().into_iter().filter(|&x| x > 0.0).fold(f64::INFINITY, f64::min);
        let places = origin.abs().max(center.abs()).max_element();
        prop_assume!(64.0 * EPSILON * places < least);
        let p = sub(dd(point.position), dd(center));
        let off = match &shape {
            Shape::Ball(ball) => (dot(p, p).sqrt() - DoubleDouble::from(ball.radius)).to_f64(),
            Shape::Cuboid(cuboid) => {
                let axis = hit.part as usize / 2;
                (dot(p, dd(rotation.col(axis))).to_f64().abs() - cuboid.half[axis]).abs()
            }
            Shape::Rectangle(rectangle) => {
                let (u, v) = (dd(rectangle.edge_u), dd(rectangle.edge_v));
                let across = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
                (dot(p, across) / dot(across, across).sqrt()).to_f64()
            }
            Shape::Instance(_) => unreachable!("not made"),
        };
        let allowed = point.error.dot(point.normal.abs());
        prop_assert!(off.abs() <= allowed, "{:e} off the surface, {:e} stated", off, allowed);
    }

    /// A rectangle is hit where its plane is, within its outline but for roundings of the place relative to the origin.
    #[test]
    fn a_rectangle_is_hit_inside_its_outline(
        center in point(), (width, height) in (size(), size()), n in direction(), around in direction(),
        (x, y) in (-1.2..1.2f64, -1.2..1.2f64), from in direction(), distance in 0.01..1e4f64,
    ) {
        let u = n.cross(around).normalize_or_zero();
        prop_assume!(u != DVec3::ZERO);
        let v = n.cross(u).normalize();
        let rectangle = Rectangle::new(center, u * width, v * height);
        let target = center + u * (width * x) + v * (height * y);
        let origin = target + from * (distance * width.max(height));
        let d = (target - origin).normalize_or_zero();
        let cosine = rectangle.normal.dot(d).abs();
        prop_assume!(cosine > 1e-3);
        // Where the ray meets the plane: the target, moved by the roundings of the places and the direction.
        let reach = origin.length() + center.length() + (target - origin).length() + width + height;
        let moved = 32.0 * EPSILON * reach / cosine;
        let inside = ((1.0 - x.abs()) * width).min((1.0 - y.abs()) * height);
        match rectangle.intersect(origin, d, f64::INFINITY) {
            Some((t, _, s, r)) => {
                prop_assert!(inside >= -moved);
                prop_assert!((t - (target - origin).length()).abs() <= moved, "t {}", t);
                // Edges at right angles to one rounding; coordinates are relative to each edge.
                let right = |s: f64, x: f64, half: f64| (s - (0.5 + 0.5 * x)).abs() <= moved / half + 1e-15;
                prop_assert!(x.abs() > 1.0 || right(s, x, width), "u {} at {}", s, x);
                prop_assert!(y.abs() > 1.0 || right(r, y, height), "v {} at {}", r, y);
            }
            None => prop_assert!(inside <= moved, "missed at {} {}", x, y),
        }
    }
}
