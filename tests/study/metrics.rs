//! Distances between pictures: known answers.

use crate::support::random::Random;
use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8};
use pathtracer::picture::byte_values;
use pathtracer::study::metrics::{Pair, trimmed_mean};

fn pair<'p>(picture: &'p [f32], reference: &'p [f32], width: usize) -> Pair<'p> {
    Pair::new(picture, reference, width, picture.len() / 3 / width).expect("pictures of one size")
}

#[test]
fn errors_of_two_pixels_are_those_of_the_definition() {
    let (picture, reference) = ([0.5, 0.0, 2.0, 1.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0, 3.0, 1.0]);
    let pair = pair(&picture, &reference, 2);
    // All values are exact in f32; the sums round in the last bits of f64.
    assert!((pair.mse() - (0.25 + 1.0 + 4.0) / 6.0).abs() < 1e-15);
    let relative = 0.25 / 0.01 + 1.0 / 1.01 + 4.0 / 9.01;
    assert!((pair.rel_mse() - relative / 6.0).abs() < 1e-14);
    assert!((pair.bias() - (5.5 / 6.0 - 1.0)).abs() < 1e-15);
}

#[test]
fn the_trimmed_error_leaves_out_one_pixel_in_a_thousand() {
    // 2000 pixels are off by 1 beside 0, and two of them by 100.
    let mut picture = vec![1.0f32; 6000];
    picture[300..306].fill(100.0);
    let reference = vec![0.0f32; 6000];
    let pair = pair(&picture, &reference, 50);
    assert!((pair.trimmed_rel_mse() - 100.0).abs() < 1e-9, "{}", pair.trimmed_rel_mse());
    assert!(pair.rel_mse() > 1000.0);
    assert_eq!(trimmed_mean(vec![7.0]), 7.0);
}

#[test]
fn a_pixel_that_is_no_number_is_not_left_out() {
    let reference = vec![0.5f32; 6000];
    for fault in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut picture = reference.clone();
        picture[301] = fault;
        assert!(!pair(&picture, &reference, 50).trimmed_rel_mse().is_finite(), "{fault}");
        assert!(!pair(&reference, &picture, 50).trimmed_rel_mse().is_finite(), "{fault}");
    }
}

#[test]
fn pictures_of_other_sizes_are_refused() {
    assert!(Pair::new(&[0.0; 6], &[0.0; 3], 1, 2).is_err());
    assert!(Pair::new(&[0.0; 6], &[0.0; 6], 3, 1).is_err());
    assert!(Pair::new(&[], &[], 0, 4).is_err());
}

/// A colourful picture, and one with a darker red, a white square and a few dark pixels.
fn colourful(changed: bool) -> Vec<f32> {
    let (width, height) = (32, 20);
    let mut values = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let mut pixel = [
                (x as f32 + 0.5) / width as f32,
                (y as f32 + 0.5) / height as f32,
                ((x * 7 + y * 3) % 16) as f32 / 15.0,
            ];
            if changed {
                pixel[0] *= 0.8;
                if (10..14).contains(&x) && (5..9).contains(&y) {
                    pixel = [1.0; 3];
                }
                if (x * 37 + y * 101 + 13) % 256 % 29 == 0 {
                    pixel = [0.0, 0.0, 0.25];
                }
            }
            values.extend(pixel);
        }
    }
    values
}

#[test]
fn flip_of_equal_pictures_is_zero() {
    let picture = colourful(false);
    assert!(pair(&picture, &picture, 32).flip().iter().all(|&value| value == 0.0));
}

#[test]
fn flip_agrees_with_its_authors_program() {
    let (picture, reference) = (colourful(true), colourful(false));
    let map = pair(&picture, &reference, 32).flip();
    let mean = map.iter().map(|&value| f64::from(value)).sum::<f64>() / map.len() as f64;
    // From `flip-evaluator` 1.7 on these pictures. It computes in f32: colours of up to 100 to 1e-5, and the root of a
    // difference of features, which are near 1, to sqrt(1e-7).
    assert!((mean - 0.286_636_05).abs() < 1e-4, "{mean}");
    for (x, y, value) in
        [(0, 0, 0.139_194_43), (12, 7, 0.834_195_6), (31, 19, 0.319_620_82), (16, 10, 0.349_181_18)]
    {
        assert!((f64::from(map[y * 32 + x]) - value).abs() < 1e-3, "{x} {y}: {}", map[y * 32 + x]);
    }
}

/// Smooth colours with noise, of bytes.
fn bytes(seed: u64, (width, height): (u32, u32)) -> Vec<u8> {
    let mut random = Random::new(seed);
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let values = pixels.flat_map(|(x, y)| {
        let wave = |k: f64| 120.0 + 80.0 * (k * f64::from(x) * 0.07 + f64::from(y) * 0.05).sin();
        [wave(1.0), wave(1.7), wave(-0.6)]
    });
    values.map(|value| (value + random.between(-30.0, 30.0)).clamp(0.0, 255.0) as u8).collect()
}

#[test]
fn flip_agrees_with_its_authors_library_on_every_pixel_of_bytes() {
    let table = byte_values(true);
    for (seed, size) in [(1, (96, 64)), (2, (61, 45)), (3, (300, 40))] {
        let pictures = [bytes(seed, size), bytes(seed + 10, size)];
        let [ours, other] = pictures
            .each_ref()
            .map(|bytes| bytes.iter().map(|&byte| table[usize::from(byte)]).collect::<Vec<f32>>());
        let [picture, reference] =
            pictures.each_ref().map(|bytes| FlipImageRgb8::with_data(size.0, size.1, bytes));
        let expected = nv_flip::flip(reference, picture, DEFAULT_PIXELS_PER_DEGREE).to_vec();
        let map = pair(&ours, &other, size.0 as usize).flip();
        let mean = |map: &[f32]| map.iter().map(|&x| f64::from(x)).sum::<f64>() / map.len() as f64;
        println!("means {} and {}", mean(&map), mean(&expected));
        // Theirs is in f32, as above.
        assert!((mean(&map) - mean(&expected)).abs() < 1e-4, "{} {}", mean(&map), mean(&expected));
        let farthest = map.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(farthest < 1e-3, "{farthest}");
    }
}

#[test]
fn flip_is_symmetric_and_light_beyond_white_is_not_seen() {
    let (a, b) = (colourful(true), colourful(false));
    assert_eq!(pair(&a, &b, 32).flip(), pair(&b, &a, 32).flip());
    let (white, brighter) = (vec![1.0f32; 300], vec![7.0f32; 300]);
    assert!(pair(&white, &brighter, 10).flip().iter().all(|&value| value == 0.0));
}
