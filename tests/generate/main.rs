//! Makes the meshes under `objects/`.
fn main() {}
