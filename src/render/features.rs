//! The features of all pixels, for channels beside the light and for denoising.

use super::{Settings, Watch, memory};
use crate::error::Result;
use crate::film::Region;
use crate::film::file::{Reader, Writer};
use crate::integrator::Features;
use crate::math::DVec3;
use crate::picture::{Channel, Samples};
use rayon::prelude::*;
use std::io;

/// What is seen in every pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct FeaturePlanes {
    /// One a pixel, in the order of the render's frame.
    pixels: Vec<Features>,
}

/// The features that can be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeatureKind {
    /// `Albedo.R`, `.G`, `.B`: means of all samples.
    Albedo,
    /// `Normal.X`, `.Y`, `.Z`: means of all samples, in world space; shorter than 1 where they differ.
    Normal,
    /// `Z`: distance along the viewing direction, the mean of the samples that met something, else [`FAR`].
    Depth,
    /// `Position.X`, `.Y`, `.Z`: the mean of the samples that met something, else 0.
    Position,
    /// `id`: index of the object plus one, of the first sample that met one; 0 for the sky. Never a mean.
    Object,
}

/// The depth of what is infinitely far, as in Blender's pictures.
pub const FAR: f32 = 1e10;

impl FeatureKind {
    /// In the order in which they are listed to users.
    pub const ALL: [FeatureKind; 5] = [
        FeatureKind::Albedo,
        FeatureKind::Normal,
        FeatureKind::Depth,
        FeatureKind::Position,
        FeatureKind::Object,
    ];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            FeatureKind::Albedo => "albedo",
            FeatureKind::Normal => "normal",
            FeatureKind::Depth => "depth",
            FeatureKind::Position => "position",
            FeatureKind::Object => "object",
        }
    }
}

/// Collects `samples(pixel)` samples of every pixel, by its number in the frame, at most one of each pixel that is left when it
/// is cancelled;
/// `feature(x, y, index)` finds one.
pub(super) fn collect<F>(
    settings: &Settings,
    watch: &dyn Watch,
    samples: impl Fn(usize) -> u64 + Sync,
    feature: F,
) -> Result<FeaturePlanes>
where
    F: Fn(u32, u32, u64) -> Features + Sync,
{
    let (frame, scrambles) = (settings.frame(), settings.scrambles());
    let mut pixels: Vec<Features> = memory::plane(settings)?;
    pixels.par_iter_mut().enumerate().for_each(|(number, pixel)| {
        let ((x, y), samples) = (frame.place(number), samples(number));
        let samples = if watch.cancelled() { samples.min(1) } else { samples };
        for sample in 0..samples {
            *pixel += feature(x, y, scrambles.place(sample).sample_index());
        }
    });
    Ok(FeaturePlanes { pixels })
}

/// Rows that [`look`] takes at once: few enough to stay in the processor's caches, and to be soon at an end.
const BAND: u32 = 16;

/// Sees the first sample of every pixel, some rows at once from the top, each of which `take` gets. Whether it got all of them:
/// not if it is cancelled.
pub(super) fn look<F>(
    settings: &Settings,
    watch: &dyn Watch,
    feature: F,
    take: &mut (dyn FnMut(&FeaturePlanes) + Send),
) -> bool
where
    F: Fn(u32, u32, u64) -> Features + Sync,
{
    let Settings { width, height, .. } = *settings;
    let first = settings.scrambles().place(0).sample_index();
    let row = width as usize;
    let mut planes = FeaturePlanes { pixels: Vec::new() };
    for top in (0..height).step_by(BAND as usize) {
        let bottom = height.min(top + BAND);
        let see = |pixel: usize| match watch.cancelled() {
            true => Features::default(),
            false => feature((pixel % row) as u32, (pixel / row) as u32, first),
        };
        let pixels = top as usize * row..bottom as usize * row;
        pixels.into_par_iter().map(see).collect_into_vec(&mut planes.pixels);
        if watch.cancelled() {
            return false;
        }
        take(&planes);
    }
    true
}

/// Numbers of a pixel's features that are no integers.
const DOUBLES: usize = 10;
/// The others.
const INTEGERS: usize = 3;

impl FeaturePlanes {
    /// Nothing seen yet.
    pub(super) fn new(settings: &Settings) -> Result<FeaturePlanes> {
        Ok(FeaturePlanes { pixels: memory::plane(settings)? })
    }

    /// Writes all of them.
    pub(super) fn write(&self, writer: &mut Writer) -> io::Result<()> {
        writer.doubles(self.pixels.iter().flat_map(|p| {
            let vectors = [p.albedo, p.normal, p.position].into_iter().flat_map(|vector| vector.to_array());
            vectors.chain([p.depth])
        }))?;
        writer.integers(self.pixels.iter().flat_map(|p| [p.samples, p.hits, p.object.into()]))
    }

    /// Reads those of a region into those of a whole picture.
    pub(super) fn read(&mut self, settings: &Settings, region: Region, reader: &mut Reader) -> Result<()> {
        let area = region.area(settings.width, settings.height);
        let doubles = reader.doubles(area * DOUBLES as u64)?;
        let integers = reader.integers(area * INTEGERS as u64)?;
        let (doubles, integers) = (doubles.chunks_exact(DOUBLES), integers.chunks_exact(INTEGERS));
        let pixels = region.pixels(settings.width, settings.height);
        for (pixel, (d, i)) in pixels.zip(doubles.zip(integers)) {
            let vector = |at: usize| DVec3::new(d[at], d[at + 1], d[at + 2]);
            self.pixels[pixel] = Features {
                samples: i[0],
                hits: i[1],
                albedo: vector(0),
                normal: vector(3),
                position: vector(6),
                depth: d[9],
                // Indices are below 2^31.
                object: i[2] as u32,
            };
        }
        Ok(())
    }

    /// The channels of some features.
    pub fn channels(&self, kinds: &[FeatureKind]) -> Vec<Channel> {
        kinds.iter().flat_map(|&kind| self.channels_of(kind)).collect()
    }

    fn channels_of(&self, kind: FeatureKind) -> Vec<Channel> {
        let floats = |name: &str, of: &dyn Fn(&Features) -> f64| Channel {
            name: name.to_owned(),
            values: Samples::Floats(self.pixels.iter().map(|pixel| of(pixel) as f32).collect()),
        };
        let seen = |sum: f64, pixel: &Features| sum / pixel.hits.max(1) as f64;
        let all = |sum: f64, pixel: &Features| sum / pixel.samples.max(1) as f64;
        match kind {
            FeatureKind::Albedo => vec![
                floats("Albedo.R", &|p| all(p.albedo.x, p)),
                floats("Albedo.G", &|p| all(p.albedo.y, p)),
                floats("Albedo.B", &|p| all(p.albedo.z, p)),
            ],
            FeatureKind::Normal => vec![
                floats("Normal.X", &|p| all(p.normal.x, p)),
                floats("Normal.Y", &|p| all(p.normal.y, p)),
                floats("Normal.Z", &|p| all(p.normal.z, p)),
            ],
            FeatureKind::Depth => {
                vec![floats("Z", &|p| if p.hits == 0 { FAR.into() } else { seen(p.depth, p) })]
            }
            FeatureKind::Position => vec![
                floats("Position.X", &|p| seen(p.position.x, p)),
                floats("Position.Y", &|p| seen(p.position.y, p)),
                floats("Position.Z", &|p| seen(p.position.z, p)),
            ],
            FeatureKind::Object => {
                let ids = self.pixels.iter().map(|pixel| pixel.object).collect();
                vec![Channel { name: "id".to_owned(), values: Samples::Integers(ids) }]
            }
        }
    }

    /// Albedo and normals as three floats a pixel.
    pub fn guides(&self) -> [Vec<f32>; 2] {
        let mean = |of: fn(&Features) -> DVec3| {
            let means = self.pixels.iter().map(|pixel| of(pixel) / pixel.samples.max(1) as f64);
            means.flat_map(|mean| mean.to_array().map(|value| value as f32)).collect()
        };
        [mean(|pixel| pixel.albedo), mean(|pixel| pixel.normal)]
    }
}
