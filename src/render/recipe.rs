//! What determines the sums of a render: checkpoints and parts hold it, and go together only where it is the same.

use super::{AccelKind, MAX_SAMPLES, Settings};
use crate::accel::{BvhQuality, Isa, Precision, used_isa};
use crate::error::Result;
use crate::film::Region;
use crate::sampling::SamplerKind;
use crate::scene::Digest;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// All that determines the sums. The names in the file are those of messages.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    /// Of the program.
    pub version: String,
    /// The scene's file, as it was named.
    pub scene: String,
    /// Of the contents of the scene and all that it names.
    #[serde(rename = "scene and meshes")]
    pub digest: Digest,
    /// In pixels.
    pub width: u32,
    /// In pixels.
    pub height: u32,
    /// Per pixel, at most.
    pub samples: u64,
    /// The longest path.
    pub bounces: u32,
    chunk: u32,
    seed: u64,
    sampler: SamplerKind,
    #[serde(rename = "light sampling")]
    light_sampling: bool,
    clamp: Option<f64>,
    noise: Option<f64>,
    /// As it was asked for.
    scramble_length: Option<u32>,
    #[serde(rename = "scramble length")]
    used_scramble_length: u64,
    #[serde(rename = "error estimate")]
    error_estimate: bool,
    precision: Precision,
    /// Where it makes a difference.
    accelerator: Option<AccelKind>,
    /// Where it makes a difference.
    #[serde(rename = "instruction set")]
    isa: Option<Isa>,
    /// Where it makes a difference.
    tree: Option<BvhQuality>,
    region: Region,
    /// The first chunk, and the one behind the last.
    chunks: Option<[u64; 2]>,
    features: bool,
}

/// What may differ between a checkpoint and the render that goes on from it.
pub(super) const RESUMABLE: [&str; 4] = ["scene", "samples", "scramble_length", "features"];
/// What may differ between the parts of a picture.
pub(super) const OF_PARTS: [&str; 5] = ["scene", "scramble_length", "region", "chunks", "features"];
/// What may differ between a part and the task that would make it.
pub(crate) const OF_A_TASK: [&str; 2] = ["scene", "scramble_length"];

impl Recipe {
    /// Of a render of the scene in the file `scene`.
    ///
    /// # Errors
    /// An instruction set that the machine lacks, where it decides about bits.
    pub fn new(scene: &Path, digest: Digest, settings: &Settings) -> Result<Recipe> {
        let accelerator_matters = settings.precision != Precision::Exact;
        let embree_decides = accelerator_matters && settings.accel == AccelKind::Embree;
        Ok(Recipe {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            scene: scene.to_string_lossy().into_owned(),
            digest,
            width: settings.width,
            height: settings.height,
            samples: settings.samples,
            bounces: settings.bounces,
            chunk: settings.chunk,
            seed: settings.seed,
            sampler: settings.sampler,
            light_sampling: settings.light_sampling,
            clamp: settings.clamp,
            noise: settings.noise,
            scramble_length: settings.scramble_length,
            used_scramble_length: settings.scrambles().length(),
            error_estimate: settings.error_estimate,
            precision: settings.precision,
            accelerator: accelerator_matters.then_some(settings.accel),
            isa: embree_decides.then(|| used_isa(settings.isa)).transpose()?,
            tree: embree_decides.then_some(settings.bvh),
            region: settings.region,
            chunks: settings.chunks.as_ref().map(|chunks| [chunks.start, chunks.end]),
            features: settings.features,
        })
    }

    /// The settings of a render that makes the same sums.
    pub fn settings(&self) -> Settings {
        Settings {
            accel: self.accelerator.unwrap_or_default(),
            precision: self.precision,
            isa: self.isa,
            bvh: self.tree.unwrap_or_default(),
            chunk: self.chunk,
            seed: self.seed,
            sampler: self.sampler,
            light_sampling: self.light_sampling,
            clamp: self.clamp,
            scramble_length: self.scramble_length,
            error_estimate: self.error_estimate,
            noise: self.noise,
            features: self.features,
            region: self.region,
            chunks: self.chunks.map(|[start, end]| start..end),
            ..Settings::new(self.width, self.height, self.samples, self.bounces)
        }
    }

    /// Whether a render with these numbers can be: what a file says is not believed.
    pub(super) fn can_be(&self) -> bool {
        let settings = self.settings();
        let chunks = self.chunks.is_none_or(|[start, end]| start < end && end <= MAX_SAMPLES);
        settings.check_ranges().is_ok()
            && settings.scrambles().length() == self.used_scramble_length
            && chunks
    }

    /// The same for other pixels and chunks.
    #[must_use]
    pub fn with_part(&self, region: Region, chunks: Option<[u64; 2]>) -> Recipe {
        Recipe { region, chunks, ..self.clone() }
    }

    /// Equal for recipes that differ only in what parts of a picture may differ in.
    pub(super) fn key(&self) -> String {
        let mut fields = serde_json::to_value(self).unwrap_or_default();
        if let Some(fields) = fields.as_object_mut() {
            OF_PARTS.iter().for_each(|&name| drop(fields.remove(name)));
        }
        fields.to_string()
    }

    /// Whether it takes the first samples of its pixels.
    pub(super) fn is_first(&self) -> bool {
        self.chunks.is_none_or(|[start, _]| start == 0)
    }

    /// The pixels.
    pub fn region(&self) -> Region {
        self.region
    }

    /// The first chunk, and the one behind the last, if not all.
    pub fn chunks(&self) -> Option<[u64; 2]> {
        self.chunks
    }

    /// What differs from another one, in words like `seed (1, not 2)`, but for the names in `but`.
    pub fn differences(&self, other: &Recipe, but: &[&str]) -> Vec<String> {
        let fields = |recipe: &Recipe| serde_json::to_value(recipe).unwrap_or_default();
        let (own, others) = (fields(self), fields(other));
        let Some(own) = own.as_object() else { return Vec::new() };
        let all = own
            .iter()
            .filter(|(name, value)| !but.contains(&name.as_str()) && others.get(name) != Some(value));
        let shown = |value: Option<&serde_json::Value>| match value {
            None | Some(serde_json::Value::Null) => "none".to_owned(),
            Some(serde_json::Value::String(text)) => text.clone(),
            Some(value) => value.to_string(),
        };
        all.map(|(name, value)| format!("{name} ({}, not {})", shown(Some(value)), shown(others.get(name))))
            .collect()
    }

    /// The command line, without the program's name, that makes these sums again, as a file `file`.
    pub fn arguments(&self, file: &str) -> Vec<String> {
        let mut words = self.settings().arguments(&self.scene, file);
        words.extend(self.features.then(|| ["--aov".to_owned(), "albedo".to_owned()]).into_iter().flatten());
        words
    }
}
