use super::{BALL, Folder};

#[test]
fn a_good_scene_is_described() {
    let ended = Folder::new().run("check ball.yaml");
    ended.succeeds();
    let lines: Vec<&str> = ended.stdout.lines().collect();
    assert_eq!(lines[0], "ball.yaml: ok");
    assert_eq!(lines[1], "  contains: 1 Ball; 0 triangles in meshes");
    assert!(lines[2].starts_with("  requires: "));
    assert!(lines[3].starts_with("  memory:   about "));
    assert_eq!(ended.stderr, "");
}

#[test]
fn one_bad_scene_among_good_ones_makes_the_exit_code() {
    let folder = Folder::new();
    folder.write("bad.yaml", &BALL.replace("Radius: 1", "Radius: -1"));
    let ended = folder.run("check ball.yaml bad.yaml ball.yaml");
    assert_eq!(ended.code, Some(3));
    assert_eq!(ended.stdout.matches("ball.yaml: ok").count(), 2);
    assert!(ended.stdout.contains("bad.yaml: 1 error\n"), "{}", ended.stdout);
}

#[test]
fn a_missing_scene_does_not_hide_the_others() {
    let ended = Folder::new().run("check missing.yaml ball.yaml");
    assert_eq!(ended.code, Some(3));
    assert!(ended.stdout.contains("missing.yaml"));
    assert!(ended.stdout.contains("ball.yaml: ok"));
}
