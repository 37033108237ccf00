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
        let mut found = objects::check(self, desc);
        found.extend(camera::check(self, desc, width));
        let is_error = |diagnostic: &Diagnostic| diagnostic.severity == Severity::Error;
        if found.iter().any(is_error) { Err(Error::Scene(found)) } else { Ok(found) }
    }
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
