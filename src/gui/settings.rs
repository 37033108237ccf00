//! The settings of the renders, and what is kept between runs.

use super::document;
use crate::accel::Precision;
use crate::error::Result;
use crate::picture::partial_file;
use crate::render::{AccelKind, Settings};
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
    /// All of them.
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
        }
    }
}

impl Knobs {
    /// Of the final render, as the command line has them.
    pub fn settings(&self) -> Settings {
        let (noise, time) = (self.noise, self.time.map(Duration::from_secs_f64));
        Settings {
            accel: self.accel,
            precision: self.precision,
            sampler: self.sampler,
            noise,
            time,
            error_estimate: true,
            ..Settings::new(self.width, self.height, self.samples, self.bounces)
        }
    }

    /// Of the preview in a place of so many pixels. A target and a time are for final renders: the preview shows what is
    /// there.
    pub fn preview_settings(&self, place: [u32; 2]) -> Settings {
        let [width, height] = self.preview_size(place);
        let samples = if self.samples == 0 { u64::from(u16::MAX) } else { self.samples };
        Settings { width, height, samples, noise: None, time: None, ..self.settings() }
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

    /// The arguments of the command line that render the same.
    pub fn command(&self, scene: &Path) -> String {
        let mut words = vec!["pathtracer".to_owned(), quoted(&scene.to_string_lossy())];
        words.extend(
            [u64::from(self.width), u64::from(self.height), self.samples, self.bounces.into()]
                .map(|n| n.to_string()),
        );
        words.push(quoted(&self.image));
        let default = Knobs::default();
        let mut option =
            |name: &str, value: Option<String>| words.extend(value.map(|value| format!("--{name} {value}")));
        option("accel", (self.accel != default.accel).then(|| self.accel.name().into()));
        option("precision", (self.precision != default.precision).then(|| self.precision.name().into()));
        option("sampler", (self.sampler != default.sampler).then(|| self.sampler.to_string()));
        option("noise", self.noise.map(|noise| noise.to_string()));
        option("time", self.time.map(|time| time.to_string()));
        option("exposure", (self.exposure != 0.0).then(|| self.exposure.to_string()));
        words.join(" ")
    }
}

/// A word for a shell.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+,@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.into()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
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
    /// All of them.
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
}

impl Default for Kept {
    fn default() -> Kept {
        Kept { knobs: Knobs::default(), recent: Vec::new(), theme: Theme::default(), size: [1280.0, 800.0] }
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
        let partial = partial_file(&file);
        let _ =
            fs::write(&partial, format!("{:#}\n", self.value())).and_then(|()| fs::rename(&partial, &file));
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
            "sampler": knobs.sampler.to_string(),
            "preview": knobs.preview.name(),
            "theme": self.theme.name(),
            "window": self.size,
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
        set(&mut knobs.accel, named(&ACCELS, AccelKind::name, &value["accelerator"]));
        set(&mut knobs.precision, named(&PRECISIONS, Precision::name, &value["precision"]));
        let sampler = SAMPLERS.into_iter().find(|sampler| value["sampler"] == sampler.to_string());
        set(&mut knobs.sampler, sampler);
        set(&mut knobs.preview, named(&PreviewSize::ALL, PreviewSize::name, &value["preview"]));
        if knobs.check().is_err() {
            *knobs = default.knobs;
        }
        set(&mut kept.theme, named(&Theme::ALL, Theme::name, &value["theme"]));
        let side = |i: usize| value["window"][i].as_f64().filter(|side| (200.0..20_000.0).contains(side));
        if let (Some(width), Some(height)) = (side(0), side(1)) {
            kept.size = [width as f32, height as f32];
        }
        let recent = value["recent"].as_array().into_iter().flatten();
        kept.recent = recent.filter_map(|path| path.as_str().map(PathBuf::from)).take(MOST_RECENT).collect();
        kept
    }
}

/// The accelerators of this build.
pub const ACCELS: [AccelKind; 2] = [AccelKind::Embree, AccelKind::Native];
/// The precisions.
pub const PRECISIONS: [Precision; 3] = [Precision::Exact, Precision::Robust, Precision::Fast];
/// The sources of random numbers.
pub const SAMPLERS: [SamplerKind; 2] = [SamplerKind::Sobol, SamplerKind::Independent];

fn set<T>(to: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *to = value;
    }
}

fn named<T: Copy>(all: &[T], name: impl Fn(T) -> &'static str, value: &Value) -> Option<T> {
    all.iter().copied().find(|&one| value.as_str() == Some(name(one)))
}

/// Where it is kept: in the folder for settings that the desktop names.
fn file() -> Option<PathBuf> {
    let folder = |name: &str| env::var_os(name).map(PathBuf::from).filter(|folder| folder.is_absolute());
    let config = folder("XDG_CONFIG_HOME").or_else(|| Some(folder("HOME")?.join(".config")))?;
    Some(config.join("pathtracer/window.json"))
}
