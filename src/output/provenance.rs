//! How a picture was made, as its file tells it, and the command line that makes it again.
//!
//! A file holds only what determines its pixels, so that equal renders are equal files. Names are those that other
//! programs use, where there are any (`Software`, `worldToCamera`, `fov`, `samplesPerPixel`); the others begin with
//! `pathtracer:`.

use crate::accel::{Precision, used_isa};
use crate::picture::{Destination, Metadata, Value};
use crate::render::{AccelKind, CHUNK, Settings, View};
use crate::scene::Digest;
use std::path::Path;

/// What a picture is made from.
pub struct Provenance<'p> {
    /// The scene's file.
    pub scene: &'p Path,
    /// Of the scene and all that it names.
    pub digest: Digest,
    /// The scene's camera.
    pub view: &'p View,
    /// The settings of the render.
    pub settings: &'p Settings,
    /// Samples per pixel that were taken, maybe fewer than the settings say.
    pub samples: u64,
    /// Whether the limit of the settings changed any sample.
    pub is_clamped: bool,
    /// Brightness in stops.
    pub exposure: f64,
}

/// A setting: its name in the file behind [`PREFIX`], its option on the command line, if it has one, and its value as the
/// option takes it; `None` where it makes no difference to the pixels.
type Setting = (&'static str, Option<&'static str>, fn(&Provenance<'_>, &Destination) -> Option<String>);

/// Every option that changes pixels, in the order of the file. A new one needs a line here, and nothing else.
const SETTINGS: [Setting; 13] = [
    ("seed", Some("--seed"), |p, _| Some(p.settings.seed.to_string())),
    ("sampler", Some("--sampler"), |p, _| Some(p.settings.sampler.to_string())),
    ("lightSampling", Some("--light-sampling"), |p, _| {
        Some(if p.settings.light_sampling { "on" } else { "off" }.to_owned())
    }),
    ("clamp", Some("--clamp"), |p, _| {
        p.settings.clamp.filter(|_| p.is_clamped).map(|limit| limit.to_string())
    }),
    ("noise", Some("--noise"), |p, _| p.settings.noise.map(|target| target.to_string())),
    ("scrambleLength", Some("--scramble-length"), |p, _| {
        let asked = p.settings.scramble_length;
        asked.filter(|&length| length != p.settings.chosen_scramble_length()).map(|length| length.to_string())
    }),
    ("precision", Some("--precision"), |p, _| Some(p.settings.precision.name().to_owned())),
    ("accelerator", Some("--accel"), |p, _| {
        p.accelerator_matters().then(|| p.settings.accel.name().to_owned())
    }),
    ("instructionSet", Some("--isa"), |p, _| {
        let isa = p.embree_decides().then(|| used_isa(p.settings.isa).ok()).flatten()?;
        Some(isa.name().to_owned())
    }),
    ("tree", Some("--bvh"), |p, _| p.embree_decides().then(|| p.settings.bvh.name().to_owned())),
    ("chunk", None, |p, _| (p.settings.chunk != CHUNK).then(|| p.settings.chunk.to_string())),
    ("exposure", Some("--exposure"), |p, to| (!to.depth().is_linear()).then(|| p.exposure.to_string())),
    ("depth", Some("--depth"), |_, to| {
        let depth = to.depth();
        (depth != to.format().depths()[0]).then(|| depth.name().to_owned())
    }),
];

/// What the names of this program's own fields begin with.
pub const PREFIX: &str = "pathtracer:";

impl Provenance<'_> {
    /// What the picture's file says there.
    pub fn metadata(&self, destination: &Destination) -> Metadata {
        let mut metadata = Metadata::default();
        let text = |text: String| Value::Text(text);
        metadata.push("Software", text(format!("pathtracer {}", env!("CARGO_PKG_VERSION"))));
        metadata.push("worldToCamera", Value::Matrix(self.view.world_to_camera));
        metadata.push("fov", Value::Number(self.view.fov * 180.0));
        // There are at most 2^32 samples.
        metadata.push("samplesPerPixel", Value::Integer(self.samples as i64));
        let scene = self.scene.file_name().unwrap_or_default().to_string_lossy();
        let mut own = |name: &str, value: String| metadata.push(format!("{PREFIX}{name}"), text(value));
        own("scene", scene.into_owned());
        own("sceneHash", self.digest.to_string());
        own("size", format!("{} {}", self.settings.width, self.settings.height));
        own("bounces", self.settings.bounces.to_string());
        for (name, _, value) in SETTINGS {
            if let Some(value) = value(self, destination) {
                own(name, value);
            }
        }
        metadata
    }

    /// Whether accelerators may differ.
    fn accelerator_matters(&self) -> bool {
        self.settings.precision != Precision::Exact
    }

    /// Whether kernels of Embree's own decide, which differ between instruction sets and trees.
    fn embree_decides(&self) -> bool {
        self.accelerator_matters() && self.settings.accel == AccelKind::Embree
    }
}

/// The arguments that make a picture again, by what its file says; `None` if that is not enough.
pub fn arguments(metadata: &Metadata, picture: &Path) -> Option<Vec<String>> {
    let own = |name: &str| metadata.get(&format!("{PREFIX}{name}"));
    // A name that could be a command or an option.
    let scene = own("scene")?;
    let mut words =
        vec![if scene.contains('.') && !scene.starts_with('-') { scene } else { format!("./{scene}") }];
    words.extend(own("size")?.split(' ').map(str::to_owned));
    words.extend([metadata.get("samplesPerPixel")?, own("bounces")?]);
    words.push(picture.to_string_lossy().into_owned());
    for (name, option, _) in SETTINGS {
        if let (Some(option), Some(value)) = (option, own(name)) {
            words.extend([option.to_owned(), value]);
        }
    }
    if own("denoised").is_some() {
        words.push("--denoise".to_owned());
    }
    if let Some(list) = own("aov") {
        words.extend(["--aov".to_owned(), list]);
    }
    Some(words)
}
