//! `pathtracer` as a library. The way of the data, which is also the order of the modules:
//!
//! ```text
//! YAML -> scene::SceneDesc -> world::World -> accel::Accelerator -> integrator -> film::Film -> picture
//! ```
//!
//! A module uses only modules above it in this list; `render`, `study`, `cli` and `gui` see everything.
#![deny(unsafe_code)]

pub mod error;
pub mod math;

mod memory;

pub mod picture;

pub mod scene;

pub mod geometry;

pub mod accel;

pub mod sampling;

pub mod material;

pub mod world;

pub mod film;

pub mod integrator;

pub mod render;

pub mod output;

pub mod study;

pub mod cli;

#[cfg_attr(not(feature = "gui"), path = "gui/missing.rs")]
pub mod gui;
