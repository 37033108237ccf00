//! One test binary; `cargo test TOPIC` runs one topic, named as its module here.

mod assets; // the committed meshes and scenes
mod generate; // their makers
