//! Which settings are tried.

use crate::accel::{Isa, Precision};
use crate::render::{AccelKind, Settings};
use crate::sampling::SamplerKind;
use crate::study::contender::Kind;
use serde::Serialize;

/// Everything about a render that trades speed for accuracy but the number of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variant {
    /// The longest path in segments.
    pub bounces: u32,
    /// What finds hits.
    pub accel: AccelKind,
    /// How hits of triangles are found.
    pub precision: Precision,
    /// Where random numbers come from.
    pub sampler: SamplerKind,
    /// Whether lights are sampled.
    pub light_sampling: bool,
    /// The most that a component of a sample may be.
    pub clamp: Option<f64>,
    /// The error at which blocks of pixels stop; then the number of samples is the most of a pixel.
    pub noise: Option<f64>,
    /// Whether the picture is denoised, whose bias counts as error.
    pub denoise: bool,
}

/// A variant as tables, CSV and JSON name it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VariantRecord {
    /// The accelerator's name.
    pub accelerator: &'static str,
    /// The precision's name.
    pub precision: &'static str,
    /// The sampler's name.
    pub sampler: &'static str,
    /// Whether lights are sampled.
    pub light_sampling: bool,
    /// The longest path in segments.
    pub bounces: u32,
    /// The limit of samples, or null.
    pub clamp: Option<f64>,
    /// The error at which blocks of pixels stop, or null.
    pub noise: Option<f64>,
    /// Whether the picture is denoised.
    pub denoise: bool,
}

impl Variant {
    /// Of a render of these sizes; what is no knob comes from `frame`.
    pub(super) fn settings(&self, frame: &Frame, samples: u64, seed: u64) -> Settings {
        Settings {
            accel: self.accel,
            precision: self.precision,
            sampler: self.sampler,
            light_sampling: self.light_sampling,
            clamp: self.clamp,
            noise: self.noise,
            features: self.denoise,
            isa: frame.isa,
            threads: Some(frame.threads),
            seed,
            ..Settings::new(frame.width, frame.height, samples, self.bounces)
        }
    }

    /// The names of everything.
    pub fn record(&self) -> VariantRecord {
        let kind = Kind { accel: self.accel, precision: self.precision };
        VariantRecord {
            accelerator: kind.accel_name(),
            precision: kind.precision_name(),
            sampler: self.sampler.name(),
            light_sampling: self.light_sampling,
            bounces: self.bounces,
            clamp: self.clamp,
            noise: self.noise,
            denoise: self.denoise,
        }
    }

    /// In words.
    pub fn name(&self) -> String {
        let VariantRecord { accelerator, precision, sampler, bounces, .. } = self.record();
        let lights = if self.light_sampling { "on" } else { "off" };
        let clamp = self.clamp.map(|limit| format!(", clamp {limit}")).unwrap_or_default();
        let noise = self.noise.map(|target| format!(", noise {target}")).unwrap_or_default();
        let denoised = if self.denoise { ", denoised" } else { "" };
        format!(
            "{accelerator} {precision}, {sampler}, light sampling {lights}, {bounces} bounces{clamp}{noise}{denoised}"
        )
    }

    /// What is not as in `base`, in words; of the base itself "default".
    pub fn difference(&self, base: &Variant) -> String {
        let (own, other) = (self.record(), base.record());
        let mut words = Vec::new();
        let mut add = |differs: bool, word: String| {
            if differs {
                words.push(word);
            }
        };
        add(own.accelerator != other.accelerator, own.accelerator.into());
        add(own.precision != other.precision, own.precision.into());
        add(own.sampler != other.sampler, own.sampler.into());
        let lights = if own.light_sampling { "lights on" } else { "lights off" };
        add(own.light_sampling != other.light_sampling, lights.into());
        let plural = if own.bounces == 1 { "" } else { "s" };
        add(own.bounces != other.bounces, format!("{} bounce{plural}", own.bounces));
        let clamp = own.clamp.map_or("no clamp".to_owned(), |limit| format!("clamp {limit}"));
        add(own.clamp != other.clamp, clamp);
        let noise = own.noise.map_or("fixed samples".to_owned(), |target| format!("noise {target}"));
        add(own.noise != other.noise, noise);
        let denoised = if own.denoise { "denoised" } else { "not denoised" };
        add(own.denoise != other.denoise, denoised.into());
        if words.is_empty() { "default".into() } else { words.join(", ") }
    }

    /// The options of the command line that differ from the program's own defaults.
    pub fn options(&self) -> String {
        let (own, plain) = (self.record(), Settings::new(1, 1, 1, 1));
        let mut options = String::new();
        let mut add = |differs: bool, name: &str, value: &str| {
            if differs {
                options += &format!(" --{name} {value}");
            }
        };
        add(self.accel != plain.accel, "accel", own.accelerator);
        add(self.precision != plain.precision, "precision", own.precision);
        add(self.sampler != plain.sampler, "sampler", own.sampler);
        let lights = if self.light_sampling { "on" } else { "off" };
        add(self.light_sampling != plain.light_sampling, "light-sampling", lights);
        add(self.clamp.is_some(), "clamp", &self.clamp.unwrap_or(0.0).to_string());
        add(self.noise.is_some(), "noise", &self.noise.unwrap_or(0.0).to_string());
        if self.denoise {
            options += " --denoise";
        }
        options
    }
}

/// What all renders share.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Threads of a render.
    pub threads: usize,
    /// The most instructions to use, or `None` for the machine's best.
    pub isa: Option<Isa>,
}

/// The values of every knob, each list not empty. The first of each is the default, to which the others are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    /// Samples a pixel, ascending.
    pub samples: Vec<u64>,
    /// Longest paths; the first is the largest, whose mean is taken for the truth.
    pub bounces: Vec<u32>,
    /// What finds hits.
    pub accels: Vec<AccelKind>,
    /// How hits of triangles are found.
    pub precisions: Vec<Precision>,
    /// Where random numbers come from.
    pub samplers: Vec<SamplerKind>,
    /// Whether lights are sampled.
    pub light_sampling: Vec<bool>,
    /// Limits of samples; the first is none, whose mean is taken for the truth.
    pub clamps: Vec<Option<f64>>,
    /// Errors at which blocks stop; the first is none, with all samples everywhere.
    pub noises: Vec<Option<f64>>,
    /// Whether pictures are denoised; the first is not, whose mean is taken for the truth.
    pub denoise: Vec<bool>,
    /// Whether all combinations are tried; else one knob at a time is turned away from its default.
    pub crossed: bool,
}

impl Grid {
    /// All variants, the default first. Each is rendered with each number of samples.
    pub fn variants(&self) -> Vec<Variant> {
        let mut all = vec![Variant {
            bounces: self.bounces[0],
            accel: self.accels[0],
            precision: self.precisions[0],
            sampler: self.samplers[0],
            light_sampling: self.light_sampling[0],
            clamp: self.clamps[0],
            noise: self.noises[0],
            denoise: self.denoise[0],
        }];
        self.turn(&mut all, &self.accels, |variant, value| variant.accel = value);
        self.turn(&mut all, &self.precisions, |variant, value| variant.precision = value);
        self.turn(&mut all, &self.samplers, |variant, value| variant.sampler = value);
        self.turn(&mut all, &self.light_sampling, |variant, value| variant.light_sampling = value);
        self.turn(&mut all, &self.bounces, |variant, value| variant.bounces = value);
        self.turn(&mut all, &self.clamps, |variant, value| variant.clamp = value);
        self.turn(&mut all, &self.noises, |variant, value| variant.noise = value);
        self.turn(&mut all, &self.denoise, |variant, value| variant.denoise = value);
        all
    }

    fn turn<T: Copy>(&self, all: &mut Vec<Variant>, values: &[T], set: impl Fn(&mut Variant, T)) {
        let from = if self.crossed { all.clone() } else { vec![all[0]] };
        for &value in values.iter().skip(1) {
            all.extend(from.iter().map(|variant| {
                let mut turned = *variant;
                set(&mut turned, value);
                turned
            }));
        }
    }

    /// The variant with the same settings whose mean is the truth: with the longest paths, without a limit, with all samples
    /// and not denoised.
    pub(super) fn truth_of(&self, variant: &Variant) -> Variant {
        let (bounces, clamp, noise) = (self.bounces[0], self.clamps[0], self.noises[0]);
        Variant { bounces, clamp, noise, denoise: self.denoise[0], ..*variant }
    }
}
