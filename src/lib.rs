//! `pathtracer` as a library: a path tracer for the CPU whose pictures are the same bytes whatever the threads and, at
//! [`Precision::Exact`](accel::Precision::Exact), the accelerator.
//!
//! # The map
//!
//! ```text
//! YAML -> scene::SceneDesc -> world::World -> accel::Accelerator -> integrator -> film::Film -> picture
//! ```
//!
//! The modules are declared, and best read, in the order of the data:
//!
//! 1. [`error`], [`math`]: the words that everything uses.
//! 2. [`picture`]: pixels in files, in and out.
//! 3. [`scene`]: what the file says, or every mistake in it with its place.
//! 4. [`geometry`]: shapes, and the definition of a hit.
//! 5. [`accel`]: what does a ray hit? Embree and a tree of its own behind one front.
//! 6. [`sampling`]: random numbers, and the maps from them to shapes.
//! 7. [`material`]: how a surface scatters light.
//! 8. [`world`]: what is rendered: the scene compiled to flat arrays, with its lights and camera.
//! 9. [`film`]: the sums of all samples, and their errors.
//! 10. [`integrator`]: how much light arrives along a ray of the camera.
//! 11. [`render`]: chunks of samples, tiles of pixels, threads; from a world to a film.
//! 12. [`output`]: a film becomes a picture that says how it was made.
//! 13. [`study`]: measuring all that.
//! 14. [`cli`], [`gui`]: the program from outside.
//!
//! A module uses only modules above it in this list (a test checks it).
//!
//! # A scene becomes a picture
//!
//! ```
//! use pathtracer::output;
//! use pathtracer::picture::Destination;
//! use pathtracer::render::{Settings, Unwatched, render};
//! use pathtracer::{scene, world::World};
//! use std::path::Path;
//!
//! # fn main() -> pathtracer::error::Result<()> {
//! let text = "
//! Camera: { Position: [-6, 0, 1], LookingAt: [0, 0, 1], Fov: 0.25, FocusDistance: 6 }
//! Environment: { SkyColor: [1, 1, 1], HorizonColor: [1, 1, 1], GroundColor: [1, 1, 1] }
//! Objects:
//!   - Object: { Type: Ball, Position: [0, 0, 1], Radius: 1, Material: { Type: Diffuse, Color: [0.5, 0.5, 0.5] } }
//! ";
//! // The second argument is the file in which mistakes are said to be, and beside which meshes and pictures are looked for.
//! let scene = scene::parse(text, Path::new("ball.yaml"))?;
//! let world = World::compile(&scene.desc)?;
//! // 64 x 48 pixels, 16 samples each, paths of at most 8 segments.
//! let rendered = render(&world, &scene.desc.camera, &Settings::new(64, 48, 16, 8), &Unwatched)?;
//!
//! // Under a white sky a ball of albedo 0.5 reflects half of the light, wherever it is seen.
//! let means: Vec<_> = rendered.film.means().collect();
//! assert!((means[24 * 64 + 32].x - 0.5).abs() < 1e-9);
//! assert_eq!(means[0].x, 1.0);
//!
//! let folder = std::env::temp_dir().join(format!("pathtracer-doc-{}", std::process::id()));
//! # std::fs::create_dir_all(&folder).expect("a folder");
//! output::write(&rendered.film, 0.0, &Destination::new(&folder.join("ball.png"))?)?;
//! # std::fs::remove_dir_all(&folder).expect("a folder");
//! # Ok(())
//! # }
//! ```
//!
//! What a ray hits is asked of an [`Accelerator`](accel::Accelerator); [`accel`] has an example.
#![deny(unsafe_code)]

pub mod error;
pub mod math;

mod memory;
mod whole_file;
mod words;

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
