//! Builds without the window.

use crate::error::{Error, Result};
use std::path::Path;

/// Says how to get the window.
///
/// # Errors
/// Always: there is no window.
pub fn open(_: Option<&Path>) -> Result<()> {
    Err(Error::Unavailable(
        "this build has no window: build with `--features gui`, or give all of SCENE WIDTH HEIGHT SAMPLES BOUNCES IMAGE"
            .into(),
    ))
}
