//! One test binary; `cargo test TOPIC` runs one topic, named as its module here.

/// Statistics, oracles, scenes: what the topics share.
mod support;

/// The order of the modules, and the length of files.
mod layers;

/// The links of the README and the guides.
mod documents;

/// The committed meshes and scenes are what their generator makes; the files of the package are there.
mod assets;
/// The makers of the committed meshes and scenes.
mod generate;

/// Pictures in files: curve, formats, whole or not at all.
mod picture;

/// Files that are no pictures, or no whole ones.
mod damaged_pictures;
/// Formats of OpenImageIO.
#[cfg(feature = "oiio")]
mod oiio;

/// Bad scenes and meshes: each mistake and its message.
mod scene_errors;
/// Scene files and meshes as they should be: every key, every default, every style.
mod scene_format;

/// Accelerators: identity with the oracle, leaks, ties, odd rays, structure.
mod accel;
/// Embree: the oracle's hits at exact, the promises of robust and fast, refusals.
#[cfg(feature = "embree")]
mod embree;
/// Robust: where Embree and the native accelerator disagree, and why they may.
#[cfg(feature = "embree")]
mod embree_agreement;

/// Sines, angles and roots of inner loops.
mod elementary;

/// Every lobe against its density, its colour, its limits.
mod material;
/// The samplers and the warps.
mod sampling;

/// Skies that are pictures.
mod environment_map;
/// Every light against its density.
mod lights;
/// Materials of OBJ files.
mod materials_of_files;
/// Pictures seen from afar: cones, footprints, smaller copies.
mod mip_maps;
/// Pictures as colours of surfaces.
mod textures;
/// Light transport against closed forms: furnaces, lights of every shape, the sky.
mod transport;

/// Whole pictures against references of another renderer, block by block.
mod golden;

/// Numerical stability: sizes, places, gaps, ties and rays at the extremes.
mod extremes;

/// The sums: the tree of chunks.
mod film;
/// Chunks, tiles, threads, stopping.
mod render;

/// The same bytes for all threads, tiles, accelerators and instruction sets, on every sample scene.
mod identity;

/// Meshes that several objects show: one copy, the same picture.
mod instances;

/// Error bars of pixels and pictures.
mod errors;

/// What is counted about the samples: fireflies, the limit and what it takes.
mod counters;

/// Random valid scenes and settings, for as long as one likes.
mod soak;

/// What a file of sums may hold, and the memory of a render.
mod keeping;

/// How much memory there is.
mod memory_limits;

/// What the fuzzers kept.
mod corpora;

/// Measuring: accelerators, rays, meshes, errors of pictures, trade-offs, growth; tables, plots, pages.
mod study;

/// The program from outside.
mod cli;

/// The window: scenes that are edited and saved, previews, panels, the real window.
#[cfg(feature = "gui")]
mod gui;

/// Measurements, which assert nothing.
mod speed;
