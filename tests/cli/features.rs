//! `--aov` and `--denoise`.

use super::Folder;
use exr::prelude::{FlatSamples, read_all_flat_layers_from_file};
use std::collections::BTreeMap;

/// The channels of an EXR by their names, as f32.
fn channels(folder: &Folder, name: &str) -> BTreeMap<String, Vec<f32>> {
    let image = read_all_flat_layers_from_file(folder.path(name)).expect("an EXR");
    let list = &image.layer_data[0].channel_data.list;
    let values = |samples: &FlatSamples| samples.values_as_f32().collect::<Vec<f32>>();
    list.iter().map(|channel| (channel.name.to_string(), values(&channel.sample_data))).collect()
}

#[test]
fn features_are_channels_beside_the_same_light() {
    let folder = Folder::new();
    folder.run("ball.yaml 9 9 16 4 plain.exr").succeeds();
    folder.run("ball.yaml 9 9 16 4 a.exr --aov albedo,normal,depth,position,object").succeeds();
    let (plain, all) = (channels(&folder, "plain.exr"), channels(&folder, "a.exr"));
    for name in ["R", "G", "B"] {
        assert_eq!(plain[name], all[name], "{name}");
    }
    assert_eq!(plain.len(), 3);
    assert_eq!(all.len(), 3 + 3 + 3 + 1 + 3 + 1);
    // The middle pixel sees the front of the ball of radius 1 at (5, 0, 0), the corner the sky. A pixel is 0.5 wide there.
    let (middle, corner) = (40, 0);
    let near = |name: &str, expected: f32, width: f32| {
        let value = all[name][middle];
        assert!((value - expected).abs() <= width, "{name}: {value} instead of {expected}");
    };
    near("Albedo.R", 0.8, 1e-6);
    near("Albedo.G", 0.1, 1e-6);
    near("Normal.X", -1.0, 0.1);
    near("Z", 4.0, 0.1);
    near("Position.X", 4.0, 0.1);
    near("Position.Y", 0.0, 0.1);
    near("id", 1.0, 0.0);
    assert_eq!(all["id"][corner], 0.0);
    assert_eq!(all["Z"][corner], 1e10);
    assert_eq!(all["Normal.X"][corner], 0.0);
}

#[test]
fn samples_and_errors_are_channels() {
    let folder = Folder::new();
    let options = "--noise 0.01 --error-bars bars.exr --aov samples,error";
    folder.run(&format!("ball.yaml 40 24 256 4 a.exr {options}")).succeeds();
    let (all, bars) = (channels(&folder, "a.exr"), channels(&folder, "bars.exr"));
    // Error bars have the mean in R, the standard error in G.
    assert_eq!(all["error"], bars["G"]);
    let samples = &all["samples"];
    assert!(samples.iter().all(|&count| (16.0..=256.0).contains(&count)));
    assert!(samples.iter().any(|&count| count != samples[0]), "blocks stop after different numbers");
    folder.run("ball.yaml 8 6 40 4 b.exr --aov samples,error").succeeds();
    let all = channels(&folder, "b.exr");
    assert_eq!(all["samples"], [40.0; 48]);
    assert!(all["error"].iter().any(|&error| error > 0.0));
}

#[test]
fn errors_of_too_few_samples_are_left_out_and_said_so() {
    let folder = Folder::new();
    let ended = folder.run("ball.yaml 8 6 8 4 a.exr --aov error");
    ended.succeeds();
    assert!(
        ended.stderr.contains(
            "no errors of the pixels were written (--error-bars, --aov error): they need 16 samples"
        ),
        "{}",
        ended.stderr
    );
    assert_eq!(channels(&folder, "a.exr").len(), 3);
}

/// Of what shines and reflects nothing, the albedo is the light: so both see the same edges if they see by the same rays.
#[test]
fn features_see_by_the_rays_of_the_light() {
    let folder = Folder::new();
    folder.write(
        "lamp.yaml",
        "Camera: { Position: [0, 0, 0], LookingAt: [1, 0, 0], Fov: 0.25, FocusDistance: 1 }\n\
         Environment: { SkyColor: [0, 0, 0], HorizonColor: [0, 0, 0], GroundColor: [0, 0, 0] }\n\
         Objects:\n  - Object:\n      Type: Ball\n      Position: [5, 0, 0]\n      Radius: 1.3\n      \
         Material: { Type: Diffuse, Color: [0, 0, 0], EmissionStrength: 0.5 }\n",
    );
    for options in ["--sampler independent", "--scramble-length 1"] {
        folder.run(&format!("lamp.yaml 16 16 32 1 a.exr --aov albedo {options}")).succeeds();
        let all = channels(&folder, "a.exr");
        assert_eq!(all["R"], all["Albedo.R"], "{options}");
        assert!(all["R"].iter().any(|&value| value > 0.0 && value < 0.5), "edges are seen");
    }
}

#[test]
fn features_are_the_same_for_all_threads() {
    let folder = Folder::new();
    let render = |name: &str, threads: &str| {
        folder
            .run(&format!("ball.yaml 24 16 4 3 {name} --aov albedo,depth,object --threads {threads}"))
            .succeeds();
        folder.read(name)
    };
    assert!(render("a.exr", "1") == render("b.exr", "3"));
}

#[test]
fn features_need_an_exr() {
    Folder::new()
        .run("ball.yaml 8 6 1 3 a.png --aov depth")
        .fails(2, "--aov needs a picture that ends in .exr");
    Folder::new().run("ball.yaml 8 6 1 3 a.exr --aov speed").fails(2, "invalid value 'speed'");
}

#[test]
fn a_missing_denoiser_says_how_to_get_it() {
    let folder = Folder::new();
    let mut command = folder.command("ball.yaml 8 6 1 3 a.png --denoise");
    let output = command.env("OIDN_DIR", folder.path("none")).output().expect("the program starts");
    let ended = super::Ended::from(output);
    ended.fails(1, "pip install pyoidn");
    assert_eq!(folder.names(), ["ball.yaml"]);
}

/// Runs where the denoiser is found.
#[test]
fn a_denoised_picture_says_so_and_keeps_the_noisy_one() {
    let folder = Folder::new();
    let ended = folder.run("ball.yaml 40 30 2 4 a.exr --denoise");
    if ended.code == Some(1) && ended.stderr.contains("pip install pyoidn") {
        println!("no denoiser here: nothing is tested");
        return;
    }
    ended.succeeds();
    folder.run("ball.yaml 40 30 2 4 b.exr").succeeds();
    assert!(folder.read("a.noisy.exr") == folder.read("b.exr"));
    assert!(folder.run("info a.exr").stdout.contains("oidn-2."));
    folder.run("diff a.exr a.noisy.exr --fail-above rmse=0.2").succeeds();
    assert_eq!(folder.run("diff a.exr a.noisy.exr --fail-above max=0").code, Some(4));
}
