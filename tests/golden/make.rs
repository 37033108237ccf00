//! Makes the files of this folder from references of full size.

use super::blocks::{BLOCKS, Blocks, SIDE, block_means};
use super::{Golden, SCENES, pixels_of};
use pathtracer::math::Rgb;
use pathtracer::picture::{Destination, Pixels};
use pathtracer::sampling::SamplerKind;
use std::path::{Path, PathBuf};

/// Names the folder that holds `A_ref.exr` and so on, and `refs.json` with the mean squared error of each.
const VARIABLE: &str = "PATHTRACER_REFERENCES";

#[test]
#[ignore = "writes the references of this folder, from those in the folder that PATHTRACER_REFERENCES names"]
fn make_references() {
    let folder = PathBuf::from(std::env::var_os(VARIABLE).expect(VARIABLE));
    let noise = std::fs::read_to_string(folder.join("refs.json")).expect("refs.json");
    let noise: serde_json::Value = serde_json::from_str(&noise).expect("JSON");
    for golden in SCENES {
        let mean = block_means(pixels_of(&folder.join(format!("{}_ref.exr", golden.name))).into_iter());
        let mse = noise[golden.name]["mse"].as_f64().expect("a mean squared error");
        let error = standard_errors(&golden, mse);
        write(&golden.file("mean.exr"), &mean);
        write(&golden.file("error.exr"), &error);
    }
}

/// The shape of our own variance, scaled to the reference's mean squared error.
fn standard_errors(golden: &Golden, mse: f64) -> Vec<f64> {
    let seeds = 1000..1016;
    let renders: Vec<Vec<Rgb>> =
        seeds.map(|seed| golden.render(golden.bounces, seed, 8, SamplerKind::Independent)).collect();
    let own = Blocks::of_renders(&renders).variance;
    let mean = own.iter().sum::<f64>() / own.len() as f64;
    let of_block = mse / ((SIDE / BLOCKS) * (SIDE / BLOCKS)) as f64;
    own.iter().map(|variance| (variance / mean * of_block).sqrt()).collect()
}

fn write(path: &Path, channels: &[f64]) {
    let floats = channels.iter().map(|&value| value as f32).collect();
    let destination = Destination::new(path).expect("a folder to write to");
    destination.write(BLOCKS as u32, BLOCKS as u32, &Pixels::Floats(floats)).expect("a file written");
}
