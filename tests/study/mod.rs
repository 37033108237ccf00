mod agreement;
mod bench;
mod chart;
#[cfg(feature = "embree")]
mod compare;
mod leaks;
mod meshes;
mod metrics;
mod plot;
mod rays;
mod scaling;
mod seams;
mod statistics;
mod table;
mod tradeoff;
