use super::CAMERA;
use pathtracer::scene::desc::{MeshDesc, ShapeDesc};
use pathtracer::scene::{self, Scene};
use std::fmt::Write;
use std::fs;

const NONE: [u32; 3] = [u32::MAX; 3];
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// The scene around the mesh file `obj`.
pub(super) fn load(obj: &[u8]) -> Scene {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("mesh.obj"), obj).unwrap();
    let object = "{Type: TriangleMesh, Filepath: mesh.obj, Position: [0, 0, 0], Material: {Type: Diffuse}}";
    let text = format!("{CAMERA}Objects: [{{Object: {object}}}]\n");
    scene::parse(&text, &folder.path().join("scene.yaml")).unwrap_or_else(|error| panic!("{error}"))
}

/// The mesh of a scene's first object.
pub(super) fn mesh_of(scene: &Scene) -> MeshDesc {
    let ShapeDesc::TriangleMesh { mesh, .. } = &scene.desc.objects[0].shape else { panic!("no mesh") };
    MeshDesc::clone(mesh)
}

/// The mesh in `obj`, which must not give warnings.
pub(super) fn mesh(obj: &str) -> MeshDesc {
    let scene = load(obj.as_bytes());
    assert_eq!(scene.warnings, []);
    mesh_of(&scene)
}

/// The corners of each triangle.
pub(super) fn corners(mesh: &MeshDesc) -> Vec<[[f64; 3]; 3]> {
    mesh.triangles.iter().map(|triangle| triangle.map(|i| mesh.positions[i as usize])).collect()
}

/// The area of a mesh in the plane z = 0, triangles wound the other way counted as negative.
pub(super) fn signed_area(mesh: &MeshDesc) -> f64 {
    let doubled = |[a, b, c]: [[f64; 3]; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    corners(mesh).into_iter().map(doubled).sum::<f64>() / 2.0
}

#[test]
fn a_triangle_keeps_its_coordinates_in_full() {
    let mesh = mesh("v 0.1 -2e-9 10000000.1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(mesh.positions[0], [0.1, -2e-9, 10000000.1]);
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert!(mesh.normals.is_empty() && mesh.normal_indices.is_empty());
    assert!(mesh.texcoords.is_empty() && mesh.texcoord_indices.is_empty());
}

#[test]
fn line_ends_comments_continuations_and_encodings_do_not_matter() {
    let expected = mesh(&format!("{SQUARE}f 1 2 3\n"));
    let text = format!("{SQUARE}f 1 2 3");
    let variants: [Vec<u8>; 7] = [
        text.clone().into_bytes(),
        text.replace('\n', "\r\n").into_bytes(),
        format!("\u{FEFF}{text}\n").into_bytes(),
        format!("# first\n  {}# last\n", text.replace('\n', " # comment \\\n\t")).into_bytes(),
        text.replace(" 2 ", " \\\n 2 \\\r\n").into_bytes(),
        [b"# f\xFCr alle\no K\xF6rper\n", text.as_bytes()].concat(),
        text.replace(' ', " \t ").into_bytes(),
    ];
    for variant in variants {
        let scene = load(&variant);
        assert_eq!(mesh_of(&scene), expected, "{}", String::from_utf8_lossy(&variant));
        assert_eq!(scene.warnings, []);
    }
}

#[test]
fn groups_objects_and_materials_are_one_mesh() {
    let text = format!(
        "mtllib none.mtl\no one\n{SQUARE}g a b\ns 1\nusemtl red\nf 1 2 3\ng\no two\ng c\ns off\nusemtl\nf 1 3 4\n"
    );
    assert_eq!(corners(&mesh(&text)), corners(&mesh(&format!("{SQUARE}f 1 2 3\nf 1 3 4\n"))));
}

#[test]
fn lines_points_and_curves_are_left_out() {
    let text = format!("{SQUARE}l 1 2 3 4\np 1 2\ncurv 0 1 1 2\nvp 0.5\nf 1 2 3\n");
    assert_eq!(mesh(&text).triangles.len(), 1);
}

#[test]
fn negative_indices_count_back_from_the_face() {
    let text =
        format!("{SQUARE}vt 0 0\nvt 1 1\nvn 0 0 1\nf -4/-2/-1 -3/-1/-1 -2/-1/-1\nv 9 9 9\nf -5 -3 -2\n");
    let mesh = mesh(&text);
    assert_eq!(
        corners(&mesh),
        [[[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]], [[0.0; 3], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]]
    );
    assert_eq!(mesh.texcoord_indices, [[0, 1, 1], NONE]);
    assert_eq!(mesh.normal_indices, [[0, 0, 0], NONE]);
}

#[test]
fn faces_may_come_before_their_vertices() {
    assert_eq!(corners(&mesh(&format!("f 1 2 3\n{SQUARE}"))), corners(&mesh(&format!("{SQUARE}f 1 2 3\n"))));
}

#[test]
fn faces_without_normals_stay_without_among_others() {
    let text = format!("{SQUARE}vn 0 0 1\nvn 1 0 0\nf 1 2 3\nf 1//2 3//2 4//1\nf 1 2 4\n");
    let mesh = mesh(&text);
    let normals: Vec<[[f32; 3]; 3]> =
        mesh.normal_indices[1..2].iter().map(|n| n.map(|i| mesh.normals[i as usize])).collect();
    assert_eq!(normals, [[[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]]);
    assert_eq!([mesh.normal_indices[0], mesh.normal_indices[2]], [NONE, NONE]);
}

#[test]
fn normals_without_length_are_none_and_extreme_ones_keep_their_direction() {
    let text =
        format!("{SQUARE}vn 0 0 0\nvn 0 0 -1e300\nvn 0 1e-300 0\nf 1//1 2//2 3//2\nf 1//2 3//2 4//3\n");
    let mesh = mesh(&text);
    assert_eq!(mesh.normal_indices[0], NONE);
    let normals = mesh.normal_indices[1].map(|i| mesh.normals[i as usize]);
    assert_eq!(normals, [[0.0, 0.0, -1.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]);
}

#[test]
fn texture_coordinates_may_have_one_to_three_numbers() {
    let mesh = mesh(&format!("{SQUARE}vt 0.25\nvt 0.5 0.75\nvt 1 2 3\nf 1/1 2/2 3/3\n"));
    let texcoords = mesh.texcoord_indices[0].map(|i| mesh.texcoords[i as usize]);
    assert_eq!(texcoords, [[0.25, 0.0], [0.5, 0.75], [1.0, 2.0]]);
}

#[test]
fn weights_divide_and_colours_are_ignored() {
    let mesh = mesh("v 0 0 0 1\nv 2 0 0 2\nv 0 1 0 0.1 0.2 0.3\nv 0 0 1 1 1 1 1\nf 1 2 3\nf 1 2 4\n");
    assert_eq!(corners(&mesh)[0], [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
}

#[test]
fn faces_without_area_are_dropped_and_counted() {
    // Equal corners, equal positions, corners in a line.
    let text = format!("{SQUARE}v 1 0 0\nv 2 0 0\nf 1 1 2\nf 1 2 5\nf 1 2 6\nf 1 2 3\n");
    let scene = load(text.as_bytes());
    assert_eq!(mesh_of(&scene).triangles.len(), 1);
    let [warning] = scene.warnings.as_slice() else { panic!("expected one warning") };
    assert!(warning.message.starts_with("Objects[0].Object.Filepath: 3 faces without area dropped from "));
}

#[test]
fn the_smallest_faces_that_have_area_stay() {
    let mesh = mesh("v 0 0 0\nv 1e-150 0 0\nv 0 1e-150 0\nf 1 2 3\n");
    assert_eq!(mesh.triangles.len(), 1);
}

#[test]
fn convex_polygons_become_fans() {
    let mesh = mesh("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n");
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 3, 4]]);
}

#[test]
fn a_concave_quadrilateral_is_split_at_its_dent() {
    // An arrow head in each of the three planes, wound both ways, from every first corner.
    for axis in 0..3 {
        for first in 0..4 {
            for reverse in [false, true] {
                let mut points = [[0.0, 2.0], [-1.0, 0.0], [0.0, 0.5], [1.0, 0.0]];
                points.rotate_left(first);
                if reverse {
                    points.reverse();
                }
                let mut text = String::new();
                for [x, y] in points {
                    let mut p = [x, y, 0.1 * x];
                    p.rotate_right(axis);
                    writeln!(text, "v {} {} {}", p[0], p[1], p[2]).unwrap();
                }
                let mut mesh = mesh(&format!("{text}f 1 2 3 4\n"));
                mesh.positions.iter_mut().for_each(|p| p.rotate_left(axis));
                assert_eq!(mesh.triangles.len(), 2);
                // Without overlap the absolute areas sum to the area of the arrow head.
                let area: f64 = corners(&mesh)
                    .iter()
                    .map(|[a, b, c]| {
                        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs() / 2.0
                    })
                    .sum();
                assert_eq!(area, 1.5);
            }
        }
    }
}

#[test]
fn a_comb_is_covered_once() {
    // Twenty teeth of width 1 and height 8, gaps of width 1, on a bar of height 1. All coordinates are integers, so
    // areas are exact.
    let mut points = vec![[0, -1], [39, -1]];
    for tooth in (0..20).rev() {
        points.extend([[2 * tooth + 1, 0], [2 * tooth + 1, 8], [2 * tooth, 8], [2 * tooth, 0]]);
    }
    let mut text = String::new();
    let mut face = "f".to_owned();
    for (i, [x, y]) in points.iter().enumerate() {
        writeln!(text, "v {x} {y} 0").unwrap();
        write!(face, " {}", i + 1).unwrap();
    }
    let mesh = mesh(&format!("{text}{face}\n"));
    let area: f64 = 39.0 + 20.0 * 8.0;
    assert_eq!(signed_area(&mesh), area);
    let doubled = |[a, b, c]: [[f64; 3]; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    assert!(corners(&mesh).into_iter().all(|triangle| doubled(triangle) > 0.0));
}

#[test]
fn corners_on_straight_edges_stay_corners() {
    let mesh = mesh("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4 5\n");
    assert_eq!(signed_area(&mesh), 4.0);
    let mut used: Vec<u32> = mesh.triangles.concat();
    used.sort();
    used.dedup();
    assert_eq!(used, [0, 1, 2, 3, 4]);
}

#[test]
fn a_polygon_keeps_the_normals_and_texture_coordinates_of_its_corners() {
    let text = format!("{SQUARE}vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n");
    let mesh = mesh(&text);
    assert_eq!(mesh.triangles, mesh.texcoord_indices);
    assert_eq!(mesh.normal_indices, [[0; 3]; 2]);
}

#[test]
fn a_mesh_of_a_million_faces_is_whole() {
    // A strip of triangles.
    let count = 1_100_000u32;
    let mut text = String::new();
    for i in 0..count + 2 {
        writeln!(text, "v {} {} 0", i / 2, i % 2).unwrap();
    }
    for i in 1..=count {
        writeln!(text, "f {} {} {}", i, i + 1, i + 2).unwrap();
    }
    let mesh = mesh(&text);
    assert_eq!(mesh.triangles.len(), count as usize);
    for (i, triangle) in (0u32..).zip(&mesh.triangles) {
        let expected = [i, i + 1, i + 2].map(|i| [f64::from(i / 2), f64::from(i % 2), 0.0]);
        assert_eq!(triangle.map(|i| mesh.positions[i as usize]), expected);
    }
}
