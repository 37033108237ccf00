//! The settings of the renders, and what is kept between runs.

use super::document;
use crate::accel::Precision;
use crate::error::Result;
use crate::output::{Aov, TextFile, Wanted, shell_line};
use crate::picture::{Depth, Format};
use crate::render::{AccelKind, SHORT_SCRAMBLE_LENGTH, Settings};
use crate::sampling::SamplerKind;
use serde_json::{Value, json};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The most files that are remembered.
const MOST_RECENT: usize = 10;

/// How large the preview is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PreviewSize {
    /// As large as there is place, at most as the picture.
    #[default]
    Fit,
    /// Half of that.
    Half,
    /// As the picture.
    Full,
}

impl PreviewSize {
    /// In the order of the list in the window.
    pub const ALL: [PreviewSize; 3] = [PreviewSize::Fit, PreviewSize::Half, PreviewSize::Full];

    /// The name in the window.
    pub const fn name(self) -> &'static str {
        match self {
            PreviewSize::Fit => "as the window",
            PreviewSize::Half => "half the window",
            PreviewSize::Full => "as the picture",
        }
    }
}

/// The settings of the window, beside the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Knobs {
    /// Of the picture, in pixels.
    pub width: u32,
    /// Of the picture, in pixels.
    pub height: u32,
    /// Samples per pixel.
    pub samples: u64,
    /// Longest path in segments.
    pub bounces: u32,
    /// The relative error at which blocks of a final render stop.
    pub noise: Option<f64>,
    /// Seconds that a final render may take.
    pub time: Option<f64>,
    /// Brightness in stops.
    pub exposure: f64,
    /// What finds hits.
    pub accel: AccelKind,
    /// How hits of triangles are found.
    pub precision: Precision,
    /// Where random numbers come from.
    pub sampler: SamplerKind,
    /// How large the preview is.
    pub preview: PreviewSize,
    /// The picture's file.
    pub image: String,
    /// What a value of it takes, where its format can have that.
    pub depth: Option<Depth>,
    /// What goes beside the light into an EXR.
    pub aov: Vec<Aov>,
    /// Whether the final picture is denoised.
    pub denoise: bool,
}

impl Default for Knobs {
    fn default() -> Knobs {
        Knobs {
            width: 1280,
            height: 720,
            samples: 256,
            bounces: 20,
            noise: None,
            time: None,
            exposure: 0.0,
            accel: AccelKind::default(),
            precision: Precision::default(),
            sampler: SamplerKind::default(),
            preview: PreviewSize::default(),
            image: "picture.png".into(),
            depth: None,
            aov: Vec::new(),
            denoise: false,
        }
    }
}

impl Knobs {
    /// The format of the picture's file, if its name tells one.
    pub fn format(&self) -> Option<Format> {
        Format::of(Path::new(&self.image)).ok()
    }

    /// The picture that the final render makes.
    pub fn wanted(&self) -> Wanted {
        let format = self.format();
        let can_be = |depth: &Depth| format.is_some_and(|format| format.depths().contains(depth));
        let aov = if format == Some(Format::Exr) { self.aov.clone() } else { Vec::new() };
        Wanted {
            image: self.image.clone().into(),
            depth: self.depth.filter(can_be),
            exposure: self.exposure,
            aov,
            denoise: self.denoise,
            stamp: false,
        }
    }

    /// Of the final render, as the command line has them.
    pub fn settings(&self) -> Settings {
        let (noise, time) = (self.noise, self.time.map(Duration::from_secs_f64));
        let Wanted { aov, denoise, .. } = self.wanted();
        Settings {
            accel: self.accel,
            precision: self.precision,
            sampler: self.sampler,
            noise,
            time,
            error_estimate: true,
            scramble_length: aov.contains(&Aov::Error).then_some(SHORT_SCRAMBLE_LENGTH),
            features: denoise || aov.iter().any(|aov| matches!(aov, Aov::Feature(_))),
            ..Settings::new(self.width, self.height, self.samples, self.bounces)
        }
    }

    /// Of the preview in a place of so many pixels. A target and a time are for final renders: the preview shows what is
    /// there.
    pub fn preview_settings(&self, place: [u32; 2]) -> Settings {
        let [width, height] = self.preview_size(place);
        let samples = if self.samples == 0 { u64::from(u16::MAX) } else { self.samples };
        let of_light = Settings { scramble_length: None, features: false, ..self.settings() };
        Settings { width, height, samples, noise: None, time: None, ..of_light }
    }

    fn preview_size(&self, [width, height]: [u32; 2]) -> [u32; 2] {
        let place = |part: f64| {
            let scale = |place: u32, side: u32| part * f64::from(place) / f64::from(side);
            scale(width, self.width).min(scale(height, self.height)).min(1.0)
        };
        let scale = match self.preview {
            PreviewSize::Fit => place(1.0),
            PreviewSize::Half => place(0.5),
            PreviewSize::Full => 1.0,
        };
        [self.width, self.height].map(|side| ((f64::from(side) * scale).round() as u32).max(1))
    }

    /// Whether the final render can be started.
    ///
    /// # Errors
    /// As [`Settings::check`].
    pub fn check(&self) -> Result<()> {
        self.settings().check()
    }

    /// The command line that renders the same.
    pub fn command(&self, scene: &Path) -> String {
        let arguments = self.settings().arguments(&scene.to_string_lossy(), &self.image);
        shell_line(["pathtracer".to_owned()].into_iter().chain(arguments).chain(self.wanted().options()))
    }
}

/// How the window looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Theme {
    /// As the desktop.
    #[default]
    System,
    /// Dark.
    Dark,
    /// Light.
    Light,
}

impl Theme {
    /// In the order of the list in the window.
    pub const ALL: [Theme; 3] = [Theme::System, Theme::Dark, Theme::Light];

    /// The name in the window and in the file.
    pub const fn name(self) -> &'static str {
        match self {
            Theme::System => "System",
            Theme::Dark => "Dark",
            Theme::Light => "Light",
        }
    }
}

/// What is kept between runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// The settings; the picture's file goes by the scene.
    pub knobs: Knobs,
    /// Scenes, the newest first.
    pub recent: Vec<PathBuf>,
    /// How the window looks.
    pub theme: Theme,
    /// The window's size in points.
    pub size: [f32; 2],
    /// Whether the panels on the left and on the right are folded away.
    pub folded: [bool; 2],
}

impl Default for Kept {
    fn default() -> Kept {
        Kept {
            knobs: Knobs::default(),
            recent: Vec::new(),
            theme: Theme::default(),
            size: [1280.0, 800.0],
            folded: [false; 2],
        }
    }
}

impl Kept {
    /// What was kept; the default where that can't be read.
    pub fn load() -> Kept {
        let text = file().and_then(|file| fs::read_to_string(file).ok());
        text.and_then(|text| serde_json::from_str(&text).ok())
            .map_or_else(Kept::default, |value| Kept::of(&value))
    }

    /// Keeps it. A folder that can't be written keeps nothing, which harms nobody.
    pub fn save(&self) {
        let Some(file) = file() else { return };
        let _ = file.parent().map(fs::create_dir_all);
        let _ = TextFile::new(&file).and_then(|file| file.write(&format!("{:#}\n", self.value())));
    }

    /// Puts a scene at the head of the list.
    pub fn remember(&mut self, path: &Path) {
        let path = document::whole_path(path);
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(MOST_RECENT);
    }

    /// As JSON.
    pub fn value(&self) -> Value {
        let knobs = &self.knobs;
        json!({
            "width": knobs.width,
            "height": knobs.height,
            "samples": knobs.samples,
            "bounces": knobs.bounces,
            "noise": knobs.noise,
            "time": knobs.time,
            "exposure": knobs.exposure,
            "accelerator": knobs.accel.name(),
            "precision": knobs.precision.name(),
            "sampler": knobs.sampler.name(),
            "depth": knobs.depth.map(Depth::name),
            "aov": knobs.aov.iter().map(|aov| aov.name()).collect::<Vec<_>>(),
            "denoise": knobs.denoise,
            "preview": knobs.preview.name(),
            "theme": self.theme.name(),
            "window": self.size,
            "folded": self.folded,
            "recent": self.recent.iter().filter_map(|path| path.to_str()).collect::<Vec<_>>(),
        })
    }

    /// From JSON; whatever is not there or makes no sense has its default.
    pub fn of(value: &Value) -> Kept {
        let default = Kept::default();
        let mut kept = default.clone();
        let whole = |name: &str| value[name].as_u64();
        let knobs = &mut kept.knobs;
        set(&mut knobs.width, whole("width").and_then(|n| u32::try_from(n).ok()));
        set(&mut knobs.height, whole("height").and_then(|n| u32::try_from(n).ok()));
        set(&mut knobs.samples, whole("samples"));
        set(&mut knobs.bounces, whole("bounces").and_then(|n| u32::try_from(n).ok()));
        knobs.noise = value["noise"].as_f64();
        knobs.time = value["time"].as_f64().filter(|time| Duration::try_from_secs_f64(*time).is_ok());
        set(&mut knobs.exposure, value["exposure"].as_f64().filter(|stops| stops.abs() <= 100.0));
        set(&mut knobs.accel, named(&AccelKind::ALL, AccelKind::name, &value["accelerator"]));
        set(&mut knobs.precision, named(&Precision::ALL, Precision::name, &value["precision"]));
        set(&mut knobs.sampler, named(&SamplerKind::ALL, SamplerKind::name, &value["sampler"]));
        knobs.depth = named(&Depth::ALL, Depth::name, &value["depth"]);
        let channels = value["aov"].as_array().into_iter().flatten();
        knobs.aov = channels.filter_map(|name| named(&Aov::ALL, Aov::name, name)).collect();
        knobs.denoise = value["denoise"] == true;
        set(&mut knobs.preview, named(&PreviewSize::ALL, PreviewSize::name, &value["preview"]));
        if knobs.samples == 0 && knobs.noise.is_none() && knobs.time.is_none() {
            knobs.samples = default.knobs.samples;
        }
        if knobs.check().is_err() {
            *knobs = default.knobs;
        }
        set(&mut kept.theme, named(&Theme::ALL, Theme::name, &value["theme"]));
        let side = |i: usize| value["window"][i].as_f64().filter(|side| (200.0..20_000.0).contains(side));
        if let (Some(width), Some(height)) = (side(0), side(1)) {
            kept.size = [width as f32, height as f32];
        }
        kept.folded = [0, 1].map(|side| value["folded"][side] == true);
        let recent = value["recent"].as_array().into_iter().flatten();
        kept.recent = recent.filter_map(|path| path.as_str().map(PathBuf::from)).take(MOST_RECENT).collect();
        kept
    }
}

fn set<T>(to: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *to = value;
    }
}

fn named<T: Copy>(all: &[T], name: impl Fn(T) -> &'static str, value: &Value) -> Option<T> {
    all.iter().copied().find(|&one| value.as_str() == Some(name(one)))
}

/// Where it is kept.
fn file() -> Option<PathBuf> {
    Some(own_folder("XDG_CONFIG_HOME", ".config")?.join("window.json"))
}

/// This program's folder in the one that the desktop names by a variable, else in one of the home folder.
pub(super) fn own_folder(variable: &str, otherwise: &str) -> Option<PathBuf> {
    let folder = |name: &str| env::var_os(name).map(PathBuf::from).filter(|folder| folder.is_absolute());
    let base = folder(variable).or_else(|| Some(folder("HOME")?.join(otherwise)))?;
    Some(base.join("pathtracer"))
}
