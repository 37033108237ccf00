//! `Material: FromFile`: what statements become, faces, lights, pictures, mistakes.

use pathtracer::error::Error;
use pathtracer::math::Rgb;
use pathtracer::scene::desc::{MaterialDesc, MaterialKind, ObjectDesc, ShapeDesc};
use pathtracer::scene::{self, Scene};
use pathtracer::world::World;
use std::fs;
use tempfile::TempDir;

const SCENE: &str = "\
Camera: {Position: [0, 0, 5], LookingAt: [0, 0, 0], Fov: 0.3, FocusDistance: 5}
Objects:
  - Object:
      Type: TriangleMesh
      Filepath: mesh.obj
      Position: [0, 0, 0]
      Axes: ZUp
      Material: FromFile
";

/// Three squares in a row.
const MESH: &str = "\
mtllib mesh.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 2 0 0
v 2 1 0
v 3 0 0
v 3 1 0
vt 0 0
vt 1 1
usemtl first one
f 1/1 2/1 3/2 4/2
usemtl second
f 2/1 5/1 6/2 3/2
usemtl first one
f 5/1 7/1 8/2 6/2
";

struct Folder(TempDir);

impl Folder {
    fn new(mesh: &str, materials: &str) -> Folder {
        let folder = Folder(tempfile::tempdir().expect("a temporary folder"));
        folder.write("mesh.obj", mesh);
        folder.write("mesh.mtl", materials);
        folder.write("scene.yaml", SCENE);
        folder
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.path().join(name), text).expect("a file in a temporary folder");
    }

    fn load(&self) -> Result<Scene, Error> {
        scene::load(&self.0.path().join("scene.yaml"))
    }

    fn objects(&self) -> Vec<ObjectDesc> {
        self.load().expect("a valid scene").desc.objects
    }
}

/// What the statements of one material become.
fn kind(statements: &str) -> MaterialKind {
    let mesh = "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\n";
    let objects = Folder::new(mesh, &format!("newmtl a\n{statements}")).objects();
    assert_eq!(objects.len(), 1);
    objects[0].material.kind.clone()
}

fn triangles(object: &ObjectDesc) -> usize {
    let ShapeDesc::TriangleMesh { mesh, .. } = &object.shape else { panic!("a mesh") };
    mesh.triangles.len()
}

#[test]
fn a_picture_for_a_mesh_without_texture_coordinates_is_a_warning() {
    let mesh = "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\nf 1 2 3\n";
    let scene = Folder::new(mesh, "newmtl a\nmap_Kd no.png\n").load().expect("a scene");
    let messages: Vec<&str> = scene.warnings.iter().map(|warning| warning.message.as_str()).collect();
    assert_eq!(messages.len(), 1, "{messages:?}");
    assert!(messages[0].contains("has no texture coordinates"), "{messages:?}");
}

#[test]
fn statements_become_the_four_materials() {
    let (half, grey) = (Rgb::splat(0.5), Rgb::splat(0.25));
    let diffuse = |color, emission| MaterialKind::Diffuse { color, emission };
    assert_eq!(kind("Kd 0.5 0.5 0.5\n"), diffuse(half, Rgb::ZERO));
    assert_eq!(kind(""), diffuse(Rgb::splat(0.8), Rgb::ZERO));
    assert_eq!(kind("Kd 0.5\nKs 1 1 1\nillum 1\n"), diffuse(half, Rgb::ZERO));
    assert_eq!(kind("Kd 0.25 0.25 0.25\nKe 3 2 1\n"), diffuse(grey, Rgb::new(3.0, 2.0, 1.0)));
    assert_eq!(kind("Ks 0.5\nillum 3\n"), MaterialKind::Reflective { color: half, specularity: 1.0 });
    // 1 - 2 / sqrt(14 + 2).
    assert_eq!(kind("Kd 0\nKs 0.5\nNs 14\n"), MaterialKind::Reflective { color: half, specularity: 0.5 });
    assert_eq!(kind("Ks 0.5\nNs 14\n"), MaterialKind::Reflective { color: half, specularity: 0.5 });
    assert_eq!(kind("Kd 1\nd 0.3\nNi 2\n"), MaterialKind::Refractive { color: Rgb::ONE, ratio: 0.5 });
    assert_eq!(kind("Tr 0.5\nTf 0.5\nNi 1.25\n"), MaterialKind::Refractive { color: half, ratio: 0.8 });
    // Half of 0.5 + 0.5 is the coat, each as bright as its share asks.
    let coat = MaterialKind::ClearCoat { color: Rgb::ONE, coat: 0.5, coat_color: Rgb::ONE, specularity: 0.5 };
    assert_eq!(kind("Kd 0.5\nKs 0.5\nNs 14\n"), coat);
}

#[test]
fn every_face_has_its_material() {
    let objects = Folder::new(MESH, "newmtl first one\nKd 1 0 0\nnewmtl second\nKd 0 1 0\n").objects();
    assert_eq!(objects.len(), 1);
    let color = |material: &MaterialDesc| match material.kind {
        MaterialKind::Diffuse { color, .. } => color,
        _ => panic!("a diffuse material"),
    };
    assert_eq!(
        (color(&objects[0].material), objects[0].material.name.as_deref()),
        (Rgb::X, Some("first one"))
    );
    let faces: Vec<(u32, Rgb)> =
        objects[0].faces.iter().map(|(first, material)| (*first, color(material))).collect();
    assert_eq!(faces, [(2, Rgb::Y), (4, Rgb::X)]);
}

#[test]
fn emitting_faces_are_lights_of_their_own() {
    let folder = Folder::new(MESH, "newmtl first one\nKd 1 0 0\nnewmtl second\nKe 5 5 5\n");
    let objects = folder.objects();
    assert_eq!(objects.iter().map(triangles).collect::<Vec<_>>(), [4, 2]);
    assert!(objects[0].faces.is_empty());
    let world = World::compile(&folder.load().expect("a scene").desc).expect("a scene");
    assert_eq!((world.requires.triangles, world.requires.area_lights), (6, 1));
}

#[test]
fn a_picture_is_found_beside_the_materials() {
    let folder = Folder::new(MESH, "newmtl first one\nmap_Kd -s 1 1 1 -o 0 0 wood.png\nnewmtl second\n");
    image::RgbImage::new(2, 2).save(folder.0.path().join("wood.png")).expect("a picture");
    let objects = folder.objects();
    assert!(objects[0].material.textures.color.is_some());
    assert!(objects[0].faces[0].1.textures.color.is_none());
    assert_eq!(World::compile(&folder.load().expect("a scene").desc).expect("a scene").requires.textures, 1);
}

#[test]
fn a_mesh_without_materials_is_grey() {
    let mesh = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";
    let objects = Folder::new(mesh, "").objects();
    assert_eq!(
        objects[0].material.kind,
        MaterialKind::Diffuse { color: Rgb::splat(0.8), emission: Rgb::ZERO }
    );
}

#[test]
fn unknown_statements_are_one_warning() {
    let materials =
        "newmtl first one\nKd spectral a.rfl\nKa 1 1 1\nmap_Bump a.png\nKa 0 0 0\nnewmtl second\nPr 0.5\n";
    let warnings = Folder::new(MESH, materials).load().expect("a scene").warnings;
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].message.contains(": Kd spectral, Ka, map_Bump, Pr of "), "{}", warnings[0].message);
}

#[track_caller]
fn assert_refused(folder: &Folder, part: &str) {
    let error = folder.load().expect_err("a mistake").to_string();
    assert!(error.contains(part), "{error}");
}

#[test]
fn mistakes_are_told_with_their_place() {
    let good = "newmtl first one\nnewmtl second\n";
    assert_refused(&Folder::new(MESH, "newmtl second\n"), "mesh.mtl has no material \"first one\"");
    assert_refused(
        &Folder::new(MESH, &format!("{good}Kd 1 x 1\n")),
        "Kd takes three numbers from 0 to 1e100",
    );
    assert_refused(&Folder::new(MESH, &format!("{good}Ns -1\n")), "mesh.mtl:3:1");
    assert_refused(&Folder::new(MESH, "Kd 1 1 1\n"), "Kd stands before the first newmtl");
    assert_refused(&Folder::new(&MESH.replace("mesh.mtl", "none.mtl"), good), "cannot be read");
    assert_refused(&Folder::new(MESH, "newmtl first one\nmap_Kd none.png\nnewmtl second\n"), "can't be used");
}
