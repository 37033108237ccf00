//! What pictures say about how they were made: `pathtracer info`, `--stamp`.

use super::{BALL, Folder};

const RENDER: &str = "ball.yaml 24 16 3 4";

/// The last line that `info` prints, without the words before the arguments.
fn command(folder: &Folder, picture: &str) -> String {
    let ended = folder.run(&format!("info {picture}"));
    ended.succeeds();
    let line = ended.stdout.lines().last().expect("a line").to_owned();
    line.strip_prefix("made again by: pathtracer ").unwrap_or_else(|| panic!("{line}")).to_owned()
}

#[test]
fn the_command_that_info_prints_makes_the_same_file_again() {
    for extension in ["png", "exr"] {
        for options in [
            "",
            "--seed 18446744073709551615 --sampler independent --clamp 0.7 --exposure -1.5",
            "--light-sampling off",
        ] {
            let folder = Folder::new();
            let name = format!("a.{extension}");
            folder.run(&format!("{RENDER} {name} {options}")).succeeds();
            let before = folder.read(&name);
            folder.run(&command(&folder, &name)).succeeds();
            assert!(folder.read(&name) == before, "{extension} {options}");
        }
    }
}

#[test]
fn a_picture_of_a_textured_scene_is_made_again_until_its_texture_changes() {
    for (extension, options) in [("png", ""), ("exr", "--aov albedo")] {
        let folder = Folder::new();
        let wood = |value: u8| {
            image::RgbImage::from_fn(16, 12, |x, y| image::Rgb([value, x as u8 * 9, y as u8 * 9]))
        };
        wood(200).save(folder.path("wood.png")).expect("a picture");
        let color = BALL.lines().find(|line| line.trim_start().starts_with("Color:")).expect("a colour");
        folder.write("ball.yaml", &BALL.replace(color, "        Color: { Image: wood.png }"));
        let name = format!("a.{extension}");
        folder.run(&format!("{RENDER} {name} {options}")).succeeds();
        let before = folder.read(&name);
        folder.run(&command(&folder, &name)).succeeds();
        assert!(folder.read(&name) == before, "{extension}");
        wood(90).save(folder.path("wood.png")).expect("a picture");
        folder.run(&format!("{RENDER} b.{extension}")).succeeds();
        let hash = |name: &str| {
            let stdout = folder.run(&format!("info {name}")).stdout;
            stdout.lines().find(|line| line.contains("sceneHash")).expect("a hash").to_owned()
        };
        assert_ne!(hash(&name), hash(&format!("b.{extension}")));
    }
}

#[test]
fn the_command_tells_every_setting_that_changes_pixels() {
    let folder = Folder::new();
    folder
        .run(&format!("{RENDER} a.png --accel native --precision fast --threads 2 --tile 8 --clamp 0.5"))
        .succeeds();
    assert_eq!(
        command(&folder, "a.png"),
        "ball.yaml 24 16 3 4 a.png --seed 0 --sampler sobol --light-sampling on --clamp 0.5 --precision fast --accel \
         native --exposure 0"
    );
}

#[test]
fn png_and_exr_say_the_same_but_for_the_exposure() {
    let folder = Folder::new();
    let says = |name: &str| {
        folder.run(&format!("{RENDER} {name}")).succeeds();
        let stdout = folder.run(&format!("info {name}")).stdout;
        let lines =
            stdout.lines().skip(1).filter(|line| !line.contains("exposure") && !line.contains("made again"));
        let mut lines: Vec<String> =
            lines.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
        lines.sort();
        lines
    };
    let lines = says("a.exr");
    assert!(lines.contains(&"samplesPerPixel 3".to_owned()), "{lines:?}");
    assert!(lines.contains(&"fov 59.4".to_owned()), "{lines:?}");
    assert_eq!(lines, says("a.png"));
}

#[test]
fn the_scene_hash_sees_the_contents_of_meshes_and_not_their_place() {
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let object = "  - Object:
      Type: TriangleMesh
      Filepath: mesh.obj
      Position: [5, 0, 0]
      Material: {Type: Diffuse}
";
    let hash = |mesh: &str| {
        let folder = Folder::new();
        folder.write("mesh.obj", mesh);
        folder.write("ball.yaml", &format!("{BALL}{object}"));
        folder.run(&format!("{RENDER} a.png")).succeeds();
        let stdout = folder.run("info a.png").stdout;
        stdout.lines().find(|line| line.contains("sceneHash")).expect("a hash").to_owned()
    };
    assert_eq!(hash(mesh), hash(mesh));
    assert_ne!(hash(mesh), hash(&mesh.replace("1 0 0", "2 0 0")));
}

#[test]
fn a_stamp_tells_time_and_threads() {
    let folder = Folder::new();
    for name in ["a.png", "a.exr"] {
        folder.run(&format!("{RENDER} {name} --stamp --threads 2")).succeeds();
        let stdout = folder.run(&format!("info {name}")).stdout;
        for part in ["DateTime", "renderTimeSeconds", "pathtracer:threads"] {
            assert!(stdout.contains(part), "{name}: {stdout}");
        }
    }
    folder.run(&format!("{RENDER} b.png --threads 2")).succeeds();
    assert!(!folder.run("info b.png").stdout.contains("DateTime"));
}

#[test]
fn a_picture_of_another_program_has_no_command() {
    let folder = Folder::new();
    image::RgbImage::new(3, 2).save(folder.path("a.png")).expect("a picture");
    let ended = folder.run("info a.png");
    ended.succeeds();
    assert_eq!(
        ended.stdout,
        "a.png: PNG, 3 x 2 pixels\nthe picture does not say how this program would make it\n"
    );
}

#[test]
fn what_is_no_picture_is_refused() {
    let folder = Folder::new();
    folder.write("text.png", "no picture");
    folder.write("text.exr", "no picture");
    folder.write("empty.exr", "");
    for name in ["text.png", "text.exr", "empty.exr", "missing.png"] {
        folder.run(&format!("info {name}")).fails(1, &format!("cannot read the picture {name}: "));
    }
}
