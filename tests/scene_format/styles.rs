use super::{CAMERA, mesh_of, parse};
use pathtracer::math::DVec3;
use pathtracer::scene::desc::{MaterialKind, ShapeDesc};
use pathtracer::scene::{self, Scene};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Centres and radii of the balls of a scene.
fn balls(scene: &Scene) -> Vec<(DVec3, f64)> {
    let ball = |shape: &ShapeDesc| match shape {
        ShapeDesc::Ball { position, radius } => (*position, *radius),
        other => panic!("{other:?} is no ball"),
    };
    scene.desc.objects.iter().map(|object| ball(&object.shape)).collect()
}

#[test]
fn block_flow_and_json_style_are_the_same() {
    let block = "Camera:
  Position:
    - 0
    - -5
    - +1
  LookingAt: [0, 0, 1]
  Fov: 3e-1
  FocusDistance: 5.
Objects:
- Object:
    Type: Ball
    Position: [0, 0, .5]
    Radius: 1
    Material:
      Type: Diffuse
";
    let flow = "{Camera: {Position: [0, -5, 1,], LookingAt: [0, 0, 1], Fov: .3, FocusDistance: 5}, Objects: [{Object: \
                {Type: Ball, Position: [0, 0, 0.5], Radius: 1, Material: {Type: Diffuse}}}]}";
    let json = r#"{"Camera":{"Position":[0,-5,1],"LookingAt":[0,0,1],"Fov":0.3,"FocusDistance":5},
"Objects":[{"Object":{"Type":"Ball","Position":[0,0,0.5],"Radius":1,"Material":{"Type":"Diffuse"}}}]}"#;
    let expected = parse(block);
    for text in [flow, json, &block.replace('\n', "\r\n"), &format!("\u{FEFF}---\n{block}...\n")] {
        let scene = parse(text);
        assert_eq!(scene.desc.camera, expected.desc.camera);
        assert_eq!(balls(&scene), [(DVec3::new(0.0, 0.0, 0.5), 1.0)]);
        assert_eq!(scene.desc.objects[0].material, expected.desc.objects[0].material);
    }
}

#[test]
fn anchors_share_values_and_whole_materials() {
    let text = format!(
        "{CAMERA}Objects:
  - Object: {{Type: Ball, Position: &here [1, 2, 3], Radius: &r 0.5, Material: &glass {{Type: Refractive}}}}
  - Object: {{Type: Ball, Position: *here, Radius: *r, Material: *glass}}
"
    );
    let scene = parse(&text);
    assert_eq!(balls(&scene), [(DVec3::new(1.0, 2.0, 3.0), 0.5); 2]);
    assert_eq!(scene.desc.objects[0].material, scene.desc.objects[1].material);
    assert!(matches!(scene.desc.objects[1].material.kind, MaterialKind::Refractive { .. }));
}

#[test]
fn objects_know_where_they_stand() {
    let text = format!(
        "{CAMERA}# two\r\nObjects:\r\n  - Object:\r\n      Type: Ball\r\n      Position: [0, 0, 0]\r\n      Radius: 1\r\n      \
         Material: {{Type: Diffuse}}\r\n  # and one more\r\n  -   {{Name: größer, \"Object\": {{Type: Ball, Position: [0, 0, 0], \
         Radius: 1, Material: {{Type: Diffuse}}}}}}\r\n"
    )
    .replace("Name: größer, ", "");
    let scene = parse(&text);
    let places: Vec<String> = scene.desc.objects.iter().map(|object| object.location.to_string()).collect();
    assert_eq!(places, ["scene.yaml:4:5", "scene.yaml:10:8"]);
}

#[test]
fn the_rivals_style_of_scenes_loads() {
    let folder = Path::new("scenes");
    let mut read = 0;
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "yaml") {
            let scene = scene::load(&path).unwrap_or_else(|error| panic!("{error}"));
            assert!(!scene.desc.objects.is_empty());
            read += 1;
        }
    }
    assert!(read > 0);
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

fn mesh_scene(files: &[&str]) -> String {
    let mut text = format!("{CAMERA}Objects:\n");
    for file in files {
        text += &format!(
            "  - Object: {{Type: TriangleMesh, Filepath: {file}, Position: [0, 0, 0], Material: {{Type: Diffuse}}}}\n"
        );
    }
    text
}

#[test]
fn a_mesh_is_looked_for_beside_the_scene_before_the_working_directory() {
    let folder = tempfile::tempdir().unwrap();
    let scene_file = folder.path().join("scene.yaml");
    let file = "tests/data/meshes/triangle.obj";
    let found = |scene: Scene| match &scene.desc.objects[0].shape {
        ShapeDesc::TriangleMesh { file, .. } => file.clone(),
        other => panic!("{other:?} is no mesh"),
    };
    let text = mesh_scene(&[file]);
    assert_eq!(found(scene::parse(&text, &scene_file).unwrap()), PathBuf::from(file));
    let beside = folder.path().join(file);
    fs::create_dir_all(beside.parent().unwrap()).unwrap();
    fs::write(&beside, TRIANGLE).unwrap();
    assert_eq!(found(scene::parse(&text, &scene_file).unwrap()), beside);
    let absolute = mesh_scene(&[beside.to_str().unwrap()]);
    assert_eq!(found(parse(&absolute)), beside);
}

#[test]
fn objects_that_name_the_same_file_share_it() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.obj", "b.obj"] {
        fs::write(folder.path().join(name), TRIANGLE).unwrap();
    }
    let text = mesh_scene(&["a.obj", "./a.obj", "b.obj"]);
    let scene = scene::parse(&text, &folder.path().join("scene.yaml")).unwrap();
    let [a, same, b] = scene.desc.objects.as_slice() else { panic!("not three objects") };
    assert!(Arc::ptr_eq(mesh_of(a), mesh_of(same)));
    assert!(!Arc::ptr_eq(mesh_of(a), mesh_of(b)));
}
