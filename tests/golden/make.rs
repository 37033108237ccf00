//! Makes the files of this folder from references of full size.

use super::blocks::{BLOCK, BLOCKS, Blocks, Channels, SIDE, within_blocks};
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
    let Some(folder) = std::env::var_os(VARIABLE).map(PathBuf::from) else {
        println!("{VARIABLE} is not set: nothing is written");
        return;
    };
    let noise = std::fs::read_to_string(folder.join("refs.json")).expect("refs.json");
    let noise: serde_json::Value = serde_json::from_str(&noise).expect("JSON");
    for golden in SCENES {
        let reference = pixels_of(&folder.join(format!("{}_ref.exr", golden.name)));
        let mse = noise[golden.name]["mse"].as_f64().expect("a mean squared error");
        write(&golden.file("_mean.exr"), &within_blocks(&reference).0);
        write(&golden.file("_error.exr"), &standard_errors(&golden, &reference, mse));
    }
}

/// The standard errors of a reference's blocks.
///
/// Most have the shape of our own variance, scaled so that its mean is the reference's mean squared error. But where its
/// renderer is noisy and ours is not (it samples the constant sky of B, which is exact for us), the differences between
/// its pixels and ours are its noise. And no mean of f32 sums is better than a few roundings.
fn standard_errors(golden: &Golden, reference: &[Rgb], mse: f64) -> Channels {
    let seeds = 1000..1016;
    let renders: Vec<Vec<Rgb>> =
        seeds.map(|seed| golden.render(golden.bounces, seed, 8, SamplerKind::Independent)).collect();
    let own = Blocks::of_renders(&renders, SIDE);
    let pixels = (BLOCK * BLOCK) as f64;
    let scale = mse / pixels / (own.variance.iter().sum::<f64>() / own.variance.len() as f64);
    let average =
        |pixel: usize| renders.iter().map(|render| render[pixel]).sum::<Rgb>() / renders.len() as f64;
    let residual: Vec<Rgb> = reference.iter().enumerate().map(|(i, &value)| value - average(i)).collect();
    let (_, residual) = within_blocks(&residual);
    (0..own.mean.len())
        .map(|i| {
            let seen = residual[i] / pixels;
            let shape = own.variance[i] * scale;
            let variance = if own.variance[i] < 0.25 * seen { shape.max(seen) } else { shape };
            variance.sqrt().max(own.mean[i] / 262_144.0)
        })
        .collect()
}

fn write(path: &Path, channels: &[f64]) {
    let floats = channels.iter().map(|&value| value as f32).collect();
    let destination = Destination::new(path).expect("a folder to write to");
    destination.write(BLOCKS as u32, BLOCKS as u32, &Pixels::Floats(floats)).expect("a file written");
}
