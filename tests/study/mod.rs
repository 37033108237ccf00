mod agreement;
mod bench;
#[cfg(feature = "embree")]
mod compare;
mod leaks;
mod meshes;
mod plot;
mod rays;
mod table;
