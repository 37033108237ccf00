//! Finds Embree and makes its bindings.
fn main() {}
