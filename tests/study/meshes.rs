//! Generated meshes: the same on every machine, of the size asked for, closed where they say so.

use pathtracer::geometry::MeshPart;
use pathtracer::study::meshes::Family;
use std::collections::HashMap;

/// FNV-1a of all numbers.
fn hash(mesh: &MeshPart) -> u64 {
    let coordinates = mesh.positions.iter().flat_map(|p| p.to_array().map(f64::to_bits));
    let corners = mesh.triangles.iter().flatten().map(|&corner| u64::from(corner));
    let bytes = coordinates.chain(corners).flat_map(u64::to_le_bytes);
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

#[test]
fn equal_arguments_make_equal_meshes() {
    for family in Family::ALL {
        assert_eq!(hash(&family.make(2000, 7)), hash(&family.make(2000, 7)), "{}", family.name());
    }
}

#[test]
fn meshes_do_not_depend_on_the_number_of_threads() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
    for family in Family::ALL {
        let alone = pool.install(|| hash(&family.make(3000, 1)));
        assert_eq!(alone, hash(&family.make(3000, 1)), "{}", family.name());
    }
}

#[test]
fn another_seed_makes_another_mesh_of_all_but_the_cube() {
    for family in Family::ALL {
        let differs = hash(&family.make(2000, 1)) != hash(&family.make(2000, 2));
        assert_eq!(differs, family != Family::Cube, "{}", family.name());
    }
}

#[test]
fn meshes_are_about_as_large_as_asked_for() {
    for family in Family::ALL {
        for wanted in [10_000, 50_000] {
            let made = family.make(wanted, 3).triangles.len();
            // The coarsest steps are those of the building (a room) and of the cube (a cell more on each side).
            let off = made.abs_diff(wanted) as f64 / wanted as f64;
            assert!(off < 0.08, "{}: {made} triangles, wanted {wanted}", family.name());
        }
    }
}

#[test]
fn every_triangle_has_corners_and_an_area() {
    for family in Family::ALL {
        let mesh = family.make(5000, 4);
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|corner| mesh.positions[corner as usize]);
            let area = (b - a).cross(c - a).length();
            assert!(area.is_finite() && area > 0.0, "{}: {triangle:?}", family.name());
        }
    }
}

/// How often each directed edge is there, with corners told by their places.
fn edges(mesh: &MeshPart) -> HashMap<[[u64; 3]; 2], i32> {
    let place = |corner: u32| mesh.positions[corner as usize].to_array().map(f64::to_bits);
    let mut counts = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *counts.entry([place(from), place(to)]).or_default() += 1;
        }
    }
    counts
}

#[test]
fn closed_meshes_meet_each_edge_from_both_sides() {
    for family in Family::ALL.into_iter().filter(|family| family.is_closed()) {
        let edges = edges(&family.make(4000, 5));
        for ([from, to], count) in &edges {
            assert_eq!(edges.get(&[*to, *from]), Some(count), "{}", family.name());
        }
    }
}

#[test]
fn closed_meshes_face_outward() {
    for family in Family::ALL.into_iter().filter(|family| family.is_closed()) {
        let mesh = family.make(4000, 6);
        // Six times the volume, by the divergence theorem.
        let volume: f64 = mesh
            .triangles
            .iter()
            .map(|t| t.map(|corner| mesh.positions[corner as usize]))
            .map(|[a, b, c]| a.dot(b.cross(c)))
            .sum();
        assert!(volume > 0.0, "{}: {volume}", family.name());
    }
}
