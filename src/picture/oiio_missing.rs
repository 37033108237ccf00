//! OpenImageIO in builds without it: says what to install.

use super::metadata::Metadata;
use super::{Decoded, Pixels};
use std::path::Path;

const MISSING: &str = "this build has no OpenImageIO and knows .png and .exr only: install Debian's libopenimageio-dev and \
                       pkg-config and build with `--features oiio`";

pub(super) fn check() -> Result<(), String> {
    Err(MISSING.to_owned())
}

pub(super) fn read(_: &Path) -> Result<Decoded, String> {
    Err(MISSING.to_owned())
}

pub(super) fn info(_: &Path) -> Result<([u32; 2], Metadata), String> {
    Err(MISSING.to_owned())
}

pub(super) fn write(_: &Path, _: &str, _: (u32, u32), _: &Pixels, _: &Metadata) -> Result<(), String> {
    Err(MISSING.to_owned())
}
