//! What is switched to nothing is not there: coats of probability 0, lenses of radius 0; a ball of glass with a ratio of 1,
//! but for two bounces a crossing.

use super::room::room;
use super::{kinds, picture, small};
use crate::support::build::*;
use pathtracer::math::DVec3;
use pathtracer::render::Settings;
use pathtracer::scene::desc::{ApertureDesc, EnvironmentDesc, MaterialKind, SceneDesc};

/// Both scenes give the same bytes, and another one others.
fn assert_equal_pictures(one: &SceneDesc, same: &SceneDesc, other: &SceneDesc) {
    for accel in kinds() {
        let settings = Settings { accel, ..small(48, 36, 8, 8) };
        let expected = picture(one, &settings);
        assert!(picture(same, &settings) == expected, "{accel:?}");
        assert!(picture(other, &settings) != expected, "{accel:?}: it can't be seen");
    }
}

/// The room with a material for everything that is white.
fn painted(kind: MaterialKind) -> SceneDesc {
    let mut desc = room(1.0);
    let white = diffuse(grey(0.75));
    desc.objects.iter_mut().filter(|o| o.material.kind == white).for_each(|o| o.material.kind = kind.clone());
    desc
}

#[test]
fn a_coat_of_probability_zero_is_the_base() {
    let color = grey(0.625);
    let coat =
        |coat| painted(MaterialKind::ClearCoat { color, coat, coat_color: grey(0.5), specularity: 0.5 });
    assert_equal_pictures(&painted(diffuse(color)), &coat(0.0), &coat(0.25));
}

#[test]
fn a_lens_of_radius_zero_is_a_pinhole() {
    let with = |aperture| {
        let mut desc = room(1.0);
        desc.camera.aperture = aperture;
        desc
    };
    let [pinhole, zero] = [ApertureDesc::DepthOfField(0.0), ApertureDesc::Radius(0.0)].map(with);
    assert_equal_pictures(&pinhole, &zero, &room(1.0));
}

/// A point of a floor below a sky and a light, seen through the ball if it is there; light comes through it as well as
/// beside it. What the light emits from is black, so that no path has more than two segments without the ball.
fn desc(with_ball: bool) -> SceneDesc {
    let mut objects = vec![
        (square(DVec3::ZERO, 4.0), diffuse(grey(0.75))),
        (
            cuboid(DVec3::new(0.6, 0.2, 3.0), DVec3::new(1.5, 1.5, 0.1), DVec3::ZERO),
            glowing(grey(0.0), grey(3.0)),
        ),
    ];
    if with_ball {
        let nothing = MaterialKind::Refractive { color: grey(1.0), ratio: 1.0 };
        objects.push((ball(DVec3::Z, 0.5), nothing));
    }
    let mut desc = scene(DVec3::new(-1.2, 0.1, 2.4), DVec3::ZERO, objects);
    desc.environment =
        EnvironmentDesc { sky: grey(1.0), horizon: grey(0.5), ground: grey(0.25), strength: 1.0 };
    desc
}

/// The path to the floor and the one from there may each cross the ball.
fn assert_not_there(width: f64) {
    for light_sampling in [false, true] {
        let mean = |with_ball: bool, samples| {
            let bounces = if with_ball { 2 + 2 * 2 } else { 2 };
            moments(&desc(with_ball), &Measure { samples, bounces, light_sampling })
        };
        let pair = [false, true].map(|with_ball| {
            let pilot = mean(with_ball, 100_000);
            let error = width * pilot.mean();
            mean(with_ball, (1.5 * pilot.variance() / (error * error)) as u64)
        });
        let [without, with] = pair;
        for moments in pair {
            let (mean, error) = (moments.mean(), moments.standard_error());
            assert!(error < width * mean, "standard error {error:e} of {mean}");
        }
        let z = (with.mean() - without.mean()) / with.standard_error().hypot(without.standard_error());
        assert!(z.abs() < 4.0, "z {z}: {} instead of {}", with.mean(), without.mean());
    }
}

#[test]
fn a_ball_of_ratio_one_changes_no_mean_by_a_thousandth() {
    assert_not_there(1e-3);
}

#[test]
#[ignore = "minutes: a standard error of 1e-4"]
fn a_ball_of_ratio_one_changes_no_mean_by_a_ten_thousandth() {
    assert_not_there(1e-4);
}
