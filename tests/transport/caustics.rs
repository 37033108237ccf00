//! Light by way of smooth balls: aimed at or found by chance, it is the same light.

use crate::support::build::*;
use crate::support::stats::Moments;
use pathtracer::math::DVec3;
use pathtracer::picture::{Decoded, Pixels};
use pathtracer::scene::desc::{MaterialKind, PictureDesc, SceneDesc, ShapeDesc};
use std::sync::Arc;

fn glass(ratio: f64) -> MaterialKind {
    MaterialKind::Refractive { color: grey(0.9), ratio }
}

fn mirror() -> MaterialKind {
    MaterialKind::Reflective { color: grey(0.8), specularity: 1.0 }
}

/// A spot of a floor at the origin, seen from the side, with `objects` around it.
fn spot(mut objects: Vec<(ShapeDesc, MaterialKind)>) -> SceneDesc {
    objects.push((square(DVec3::ZERO, 1e-3), diffuse(grey(0.7))));
    scene(DVec3::new(-1e-4, 0.0, 1e-4), DVec3::ZERO, objects)
}

fn measured(desc: &SceneDesc, bounces: u32, light_sampling: bool) -> Moments {
    moments(desc, &Measure { samples: 2_000_000, bounces, light_sampling })
}

/// Aims at light and waits for it; the means must agree within four standard errors of their difference, which must be
/// below `width` of the mean.
fn assert_same_light(what: &str, desc: &SceneDesc, bounces: u32, width: f64) {
    let (aimed, met) = (measured(desc, bounces, true), measured(desc, bounces, false));
    let error = aimed.standard_error().hypot(met.standard_error());
    assert!(error < width * met.mean(), "{what}: standard error {error}, mean {}", met.mean());
    let z = (aimed.mean() - met.mean()) / error;
    assert!(z.abs() < 4.0, "{what}: {} aimed at, {} met, z = {z}", aimed.mean(), met.mean());
}

/// A ball between the spot and a light that is not straight above it.
fn ball_below(light: ShapeDesc, material: MaterialKind) -> SceneDesc {
    spot(vec![(ball(DVec3::new(0.1, -0.05, 1.0), 0.5), material), (light, glowing(grey(0.0), grey(3.0)))])
}

#[test]
fn every_shape_of_light_shines_through_a_glass_ball() {
    let at = DVec3::new(0.5, 0.3, 3.0);
    let corners = vec![[0.0, -0.5, 2.5], [1.0, -0.4, 3.0], [0.3, 0.8, 2.8]];
    let lights = [
        ("rectangle", square(at, 1.0)),
        ("ball", ball(at, 0.5)),
        ("box", cuboid(at, DVec3::new(0.8, 0.6, 0.7), DVec3::new(10.0, 20.0, 30.0))),
        ("mesh", mesh(corners, vec![[0, 1, 2]])),
    ];
    for (what, light) in lights {
        assert_same_light(what, &ball_below(light, glass(1.0 / 1.5)), 6, 1e-2);
    }
}

#[test]
fn glass_of_any_ratio_below_one_shines() {
    for ratio in [0.3, 0.42, 0.9, 0.999] {
        let light = ball(DVec3::new(0.8, 0.3, 3.0), 0.6);
        assert_same_light(&format!("ratio {ratio}"), &ball_below(light, glass(ratio)), 8, 1e-2);
    }
}

#[test]
fn a_mirror_ball_and_glass_reflect_light_from_their_side() {
    for (what, material) in [("mirror", mirror()), ("glass", glass(0.6))] {
        let light = ball(DVec3::new(2.0, 0.3, 1.0), 0.5);
        let desc = spot(vec![
            (ball(DVec3::new(-0.8, 0.1, 0.7), 0.5), material),
            (light, glowing(grey(0.0), grey(3.0))),
        ]);
        assert_same_light(what, &desc, 4, 1e-2);
    }
}

#[test]
fn light_comes_by_way_of_several_balls_of_which_one_is_in_the_way() {
    let desc = spot(vec![
        (ball(DVec3::new(0.0, 0.0, 0.8), 0.4), glass(0.7)),
        (ball(DVec3::new(0.9, 0.2, 0.6), 0.4), mirror()),
        (ball(DVec3::new(-0.9, 0.2, 0.7), 0.5), glass(0.6)),
        (ball(DVec3::new(0.2, 0.1, 1.5), 0.2), diffuse(grey(0.5))),
        (ball(DVec3::new(0.5, 0.3, 3.0), 0.6), glowing(grey(0.0), grey(3.0))),
        (square(DVec3::new(-1.0, 0.0, 2.5), 0.8), glowing(grey(0.0), grey(2.0))),
    ]);
    assert_same_light("several", &desc, 8, 1e-2);
}

#[test]
fn a_ball_around_the_spot_and_one_with_a_light_inside_are_left_to_chance() {
    let around = spot(vec![
        (ball(DVec3::new(0.0, 0.0, 0.3), 1.0), glass(0.7)),
        (ball(DVec3::new(0.5, 0.3, 3.0), 0.6), glowing(grey(0.0), grey(3.0))),
    ]);
    assert_same_light("around the spot", &around, 8, 1e-2);
    let inside = spot(vec![
        (ball(DVec3::new(0.1, 0.0, 1.0), 0.6), glass(0.7)),
        (ball(DVec3::new(0.2, 0.1, 1.1), 0.2), glowing(grey(0.0), grey(3.0))),
    ]);
    assert_same_light("a light inside", &inside, 8, 1e-2);
}

#[test]
fn a_limit_of_bounces_cuts_the_same_paths() {
    let light = ball(DVec3::new(0.5, 0.3, 3.0), 0.6);
    for bounces in [3, 4, 5] {
        let desc = ball_below(light.clone(), glass(1.0 / 1.5));
        if bounces == 3 {
            // Only reflections are so short, and here there is nothing to reflect: straight light through the ball needs
            // four segments.
            let aimed = measured(&desc, bounces, true);
            assert!(aimed.mean() == 0.0, "{}", aimed.mean());
        } else {
            assert_same_light(&format!("{bounces} bounces"), &desc, bounces, 1e-2);
        }
    }
}

#[test]
fn balls_with_a_picture_as_their_colour_are_left_to_chance() {
    let light = ball(DVec3::new(0.5, 0.3, 3.0), 0.6);
    let mut desc = ball_below(light, glass(1.0 / 1.5));
    let rgb = [0.2f32, 0.9, 0.5, 0.7].into_iter().flat_map(|value| [value; 3]).collect();
    let picture = Decoded { width: 2, height: 2, pixels: Pixels::Floats(rgb), is_encoded: false };
    let picture = PictureDesc { file: "a.exr".into(), picture: Arc::new(picture), is_encoded: false };
    desc.objects[0].material.textures.color = Some(picture);
    assert_same_light("a picture", &desc, 6, 2e-2);
}

#[test]
fn small_lights_through_glass_make_no_fireflies() {
    // Met by chance, a sample in a hundred thousand is as bright as the light. Aimed at, none is brighter than a few
    // times the mean: a tenth of the variance is far from either.
    let desc = ball_below(ball(DVec3::new(0.1, -0.05, 4.0), 0.02), glass(1.0 / 1.5));
    let (aimed, met) = (measured(&desc, 4, true), measured(&desc, 4, false));
    assert!(
        aimed.standard_error() * 3.0 < met.standard_error(),
        "{} against {}",
        aimed.standard_error(),
        met.standard_error()
    );
}
