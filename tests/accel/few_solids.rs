//! Few solids are tried several at a time, without a tree, more by a tree: the hits are those of one after the other.

#[cfg(feature = "embree")]
use pathtracer::accel::BuildOptions;
use pathtracer::accel::Precision;
use pathtracer::accel::brute_force::BruteForce;
#[cfg(feature = "embree")]
use pathtracer::accel::embree::Embree;
use pathtracer::geometry::{Ball, Cuboid, Geometry, PrimitiveId, Ray, Rectangle, Shape, Solid};
use pathtracer::math::{DMat3, DVec3};

use super::every_isa;
use crate::support::compare::assert_identical;
use crate::support::random::Random;

/// A ball, box or rectangle of some size, which the random number chooses, or one of the kind asked for.
fn shape(random: &mut Random, kind: usize) -> Shape {
    let center = random.in_cube() * 2.0;
    let size = libm::exp(random.between(-4.0, 1.0));
    let turn =
        DMat3::from_rotation_y(random.between(0.0, 6.0)) * DMat3::from_rotation_z(random.between(0.0, 6.0));
    // A third stand along the axes, where rays meet edges and corners exactly.
    let turn = if random.index(3) == 0 { DMat3::IDENTITY } else { turn };
    let side = |random: &mut Random| size * random.between(0.1, 1.0);
    match kind {
        0 => Shape::Ball(Ball { center, radius: size }),
        1 => {
            let half = DVec3::new(side(random), side(random), side(random));
            Shape::Cuboid(Cuboid { center, half, rotation: turn })
        }
        _ => {
            let (u, v) = (turn * DVec3::X * side(random), turn * DVec3::Y * side(random));
            Shape::Rectangle(Rectangle::new(center, u, v))
        }
    }
}

/// A point of a shape that rays are aimed at: inside, on an edge, at a corner or on the diagonal.
fn target(random: &mut Random, shape: &Shape) -> DVec3 {
    let step = |random: &mut Random| [-1.0, -0.5, 0.0, 0.5, 1.0][random.index(5)];
    let (a, b, c) = (step(random), step(random), step(random));
    match shape {
        Shape::Ball(ball) => ball.center + DVec3::new(a, b, c).normalize_or_zero() * ball.radius,
        Shape::Cuboid(cuboid) => cuboid.center + cuboid.rotation * (cuboid.half * DVec3::new(a, b, c)),
        Shape::Rectangle(r) => r.center + 0.5 * (a * r.edge_u + b * r.edge_v),
        Shape::Instance(_) => DVec3::ZERO,
    }
}

/// Rays of every kind among some shapes: at random, aimed, along the axes, leaving one of them, into it and away.
fn rays(random: &mut Random, solids: &[Solid], count: usize) -> Vec<Ray> {
    let one = |random: &mut Random| {
        let origin = random.in_cube() * if random.index(8) == 0 { 1e5 } else { 3.0 };
        let Some(solid) = (!solids.is_empty()).then(|| random.index(solids.len())) else {
            return Ray::new(origin, random.direction());
        };
        let aim = target(random, &solids[solid].shape);
        match random.index(4) {
            0 => Ray::new(origin, random.direction()),
            1 => {
                let axis = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X][random.index(4)];
                Ray::new(aim - axis * random.between(0.0, 4.0), axis)
            }
            2 => Ray {
                leaving: PrimitiveId::solid(solid as u32),
                inward: false,
                ..Ray::new(aim, random.direction())
            },
            _ => {
                let way = (aim - origin).normalize_or_zero();
                let inward = random.index(4) == 0;
                let leaving = if inward { PrimitiveId::solid(solid as u32) } else { PrimitiveId::NONE };
                Ray { leaving, inward, ..Ray::new(origin, way) }
            }
        }
    };
    (0..count).map(|_| one(random)).collect()
}

/// Compares every accelerator with brute force; kinds of shapes are taken in turn from `kinds`.
fn assert_all_agree(seed: u64, count: usize, kinds: &[usize]) {
    let mut random = Random::new(seed);
    let solid = |object| Solid { object, shape: shape(&mut random, kinds[object as usize % kinds.len()]) };
    let solids: Vec<Solid> = (0..count as u32).map(solid).collect();
    let rays = rays(&mut random, &solids, 2000);
    let geometry = Geometry::new(solids, &[]);
    let oracle = BruteForce::new(&geometry);
    for kernel in every_isa(&geometry, Precision::Exact) {
        let what = format!("{count} of {kinds:?}, native {:?}", kernel.isa());
        assert_identical(&what, &oracle, &kernel, &rays);
    }
    #[cfg(feature = "embree")]
    {
        let kernel = Embree::build(&geometry, &BuildOptions::default()).expect("Embree");
        assert_identical(&format!("{count} of {kinds:?}, Embree"), &oracle, &kernel, &rays);
    }
}

#[test]
fn any_number_of_any_shapes_gets_the_hits_of_brute_force() {
    for count in 0..=24 {
        for (seed, kinds) in [&[0][..], &[1], &[2], &[0, 1, 2], &[2, 2, 0, 1]].into_iter().enumerate() {
            assert_all_agree(100 * count as u64 + seed as u64, count, kinds);
        }
    }
}

/// Rays that lie in a rectangle but for the rounding of its normal meet it somewhere, and a tree must not look elsewhere.
#[test]
fn solids_in_a_tree_get_the_hits_of_brute_force() {
    for count in [25, 40, 100] {
        for (seed, kinds) in [&[0][..], &[1], &[2], &[0, 1, 2], &[2, 2, 0, 1]].into_iter().enumerate() {
            for round in 0..4 {
                assert_all_agree(1000 * round + 100 * count as u64 + seed as u64, count, kinds);
            }
        }
    }
}
