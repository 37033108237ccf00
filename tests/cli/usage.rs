use super::{Ended, Folder};

#[test]
fn a_window_without_a_display_is_answered_by_the_usage() {
    let folder = Folder::new();
    for arguments in ["", "gui", "gui ball.yaml", "ball.yaml"] {
        let mut command = folder.command(arguments);
        ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"].iter().for_each(|name| {
            command.env_remove(name);
        });
        let ended = Ended::from(command.output().expect("the program starts"));
        let why = if cfg!(feature = "gui") { "there is no display" } else { "build with `--features gui`" };
        ended.fails(2, why);
        ended.fails(2, "Usage: pathtracer");
    }
}

#[test]
fn two_to_five_positional_arguments_are_too_few() {
    let folder = Folder::new();
    folder.run("ball.yaml --quiet").fails(2, "missing WIDTH HEIGHT SAMPLES BOUNCES IMAGE");
    folder.run("ball.yaml 8").fails(2, "missing HEIGHT SAMPLES BOUNCES IMAGE");
    folder.run("ball.yaml 8 6 --json").fails(2, "missing SAMPLES BOUNCES IMAGE");
    folder.run("ball.yaml 8 6 1").fails(2, "missing BOUNCES IMAGE");
    folder.run("ball.yaml 8 6 1 3").fails(2, "missing IMAGE");
}

#[test]
fn an_argument_too_many_is_named() {
    Folder::new().run("ball.yaml 8 6 1 3 a.png extra").fails(2, "unexpected argument 'extra' after IMAGE");
}

#[test]
fn a_misspelt_command_is_suggested() {
    let message = "there is no scene file 'chek'; did you mean the command 'check'?";
    Folder::new().run("chek ball.yaml").fails(2, message);
    Folder::new().run("chek").fails(2, message);
}

#[test]
fn a_command_after_an_option_is_told_to_come_first() {
    Folder::new().run("--quiet check ball.yaml").fails(2, "the command 'check' must come first");
}

#[test]
fn check_needs_a_scene() {
    Folder::new().run("check").fails(2, "required arguments were not provided");
}

#[test]
fn a_scene_named_like_a_command_is_reached_by_its_path() {
    let folder = Folder::new();
    std::fs::rename(folder.path("ball.yaml"), folder.path("check")).expect("a new name");
    folder.run("./check 8 6 1 3 a.png").succeeds();
    assert!(folder.has("a.png"));
}

#[test]
fn numbers_out_of_range_are_refused_with_the_range() {
    let folder = Folder::new();
    let sides = "expected a whole number from 1 to 65536";
    for size in ["0 6", "8 0", "-5 6", "8 1000000000", "1e3 6", "8.5 6", "99999999999999999999 6"] {
        folder.run(&format!("ball.yaml {size} 1 3 a.png")).fails(2, sides);
    }
    folder.run("ball.yaml 8 6 0 3 a.png").fails(2, "0 samples, which means no limit, can only be given with");
    folder.run("ball.yaml 8 6 1 -3 a.png").fails(2, "'[BOUNCES]': expected a whole number from 1 to");
    folder.run("ball.yaml 8 6 1 3 a.png --threads 0").fails(2, "expected a whole number from 1 to 1024");
    folder.run("ball.yaml 8 6 1 3 a.png --tile -1").fails(2, sides);
    folder.run("ball.yaml 8 6 1 3 a.png --exposure nan").fails(2, "expected a number from -100 to 100");
    assert_eq!(folder.names(), ["ball.yaml"]);
}

#[test]
fn a_picture_too_large_is_refused_before_anything_is_allocated() {
    let folder = Folder::new();
    folder.run("ball.yaml 65536 65536 1 3 a.png").fails(2, "all together at most 1073741824");
}

#[test]
fn an_unknown_option_is_answered_by_a_similar_one() {
    Folder::new().run("ball.yaml 8 6 1 3 a.png --acel native").fails(2, "'--accel'");
}

#[test]
fn an_unknown_name_is_answered_by_the_known_ones() {
    let folder = Folder::new();
    folder.run("ball.yaml 8 6 1 3 a.png --accel rust").fails(2, "[possible values: embree, native]");
    folder.run("ball.yaml 8 6 1 3 a.png --precision f64").fails(2, "exact, robust, fast");
    folder.run("ball.yaml 8 6 1 3 a.png --isa neon").fails(2, "sse2, avx2, avx512");
    folder.run("ball.yaml 8 6 1 3 a.png --sampler halton").fails(2, "sobol, independent");
    folder.run("ball.yaml 8 6 1 3 a.png --light-sampling yes").fails(2, "on, off");
}

#[test]
fn an_unknown_extension_is_refused_before_the_scene_is_read() {
    Folder::new()
        .run("missing.yaml 8 6 1 3 a.gif")
        .fails(2, "known are .png, .exr, .tif, .tiff, .hdr, .jpg, .jpeg");
}

#[cfg(not(feature = "embree"))]
#[test]
fn embree_in_a_build_without_it_is_answered_by_how_to_get_it() {
    Folder::new().run("ball.yaml 8 6 1 3 a.png --accel embree").fails(2, "--features embree");
}

#[test]
fn help_and_version_go_to_stdout() {
    let folder = Folder::new();
    let help = folder.run("--help");
    help.succeeds();
    assert!(help.stdout.contains("--light-sampling"));
    let version = folder.run("--version");
    version.succeeds();
    assert!(version.stdout.starts_with(concat!("pathtracer ", env!("CARGO_PKG_VERSION"), " (Embree: ")));
    assert_eq!(help.stderr + &version.stderr, "");
}

#[test]
fn no_escape_codes_reach_a_pipe() {
    let folder = Folder::new();
    for arguments in ["ball.yaml 8", "--help", "ball.yaml 8 6 1 3 a.png", "ball.yaml x 6 1 3 a.png"] {
        let ended = folder.run(arguments);
        assert!(!(ended.stdout + &ended.stderr).contains('\x1b'), "{arguments}");
    }
}

#[test]
fn what_is_read_is_not_written_over() {
    let folder = Folder::new();
    let scene = folder.read("ball.yaml");
    for name in ["ball.png", "ball.exr"] {
        std::fs::write(folder.path(name), &scene).expect("a copy");
    }
    for arguments in [
        "ball.png 8 8 1 1 ball.png",
        "ball.exr 8 8 1 1 a.png --error-bars ./ball.exr",
        #[cfg(feature = "embree")]
        "compare ball.png --csv ball.png",
        "bench ball.png --csv ball.png",
        "bench ball.png --plot ./ball.png",
        "tradeoff ball.png --csv ball.png",
        "tradeoff ball.png --plot ball.png",
    ] {
        folder.run(arguments).fails(2, "choose another name for what is written");
        assert!(folder.read("ball.png") == scene && folder.read("ball.exr") == scene, "{arguments}");
    }
}
