//! A ball as large as the ground, against the same formulas in double-double arithmetic.

use super::{accelerators, traced, watertight_accelerators};
use crate::support::build::*;
use crate::support::double_double::DoubleDouble;
use crate::support::random::Random;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{Ball, Geometry, Ray, Shape, Solid};
use pathtracer::math::DVec3;
use pathtracer::scene::desc::{SceneDesc, ShapeDesc};
use pathtracer::world::World;

const RADII: [f64; 5] = [1e3, 1e4, 1e5, 1e6, 1e7];
const EYE: f64 = 1.5;
const ROWS: u32 = 1000;

fn dd(x: f64) -> DoubleDouble {
    DoubleDouble::from(x)
}

/// A ground that touches the origin from below.
fn ground(radius: f64) -> Geometry {
    let ball = Ball { center: DVec3::new(0.0, 0.0, -radius), radius };
    Geometry::new(vec![Solid { object: 0, shape: Shape::Ball(ball) }], &[])
}

/// Directions to points of the ground in a vertical plane, in equal steps of the horizontal distance, from straight down to
/// 99.9 % of the distance of the horizon.
fn column(radius: f64, azimuth: f64) -> Vec<Ray> {
    let (sin, cos) = libm::sincos(azimuth);
    // Where a line from the eye touches the ball.
    let horizon = radius * libm::sqrt(EYE * (2.0 * radius + EYE)) / (radius + EYE);
    let ray = |row: u32| {
        let x = 0.999 * horizon * f64::from(row) / f64::from(ROWS - 1);
        let depth = x * x / (radius + libm::sqrt((radius - x) * (radius + x)));
        Ray::new(DVec3::new(0.0, 0.0, EYE), DVec3::new(x * cos, x * sin, -depth - EYE).normalize())
    };
    (0..ROWS).map(ray).collect()
}

/// The nearer distance, with the direction taken as it is, not as a unit vector.
fn reference(ray: &Ray, radius: f64) -> f64 {
    let [x, y, z] = ray.direction.to_array().map(dd);
    let height = dd(EYE) + dd(radius);
    let a = x * x + y * y + z * z;
    let b = -(height * z);
    let c = (height - dd(radius)) * (height + dd(radius));
    (c / (b + (b * b - a * c).sqrt())).to_f64()
}

#[test]
fn distances_positions_and_normals_are_those_of_double_double() {
    let mut random = Random::new(91);
    for radius in RADII {
        let geometry = ground(radius);
        for accelerator in accelerators(&geometry, Precision::Exact) {
            for _ in 0..5 {
                let mut last = DVec3::Z;
                for ray in column(radius, random.between(0.0, std::f64::consts::TAU)) {
                    let hit = accelerator.intersect(&ray).expect("the ground is there");
                    let t = reference(&ray, radius);
                    assert!((hit.t / t - 1.0).abs() < 1e-6, "R {radius}: t {} instead of {t}", hit.t);
                    let point = geometry.surface(&ray, &hit);
                    let x = point.position.truncate().length();
                    let depth = (dd(radius) * dd(radius) - dd(x) * dd(x)).sqrt() - dd(radius);
                    let error = (dd(point.position.z) - depth).to_f64().abs();
                    assert!(error < 1e-6 * (1.0 + x), "R {radius}: z is wrong by {error:e} at {x}");
                    // Bands would show as normals that stand still or go back.
                    // Near the top z is 1 less its rounding.
                    let turned = point.normal.truncate().length();
                    assert!(
                        turned >= last.truncate().length() && point.normal.z <= last.z + f64::EPSILON,
                        "R {radius} at {x}"
                    );
                    last = point.normal;
                }
            }
        }
    }
}

/// A ball of radius 1 on the ground and a light above both, seen from beside the contact.
fn resting(ground: ShapeDesc, aim: DVec3) -> SceneDesc {
    let objects = vec![
        (ground, diffuse(grey(1.0))),
        (ball(DVec3::Z, 1.0), diffuse(grey(1.0))),
        (ball(DVec3::new(0.0, 0.0, 20.0), 1.0), glowing(grey(0.0), grey(1000.0))),
    ];
    let eye = DVec3::new(-2.0, 0.0, 0.2);
    scene(eye, aim, objects)
}

/// The ball hides the whole light from every point of the ground within 0.5 of the contact (the cone that touches both
/// balls of radius 1 is a cylinder of radius 1) and from its own lower half.
fn assert_dark_below(what: &str, ground: impl Fn() -> ShapeDesc) {
    for i in 0..60 {
        // From 1e-6 to 0.3 from the contact: the gap under the ball there is half of the square of it.
        let distance = libm::pow(10.0, -6.0 + 5.5 * f64::from(i) / 60.0);
        let on_ball = libm::sqrt((1.0 - distance) * (1.0 + distance));
        let aims = [DVec3::new(-distance, 0.0, 0.0), DVec3::new(-distance, 0.0, 1.0 - on_ball)];
        for aim in aims {
            let desc = resting(ground(), aim);
            let world = World::compile(&desc).expect("a valid scene");
            for accelerator in watertight_accelerators(&world.geometry) {
                let light = traced(&world, &desc, &accelerator, 64, 2);
                let lit = light.iter().find(|&&x| x != 0.0);
                assert_eq!(lit, None, "{what}, {}: light at {aim}", accelerator.name);
            }
        }
    }
}

#[test]
fn no_light_gets_below_a_ball_on_a_ground_ball() {
    for radius in RADII {
        assert_dark_below(&format!("R {radius}"), || ball(DVec3::new(0.0, 0.0, -radius), radius));
    }
}

#[test]
fn no_light_gets_below_a_ball_on_a_large_floor() {
    assert_dark_below("rectangle", || square(DVec3::ZERO, 2e6));
    let corners = vec![[-1e6, -1e6, 0.0], [1e6, -1e6, 0.0], [1e6, 1e6, 0.0], [-1e6, 1e6, 0.0]];
    assert_dark_below("mesh", || mesh(corners.clone(), vec![[0, 1, 2], [0, 2, 3]]));
}

/// A mesh on a ball of radius 1e7: the ground must not widen or move the mesh's own space.
#[test]
fn a_mesh_on_a_ball_of_radius_1e7_is_hit_as_without_it() {
    use crate::support::meshes;
    let mesh = meshes::moved(meshes::sphere(1.0, 60, 0.05, 3), DVec3::Z * 1.1);
    let ball = Ball { center: DVec3::new(0.0, 0.0, -1e7), radius: 1e7 };
    let solids = vec![Solid { object: 1, shape: Shape::Ball(ball) }];
    let alone = Geometry::new(Vec::new(), std::slice::from_ref(&mesh));
    let both = Geometry::new(solids, &[mesh]);
    let mut random = Random::new(92);
    for (one, other) in
        accelerators(&alone, Precision::Exact).iter().zip(accelerators(&both, Precision::Exact))
    {
        for _ in 0..100_000 {
            let origin = random.direction() * random.between(3.0, 30.0);
            let origin = DVec3::new(origin.x, origin.y, origin.z.abs());
            let ray = Ray::new(origin, (random.in_cube() + DVec3::Z * 1.1 - origin).normalize());
            let (hit, with_ground) = (one.intersect(&ray), other.intersect(&ray));
            if hit.is_some() {
                assert_eq!(hit, with_ground, "{}", one.name);
            } else {
                assert!(with_ground.is_none_or(|hit| hit.object == 1), "{}", one.name);
            }
        }
    }
}
