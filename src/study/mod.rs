//! Measuring itself.
//!
//! - [`compare`]: both accelerators on the same rays of one scene, hits compared bit by bit.
//! - [`bench`](mod@bench): both accelerators at all precisions on meshes of growing size.
//! - [`difference`]: how far two pictures are from each other, by the [`metrics`].
//!
//! The first two stand on the same parts: [`meshes`] to measure on, [`rays`] to measure with (from a [`view`] of a mesh, or
//! recorded from real paths, [`record`]), [`contender`]s that are timed in interleaved rounds ([`rounds`]), a
//! [`verdict`] on two answers that differ and their [`tally`], a count of [`leaks`]. What comes out is data; [`table`] and [`plot`] show it.

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
pub mod table;
pub mod tally;
pub mod verdict;
pub mod view;

mod random;
mod triangles;
