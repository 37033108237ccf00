//! Pictures as colours of surfaces.

use super::extent::Extent;
use crate::math::Rgb;
use crate::picture::{Decoded, Pixels, byte_values};
use crate::scene::desc::PictureDesc;
use rayon::prelude::*;
use std::sync::Arc;

/// A picture that is looked up between its pixels, repeated in both directions, and between copies of it that are ever
/// smaller by half.
#[derive(Clone, Debug)]
pub(super) struct Texture {
    picture: Arc<Decoded>,
    /// Linear values of bytes.
    bytes: Box<[f32; 256]>,
    /// Linear values where the file has no bytes.
    floats: Vec<f32>,
    /// From half the size to one pixel.
    smaller: Vec<Level>,
}

/// A smaller copy of a picture.
#[derive(Clone, Debug)]
struct Level {
    size: [u32; 2],
    /// Linear.
    rgb: Vec<f32>,
}

/// Bytes that the texture of a picture takes beside the picture: values that are no bytes as floats, and a third as many
/// for the smaller copies.
pub fn texture_bytes(desc: &PictureDesc) -> u64 {
    let values = 3 * u64::from(desc.picture.width) * u64::from(desc.picture.height);
    let floats = match desc.picture.pixels {
        Pixels::Bytes(_) => 0,
        _ => values,
    };
    (floats + values / 3) * size_of::<f32>() as u64
}

impl Texture {
    /// The picture of a scene. Values above 1 count as 1.
    pub(super) fn new(desc: &PictureDesc) -> Texture {
        let floats = match desc.picture.pixels {
            Pixels::Bytes(_) => Vec::new(),
            _ => desc.picture.to_linear(desc.is_encoded).into_iter().map(|value| value.min(1.0)).collect(),
        };
        let bytes = Box::new(byte_values(desc.is_encoded));
        let mut texture = Texture { picture: desc.picture.clone(), bytes, floats, smaller: Vec::new() };
        while texture.size(texture.smaller.len()) != [1, 1] {
            texture.smaller.push(texture.halved(texture.smaller.len()));
        }
        texture
    }

    /// The colour at (u, v), (0, 0) being the lower left corner of the picture and (1, 1) the upper right one, as seen by
    /// what is as large as `extent`: between the two copies whose pixels are next to its shorter axis in size. What is
    /// smaller than a pixel sees the picture itself.
    pub(super) fn at(&self, place: [f64; 2], extent: &Extent) -> Rgb {
        let pixels = extent.shorter_axis(self.size(0));
        // It may be no number.
        let detail = if pixels > 1.0 { libm::log2(pixels).min(self.smaller.len() as f64) } else { 0.0 };
        let (level, share) = (detail as usize, detail - detail.floor());
        let fine = self.between(level, place);
        if share == 0.0 { fine } else { fine + (self.between(level + 1, place) - fine) * share }
    }

    /// The colour between the four nearest pixels.
    fn between(&self, level: usize, [u, v]: [f64; 2]) -> Rgb {
        let [width, height] = self.size(level);
        let (left, right, across) = neighbours(u, width);
        // Rows count downwards.
        let (upper, lower, down) = neighbours(1.0 - v, height);
        // Written so that equal pixels give their colour to the last bit.
        let row = |y: u32| {
            let first = self.pixel(level, left, y);
            first + (self.pixel(level, right, y) - first) * across
        };
        let first = row(upper);
        first + (row(lower) - first) * down
    }

    /// Width and height of the picture, or of one of its smaller copies from 1 on.
    fn size(&self, level: usize) -> [u32; 2] {
        match level.checked_sub(1) {
            None => [self.picture.width, self.picture.height],
            Some(index) => self.smaller[index].size,
        }
    }

    fn pixel(&self, level: usize, x: u32, y: u32) -> Rgb {
        let first = 3 * (y as usize * self.size(level)[0] as usize + x as usize);
        let floats = match (level.checked_sub(1), &self.picture.pixels) {
            (Some(index), _) => &self.smaller[index].rgb,
            (None, Pixels::Bytes(bytes)) => {
                let value = |i: usize| f64::from(self.bytes[usize::from(bytes[first + i])]);
                return Rgb::new(value(0), value(1), value(2));
            }
            (None, _) => &self.floats,
        };
        Rgb::new(floats[first].into(), floats[first + 1].into(), floats[first + 2].into())
    }

    /// A copy of half the size, rounded down: each pixel is the mean of what it covers, so that the mean of all stays.
    fn halved(&self, level: usize) -> Level {
        let [width, height] = self.size(level);
        let size = [width, height].map(|side| (side / 2).max(1));
        let mut rgb = vec![0.0; 3 * size[0] as usize * size[1] as usize];
        rgb.par_chunks_exact_mut(3 * size[0] as usize).zip(0..size[1]).for_each(|(row, y)| {
            for (pixel, x) in row.chunks_exact_mut(3).zip(0..size[0]) {
                let across = |y: u32| mean(x, width, |x| self.pixel(level, x, y));
                pixel.copy_from_slice(&mean(y, height, across).as_vec3().to_array());
            }
        });
        Level { size, rgb }
    }
}

/// The mean of what pixel `index` of a line of half as many covers of a line of `count`: two pixels, or of an odd number
/// parts of three. The weights are whole numbers, so that the mean of equal values of f32 is exact.
fn mean(index: u32, count: u32, value: impl Fn(u32) -> Rgb) -> Rgb {
    let (first, half) = (2 * index, count / 2);
    match count {
        1 => value(0),
        _ if count.is_multiple_of(2) => (value(first) + value(first + 1)) * 0.5,
        _ => {
            let weights = [half - index, half, index + 1].map(f64::from);
            let sum =
                value(first) * weights[0] + value(first + 1) * weights[1] + value(first + 2) * weights[2];
            sum / f64::from(count)
        }
    }
}

/// The two pixels of a line of `count` between whose middles the coordinate `t` lies, and the second one's share.
fn neighbours(t: f64, count: u32) -> (u32, u32, f64) {
    // A coordinate of a file may be huge, or come out as NaN where such ones are interpolated.
    let place = (t - t.floor()) * f64::from(count) - 0.5;
    let first = place.floor();
    let share = if place.is_finite() { place - first } else { 0.0 };
    let index = first as i64;
    let wrapped = |index: i64| index.rem_euclid(count.into()) as u32;
    (wrapped(index), wrapped(index + 1), share)
}
