use super::{BALL, Folder};

fn information(scene: &str) -> Vec<String> {
    let folder = Folder::new();
    folder.write("scene.yaml", scene);
    let ended = folder.run("scene.yaml 4 3 1 2 a.png");
    ended.succeeds();
    let lines = ended.stderr.lines().skip_while(|line| *line != "===== SCENE INFORMATION =====");
    lines.map(str::to_owned).collect()
}

fn with_object(object: &str) -> String {
    format!("{BALL}  - Object:\n{object}")
}

#[test]
fn a_scene_is_described_as_in_the_original_manual() {
    let lines = information(BALL);
    assert_eq!(lines[1], "Ball at: (5 0 0) with radius: 1, with material: RED DIFFUSE");
    assert_eq!(
        lines[2],
        "Camera at: (0 0 0) looking at point: (5 0 0) with FOV: 59.4 degrees, DOF: 30 and focus distance: 5"
    );
    assert!(lines[3].starts_with("a.png written in "), "{}", lines[3]);
    assert_eq!(lines.len(), 4);
}

#[test]
fn a_material_without_a_name_is_called_by_its_type() {
    let lines = information(&BALL.replace("        Name: RED DIFFUSE\n", ""));
    assert_eq!(lines[1], "Ball at: (5 0 0) with radius: 1, with material: DIFFUSE");
}

#[test]
fn a_box_shows_its_edges_and_rotation() {
    let object = "      Type: Box
      Name: Crate
      Position: [1.5, -2, 0.25]
      Width: 2
      Height: 3
      Depth: 1
      Rotation: [0, 0, 45]
      Material: {Type: ClearCoat}
";
    assert_eq!(
        information(&with_object(object))[2],
        "Box Crate at: (1.5 -2 0.25) with width: 2, height: 3, depth: 1, rotation: (0 0 45), with material: CLEARCOAT"
    );
}

#[test]
fn a_rectangle_shows_its_edges() {
    let object = "      Type: Rectangle
      Position: [1.0e+9, 0, 0.1]
      Width: 2
      Height: 0.333333333333
      Material: {Type: Reflective}
";
    assert_eq!(
        information(&with_object(object))[2],
        "Rectangle at: (1000000000 0 0.1) with width: 2, height: 0.333333, with material: REFLECTIVE"
    );
}

#[test]
fn a_mesh_shows_its_file_and_triangles() {
    let folder = Folder::new();
    folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    let object = "      Type: TriangleMesh
      Filepath: square.obj
      Position: [0, 0, 7]
      Scale: 2
      Material: {Type: Refractive}
";
    folder.write("scene.yaml", &with_object(object));
    let ended = folder.run("scene.yaml 4 3 1 2 a.png");
    ended.succeeds();
    let expected =
        "TriangleMesh at: (0 0 7) with file: square.obj, triangles: 2, scale: 2, with material: REFRACTIVE";
    assert!(ended.stderr.lines().any(|line| line == expected), "{}", ended.stderr);
}

#[test]
fn a_physical_lens_is_shown_by_its_radius() {
    let lines = information(&BALL.replace("DepthOfField: 30", "ApertureRadius: 0.01\n  Angle: 10"));
    assert!(
        lines[2].ends_with("FOV: 59.4 degrees, aperture radius: 0.01 and focus distance: 5, angle: 10"),
        "{}",
        lines[2]
    );
}

#[test]
fn more_than_a_hundred_objects_are_counted_by_type() {
    let object = BALL.split_once("Objects:\n").expect("a list of objects").1;
    let lines = information(&format!("{BALL}{}", object.repeat(100)));
    assert_eq!(lines[1], "Ball: 101");
    assert!(lines[2].starts_with("Camera at: "));
}

#[test]
fn quiet_prints_nothing() {
    let ended = Folder::new().run("ball.yaml 4 3 1 2 a.png --quiet");
    ended.succeeds();
    assert_eq!(ended.stderr + &ended.stdout, "");
}

#[test]
fn a_part_and_a_checkpoint_say_what_they_are() {
    let folder = Folder::new();
    folder.run("ball.yaml 40 36 2 1 a.film --part 1/2 --seed 7 -q").succeeds();
    let told = folder.run("info a.film").stdout;
    let again = "made again by: pathtracer ball.yaml 40 36 2 1 a.film --part 1/2 --seed 7";
    assert!(told.starts_with("a.film: part 1/2 of ball.yaml, 40 x 36 pixels, 2 samples; "), "{told}");
    assert!(told.contains("pathtracer merge PART... IMAGE") && told.trim_end().ends_with(again), "{told}");
    folder.run("ball.yaml 40 36 2 1 a.png --checkpoint b.film -q").succeeds();
    let told = folder.run("info b.film").stdout;
    let goes_on = "goes on by: pathtracer ball.yaml 40 36 2 1 IMAGE --resume b.film";
    assert!(told.starts_with("b.film: a checkpoint of ball.yaml, 40 x 36 pixels, 2 samples; "), "{told}");
    assert!(told.trim_end().ends_with(goes_on), "{told}");
}
