//! Measuring itself.
//!
//! - [`compare`]: both accelerators on the same rays of one scene, hits compared bit by bit.
//! - [`bench`](mod@bench): both accelerators at all precisions on meshes of growing size.
//! - [`difference`]: how far two pictures are from each other, by the [`metrics`].
//! - [`scaling`]: how the cost of a sample grows with threads, pixels, triangles and lights.
//! - [`tradeoff`]: what every knob of a render costs in time and gains in accuracy.
//!
//! They stand on the same parts: [`meshes`] to measure on, [`rays`] to measure with (from a [`view`] of a mesh, or
//! recorded from real paths, [`record`]), [`contender`]s that are timed in interleaved rounds ([`rounds`]), a
//! [`verdict`] on two answers that differ and their [`tally`], a count of [`leaks`]
//! (at the [`seams`] of any mesh), [`metrics`] of pictures, [`statistics`]. What comes out is data; [`table`] and [`plot`]
//! show it.

pub mod bench;
pub mod compare;
pub mod contender;
pub mod difference;
pub mod leaks;
pub mod machine;
pub mod meshes;
pub mod metrics;
pub mod plot;
pub mod rays;
pub mod record;
pub mod rounds;
pub mod scaling;
pub mod seams;
pub mod statistics;
pub mod table;
pub mod tally;
pub mod tradeoff;
pub mod verdict;
pub mod view;

mod random;
mod triangles;
