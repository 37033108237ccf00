//! Light transport against closed forms. Means are compared by z: |mean - expected| below four standard errors, and
//! the standard error below the width that the test names.

mod camera;
mod caustics;
mod counters;
mod direct;
mod furnace;
mod invariance;
mod narrow;
mod rays;
