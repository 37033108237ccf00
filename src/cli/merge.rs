//! `pathtracer merge PART... IMAGE`.

use super::arguments::{Job, MergeArguments};
use super::console::say;
use super::render::{ending, error_bars, missing_errors, write_picture};
use super::{findings, interrupt};
use crate::error::Error;
use crate::output::{Aov, Target};
use crate::render::{Merged, Settings, in_pool, merge};
use std::path::Path;
use std::time::Duration;

/// Makes the picture; returns the exit code.
pub(super) fn run(arguments: &MergeArguments) -> anyhow::Result<u8> {
    let (parts, image) = arguments.files()?;
    if let Some(part) = parts.iter().find(|part| part.as_path() == image.as_path()) {
        return Err(Error::Usage(format!("{} can't be a part and the picture", part.display())).into());
    }
    // Whatever can be known to fail fails before the work.
    let target = Target::new(arguments.wanted(image))?;
    let bars = arguments.error_bars.as_deref().map(error_bars).transpose()?;
    if bars.as_ref().is_some_and(|bars| target.holds(bars.path())) {
        return Err(Error::Usage("--error-bars needs a file of its own, beside the picture's".into()).into());
    }
    let mut partial = target.partial_paths();
    partial.extend(bars.iter().map(|bars| bars.partial_path().to_path_buf()));
    interrupt::listen(partial)?;
    let pool = Settings::new(1, 1, 1, 1);
    let Merged { rendered, origin } = in_pool(&pool, || merge(parts, arguments.mix_instruction_sets))?;
    let job = job(arguments, image, &origin.recipe.scene, origin.recipe.settings());
    let needs_features = job.denoise || job.aov.iter().any(|aov| matches!(aov, Aov::Feature(_)));
    if rendered.features.is_none() && needs_features {
        return Err(Error::Usage(no_features().into()).into());
    }
    write_picture(&target, bars.as_ref(), &job, &origin, &rendered)?;
    findings::report(&job, &rendered);
    if !job.quiet {
        ending(&job, &rendered).iter().for_each(say);
        say(format_args!("{} made of {} parts", image.display(), parts.len()));
    }
    // The picture is there; but whoever runs many of these looks at how they end.
    missing_errors(&job, &rendered).map_or(Ok(0), |what| Err(Error::Film(what.into()).into()))
}

fn no_features() -> &'static str {
    "the parts do not hold what --aov and --denoise need: render them with --aov or --denoise"
}

/// The render of the whole picture.
fn job(arguments: &MergeArguments, image: &Path, scene: &str, settings: Settings) -> Job {
    Job {
        scene: scene.into(),
        image: image.into(),
        error_bars: arguments.error_bars.clone(),
        settings,
        checkpoint: None,
        every: Duration::MAX,
        resume: None,
        exposure: arguments.exposure,
        depth: arguments.depth,
        aov: arguments.aov.clone(),
        denoise: arguments.denoise,
        stamp: false,
        quiet: arguments.quiet,
        json: false,
        openjd: false,
    }
}
