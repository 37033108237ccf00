//! A picture on its way to the window, with all that can be asked about it.

use crate::gui::document::Loaded;
use crate::math::Rgb;
use crate::picture::Samples;
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
