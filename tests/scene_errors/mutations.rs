//! Random damage to good files: whatever comes out, no panic, and every place lies in the file.

use super::{CAMERA, mesh_object};
use pathtracer::error::{Diagnostic, Error};
use pathtracer::scene::desc::{MeshDesc, ShapeDesc};
use pathtracer::scene::{self, Scene};
use std::fs;
use std::path::Path;

const SCENE: &str = "Camera:
  Position: [0, -5, 1]
  LookingAt: [0, 0, 1]   # ahead
  Fov: 0.3
  FocusDistance: 5
  DepthOfField: 30
Environment: {SkyColor: &c [0.2, 0.5, 1], HorizonColor: *c, GroundColor: [1e-1, .1, 0], Strength: 2}
Objects:
  - Object:
      Name: \"gl\u{e4}sern \\x41\"
      Type: Ball
      Position: [0, 0, 1]
      Radius: 1
      Material: &glass
        Type: Refractive
        RefractionRatio: 0.67
        EmissionStrength: 1
  - Object: {Type: Box, Position: [1, 2, 3], Width: 1, Height: 2, Depth: 3, Rotation: [0, 0, 45], Material: *glass}
  - Object:
      Type: TriangleMesh
      Filepath: tests/data/meshes/triangle.obj
      Position: [0, 0, 0]
      Axes: ZUp
      Smooth: false
      Material:
        Type: ClearCoat
        Color: [1, 0, 0]
        ClearCoat: 0.5
        Name: |
          coat
";

const MESH: &str = "# a mesh
o first
v 0 0 0
v 1 0 0 1.5
v 1 1e0 0 0.5 0.5 0.5
v 0 1 .0
vt 0 0
vt 1
vn 0 0 1
s off
f 1 2 3 4
usemtl red
f 1/1/1 2/2/1 \\
  3/1/1
g second
f -4//-1 -2//-1 -1//-1
l 1 2 3
f 1/1 2/1 4/2 # the end
";

/// Knuth's MMIX generator; the high bits are good enough to pick damage.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % limit.max(1)
    }
}

/// Pieces that parsers stumble over.
const PIECES: [&str; 38] = [
    "[",
    "]",
    "{",
    "}",
    ":",
    ": ",
    "- ",
    "-",
    "\n",
    "\r",
    "\t",
    " ",
    "#",
    "'",
    "\"",
    "\\",
    "&c ",
    "*c",
    "*glass",
    "!",
    "!!str ",
    "|",
    ">",
    "? ",
    "%",
    "@",
    "---\n",
    "...",
    "~",
    ".nan",
    "1e999",
    "-9223372036854775808",
    "/",
    "//",
    "f ",
    "v ",
    "\u{85}",
    "\u{2028}",
];

/// `text` with one to four pieces of damage. Bytes, so that encodings break too.
fn mutate(text: &str, random: &mut Random) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..1 + random.below(4) {
        let at = random.below(bytes.len());
        let end = (at + 1 + random.below(12)).min(bytes.len());
        match random.below(6) {
            0 => drop(bytes.drain(at..end)),
            1 => drop(bytes.splice(at..at, PIECES[random.below(PIECES.len())].bytes())),
            2 => drop(bytes.splice(at..end, PIECES[random.below(PIECES.len())].bytes())),
            3 => bytes.truncate(at.max(1)),
            4 => {
                let copy = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                drop(bytes.splice(to..to, copy));
            }
            _ => bytes[at] = random.below(256) as u8,
        }
        if bytes.is_empty() {
            bytes.push(b' ');
        }
    }
    bytes
}

/// Checks that the places of all diagnostics lie in `bytes` and that they can be shown.
fn check_places(diagnostics: &[Diagnostic], file: &Path, bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(&text).replace("\r\n", "\n");
    // A carriage return alone ends a line of YAML, not of OBJ.
    let text = if file.extension().is_some_and(|e| e == "yaml") { text.replace('\r', "\n") } else { text };
    for diagnostic in diagnostics {
        assert!(!diagnostic.to_string().is_empty());
        let Some(location) = diagnostic.location.as_ref().filter(|location| location.file == file) else {
            continue;
        };
        let line = text.split('\n').nth(location.line - 1);
        let line = line.unwrap_or_else(|| panic!("{diagnostic}\nis not in\n{text}"));
        assert!(location.column >= 1 && location.column <= line.chars().count() + 1, "{diagnostic}\n{text}");
    }
}

fn diagnostics_of(outcome: Result<Scene, Error>) -> Vec<Diagnostic> {
    match outcome {
        Ok(scene) => scene.warnings,
        Err(Error::Scene(diagnostics)) => {
            assert!(!diagnostics.is_empty());
            diagnostics
        }
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn damaged_scenes_are_refused_or_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.yaml");
    let mut random = Random(1);
    assert!(scene::parse(SCENE, Path::new("scene.yaml")).is_ok());
    for _ in 0..6000 {
        let bytes = mutate(SCENE, &mut random);
        let outcome = match std::str::from_utf8(&bytes) {
            Ok(text) => scene::parse(text, &path),
            Err(_) => {
                fs::write(&path, &bytes).unwrap();
                scene::load(&path)
            }
        };
        check_places(&diagnostics_of(outcome), &path, &bytes);
    }
}

/// What the documentation of [`MeshDesc`] promises.
fn check_mesh(mesh: &MeshDesc) {
    let triangles = mesh.triangles.len();
    assert!(triangles > 0);
    assert!(mesh.positions.as_flattened().iter().all(|x| x.is_finite()));
    assert!(mesh.normals.iter().all(|n| n.iter().all(|x| x.is_finite()) && n.iter().any(|x| *x != 0.0)));
    assert!(mesh.texcoords.as_flattened().iter().all(|x| x.is_finite()));
    let in_range =
        |indices: &[[u32; 3]], count: usize| indices.as_flattened().iter().all(|&i| (i as usize) < count);
    assert!(in_range(&mesh.triangles, mesh.positions.len()));
    let mut used = vec![false; mesh.positions.len()];
    mesh.triangles.as_flattened().iter().for_each(|&i| used[i as usize] = true);
    assert!(used.into_iter().all(|used| used));
    for (indices, count) in
        [(&mesh.normal_indices, mesh.normals.len()), (&mesh.texcoord_indices, mesh.texcoords.len())]
    {
        assert!(indices.is_empty() || indices.len() == triangles);
        assert!(indices.iter().all(|face| *face == [u32::MAX; 3] || in_range(&[*face], count)));
    }
}

#[test]
fn damaged_meshes_are_refused_or_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.obj");
    let text = format!("{CAMERA}Objects:\n{}", mesh_object("mesh.obj"));
    let mut random = Random(2);
    let mut read = 0;
    for _ in 0..2000 {
        let bytes = mutate(MESH, &mut random);
        fs::write(&path, &bytes).unwrap();
        let outcome = scene::parse(&text, &folder.path().join("scene.yaml"));
        if let Ok(scene) = &outcome {
            let ShapeDesc::TriangleMesh { mesh, .. } = &scene.desc.objects[0].shape else {
                panic!("not a mesh")
            };
            check_mesh(mesh);
            read += 1;
        }
        let diagnostics = diagnostics_of(outcome);
        // Whatever stops the parallel reader is found again by the one that explains it.
        assert!(
            !diagnostics.iter().any(|diagnostic| diagnostic.message.contains("changed while it was read"))
        );
        check_places(&diagnostics, &path, &bytes);
    }
    // Most damage is found; damage to comments, names and digits is not.
    assert!((200..1800).contains(&read), "{read}");
}
