//! A picture on its way to the window, with all that can be asked about it.

use crate::film::{BLOCK, relative_weight};
use crate::gui::document::Loaded;
use crate::math::Rgb;
use crate::picture::{Decoded, Samples};
use crate::render::{FeatureKind, FeaturePlanes, Settings};
use crate::scene::edit::Editable;
use crate::world::World;
use std::sync::Arc;

/// The picture after a pass.
pub struct Frame {
    /// The number of its order.
    pub job: u64,
    /// Whether it is smaller than what was ordered.
    pub is_coarse: bool,
    /// Linear light, row by row from the top left.
    pub light: Vec<Rgb>,
    /// The render, with the size of the picture.
    pub settings: Settings,
    /// Samples that every pixel has, or the most that one has.
    pub samples: u64,
    /// The standard error of the mean of each pixel's components; `None` while nothing is known.
    pub errors: Option<Arc<Vec<f32>>>,
    /// What is known of the errors of blocks.
    pub blocks: Option<Arc<BlockErrors>>,
    /// Samples of each pixel where blocks have stopped.
    pub counts: Option<Vec<u32>>,
    /// What is seen beside the light.
    pub look: Option<Arc<Look>>,
    /// The scene that was rendered.
    pub loaded: Arc<Loaded>,
    /// What it said then.
    pub editable: Arc<Editable>,
    /// The scene, compiled.
    pub world: Arc<World>,
}

impl Frame {
    /// A picture of a file, of which only the light is known, beside another frame.
    pub fn of_picture(picture: &Decoded, like: &Frame) -> Frame {
        let values = picture.to_linear(picture.is_encoded);
        let light = values.as_chunks::<3>().0.iter().map(|rgb| Rgb::from_array(rgb.map(f64::from)));
        Frame {
            job: 0,
            is_coarse: false,
            light: light.collect(),
            settings: Settings { width: picture.width, height: picture.height, ..like.settings.clone() },
            samples: 0,
            errors: None,
            blocks: None,
            counts: None,
            look: None,
            loaded: Arc::clone(&like.loaded),
            editable: Arc::clone(&like.editable),
            world: Arc::clone(&like.world),
        }
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        [self.settings.width as usize, self.settings.height as usize]
    }

    /// The index of a pixel.
    pub fn index(&self, x: usize, y: usize) -> Option<usize> {
        let [width, height] = self.size();
        (x < width && y < height).then_some(y * width + x)
    }

    /// The standard error of the mean of a pixel's components.
    pub fn error(&self, pixel: usize) -> Option<f32> {
        self.errors.as_ref()?.get(pixel).copied()
    }

    /// Samples of a pixel.
    pub fn count(&self, pixel: usize) -> u64 {
        let count = self.counts.as_ref().and_then(|counts| counts.get(pixel));
        count.map_or(self.samples, |&count| count.into())
    }
}

/// The errors of the blocks of a picture after so many samples a pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockErrors {
    /// Samples of each pixel.
    pub samples: u64,
    /// Of each block the mean of its pixels' squared relative errors, as `noise` judges them, and its pixels.
    pub squares: Vec<(f64, f64)>,
}

impl BlockErrors {
    /// From the light of rows of `width` pixels and the standard errors of the means of their components.
    pub(super) fn new(light: &[Rgb], errors: &[f32], width: u32, samples: u64) -> BlockErrors {
        let width = width as usize;
        let (columns, rows) = (width.div_ceil(BLOCK as usize), light.len().div_ceil(width * BLOCK as usize));
        let mut squares = vec![(0.0, 0.0); columns * rows];
        for (pixel, (light, error)) in light.iter().zip(errors).enumerate() {
            let (x, y) = (pixel % width, pixel / width);
            let (square, pixels) = &mut squares[y / BLOCK as usize * columns + x / BLOCK as usize];
            let error = f64::from(*error);
            *square += error * error * relative_weight(*light, light.element_sum() / 3.0);
            *pixels += 1.0;
        }
        squares.iter_mut().for_each(|(square, pixels)| *square /= *pixels);
        BlockErrors { samples, squares }
    }
}

/// What is seen in every pixel, beside its light.
#[derive(Debug, Default)]
pub struct Look {
    /// Reflectances.
    pub albedo: Vec<f32>,
    /// Normals, three floats a pixel.
    pub normal: Vec<f32>,
    /// Distance along the viewing direction; very far where nothing is.
    pub depth: Vec<f32>,
    /// Index of the object plus one; 0 is the sky.
    pub object: Vec<u32>,
}

impl Look {
    /// Adds the next rows.
    pub(super) fn add(&mut self, planes: &FeaturePlanes) {
        let [albedo, normal] = planes.guides();
        self.albedo.extend(albedo);
        self.normal.extend(normal);
        for channel in planes.channels(&[FeatureKind::Depth, FeatureKind::Object]) {
            match channel.values {
                Samples::Floats(depth) => self.depth.extend(depth),
                Samples::Integers(object) => self.object.extend(object),
            }
        }
    }

    /// The object that is seen in a pixel.
    pub fn object_at(&self, pixel: usize) -> Option<usize> {
        (*self.object.get(pixel)?).checked_sub(1).map(|object| object as usize)
    }
}
