//! What was typed: the options of clap, and the cases where it needs help to say what is wrong.

mod bench;
mod compare;
mod diff;
mod farm;
mod merge;
mod shared;
mod tradeoff;
mod values;

pub(super) use bench::{BenchArguments, BenchJob, Subject};
pub(super) use compare::{CompareArguments, CompareJob};
pub(super) use diff::DiffArguments;
pub(super) use farm::{FarmArguments, FarmCommand};
pub(super) use merge::MergeArguments;
pub(super) use tradeoff::{TradeoffArguments, TradeoffJob};

use crate::accel::{BvhQuality, Isa, Precision};
use crate::error::Error;
use crate::film::Region;
use crate::output::{Aov, Wanted};
use crate::picture::Depth;
use crate::render::{
    AccelKind, MAX_BOUNCES, MAX_SAMPLES, MAX_SIDE, MAX_THREADS, SHORT_SCRAMBLE_LENGTH, Settings,
};
use crate::sampling::SamplerKind;
use clap::{CommandFactory, FromArgMatches, Parser};
use clap_complete::Shell;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::Duration;
use values::{choice, chunks, crop, part, positive, shell, stops, switch, time, whole, whole_or_none};

/// How often checkpoints are written, unless set otherwise.
pub(super) const EVERY: Duration = Duration::from_secs(60);

/// The positional arguments of a render, as messages name them.
const POSITIONALS: [&str; 6] = ["SCENE", "WIDTH", "HEIGHT", "SAMPLES", "BOUNCES", "IMAGE"];

static VERSION: LazyLock<String> = LazyLock::new(|| {
    let embree = option_env!("PATHTRACER_EMBREE_VERSION").unwrap_or("none");
    format!("{} (Embree: {embree})", env!("CARGO_PKG_VERSION"))
});

/// Everything on the command line.
#[derive(Debug, Parser)]
#[command(
    name = "pathtracer",
    version = VERSION.as_str(),
    about = "Renders a scene by path tracing",
    after_help = EXIT_CODES,
    override_usage = USAGE,
    args_conflicts_with_subcommands = true,
    disable_help_subcommand = true
)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) render: RenderArguments,
}

/// Every way to call the program; the lines stand below each other behind `Usage: `.
const USAGE: &str = "pathtracer [OPTIONS] SCENE WIDTH HEIGHT SAMPLES BOUNCES IMAGE\n\
    \x20      pathtracer [gui] [SCENE]\n\
    \x20      pathtracer check SCENE...\n\
    \x20      pathtracer compare [OPTIONS] SCENE\n\
    \x20      pathtracer bench [OPTIONS] [SCENE | OBJ]\n\
    \x20      pathtracer tradeoff [OPTIONS] SCENE\n\
    \x20      pathtracer diff [OPTIONS] PICTURE REFERENCE\n\
    \x20      pathtracer info FILE\n\
    \x20      pathtracer merge [OPTIONS] PART... IMAGE\n\
    \x20      pathtracer farm export|slurm --parts N [OPTIONS] SCENE WIDTH HEIGHT SAMPLES BOUNCES IMAGE\n\
    \x20      pathtracer completions bash|zsh|fish\n\
    \x20      pathtracer man";

/// What stands below all help.
pub(super) const EXIT_CODES: &str = "A scene that is named like a command is reached by ./NAME.\n\
    Exit codes: 0 done, 1 failure, 2 usage, 3 bad scene, 4 hits or pictures differ (compare, diff),\n\
    5 the time of --time was up before the error of --noise was reached, 130 and 143 interrupted.";

#[derive(Debug, clap::Subcommand)]
pub(super) enum Command {
    /// Open the window, which renders while the scene is changed; so does no command at all
    #[command(override_usage = "pathtracer gui [SCENE]")]
    Gui {
        /// A scene file
        #[arg(value_name = "SCENE")]
        scene: Option<PathBuf>,
    },
    /// Say everything that is wrong with scenes, what they contain and what they need
    #[command(override_usage = "pathtracer check SCENE...")]
    Check {
        /// Scene files
        #[arg(value_name = "SCENE", required = true)]
        scenes: Vec<PathBuf>,
    },
    /// Trace the same rays of a scene with both accelerators: do the hits agree, and what do they cost?
    Compare(CompareArguments),
    /// Measure both accelerators at all precisions on meshes of growing size, or on one's own scene or mesh
    Bench(BenchArguments),
    /// Measure what every setting of a scene's renders costs in time and gains in accuracy
    Tradeoff(Box<TradeoffArguments>),
    /// Say how far a picture is from another one
    Diff(DiffArguments),
    /// Make a picture of the parts of a render
    Merge(MergeArguments),
    /// Print a render in parts as a job for a render farm
    #[command(subcommand)]
    Farm(FarmCommand),
    /// Say how a picture was made, and the command that makes it again
    #[command(override_usage = "pathtracer info FILE")]
    Info {
        /// A picture, a part or a checkpoint
        #[arg(value_name = "FILE")]
        file: PathBuf,
    },
    /// Print the completions of a shell
    #[command(override_usage = "pathtracer completions bash|zsh|fish")]
    Completions {
        /// The shell
        #[arg(value_name = "SHELL", value_parser = shell())]
        shell: Shell,
    },
    /// Print the page of the manual, for man -l
    #[command(override_usage = "pathtracer man")]
    Man,
}

/// A render as it was typed.
#[derive(Debug, clap::Args)]
pub(super) struct RenderArguments {
    /// Scene file (YAML)
    #[arg(value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Width of the picture in pixels
    #[arg(value_name = "WIDTH", allow_negative_numbers = true, value_parser = whole(MAX_SIDE.into()))]
    width: Option<u64>,
    /// Height of the picture in pixels
    #[arg(value_name = "HEIGHT", allow_negative_numbers = true, value_parser = whole(MAX_SIDE.into()))]
    height: Option<u64>,
    /// Samples per pixel; with --noise or --time the most, 0 for no limit
    #[arg(value_name = "SAMPLES", allow_negative_numbers = true, value_parser = whole_or_none(MAX_SAMPLES))]
    samples: Option<u64>,
    /// Longest path in ray segments; 1 shows only lights and the sky
    #[arg(value_name = "BOUNCES", allow_negative_numbers = true, value_parser = whole(MAX_BOUNCES.into()))]
    bounces: Option<u64>,
    /// Picture to write: .png, .exr (linear), and with OpenImageIO .tif, .hdr (linear), .jpg
    #[arg(value_name = "IMAGE")]
    image: Option<PathBuf>,
    /// Takes what is too much, so that it can be named.
    #[arg(hide = true)]
    extra: Vec<OsString>,

    /// What finds hits [default: embree where compiled in]
    #[arg(long, value_name = "NAME", value_parser = choice(&AccelKind::ALL, AccelKind::name))]
    accel: Option<AccelKind>,
    /// How hits of triangles are found [default: exact]
    #[arg(long, value_name = "NAME", value_parser = choice(&Precision::ALL, Precision::name))]
    precision: Option<Precision>,
    /// Most instructions to use [default: the machine's best]
    #[arg(long, value_name = "NAME", value_parser = choice(&Isa::ALL, Isa::name))]
    isa: Option<Isa>,
    /// How much time goes into the tree over the triangles [default: default]
    #[arg(long, value_name = "NAME", value_parser = choice(&BvhQuality::ALL, BvhQuality::name))]
    bvh: Option<BvhQuality>,
    /// Threads [default: one a core]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole(MAX_THREADS as u64))]
    threads: Option<u64>,
    /// Side of the tiles in pixels; does not change the picture [default: by the picture's size]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole(MAX_SIDE.into()))]
    tile: Option<u64>,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 0)]
    seed: u64,
    /// Where random numbers come from [default: sobol]
    #[arg(long, value_name = "NAME", value_parser = choice(&SamplerKind::ALL, SamplerKind::name))]
    sampler: Option<SamplerKind>,
    /// Whether lights are sampled [default: on]
    #[arg(long, value_name = "on|off", value_parser = switch())]
    light_sampling: Option<bool>,
    /// Most that a component of a sample's radiance may be; takes light away and says how much [default: no limit]
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = positive)]
    clamp: Option<f64>,
    /// Relative error at which blocks of 16 x 16 pixels stop, such as 0.02 [default: all take SAMPLES]
    #[arg(long, value_name = "E", allow_negative_numbers = true, value_parser = positive)]
    noise: Option<f64>,
    /// The best picture within this time of sampling, such as 30, 500ms or 2m [default: no limit]
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = time)]
    time: Option<Duration>,
    /// Also write the error of every pixel: an .exr with its mean, standard error and half 95 % interval in R, G and B
    #[arg(long, value_name = "FILE")]
    error_bars: Option<PathBuf>,
    /// Points that each of a pixel's eight scrambles gets at first [default: 128; 2 where it costs nothing, and with
    /// --noise, --error-bars and --aov error]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(1..))]
    scramble_length: Option<u32>,
    /// Whether the error of the picture is estimated from a few pixels where its samples alone can't tell it, for about 3 %
    /// more time [default: on]
    #[arg(long, value_name = "on|off", value_parser = switch())]
    error_estimate: Option<bool>,
    /// Keep what it takes to go on with the render in this file
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,
    /// How often it is written, such as 60, 500ms or 5m, at the next end of a pass [default: 60s]
    #[arg(long, value_name = "T", allow_negative_numbers = true, value_parser = time)]
    every: Option<Duration>,
    /// Go on with the render of a checkpoint; with the same file in --checkpoint, begin where there is none
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,
    /// Render every Nth block of 16 x 16 pixels from block I (0 to N - 1) on, into a part file, IMAGE.film
    #[arg(long, value_name = "I/N", value_parser = part, conflicts_with = "crop")]
    part: Option<Region>,
    /// Render only the pixels of these columns and rows, without the last ones, from the top left, into a part file
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = crop)]
    crop: Option<Region>,
    /// Render only these chunks of 16 samples, without the last one, into a part file
    #[arg(long, value_name = "A..B", value_parser = chunks)]
    chunks: Option<[u64; 2]>,
    /// Brightness of a picture that is not linear in stops, -100 to 100
    #[arg(long, value_name = "STOPS", allow_negative_numbers = true, default_value = "0", value_parser = stops)]
    exposure: f64,
    /// What a value of the picture takes: 8 or 16 bits of sRGB (.png, .tif), half or float, linear (.exr; .tif: float)
    /// [default: 8, of .exr and .hdr float]
    #[arg(long, value_name = "NAME", value_parser = choice(&Depth::ALL, Depth::name))]
    depth: Option<Depth>,
    /// Channels of an EXR beside the light: albedo, normal, depth, position, object, samples, error;
    /// several with commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = choice(&Aov::ALL, Aov::name))]
    aov: Vec<Aov>,
    /// Remove noise by Open Image Denoise; the noisy picture is kept beside, as NAME.noisy
    #[arg(long)]
    denoise: bool,
    /// Write time, threads and machine into the picture, which then differs from equal renders
    #[arg(long)]
    stamp: bool,
    /// Print errors only
    #[arg(long, short)]
    quiet: bool,
    /// Print events as JSON lines on stdout
    #[arg(long)]
    json: bool,
    /// Print the progress on stdout as Open Job Description has it: openjd
    #[arg(long, value_name = "FORM", value_parser = ["openjd"], conflicts_with = "json")]
    progress: Option<String>,
}

/// A render as it was meant.
#[derive(Debug)]
pub(super) struct Job {
    pub(super) scene: PathBuf,
    pub(super) image: PathBuf,
    /// Where the errors of the pixels go.
    pub(super) error_bars: Option<PathBuf>,
    pub(super) settings: Settings,
    /// Where checkpoints go.
    pub(super) checkpoint: Option<PathBuf>,
    /// How often.
    pub(super) every: Duration,
    /// The checkpoint to go on from.
    pub(super) resume: Option<PathBuf>,
    /// In stops.
    pub(super) exposure: f64,
    pub(super) depth: Option<Depth>,
    /// What goes beside the light into an EXR.
    pub(super) aov: Vec<Aov>,
    /// Whether the picture is denoised.
    pub(super) denoise: bool,
    /// Whether the picture says when and where it was made.
    pub(super) stamp: bool,
    pub(super) quiet: bool,
    pub(super) json: bool,
    /// Whether progress is printed as Open Job Description has it.
    pub(super) openjd: bool,
}

impl Job {
    /// The picture.
    pub(super) fn wanted(&self) -> Wanted {
        Wanted {
            image: self.image.clone(),
            depth: self.depth,
            exposure: self.exposure,
            aov: self.aov.clone(),
            denoise: self.denoise,
            stamp: self.stamp,
        }
    }
}

/// The definition of the command line.
pub(super) fn command() -> clap::Command {
    Arguments::command()
}

impl Arguments {
    /// Parses a command line, the program's name first.
    pub(super) fn parse(arguments: &[OsString]) -> anyhow::Result<Arguments> {
        let matches = Arguments::command().try_get_matches_from(arguments);
        let parsed = matches.and_then(|matches| Arguments::from_arg_matches(&matches));
        let is_wrong = match &parsed {
            Ok(parsed) => parsed.command.is_none() && parsed.render.image.is_none(),
            Err(error) => error.use_stderr(),
        };
        match misplaced_command(arguments).filter(|_| is_wrong) {
            Some(message) => Err(Error::Usage(message).into()),
            None => Ok(parsed?),
        }
    }
}

impl RenderArguments {
    /// Either all positional arguments are there or an error says which are not.
    pub(super) fn resolve(self) -> anyhow::Result<Job> {
        if let Some(extra) = self.extra.first() {
            let message = format!("unexpected argument '{}' after IMAGE", extra.to_string_lossy());
            return Err(usage(&message).into());
        }
        let (scene, numbers, image) = self.positionals()?;
        let settings = self.settings(numbers)?;
        let RenderArguments { exposure, depth, aov, denoise, stamp, quiet, json, error_bars, .. } = self;
        let RenderArguments { checkpoint, every, resume, progress, .. } = self;
        Ok(Job {
            scene,
            image,
            error_bars,
            settings,
            checkpoint,
            every: every.unwrap_or(EVERY),
            resume,
            exposure,
            depth,
            aov,
            denoise,
            stamp,
            quiet,
            json,
            openjd: progress.is_some(),
        })
    }

    /// SCENE, the four numbers and IMAGE; an error says which are missing.
    fn positionals(&self) -> Result<(PathBuf, [u64; 4], PathBuf), Error> {
        let RenderArguments { scene, width, height, samples, bounces, image, .. } = self;
        if let (Some(scene), &Some(width), &Some(height), &Some(samples), &Some(bounces), Some(image)) =
            (scene, width, height, samples, bounces, image)
        {
            return Ok((scene.clone(), [width, height, samples, bounces], image.clone()));
        }
        let given = self.given();
        let missing: Vec<&str> = POSITIONALS.into_iter().skip(given).collect();
        Err(usage(&match given {
            0 => "nothing to render".to_owned(),
            _ => format!("missing {}", missing.join(" ")),
        }))
    }

    fn settings(&self, [width, height, samples, bounces]: [u64; 4]) -> anyhow::Result<Settings> {
        if samples == 0 && self.noise.is_none() && self.time.is_none() {
            let message = "0 samples, which means no limit, can only be given with --noise or --time";
            return Err(usage(message).into());
        }
        let errors = self.error_bars.is_some() || self.aov.contains(&Aov::Error);
        let defaults =
            Settings::new(u32::try_from(width)?, u32::try_from(height)?, samples, u32::try_from(bounces)?);
        Ok(Settings {
            accel: self.accel.unwrap_or(defaults.accel),
            precision: self.precision.unwrap_or(defaults.precision),
            isa: self.isa,
            bvh: self.bvh.unwrap_or(defaults.bvh),
            threads: self.threads.map(usize::try_from).transpose()?,
            tile: self.tile.map(u32::try_from).transpose()?,
            seed: self.seed,
            sampler: self.sampler.unwrap_or(defaults.sampler),
            light_sampling: self.light_sampling.unwrap_or(defaults.light_sampling),
            clamp: self.clamp,
            error_estimate: self.error_estimate.unwrap_or(true),
            scramble_length: self.scramble_length.or(errors.then_some(SHORT_SCRAMBLE_LENGTH)),
            noise: self.noise,
            time: self.time,
            features: self.denoise || self.aov.iter().any(|aov| matches!(aov, Aov::Feature(_))),
            region: self.part.or(self.crop).unwrap_or_default(),
            chunks: self.chunks.map(|[start, end]| start..end),
            ..defaults
        })
    }

    /// The scene, if it is the only positional argument.
    pub(super) fn only_scene(&self) -> Option<&Path> {
        self.scene.as_deref().filter(|_| self.given() == 1)
    }

    /// How many positional arguments there are.
    fn given(&self) -> usize {
        let numbers = [self.width, self.height, self.samples, self.bounces];
        usize::from(self.scene.is_some())
            + numbers.iter().flatten().count()
            + usize::from(self.image.is_some())
    }
}

/// A message with the usage.
pub(super) fn usage(message: &str) -> Error {
    Error::Usage(format!("{message}\n\nUsage: {USAGE}\n\nFor more information, try '--help'."))
}

/// What to say if the first word stands where a scene would, is no file and looks like a command.
fn misplaced_command(arguments: &[OsString]) -> Option<String> {
    let words = arguments.iter().enumerate().skip(1).filter_map(|(i, word)| Some((i, word.to_str()?)));
    let (place, word) = words.into_iter().find(|(_, word)| !word.starts_with('-'))?;
    if Path::new(word).exists() {
        return None;
    }
    let commands = Arguments::command();
    let mut names = commands.get_subcommands().map(clap::Command::get_name);
    let close = names.find(|name| edit_distance(word, name) <= 2)?;
    match (close == word, place) {
        (true, 1) => None,
        (true, _) => Some(format!("the command '{close}' must come first")),
        (false, _) => Some(format!("there is no scene file '{word}'; did you mean the command '{close}'?")),
    }
}

/// Levenshtein's distance in bytes.
fn edit_distance(a: &str, b: &str) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.bytes().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, y) in b.bytes().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

/// The threads asked for, or one a core.
fn threads(wanted: Option<u64>) -> Result<usize, std::num::TryFromIntError> {
    let all = || std::thread::available_parallelism().map_or(1, usize::from);
    wanted.map(usize::try_from).transpose().map(|threads| threads.unwrap_or_else(all))
}
