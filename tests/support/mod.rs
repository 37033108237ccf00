//! What several topics share: random numbers, meshes, scenes, rays, exact arithmetic, statistics, and the comparison of two accelerators.

pub(crate) mod build;
pub(crate) mod compare;
pub(crate) mod double_double;
pub(crate) mod exact;
pub(crate) mod meshes;
pub(crate) mod random;
pub(crate) mod random_scenes;
pub(crate) mod rays;
pub(crate) mod scenes;
pub(crate) mod stats;
pub(crate) mod watch;
