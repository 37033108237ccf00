//! Pictures seen from afar: cones of rays, their footprints in pictures, smaller copies of pictures.

use crate::support::build::{ball, cuboid, diffuse, grey, mesh, placed, scene, sky, square};
use crate::support::random::Random;
use crate::support::watch::Unwatched;
use pathtracer::accel::{Accelerator, brute_force::BruteForce};
use pathtracer::geometry::{Hit, Ray};
use pathtracer::material::{Material, Pdf, Scatter};
use pathtracer::math::{DVec3, Rgb};
use pathtracer::picture::{Decoded, Pixels};
use pathtracer::render::{Settings, render};
use pathtracer::scene::desc::{MaterialKind, PictureDesc, SceneDesc, ShapeDesc};
use pathtracer::world::{Cone, Interaction, World};
use std::f64::consts::PI;
use std::sync::Arc;

/// A linear picture of greys, by column and row from the top.
fn picture(width: u32, height: u32, grey: impl Fn(u32, u32) -> f32) -> PictureDesc {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let pixels = Pixels::Floats(pixels.flat_map(|(x, y)| [grey(x, y); 3]).collect());
    let picture = Arc::new(Decoded { width, height, pixels, is_encoded: false });
    PictureDesc { file: "a.exr".into(), picture, is_encoded: false }
}

/// Squares of one pixel. All smaller copies are grey, so that the middle of a white pixel tells the detail from 0 to 1.
fn board(side: u32) -> PictureDesc {
    picture(side, side, |x, y| ((x + y) % 2) as f32)
}

fn world(shape: ShapeDesc, kind: MaterialKind, picture: PictureDesc) -> World {
    let mut desc = scene(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, vec![(shape, kind)]);
    desc.objects[0].material.textures.color = Some(picture);
    World::compile(&desc).expect("a valid scene")
}

/// Where a ray from `eye` through `target` meets the world.
fn met(world: &World, eye: DVec3, target: DVec3) -> (Ray, Hit, Interaction) {
    let ray = Ray::new(eye - world.origin, (target - eye).normalize());
    let hit = BruteForce::new(&world.geometry).intersect(&ray).expect("a hit");
    (ray, hit, world.interaction(&ray, &hit))
}

/// The colour of a white diffuse shape there, for a cone of this width.
fn seen(world: &World, eye: DVec3, target: DVec3, width: f64) -> f64 {
    let (_, hit, at) = met(world, eye, target);
    let Some(Material::Diffuse(diffuse)) = world.varied_material(&hit, &at, width) else {
        panic!("a varied material")
    };
    diffuse.color.x
}

/// A rectangle from (0, 0) to (width, height) in the plane z = 0, seen upright from above: u along x, v along y.
fn sheet(width: f64, height: f64, repeats: f32) -> ShapeDesc {
    let corners = vec![[0.0, 0.0, 0.0], [width, 0.0, 0.0], [width, height, 0.0], [0.0, height, 0.0]];
    let texcoords = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|uv| uv.map(|x: f32| x * repeats));
    with_texcoords(mesh(corners, vec![[0, 1, 2], [0, 2, 3]]), texcoords.to_vec())
}

fn with_texcoords(shape: ShapeDesc, texcoords: Vec<[f32; 2]>) -> ShapeDesc {
    let ShapeDesc::TriangleMesh { file, mesh, scale, position, rotation, axes, smooth } = shape else {
        panic!("a mesh")
    };
    let mut mesh = (*mesh).clone();
    mesh.texcoords = texcoords;
    mesh.texcoord_indices = mesh.triangles.clone();
    ShapeDesc::TriangleMesh { file, mesh: Arc::new(mesh), scale, position, rotation, axes, smooth }
}

/// The value in the middle of pixel (x, y), from the lower left, of the copy of half the size that often, of a picture whose
/// pixels are squares of the side 1 in the world.
fn copied(world: &World, (width, height): (u32, u32), [x, y]: [u32; 2], halves: u32) -> f64 {
    let size = [width, height].map(|side| f64::from((side >> halves).max(1)));
    let at = DVec3::new(
        (f64::from(x) + 0.5) / size[0] * f64::from(width),
        (f64::from(y) + 0.5) / size[1] * f64::from(height),
        0.0,
    );
    seen(world, at + DVec3::Z, at, f64::from(1 << halves))
}

#[test]
fn copies_keep_the_mean_of_the_picture_whatever_its_size() {
    let mut random = Random::new(1);
    for (width, height) in [(8, 8), (7, 5), (13, 1), (1, 6), (33, 20), (31, 63)] {
        let values: Vec<f32> = (0..width * height).map(|_| random.unit() as f32).collect();
        let mean = values.iter().map(|&x| f64::from(x)).sum::<f64>() / f64::from(width * height);
        let picture = picture(width, height, |x, y| values[(y * width + x) as usize]);
        let world = world(sheet(width.into(), height.into(), 1.0), diffuse(grey(1.0)), picture);
        for halves in 0..=width.max(height).ilog2() {
            let size = [width, height].map(|side| (side >> halves).max(1));
            let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
            let sum: f64 = pixels.map(|pixel| copied(&world, (width, height), pixel, halves)).sum();
            // Each copy rounds to f32; the place of a pixel's middle, on corners of f32, is right to 1e-6 of its size.
            let found = sum / f64::from(size[0] * size[1]);
            assert!((found - mean).abs() < 1e-5, "{width} x {height}, {halves}: {found} {mean}");
        }
    }
}

#[test]
fn a_pixel_of_a_copy_is_the_mean_of_what_it_covers() {
    // Five columns become two, of two and a half each; three rows one.
    let greys = [[0.1, 0.2, 0.3, 0.4, 0.5], [0.9, 0.8, 0.7, 0.6, 0.5], [0.2, 0.2, 0.2, 0.2, 0.2f32]];
    let picture = picture(5, 3, |x, y| greys[y as usize][x as usize]);
    let world = world(sheet(5.0, 3.0, 1.0), diffuse(grey(1.0)), picture);
    let columns = [0, 1, 2, 3, 4].map(|x| (0..3).map(|y| f64::from(greys[y][x])).sum::<f64>() / 3.0);
    let expected = [
        (columns[0] + columns[1] + 0.5 * columns[2]) / 2.5,
        (0.5 * columns[2] + columns[3] + columns[4]) / 2.5,
    ];
    for (x, expected) in expected.into_iter().enumerate() {
        let found = copied(&world, (5, 3), [x as u32, 0], 1);
        assert!((found - expected).abs() < 1e-6, "{x}: {found} {expected}");
    }
}

#[test]
fn between_two_sizes_colours_are_mixed_by_the_logarithm_of_the_width() {
    let picture = picture(16, 16, |x, y| ((x * 7 + y * 5) % 11) as f32 / 11.0);
    let world = world(sheet(16.0, 16.0, 1.0), diffuse(grey(1.0)), picture);
    let at = DVec3::new(3.3, 9.1, 0.0);
    let look = |width: f64| seen(&world, at + DVec3::Z, at, width);
    for halves in 0..4 {
        let (fine, coarse) = (look(2f64.powi(halves)), look(2f64.powi(halves + 1)));
        for share in [0.25, 0.5, 0.9] {
            let expected = fine + (coarse - fine) * share;
            let found = look((f64::from(halves) + share).exp2());
            assert!((found - expected).abs() < 1e-9, "{halves} {share}: {found} {expected}");
        }
    }
    // Magnified, the picture is what it is without a cone; beyond its whole size it is its mean.
    for width in [1e-9, 0.3, 1.0] {
        assert_eq!(look(width), look(0.0));
    }
    assert_eq!(look(16.0), look(1e9));
    assert_eq!(look(f64::NAN), look(0.0));
}

/// How much less than 1 the middle of a white pixel of a [`board`] is, times 2.
#[track_caller]
fn assert_detail(world: &World, eye: DVec3, target: DVec3, longest: f64) {
    // `longest` is the width of a cone whose footprint is as wide as a pixel.
    for detail in [-1.0, 0.0, 0.25, 0.5, 0.75, 1.0, 3.0] {
        let value = seen(world, eye, target, longest * f64::exp2(detail));
        let expected = 1.0 - 0.5 * detail.clamp(0.0, 1.0);
        // The place is found to 1e-6 of a picture of 64 pixels.
        assert!((value - expected).abs() < 2e-4, "{detail}: {value} instead of {expected}");
    }
}

#[test]
fn the_footprint_on_a_triangle_is_its_shorter_axis_in_pixels() {
    let mut random = Random::new(2);
    for trial in 0..20 {
        let mut point = || [0, 1, 2].map(|_| random.between(-3.0, 3.0));
        let corners = [point(), point(), point()];
        let mut uv = || [0, 1].map(|_| random.between(0.0, 1.0) as f32);
        let texcoords = [uv(), uv(), uv()];
        let [a, b, c] = corners.map(DVec3::from);
        let (ab, ac) = (b - a, c - a);
        let [p, q, r] = texcoords.map(|uv| uv.map(f64::from));
        let (s, t) = ([q[0] - p[0], q[1] - p[1]], [r[0] - p[0], r[1] - p[1]]);
        let turn = s[0] * t[1] - s[1] * t[0];
        // Thin triangles say little, and their axes are hard to find by trial.
        if turn.abs() < 0.1 || ab.cross(ac).length() < 2.0 {
            continue;
        }
        // By trial of directions in the plane: pixels along each.
        let (x, normal) = (ab.normalize(), ab.cross(ac).normalize());
        let y = normal.cross(x);
        let pixels = |angle: f64| {
            let d = x * angle.cos() + y * angle.sin();
            let area = ab.cross(ac).dot(normal);
            let (u, v) = (d.cross(ac).dot(normal) / area, ab.cross(d).dot(normal) / area);
            64.0 * (s[0] * u + t[0] * v).hypot(s[1] * u + t[1] * v)
        };
        let shortest =
            (0..20_000).map(|i| pixels(f64::from(i) * PI / 20_000.0)).fold(f64::INFINITY, f64::min);
        // The middle of a white pixel near the middle of the triangle.
        let middle = [0, 1].map(|i| ((p[i] + q[i] + r[i]) / 3.0 * 64.0).floor());
        // Rows count from the top: of 64 rows the lowest is odd.
        let is_white = (middle[0] as i64 + 63 - middle[1] as i64) % 2 == 1;
        let place = [(middle[0] + if is_white { 0.5 } else { 1.5 }) / 64.0, (middle[1] + 0.5) / 64.0];
        let d = [place[0] - p[0], place[1] - p[1]];
        let (u, v) = ((d[0] * t[1] - d[1] * t[0]) / turn, (s[0] * d[1] - s[1] * d[0]) / turn);
        if u.min(v).min(1.0 - u - v) < 0.01 {
            continue;
        }
        let target = a + ab * u + ac * v;
        let shape = with_texcoords(mesh(corners.to_vec(), vec![[0, 1, 2]]), texcoords.to_vec());
        // Alone, and as one of two copies that are twice as large.
        let alone = world(shape.clone(), diffuse(grey(1.0)), board(64));
        println!("{trial}: {shortest} pixels a unit");
        assert_detail(&alone, target + normal, target, 1.0 / shortest);
        let copies = [100.0, 0.0]
            .map(|x| (placed(shape.clone(), DVec3::new(x, 0.0, 0.0), 2.0, DVec3::ZERO), diffuse(grey(1.0))));
        let mut desc = scene(DVec3::Z, DVec3::ZERO, copies.into());
        desc.objects[1].material.textures.color = Some(board(64));
        let copied = World::compile(&desc).expect("a valid scene");
        assert_detail(&copied, (target + normal) * 2.0, target * 2.0, 2.0 / shortest);
    }
}

#[test]
fn the_footprint_on_solids_is_their_shorter_axis_in_pixels() {
    // 16 pixels along 8 and along 2 units: a footprint of one pixel along the longer side is half a unit.
    let rectangle =
        ShapeDesc::Rectangle { position: DVec3::ZERO, width: 8.0, height: 2.0, rotation: DVec3::ZERO };
    let white = diffuse(grey(1.0));
    let flat = world(rectangle, white.clone(), board(16));
    // The middle of the pixel right of and above the middle, towards -y and +z: column 8, row 7 from the top.
    let target = DVec3::new(0.0, -0.25, 0.0625);
    assert_detail(&flat, target - DVec3::X, target, 0.5);
    let block = world(cuboid(DVec3::ZERO, DVec3::new(2.0, 8.0, 4.0), DVec3::ZERO), white.clone(), board(16));
    for (out, beside, longest) in [
        (DVec3::X, DVec3::new(0.0, 0.25, 0.125), 0.5),
        (DVec3::Y * 4.0, DVec3::new(-0.0625, 0.0, 0.125), 0.25),
        (DVec3::Z * 2.0, DVec3::new(0.0625, -0.25, 0.0), 0.5),
    ] {
        assert_detail(&block, out * 2.0 + beside, out + beside, longest);
    }
    // Of a ball of radius 3: along the equator 3 pi in 8 rows, or 6 pi in 8 columns, which shrink towards the poles.
    let round = world(ball(DVec3::ZERO, 3.0), white, board(8));
    for (row, longest) in [(3, 6.0 * PI / 8.0 * (0.5 * PI * 0.125).cos()), (0, 3.0 * PI / 8.0)] {
        let (azimuth, colatitude) = (0.5 / 8.0 * 2.0 * PI, (f64::from(row) + 0.5) / 8.0 * PI);
        let column = if row % 2 == 1 { azimuth } else { 3.0 * azimuth };
        let out =
            DVec3::new(colatitude.sin() * column.cos(), colatitude.sin() * column.sin(), colatitude.cos());
        assert_detail(&round, out * 9.0, out * 3.0, longest);
    }
}

#[test]
fn a_cone_is_as_wide_as_its_part_of_a_pixel_on_a_plane_at_any_angle_and_never_wider() {
    let mut desc =
        scene(DVec3::new(-9.0, 2.0, 4.0), DVec3::ZERO, vec![(square(DVec3::ZERO, 4.0), diffuse(grey(1.0)))]);
    desc.camera.fov = 0.3;
    let world = World::compile(&desc).expect("a valid scene");
    for target in [DVec3::ZERO, DVec3::new(30.0, -4.0, 0.0), DVec3::new(-8.9, 2.1, 0.0)] {
        desc.camera.looking_at = target;
        let camera = world.camera(&desc.camera, 200, 120);
        for (x, y) in [(100.0, 60.0), (3.5, 100.5), (180.5, 80.5)] {
            let ray = |x: f64, y: f64| camera.ray(x, y, || [0.0; 2]);
            let (middle, cosine) = (ray(x, y), ray(x, y).direction.dot(camera.forward));
            let distance = |ray: &Ray| -(ray.origin.z + world.origin.z) / ray.direction.z;
            let point = |x: f64, y: f64| ray(x, y).at(distance(&ray(x, y)));
            let (across, down) = (
                (point(x + 0.01, y) - point(x - 0.01, y)) / 0.02,
                (point(x, y + 0.01) - point(x, y - 0.01)) / 0.02,
            );
            let shortest = (0..20_000)
                .map(|i| f64::from(i) * PI / 20_000.0)
                .map(|angle| (across * angle.cos() + down * angle.sin()).length())
                .fold(f64::INFINITY, f64::min);
            let width = camera.cone(middle.direction).at(distance(&middle)).width / Cone::CAMERA_PIXELS;
            // Off the axis a pixel is seen under angles that differ by the cosine.
            let slack = 1e-3;
            assert!(width <= shortest * (1.0 + slack), "{target} {x} {y}: {width} {shortest}");
            assert!(width >= shortest * cosine * (1.0 - slack), "{target} {x} {y}: {width} {shortest}");
        }
    }
}

/// The cone beyond a surface of this material, which turned a ray from `eye` to `target`.
fn beyond(shape: ShapeDesc, kind: MaterialKind, eye: DVec3, target: DVec3, pdf: Pdf) -> (Cone, f64) {
    let desc = scene(eye, target, vec![(shape, kind)]);
    let world = World::compile(&desc).expect("a valid scene");
    let (ray, hit, at) = met(&world, eye, target);
    let material = *world.material(hit.object);
    let scatter = match pdf {
        Pdf::Delta => {
            material.sample(-ray.direction, at.normal, at.entering, [0.99, 0.5, 0.5]).expect("above")
        }
        Pdf::SolidAngle(_) => Scatter { direction: at.normal, weight: Rgb::ONE, pdf },
    };
    let cone = Cone { width: 0.01, spread: 0.02 };
    (world.cone_beyond(cone, ray.direction, &at, &material, &scatter), ray.direction.dot(at.normal).abs())
}

#[test]
fn mirrors_and_glass_turn_cones_and_what_gathers_light_ends_them() {
    let mirror = MaterialKind::Reflective { color: grey(1.0), specularity: 1.0 };
    let glass = MaterialKind::Refractive { color: grey(1.0), ratio: 0.5 };
    let (above, below, inside) =
        (DVec3::new(0.3, 0.1, 5.0), DVec3::new(0.3, 0.1, -5.0), DVec3::new(0.3, 0.1, -0.5));
    let floor = || square(DVec3::ZERO, 9.0);
    let round = || ball(DVec3::ZERO, 2.0);
    let cone = |shape, kind: &MaterialKind, eye| beyond(shape, kind.clone(), eye, DVec3::ZERO, Pdf::Delta).0;
    assert_eq!(cone(floor(), &mirror, above), Cone { width: 0.01, spread: 0.02 });
    assert_eq!(cone(floor(), &glass, above), Cone { width: 0.01, spread: 0.01 });
    // From the back the ratio is that of glass by air; this steep it goes through.
    assert_eq!(cone(floor(), &glass, below), Cone { width: 0.01, spread: 0.04 });
    assert_eq!(cone(round(), &glass, above), Cone::LINE);
    assert_eq!(cone(round(), &mirror, inside), Cone::LINE);
    // Neighbouring normals of a ball of radius 2 turn by 0.01 / 2, and what they mirror by twice that times the cosine.
    let (convex, cosine) = beyond(round(), mirror, above, DVec3::new(0.2, 0.9, 0.0), Pdf::Delta);
    assert!((convex.spread - (0.02 + 0.01 * cosine)).abs() < 1e-15, "{convex:?} {cosine}");
    assert_eq!(convex.width, 0.01);
}

#[test]
fn rough_surfaces_spread_cones_by_their_lobe() {
    let spread = |pdf: f64| {
        let cone =
            beyond(square(DVec3::ZERO, 1.0), diffuse(grey(0.5)), DVec3::Z, DVec3::ZERO, Pdf::SolidAngle(pdf));
        cone.0.spread
    };
    // A Lambertian surface: a tenth, whatever the angle; a hundred times as narrow: a tenth of that.
    assert_eq!(spread(1.0 / PI), 0.1);
    assert_eq!(spread(1e-9), 0.1);
    assert!((spread(100.0 / PI) - 0.01).abs() < 1e-15);
}

fn rendered(desc: &SceneDesc, settings: &Settings) -> Vec<Rgb> {
    let world = World::compile(desc).expect("a valid scene");
    render(&world, &desc.camera, settings, &Unwatched).expect("a render").film.means().collect()
}

/// A floor of copies of a picture, ten a unit, under a constant sky of 1, seen from a height of one unit.
fn plain(picture: Option<PictureDesc>, color: Rgb) -> SceneDesc {
    let floor = placed(sheet(4000.0, 4000.0, 40_000.0), DVec3::new(-1.0, -2000.0, 0.0), 1.0, DVec3::ZERO);
    let mut desc = scene(DVec3::new(0.0, 0.5, 1.0), DVec3::ZERO, vec![(floor, diffuse(color))]);
    desc.objects[0].material.textures.color = picture;
    desc.environment = sky(1.0);
    // The upper edge of the picture is a little below the horizon.
    desc.camera.fov = 0.3;
    let pitch = libm::atan(libm::tan(0.15 * PI) * 0.75) + 0.004;
    desc.camera.looking_at = desc.camera.position + DVec3::new(pitch.cos(), 0.0, -pitch.sin());
    desc
}

#[test]
fn a_checkerboard_up_to_the_horizon_has_the_mean_of_its_squares() {
    let picture = picture(2, 2, |x, y| if (x + y) % 2 == 0 { 0.9 } else { 0.1 });
    let desc = plain(Some(picture), grey(1.0));
    let pixels = rendered(&desc, &Settings::new(64, 48, 4, 2));
    // The first row begins at 0.018 radians below the horizon, 55 units away, where a quarter of a pixel of 0.014
    // radians is wider than a copy: there it is one colour, the mean of f32 values.
    let mean = f64::from(0.9f32) * 0.5 + f64::from(0.1f32) * 0.5;
    for pixel in &pixels[..64] {
        assert!((pixel.x - mean).abs() < 1e-7, "{pixel}");
    }
    // Near by, where a pixel is half as wide as a square, it shows its squares.
    assert!(pixels[64 * 47..].iter().any(|pixel| (pixel.x - mean).abs() > 0.1));
}

#[test]
fn cones_do_not_change_the_mean_of_what_is_seen() {
    let squares = picture(8, 8, |x, y| if (x / 2 + y / 2) % 2 == 0 { 0.9 } else { 0.1 });
    let desc = plain(Some(squares), grey(1.0));
    let world = World::compile(&desc).expect("a valid scene");
    let camera = world.camera(&desc.camera, 64, 48);
    let accelerator = BruteForce::new(&world.geometry);
    const STEPS: u32 = 8;
    let (mut sums, mut squares) = ([0.0, 0.0], 0.0);
    let count = f64::from(64 * 48 * STEPS * STEPS);
    for (x, y) in (0..48 * STEPS).flat_map(|y| (0..64 * STEPS).map(move |x| (x, y))) {
        let place = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
        let ray = camera.ray(place(x), place(y), || [0.0; 2]);
        let hit = accelerator.intersect(&ray).expect("a hit");
        let at = world.interaction(&ray, &hit);
        let color = |width: f64| match world.varied_material(&hit, &at, width) {
            Some(Material::Diffuse(diffuse)) => diffuse.color.x,
            _ => panic!("a varied material"),
        };
        let colors = [color(0.0), color(camera.cone(ray.direction).at(hit.t).width)];
        let difference = colors[1] - colors[0];
        squares += difference * difference;
        sums = [sums[0] + colors[0], sums[1] + colors[1]];
    }
    // Differences have the mean 0, and this spread.
    let error = (squares / count / count).sqrt();
    assert!(error > 0.0);
    assert!(((sums[1] - sums[0]) / count).abs() < 4.0 * error, "{sums:?} {error}");
}

#[test]
fn a_picture_of_one_colour_is_that_colour_to_the_last_bit() {
    // f32 holds the colour, whatever it is; sizes that are no powers of two.
    let color = 0.3f32;
    let settings = Settings::new(48, 32, 8, 4);
    let textured = plain(Some(picture(11, 7, |_, _| color)), grey(1.0));
    assert!(rendered(&textured, &settings) == rendered(&plain(None, grey(color.into())), &settings));
}

#[test]
fn a_scene_with_textures_says_so() {
    let requires = World::compile(&plain(Some(board(2)), grey(1.0))).expect("a valid scene").requires;
    assert!(requires.to_string().contains("1 texture with mip maps"), "{requires}");
}
