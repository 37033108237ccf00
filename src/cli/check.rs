//! `pathtracer check SCENE...`: what is wrong with scenes, what they contain and what they need.

use super::describe;
use crate::error::{Diagnostic, Error, Result, Severity};
use crate::geometry::MeshSpace;
use crate::render::{Settings, film_bytes};
use crate::scene;
use crate::words::bytes;
use crate::world::World;
use std::fmt::Write as _;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

/// What Embree and the native BVH take for a triangle, roughly: nodes and leaves.
const ACCEL_BYTES: usize = 100;

/// Checks every scene and prints a report of each on stdout. Returns the exit code.
pub(super) fn run(scenes: &[PathBuf]) -> u8 {
    let mut code = 0;
    for path in scenes {
        let (text, is_good) = match report(path) {
            Ok(text) => (text, true),
            Err(error) => (failure(path, &error), false),
        };
        // A reader that has gone away does not change the answer.
        let _ = writeln!(io::stdout(), "{text}");
        if !is_good {
            code = Error::Scene(Vec::new()).exit_code();
        }
    }
    code
}

/// Warnings, contents, needs.
fn report(path: &Path) -> Result<String> {
    let scene = scene::load(path)?;
    let world = World::compile(&scene.desc)?;
    let (width, height, samples) = (1920, 1080, 1024);
    let guards = world.guards(&scene.desc, width)?;
    let warnings: Vec<Diagnostic> = scene.warnings.into_iter().chain(guards).collect();
    let mut text = listed(&warnings);
    let counts: Vec<String> =
        describe::counts(&scene.desc).into_iter().map(|(name, count)| format!("{count} {name}")).collect();
    let contents = if counts.is_empty() { "no objects".into() } else { counts.join(", ") };
    let triangles = describe::triangles(&scene.desc);
    let picture = bytes(film_bytes(&Settings::new(width, height, samples, 1)));
    let memory = bytes(world_bytes(&world) as u64);
    let lines = [
        format!("{}: {}", path.display(), verdict(&warnings)),
        format!("  contains: {contents}; {triangles} triangles in meshes"),
        format!("  requires: {}", world.requires),
        format!(
            "  memory:   about {memory}, and {picture} for {width} x {height} pixels at {samples} samples"
        ),
    ];
    let _ = write!(text, "{}", lines.join("\n"));
    Ok(text)
}

fn failure(path: &Path, error: &Error) -> String {
    match error {
        Error::Scene(diagnostics) => {
            format!("{}{}: {}", listed(diagnostics), path.display(), verdict(diagnostics))
        }
        other => format!("error: {other}\n{}: 1 error", path.display()),
    }
}

fn listed(diagnostics: &[Diagnostic]) -> String {
    diagnostics.iter().map(|diagnostic| format!("{diagnostic}\n")).collect()
}

/// How many errors and warnings there are, in words.
fn verdict(diagnostics: &[Diagnostic]) -> String {
    let counted = |severity: Severity, word: &str| {
        let count = diagnostics.iter().filter(|diagnostic| diagnostic.severity == severity).count();
        (count > 0).then(|| format!("{count} {word}{}", if count == 1 { "" } else { "s" }))
    };
    let counts: Vec<String> = [counted(Severity::Error, "error"), counted(Severity::Warning, "warning")]
        .into_iter()
        .flatten()
        .collect();
    if counts.is_empty() { "ok".into() } else { counts.join(", ") }
}

/// What the compiled scene and an accelerator over it take, roughly.
fn world_bytes(world: &World) -> usize {
    let geometry = &world.geometry;
    geometry.spaces.iter().map(MeshSpace::bytes).sum::<usize>()
        + geometry.triangle_count() * ACCEL_BYTES
        + size_of_val(geometry.solids.as_slice())
}
