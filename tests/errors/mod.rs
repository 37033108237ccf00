//! The error bars of pixels and pictures.

mod bars;
mod coverage;
mod halving;
mod noise;
mod picture;
mod scenes;
mod slopes;
mod time;
