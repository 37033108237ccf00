//! Lights that lie on other surfaces: rays that are aimed at them see what paths see.
//!
//! Every mean is found with light sampling and without. The two differ by less than four standard errors of the
//! difference, of samples that are independent.

use super::{Named, accelerators};
use crate::support::build::*;
use crate::support::stats::Moments;
use pathtracer::accel::Precision;
use pathtracer::integrator::{Counters, PathTracer};
use pathtracer::math::DVec3;
use pathtracer::sampling::{Independent, Sampler};
use pathtracer::scene::desc::{MaterialKind, SceneDesc, ShapeDesc};
use pathtracer::world::World;

type Objects = Vec<(ShapeDesc, MaterialKind)>;

/// The floor at the origin, with these objects above it.
fn above_floor(objects: Objects) -> SceneDesc {
    let mut all = vec![(square(DVec3::ZERO, 1e-3), diffuse(grey(1.0)))];
    all.extend(objects);
    scene(DVec3::new(-1e-4, 0.0, 1e-4), DVec3::ZERO, all)
}

fn lamp(radiance: f64) -> MaterialKind {
    glowing(grey(0.0), grey(radiance))
}

fn dark() -> MaterialKind {
    diffuse(grey(0.0))
}

fn traced(world: &World, desc: &SceneDesc, accelerator: &Named<'_>, bounces: u32, aimed: bool) -> Moments {
    let camera = world.camera(&desc.camera, 1, 1);
    let tracer = PathTracer::new(world, &camera, accelerator, bounces, aimed);
    let sampler = Independent::new(11 + u64::from(aimed));
    let mut counters = Counters::default();
    Moments::of((0..SAMPLES).map(|index| tracer.sample(&sampler, 0, 0, index, &mut counters).x))
}

const SAMPLES: u64 = 40_000;

/// Both ways agree with each accelerator at exact and robust; the mean by aiming of the first, which is exact.
fn agreed(what: &str, desc: &SceneDesc, bounces: u32) -> f64 {
    let world = World::compile(desc).expect("a valid scene");
    let mut first = None;
    for precision in [Precision::Exact, Precision::Robust] {
        for named in accelerators(&world.geometry, precision) {
            let [aimed, met] = [true, false].map(|aimed| traced(&world, desc, &named, bounces, aimed));
            let apart = aimed.mean() - met.mean();
            let error = aimed.standard_error().hypot(met.standard_error());
            assert!(
                apart.abs() <= 4.0 * error + 1e-12,
                "{what}, {}: {} by aiming, {} without, standard error {error:e}",
                named.name,
                aimed.mean(),
                met.mean()
            );
            first.get_or_insert(aimed.mean());
        }
    }
    first.expect("an accelerator")
}

/// The kinds of lamps, large above the floor, so that paths meet them often by themselves.
fn lamps() -> [(&'static str, ShapeDesc); 4] {
    let at = DVec3::new(0.2, -0.1, 1.0);
    let corners = [[-1.0, -1.0, 1.0], [1.2, -0.9, 1.2], [0.1, 1.3, 0.9]];
    [
        ("rectangle", square(at, 1.5)),
        ("ball", ball(at, 0.6)),
        ("box", cuboid(at, DVec3::new(0.8, 1.0, 0.6), DVec3::new(10.0, 20.0, 30.0))),
        ("face", mesh(corners.to_vec(), vec![[0, 1, 2]])),
    ]
}

/// What is seen is the first of them, as if the others were not there: the means differ by the noise of both, of which
/// each is below 1 %.
#[test]
fn of_equal_lamps_the_first_alone_lights_a_floor() {
    for (name, shape) in lamps() {
        let one = agreed(name, &above_floor(vec![(shape.clone(), lamp(1.0))]), 2);
        assert!(one > 0.1);
        for copies in [2, 5, 1000] {
            let first = std::iter::once((shape.clone(), lamp(1.0)));
            let others = (1..copies).map(|_| (shape.clone(), lamp(3.0)));
            let mean = agreed(&format!("{copies} x {name}"), &above_floor(first.chain(others).collect()), 2);
            assert!((mean / one - 1.0).abs() < 0.05, "{copies} x {name}: {mean}, one alone {one}");
        }
    }
}

#[test]
fn equal_faces_of_a_mesh_light_a_floor_as_one() {
    let corners = vec![[-1.0, -1.0, 1.0], [1.2, -0.9, 1.2], [0.1, 1.3, 0.9]];
    let faces = |count| above_floor(vec![(mesh(corners.clone(), vec![[0, 1, 2]; count]), lamp(1.0))]);
    let one = agreed("one face", &faces(1), 2);
    let thousand = agreed("a thousand faces", &faces(1000), 2);
    assert!((thousand / one - 1.0).abs() < 0.05, "{thousand}, one alone {one}");
    // The same triangle, begun at another corner: its distance is rounded otherwise.
    let turned = mesh(corners.clone(), vec![[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1]]);
    let turned = agreed("turned faces", &above_floor(vec![(turned, lamp(1.0))]), 2);
    assert!((turned / one - 1.0).abs() < 0.05, "{turned}, one alone {one}");
}

#[test]
fn a_dark_surface_that_is_equal_to_a_lamp_hides_it_if_it_comes_first() {
    for (name, shape) in lamps() {
        let one = agreed(name, &above_floor(vec![(shape.clone(), lamp(1.0))]), 2);
        let (lamp, cover) = ((shape.clone(), lamp(1.0)), (shape, dark()));
        let hidden = agreed(name, &above_floor(vec![cover.clone(), lamp.clone()]), 2);
        assert_eq!(hidden, 0.0, "{name} behind a dark one");
        let seen = agreed(name, &above_floor(vec![lamp, cover]), 2);
        assert!((seen / one - 1.0).abs() < 0.05, "{name} before a dark one: {seen}, alone {one}");
    }
}

#[test]
fn a_lamp_flush_with_a_ceiling_is_met_if_it_comes_first() {
    let ceiling = || (square(DVec3::Z, 8.0), dark());
    let lamp = || (square(DVec3::new(0.2, -0.1, 1.0), 1.0), lamp(1.0));
    let alone = agreed("alone", &above_floor(vec![lamp()]), 2);
    assert_eq!(agreed("ceiling first", &above_floor(vec![ceiling(), lamp()]), 2), 0.0);
    let first = agreed("lamp first", &above_floor(vec![lamp(), ceiling()]), 2);
    assert!((first / alone - 1.0).abs() < 0.05, "{first}, alone {alone}");
}

/// Of longer paths: points of a white surface where a lamp lies on it have the lamp at no distance, on either side.
#[test]
fn a_lamp_sheds_no_light_on_the_surface_that_hides_it() {
    for front in [90.0, -90.0] {
        let flat = |z: f64, side: f64, material| {
            let rotation = DVec3::new(0.0, front, 0.0);
            let position = DVec3::new(0.0, 0.0, z);
            (ShapeDesc::Rectangle { position, width: side, height: side, rotation }, material)
        };
        let ceiling = || flat(1.0, 6.0, diffuse(grey(0.75)));
        let box_lamp = (cuboid(DVec3::Z * 1.25, DVec3::new(1.0, 1.0, 0.5), DVec3::ZERO), lamp(1.0));
        for (name, hidden) in [("rectangle", flat(1.0, 1.5, lamp(1.0))), ("box", box_lamp)] {
            for height in [0.0, 0.3] {
                let mut desc = above_floor(vec![ceiling(), hidden.clone()]);
                // A floor that sends on what the ceiling does; elsewhere than at the middle of all.
                desc.objects[0].shape = square(DVec3::Z * height, 4.0);
                desc.camera.position = DVec3::new(-0.3, 0.2, height + 0.5);
                desc.camera.looking_at = DVec3::new(0.1, 0.05, height);
                let what = format!("{name}, front {front}, floor at {height}");
                let mean = agreed(&what, &desc, 5);
                // What goes round the ceiling, of the box above it.
                assert!(name == "box" || mean == 0.0, "{what}: {mean}");
            }
        }
    }
}

/// Where roundings decide which of two surfaces is met, they decide alike for rays that are aimed.
#[test]
fn lamps_that_are_flush_with_something_else_are_seen_as_they_are_met() {
    let turn = DVec3::new(12.0, 71.0, 33.0);
    let turned = |width, height| ShapeDesc::Rectangle { position: DVec3::Z, width, height, rotation: turn };
    let quad = |z: f64, half: f64| {
        let corners = vec![[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]];
        mesh(corners, vec![[0, 1, 2], [0, 2, 3]])
    };
    let slab = cuboid(DVec3::new(0.0, 0.0, 1.25), DVec3::new(1.1, 1.3, 0.5), DVec3::ZERO);
    let shown_twice = quad(1.0, 0.6);
    let again = placed(shown_twice.clone(), DVec3::new(0.0, 0.0, 9.0), 1.0, DVec3::ZERO);
    let pairs: Vec<(&str, Objects, Objects)> = vec![
        ("turned", vec![(turned(1.0, 0.7), lamp(1.0))], vec![(turned(5.0, 4.0), dark())]),
        ("two lamps", vec![(turned(1.0, 0.7), lamp(1.0))], vec![(turned(0.5, 2.0), lamp(4.0))]),
        ("mesh in a ceiling", vec![(quad(1.0, 0.7), lamp(1.0))], vec![(square(DVec3::Z, 8.0), dark())]),
        (
            "in a ceiling of triangles",
            vec![(square(DVec3::Z, 1.0), lamp(1.0))],
            vec![(quad(1.0, 4.0), dark())],
        ),
        ("box", vec![(slab, lamp(1.0))], vec![(square(DVec3::Z, 0.8), dark())]),
        ("instances", vec![(square(DVec3::Z, 1.0), lamp(1.0))], vec![(shown_twice, dark()), (again, dark())]),
        (
            "in the middle of a million",
            vec![(turned(1.0, 0.7), lamp(1.0))],
            vec![(turned(5.0, 4.0), dark()), (ball(DVec3::Z * -1e6, 1e6 - 1.0), dark())],
        ),
    ];
    for (name, lamps, others) in pairs {
        for order in [[&lamps, &others], [&others, &lamps]] {
            agreed(name, &above_floor(order.into_iter().flatten().cloned().collect()), 2);
        }
    }
}

#[test]
fn light_by_way_of_equal_balls_is_that_by_way_of_one() {
    for glass in [true, false] {
        let material = || match glass {
            true => MaterialKind::Refractive { color: grey(1.0), ratio: 1.0 / 1.5 },
            false => MaterialKind::Reflective { color: grey(0.9), specularity: 1.0 },
        };
        let shape = ball(DVec3::new(0.1, 0.0, 0.5), 0.3);
        let light = || (square(DVec3::Z * 1.5, 1.5), lamp(1.0));
        let balls = |count| {
            let balls = (0..count).map(|_| (shape.clone(), material()));
            above_floor(balls.chain([light(), light()]).collect())
        };
        let (one, two) = (agreed("one ball", &balls(1), 7), agreed("two balls", &balls(2), 7));
        assert!((two / one - 1.0).abs() < 0.05, "glass {glass}: {two}, by way of one {one}");
    }
}
