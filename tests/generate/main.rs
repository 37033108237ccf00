//! Writes the meshes and pictures under `objects/` and the long scene under `scenes/`: `cargo run --release --example generate`;
//! with the argument `icon` the icons under `packaging/`.
//!
//! What it writes depends on nothing but its own code, so that the same files come out on every machine.

mod blossom_tree;
mod board;
mod files;
mod gallery;
mod icon;
mod implicit;
mod knight;
mod lathe;
mod mesh;
mod random;
mod spiral_scene;
mod tube;

use pathtracer::picture::Destination;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    if std::env::args().nth(1).as_deref() == Some("icon") {
        return icon::write(root);
    }
    for (path, content) in files::all() {
        println!("{path}: {} bytes", content.len());
        std::fs::write(root.join(path), content)?;
    }
    for (path, picture) in files::pictures() {
        println!("{path}: {} x {} pixels", picture.width, picture.height);
        let place = Destination::new(&root.join(path)).and_then(|place| place.with_depth(picture.depth()));
        place.and_then(|place| place.write_picture(&picture))?;
    }
    Ok(())
}
