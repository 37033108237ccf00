//! What can't be rendered right is said, not drawn wrong: sizes and places that numbers can't hold together.
//!
//! Solids are known to the error bound of their points ([`crate::geometry::SurfacePoint::error`]), corners of meshes to
//! what rounding them to f32 has moved them. What is not much larger than that gets a warning with the numbers; where
//! nothing is left of it, the scene is refused.

mod camera;
mod objects;

use super::World;
use crate::error::{Diagnostic, Error, Location, Result, Severity};
use crate::scene::desc::SceneDesc;

/// What is this many times larger than the error of its points looks right.
const SIGNIFICANT: f64 = 1024.0;

impl World {
    /// What a user should know about the numbers of the scene `desc`, which this world was compiled from, in pictures
    /// of `width` pixels a row: warnings, objects first, in the order of the file.
    ///
    /// # Errors
    /// [`Error::Scene`] with all of them, if the picture of an object or the view would be meaningless.
    pub fn guards(&self, desc: &SceneDesc, width: u32) -> Result<Vec<Diagnostic>> {
        let mut found = summed_up(objects::check(self, desc));
        found.extend(camera::check(self, desc, width));
        let is_error = |diagnostic: &Diagnostic| diagnostic.severity == Severity::Error;
        if found.iter().any(is_error) { Err(Error::Scene(found)) } else { Ok(found) }
    }
}

/// The most warnings that are said of objects one by one.
const MOST_WARNINGS: usize = 20;

/// All errors and the first warnings, and how many more of these there are.
fn summed_up(all: Vec<Diagnostic>) -> Vec<Diagnostic> {
    let mut warnings = 0;
    let mut said: Vec<Diagnostic> = Vec::new();
    for diagnostic in all {
        let is_warning = diagnostic.severity == Severity::Warning;
        warnings += usize::from(is_warning);
        if !is_warning || warnings <= MOST_WARNINGS {
            said.push(diagnostic);
        }
    }
    if warnings > MOST_WARNINGS {
        let message = format!("{} more warnings about objects", warnings - MOST_WARNINGS);
        said.push(diagnostic(Severity::Warning, None, message, "mend the first ones"));
    }
    said
}

fn diagnostic(severity: Severity, location: Option<&Location>, message: String, help: &str) -> Diagnostic {
    let (location, help) = (location.cloned(), Some(help.to_owned()));
    Diagnostic { severity, message, location, source_line: None, help }
}

/// The severity of something of this size that is known to within `error`; `None` where that is small enough.
fn severity(size: f64, error: f64) -> Option<Severity> {
    if error >= size {
        Some(Severity::Error)
    } else {
        (error * SIGNIFICANT > size).then_some(Severity::Warning)
    }
}
