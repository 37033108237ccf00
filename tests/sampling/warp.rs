use crate::support::random::Sample4;
use crate::support::stats::{SIGNIFICANCE, chi_square, sidak};
use pathtracer::math::DVec3;
use pathtracer::sampling::{Independent, Sampler, warp};
use std::f64::consts::TAU;

const SAMPLES: u64 = 1 << 20;
const RINGS: usize = 40;
const SECTORS: usize = 80;

fn squares() -> impl Iterator<Item = [f64; 2]> {
    let sampler = Independent::new(17);
    let pixel = sampler.pixel(0, 0);
    (0..SAMPLES).map(move |i| {
        let [a, b, ..] = sampler.sample4(pixel, i, 0);
        [a, b]
    })
}

/// Corners, edges and the middle of the square, and the last number below 1.
fn odd_squares() -> Vec<[f64; 2]> {
    let values = [0.0, 2f64.powi(-53), 0.5, 1f64.next_down()];
    values.iter().flat_map(|&a| values.map(|b| [a, b])).collect()
}

/// The p-value of points given by a height in [0, 1) and an azimuth against `density` of the height, which is per
/// unit of height over all azimuths and linear, so that the middle of a ring stands for it.
fn rings_and_sectors(points: impl Iterator<Item = (f64, f64, f64)>, density: impl Fn(f64) -> f64) -> f64 {
    let mut counts = vec![0; RINGS * SECTORS];
    for (height, x, y) in points {
        let ring = ((height * RINGS as f64) as usize).min(RINGS - 1);
        let azimuth = libm::atan2(y, x) / TAU + 0.5;
        let sector = ((azimuth * SECTORS as f64) as usize).min(SECTORS - 1);
        counts[ring * SECTORS + sector] += 1;
    }
    let cell = SAMPLES as f64 / (RINGS * SECTORS) as f64;
    let expected: Vec<f64> =
        (0..RINGS * SECTORS).map(|i| cell * density(((i / SECTORS) as f64 + 0.5) / RINGS as f64)).collect();
    let total: f64 = expected.iter().sum();
    assert!((total / SAMPLES as f64 - 1.0).abs() < 1e-12, "the density integrates to {total} / {SAMPLES}");
    chi_square(&counts, &expected)
}

#[test]
fn the_disk_is_uniform() {
    // Height r^2, with area pi a unit.
    let points = squares().map(warp::square_to_disk).map(|[x, y]| (x * x + y * y, x, y));
    assert!(rings_and_sectors(points, |_| 1.0) > SIGNIFICANCE);
}

#[test]
fn the_hemisphere_has_the_density_of_the_cosine() {
    // Height z, with solid angle 2 pi a unit.
    let points = squares().map(warp::square_to_cosine_hemisphere).map(|d| (d.z, d.x, d.y));
    assert!(rings_and_sectors(points, |z| warp::cosine_hemisphere_pdf(z) * TAU) > SIGNIFICANCE);
}

#[test]
fn the_hemisphere_has_no_density_below_the_horizon() {
    assert_eq!(warp::cosine_hemisphere_pdf(-0.5), 0.0);
    assert!(squares().all(|u| warp::square_to_cosine_hemisphere(u).z > 0.0));
}

#[test]
fn cones_of_any_width_are_uniform() {
    let widths = [2.0, 1.0, 0.3, 1e-3, 1e-8, 1e-16, 1e-30];
    for width in widths {
        // Height (1 - z) / width, with solid angle 2 pi width a unit; 1 - z from the sine, where it is small.
        let points = squares().map(|u| warp::square_to_cone(u, width)).map(|d| {
            let one_minus_z = if d.z > 0.0 { (d.x * d.x + d.y * d.y) / (1.0 + d.z) } else { 1.0 - d.z };
            (one_minus_z / width, d.x, d.y)
        });
        let p = rings_and_sectors(points, |_| warp::cone_pdf(width) * TAU * width);
        assert!(p > sidak(SIGNIFICANCE, widths.len()), "width {width}: p = {p}");
    }
}

#[test]
fn the_triangle_is_uniform() {
    // Both barycentric coordinates in 40 parts make 1600 small triangles of equal area.
    let parts = 40;
    let mut counts = vec![0; 2 * parts * parts];
    let mut areas = vec![0.0; 2 * parts * parts];
    for i in 0..parts {
        for j in 0..parts - i {
            areas[2 * (i * parts + j)] = 0.5 / (parts * parts) as f64;
            if i + j + 1 < parts {
                areas[2 * (i * parts + j) + 1] = 0.5 / (parts * parts) as f64;
            }
        }
    }
    for [a, b] in squares().map(warp::square_to_triangle) {
        let (i, j) = ((a * parts as f64) as usize, (b * parts as f64) as usize);
        let upper = (a * parts as f64).fract() + (b * parts as f64).fract() >= 1.0;
        counts[2 * (i * parts + j) + usize::from(upper)] += 1;
    }
    let expected: Vec<f64> = areas.iter().map(|area| area / 0.5 * SAMPLES as f64).collect();
    assert!((expected.iter().sum::<f64>() / SAMPLES as f64 - 1.0).abs() < 1e-12);
    assert!(chi_square(&counts, &expected) > SIGNIFICANCE);
}

#[test]
fn a_wrong_density_is_noticed() {
    // Uniform points against the density of the cosine on the hemisphere, and a disk squeezed by a thousandth.
    let uniform = squares().map(|u| warp::square_to_cone(u, 1.0)).map(|d| (d.z, d.x, d.y));
    assert!(rings_and_sectors(uniform, |z| warp::cosine_hemisphere_pdf(z) * TAU) < 1e-100);
    let squeezed = squares().map(warp::square_to_disk).map(|[x, y]| (0.99 * (x * x + y * y), x, y));
    assert!(rings_and_sectors(squeezed, |_| 1.0) < 1e-100);
}

#[test]
fn directions_are_unit_vectors() {
    // Sums of three squares, each with a few roundings, and the series of sine and cosine: 8 units of 2^-53.
    let error = |d: DVec3| (d.length_squared() - 1.0).abs();
    let bound = 8.0 * f64::EPSILON;
    for u in squares().take(100_000).chain(odd_squares()) {
        assert!(error(warp::square_to_cosine_hemisphere(u)) < bound, "{u:?}");
        for width in [2.0, 1.5, 0.1, 1e-9] {
            assert!(error(warp::square_to_cone(u, width)) < bound, "{u:?} {width}");
        }
    }
}

#[test]
fn the_border_of_the_square_stays_in_the_shape() {
    for u in odd_squares() {
        let [x, y] = warp::square_to_disk(u);
        assert!(x * x + y * y <= 1.0 + 4.0 * f64::EPSILON, "{u:?}");
        assert!(warp::square_to_cosine_hemisphere(u).z >= 0.0, "{u:?}");
        let [a, b] = warp::square_to_triangle(u);
        assert!(a >= 0.0 && b >= 0.0 && a + b <= 1.0, "{u:?}");
    }
}
