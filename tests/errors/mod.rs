//! The error bars of pixels and pictures.

mod bars;
mod picture;
