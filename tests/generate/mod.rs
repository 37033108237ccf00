//! The makers of the committed meshes, shared with the program `generate` (its `main.rs` lies beside this file).

mod blossom_tree;
mod board;
pub(crate) mod files;
mod gallery;
mod implicit;
mod knight;
mod lathe;
mod mesh;
mod random;
mod spiral_scene;
mod tube;
