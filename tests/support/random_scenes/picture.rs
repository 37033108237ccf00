//! Small pictures of every format that is read, of bytes and floats.

use super::Random;
use half::f16;
use image::{DynamicImage, GrayImage, RgbaImage};
use pathtracer::picture::{Depth, Destination, Pixels};
use std::path::Path;

/// What is written by this program; the last three need OpenImageIO.
const WRITTEN: [(&str, Depth); 7] = [
    ("png", Depth::Eight),
    ("png", Depth::Sixteen),
    ("exr", Depth::Float),
    ("exr", Depth::Half),
    ("tif", Depth::Sixteen),
    ("jpg", Depth::Eight),
    ("hdr", Depth::Float),
];

/// A picture of a colour; values above 1 are allowed. Its name.
pub(super) fn texture(folder: &Path, number: usize, random: &mut Random) -> String {
    let stem = format!("texture{number}");
    let (width, height) = (1 + random.index(24) as u32, 1 + random.index(24) as u32);
    match random.index(4) {
        0 => grey(folder, &stem, width, height, random),
        1 => transparent(folder, &stem, width, height, random),
        _ => written(folder, &stem, (width, height), 1.2, random),
    }
}

/// A picture of the sky, maybe with a sun. Its name.
pub(super) fn sky(folder: &Path, random: &mut Random) -> String {
    let (width, height) = (1 + random.index(40) as u32, 1 + random.index(20) as u32);
    let most = if random.chance(0.3) { random.power(0.0, 5.0) } else { 2.0 };
    written(folder, "sky", (width, height), most, random)
}

fn written(folder: &Path, stem: &str, (width, height): (u32, u32), most: f64, random: &mut Random) -> String {
    let index = random.index(WRITTEN.len());
    let has_library = cfg!(feature = "oiio");
    let (extension, depth) = WRITTEN[if has_library { index } else { index % 4 }];
    let values = values(3 * (width * height) as usize, most, random);
    let name = format!("{stem}.{extension}");
    let place = Destination::new(&folder.join(&name)).expect("a place");
    place.write(width, height, &pixels(depth, &values)).expect("a picture");
    name
}

/// One value everywhere, few bright ones, or any.
fn values(count: usize, most: f64, random: &mut Random) -> Vec<f64> {
    let (kind, all) = (random.index(4), random.unit());
    let mut value = || match kind {
        0 => all,
        1 if random.chance(0.95) => 0.0,
        1 => most,
        _ => random.between(0.0, most),
    };
    (0..count).map(|_| value()).collect()
}

fn pixels(depth: Depth, values: &[f64]) -> Pixels {
    let share = |value: &f64| value.min(1.0);
    match depth {
        Depth::Eight => Pixels::Bytes(values.iter().map(|value| (share(value) * 255.0) as u8).collect()),
        Depth::Sixteen => Pixels::Words(values.iter().map(|value| (share(value) * 65535.0) as u16).collect()),
        Depth::Half => Pixels::Halves(values.iter().map(|value| f16::from_f64(value.min(65504.0))).collect()),
        Depth::Float => Pixels::Floats(values.iter().map(|&value| value as f32).collect()),
    }
}

fn grey(folder: &Path, stem: &str, width: u32, height: u32, random: &mut Random) -> String {
    let picture = GrayImage::from_fn(width, height, |_, _| image::Luma([random.bits() as u8]));
    save(folder, stem, DynamicImage::from(picture))
}

fn transparent(folder: &Path, stem: &str, width: u32, height: u32, random: &mut Random) -> String {
    let picture = RgbaImage::from_fn(width, height, |_, _| image::Rgba((random.bits() as u32).to_le_bytes()));
    save(folder, stem, DynamicImage::from(picture))
}

fn save(folder: &Path, stem: &str, picture: DynamicImage) -> String {
    let name = format!("{stem}.png");
    picture.save(folder.join(&name)).expect("a picture");
    name
}
