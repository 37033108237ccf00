//! What several topics share: random numbers, meshes, scenes, rays, and the comparison of two accelerators.

pub(crate) mod compare;
pub(crate) mod meshes;
pub(crate) mod random;
pub(crate) mod rays;
pub(crate) mod scenes;
