//! The committed meshes and scenes: what the generator makes, sound as surfaces.

use crate::generate::files;
use pathtracer::picture::Pixels;
use std::collections::HashMap;
use std::path::Path;

/// The geometry of a committed mesh.
fn mesh(name: &str) -> tobj::Mesh {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("objects").join(name);
    let (models, _) = tobj::load_obj(path, &tobj::LoadOptions::default()).expect("a mesh that can be read");
    assert_eq!(models.len(), 1, "{name} has one group");
    models.into_iter().next().expect("one group").mesh
}

/// The corners of all triangles.
fn triangles(mesh: &tobj::Mesh) -> impl Iterator<Item = [glam::DVec3; 3]> {
    let position = |i: u32| glam::DVec3::from_slice(&mesh.positions[3 * i as usize..]);
    mesh.indices.chunks_exact(3).map(move |t| [position(t[0]), position(t[1]), position(t[2])])
}

/// Every mesh under `objects/` that the generator makes.
fn mesh_names() -> Vec<&'static str> {
    let names = files::all().into_iter().filter_map(|(path, _)| path.strip_prefix("objects/"));
    // The lantern has a group a material.
    names.filter(|name| name.ends_with(".obj") && *name != "lantern.obj").collect()
}

#[test]
fn committed_files_are_what_the_generator_makes() {
    for (path, content) in files::all() {
        let committed = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path));
        let committed = committed.unwrap_or_else(|error| panic!("{path}: {error}"));
        assert!(committed == content, "{path} differs: run `cargo run --release --example generate`");
    }
}

#[test]
fn committed_pictures_are_what_the_generator_makes() {
    for (path, picture) in files::pictures() {
        let committed =
            pathtracer::picture::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).expect(path);
        assert_eq!((committed.width, committed.height), (picture.width, picture.height), "{path}");
        // Of floats the reader makes 32 bits.
        let expected = match picture.pixels {
            Pixels::Halves(halves) => Pixels::Floats(halves.into_iter().map(f32::from).collect()),
            other => other,
        };
        assert!(committed.pixels == expected, "{path} differs: run `cargo run --release --example generate`");
    }
}

/// What `Cargo.toml` puts into the package for Debian, but for what `packaging/deb.sh` makes first.
#[test]
fn files_of_the_package_are_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let manifest = std::fs::read_to_string(root.join("Cargo.toml")).expect("Cargo.toml");
    let assets =
        manifest.split("[package.metadata.deb]").nth(1).expect("a package").split("assets = [").nth(1);
    let lines = assets.expect("assets").lines().map(str::trim).take_while(|line| *line != "]");
    let sources: Vec<&str> = lines.filter_map(|line| line.split('"').nth(1)).collect();
    assert!(sources.len() > 10, "{sources:?}");
    for source in sources.into_iter().filter(|source| !source.starts_with("target/")) {
        let (folder, pattern) = source.rsplit_once('/').unwrap_or((".", source));
        // A pattern has one star.
        let (start, end) =
            (pattern.split('*').next().unwrap_or(""), pattern.split('*').next_back().unwrap_or(""));
        let mut files =
            std::fs::read_dir(root.join(folder)).expect("a folder").map(|entry| entry.expect("an entry"));
        let fits = |name: &str| name.starts_with(start) && name.ends_with(end);
        assert!(files.any(|file| fits(&file.file_name().to_string_lossy())), "there is no {source}");
    }
}

#[test]
fn solid_meshes_are_closed_and_consistently_oriented() {
    for name in ["knight.obj", "tree_bark.obj", "board_light.obj", "board_dark.obj"] {
        let mut edges = HashMap::new();
        for t in mesh(name).indices.chunks_exact(3) {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                *edges.entry((a, b)).or_insert(0) += 1;
            }
        }
        // Each directed edge is there once, and once in the other direction in the neighbour.
        for (&(a, b), &count) in &edges {
            assert_eq!((count, edges.get(&(b, a))), (1, Some(&1)), "{name}: edge {a} {b}");
        }
    }
}

#[test]
fn solid_meshes_face_outwards() {
    for name in ["knight.obj", "tree_bark.obj", "board_light.obj", "board_dark.obj"] {
        let volume: f64 = triangles(&mesh(name)).map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum();
        assert!(volume > 0.0, "{name}: volume {volume}");
    }
}

#[test]
fn no_triangle_is_without_area() {
    for name in mesh_names() {
        for (i, [a, b, c]) in triangles(&mesh(name)).enumerate() {
            assert!((b - a).cross(c - a).length() > 0.0, "{name}: triangle {i}");
        }
    }
}

#[test]
fn normals_have_unit_length_and_agree_with_their_triangles() {
    for name in ["knight.obj", "tree_bark.obj"] {
        let mesh = mesh(name);
        // Three or four decimals: each component is off by at most 5e-4, so the length by at most sqrt(3) times that.
        for normal in mesh.normals.chunks_exact(3) {
            let length = glam::DVec3::from_slice(normal).length();
            assert!((length - 1.0).abs() < 9e-4, "{name}: normal of length {length}");
        }
        let mut opposed = 0;
        for ([a, b, c], corners) in triangles(&mesh).zip(mesh.normal_indices.chunks_exact(3)) {
            let outward = (b - a).cross(c - a);
            let shading = |i: u32| glam::DVec3::from_slice(&mesh.normals[3 * i as usize..]);
            opposed += corners.iter().filter(|&&i| shading(i).dot(outward) <= 0.0).count();
        }
        assert!(opposed == 0, "{name}: {opposed} corners shade as if seen from behind");
    }
}

#[test]
fn mesh_sizes_suit_a_repository() {
    for (path, content) in files::all() {
        assert!(content.len() < 2_000_000, "{path} has {} bytes", content.len());
    }
    let count: usize = mesh_names()
        .iter()
        .filter(|name| name.starts_with("tree"))
        .map(|name| mesh(name).indices.len() / 3)
        .sum();
    assert!((20_000..60_000).contains(&count), "the tree has {count} triangles");
}
