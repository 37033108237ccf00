//! Renders that nobody follows.

pub(crate) use pathtracer::render::Unwatched;
