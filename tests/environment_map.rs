//! Skies that are pictures: orientation, density, closed forms, noise.

use crate::support::build::{Measure, assert_mean, diffuse, grey, moments, samples, scene, sky, square};
use pathtracer::math::{DVec3, Rgb};
use pathtracer::picture::{Decoded, Pixels};
use pathtracer::scene::desc::{EnvironmentMapDesc, PictureDesc, SceneDesc};
use pathtracer::world::{SkyKind, World};
use std::f64::consts::PI;
use std::sync::Arc;

const WIDTH: u32 = 64;
const HEIGHT: u32 = 32;

/// A picture of linear values, row by row from the top.
fn map(width: u32, height: u32, rgb: Vec<f32>) -> EnvironmentMapDesc {
    let picture = Decoded { width, height, pixels: Pixels::Floats(rgb), is_encoded: false };
    let picture = PictureDesc { file: "sky.exr".into(), picture: Arc::new(picture), is_encoded: false };
    EnvironmentMapDesc { picture, rotation: 0.0 }
}

/// A picture whose pixels are the grey `value` of column and row.
fn greys(value: impl Fn(u32, u32) -> f32) -> EnvironmentMapDesc {
    let pixels = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
    map(WIDTH, HEIGHT, pixels.flat_map(|(x, y)| [value(x, y); 3]).collect())
}

/// A white diffuse floor seen from above, under a map.
fn floor(map: EnvironmentMapDesc) -> SceneDesc {
    let objects = vec![(square(DVec3::ZERO, 1.0), diffuse(grey(1.0)))];
    let mut desc = scene(DVec3::new(-1.0, 0.0, 1.0), DVec3::ZERO, objects);
    desc.environment = sky(1.0);
    desc.environment_map = Some(map);
    desc
}

fn world(map: EnvironmentMapDesc) -> World {
    World::compile(&floor(map)).expect("a valid scene")
}

/// The direction of a point of the picture: from the left, from the top, in 0..1.
fn direction(u: f64, v: f64) -> DVec3 {
    let (azimuth, colatitude) = ((0.5 - u) * 2.0 * PI, v * PI);
    DVec3::new(colatitude.sin() * azimuth.cos(), colatitude.sin() * azimuth.sin(), colatitude.cos())
}

/// The middle of a pixel.
fn middle(x: u32, y: u32) -> DVec3 {
    direction((f64::from(x) + 0.5) / f64::from(WIDTH), (f64::from(y) + 0.5) / f64::from(HEIGHT))
}

#[test]
fn the_middle_column_is_plus_x_and_minus_y_is_to_its_right() {
    let map = greys(|x, y| (y * WIDTH + x) as f32);
    let seen = |d: DVec3| world(map.clone()).sky.radiance(d.normalize()).x;
    let at = |x: f64, y: f64| y * f64::from(WIDTH) + x;
    let near =
        |d: DVec3, expected: f64| assert!((seen(d) - expected).abs() < 1e-6, "{d}: {} {expected}", seen(d));
    // Column borders are at whole numbers, pixel values in the middle.
    near(DVec3::X, at(31.5, 15.5));
    near(DVec3::NEG_Y, at(47.5, 15.5));
    near(DVec3::Y, at(15.5, 15.5));
    // At the edges, between the last and the first column.
    near(DVec3::NEG_X, at(31.5, 15.5));
    for (x, y) in [(3, 0), (40, 31), (63, 17)] {
        near(middle(x, y), at(x.into(), y.into()));
    }
}

#[test]
fn a_rotation_turns_the_picture_about_z() {
    let still = greys(|x, y| (y * WIDTH + x) as f32);
    let turned = EnvironmentMapDesc { rotation: 90.0, ..still.clone() };
    let (still, turned) = (world(still), world(turned));
    // What was at +x is at +y.
    for (from, to) in [(DVec3::X, DVec3::Y), (DVec3::Y, DVec3::NEG_X)] {
        let seen = [still.sky.radiance(from).x, turned.sky.radiance(to).x];
        assert!((seen[0] - seen[1]).abs() < 1e-9, "{seen:?}");
    }
}

#[test]
fn a_constant_map_is_a_constant_sky() {
    let mut plain = floor(greys(|_, _| 0.75));
    plain.environment.strength = 2.0;
    assert_eq!(World::compile(&plain).expect("a scene").requires.sky, SkyKind::Constant);
    let mut constant = plain.clone();
    constant.environment_map = None;
    constant.environment = sky(1.5);
    let measure = Measure { samples: 100, bounces: 3, light_sampling: true };
    assert_eq!(samples(&plain, &measure), samples(&constant, &measure));
    assert_eq!(World::compile(&floor(greys(|_, _| 0.0))).expect("a scene").requires.sky, SkyKind::Black);
}

/// A map with a smooth part, a dark part and a sun.
fn varied() -> EnvironmentMapDesc {
    greys(|x, y| match (x, y) {
        (50, 5) => 1000.0,
        _ if y > 20 => 0.0,
        _ => 1.0 + (x as f32 * 0.3).sin(),
    })
}

#[test]
fn the_density_of_directions_integrates_to_one() {
    let world = world(varied());
    let steps = 8;
    let (columns, rows) = (WIDTH * steps, HEIGHT * steps);
    let mut sum = 0.0;
    for y in 0..rows {
        for x in 0..columns {
            let (u, v) = ((f64::from(x) + 0.5) / f64::from(columns), (f64::from(y) + 0.5) / f64::from(rows));
            sum += world.sky.pdf(direction(u, v)) * (v * PI).sin();
        }
    }
    let integral = sum * 2.0 * PI * PI / (f64::from(columns) * f64::from(rows));
    // The density times the sine is linear between the points of the rule but for its bends, which lie on its borders.
    assert!((integral - 1.0).abs() < 1e-6, "{integral}");
}

/// Sums over directions as they are sampled, of what their density says they stand for.
#[test]
fn directions_are_chosen_by_their_density() {
    let world = world(varied());
    let count = 400;
    let mut weights = 0.0;
    let mut counted = [0u64; 32];
    let mut expected = [0.0; 32];
    let cell = |d: DVec3| {
        let u = 0.5 - d.y.atan2(d.x) / (2.0 * PI);
        ((u * 8.0) as usize).min(7) * 4 + ((d.z.acos() / PI * 4.0) as usize).min(3)
    };
    for i in 0..count {
        for j in 0..count {
            let u = [i, j].map(|k| (f64::from(k) + 0.5) / f64::from(count));
            let (d, pdf) = world.sky.sample(u);
            assert!((d.length() - 1.0).abs() < 1e-12 && pdf > 0.0);
            assert_eq!(pdf, world.sky.pdf(d));
            counted[cell(d)] += 1;
            weights += world.sky.radiance(d).x / pdf;
        }
    }
    let steps = 16;
    let (columns, rows) = (WIDTH * steps, HEIGHT * steps);
    let mut light = 0.0;
    for y in 0..rows {
        for x in 0..columns {
            let (u, v) = ((f64::from(x) + 0.5) / f64::from(columns), (f64::from(y) + 0.5) / f64::from(rows));
            let d = direction(u, v);
            let solid_angle = 2.0 * PI * PI * (v * PI).sin() / (f64::from(columns) * f64::from(rows));
            expected[cell(d)] += world.sky.pdf(d) * solid_angle;
            light += world.sky.radiance(d).x * solid_angle;
        }
    }
    let total = f64::from(count * count);
    for (counted, expected) in counted.iter().zip(expected) {
        // A grid of 400 x 400 points misses a share by at most a few lines of points.
        assert!((*counted as f64 / total - expected).abs() < 6.0 / f64::from(count), "{counted} {expected}");
    }
    assert!((weights / total / light - 1.0).abs() < 1e-3, "{} {light}", weights / total);
}

/// One bright pixel is a tent in both angles: the irradiance of a floor is L sin cos times the tent's solid angle, where
/// the integral of sin 2a over a tent of half width D is sin 2a (sin D / D)^2.
#[test]
fn one_bright_pixel_lights_a_floor_as_a_distant_disc() {
    for y in [4, 9] {
        let desc = floor(greys(|x, row| if (x, row) == (20, y) { 1e5 } else { 0.0 }));
        let step = PI / f64::from(HEIGHT);
        let angle = (f64::from(y) + 0.5) * step;
        let area = step * 2.0 * PI / f64::from(WIDTH);
        let irradiance = 1e5 * 0.5 * (2.0 * angle).sin() * area * (step.sin() / step).powi(2);
        let measure = Measure { samples: 20_000, bounces: 2, light_sampling: true };
        assert_mean(&format!("row {y}"), &desc, &measure, irradiance / PI, 1e-2);
    }
}

#[test]
fn a_sun_of_one_pixel_converges_where_chance_does_not() {
    let desc = floor(greys(|x, y| if (x, y) == (20, 9) { 1e5 } else { 0.5 }));
    let measure = |light_sampling| Measure { samples: 100_000, bounces: 2, light_sampling };
    let (aimed, chance) = (moments(&desc, &measure(true)), moments(&desc, &measure(false)));
    let ratio = (chance.standard_error() / aimed.standard_error()).powi(2);
    println!("variance by chance / aimed: {ratio:.0}");
    // The sun has nearly all the light. Aimed samples vary with its cosine, by a share of its width; those by chance find
    // it in 1 of pi / (sin cos step^2) = 670 of cases.
    assert!(aimed.standard_error() / aimed.mean() < 0.2 / 100_000f64.sqrt(), "{}", aimed.standard_error());
    assert!(ratio > 670.0, "{ratio}");
    let allowed = 4.0 * (chance.standard_error() + aimed.standard_error());
    assert!((chance.mean() - aimed.mean()).abs() < allowed);
}

#[test]
fn a_coloured_map_keeps_its_colours() {
    let rgb: Vec<f32> = (0..8).flat_map(|i| [i as f32, 2.0 * i as f32, 0.5]).collect();
    let world = world(map(4, 2, rgb));
    let seen = world.sky.radiance(direction(0.625, 0.25));
    assert!((seen - Rgb::new(2.0, 4.0, 0.5)).abs().max_element() < 1e-9, "{seen}");
}
