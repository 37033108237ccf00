//! Passes on what `embree-sys` found: the version, for the program to print, and the place of a library that the
//! loader does not know, as the run path of the binaries.

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let version = env::var("DEP_EMBREE_VERSION").unwrap_or_else(|_| "none".to_string());
    println!("cargo::rustc-env=PATHTRACER_EMBREE_VERSION={version}");
    if let Ok(folder) = env::var("DEP_EMBREE_RPATH") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{folder}");
    }
}
