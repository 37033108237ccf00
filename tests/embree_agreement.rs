//! Robust: where Embree's kernel and the native one disagree, f32 can't tell.
//!
//! [`Verdict`] derives the bounds; a disagreement beyond them is a fault.

use crate::support::meshes;
use crate::support::random::Random;
use crate::support::rays::rays;
use crate::support::scenes::TestScene;
use pathtracer::accel::bvh::Bvh;
use pathtracer::accel::embree::Embree;
use pathtracer::accel::{Accelerator, BuildOptions, Precision};
use pathtracer::geometry::{Geometry, Hit, MeshPart, Ray};
use pathtracer::math::DVec3;
use pathtracer::study::verdict::Verdict;
use rayon::prelude::*;

/// Rays from anywhere in and around the mesh in all directions.
fn incoherent_rays(count: usize, seed: u64) -> Vec<Ray> {
    let mut random = Random::new(seed);
    (0..count).map(|_| Ray::new(random.in_cube(), random.direction())).collect()
}

/// Every disagreement, and how many rays hit anything.
fn disagreements(native: &Geometry, embree: &Geometry, rays: &[Ray]) -> (Vec<Verdict>, usize) {
    let options = BuildOptions { precision: Precision::Robust, ..Default::default() };
    let bvh = Bvh::build(native, &options).expect("a tree");
    let other = Embree::build(embree, &options).expect("an Embree scene");
    let answers: Vec<(Option<Hit>, Option<Hit>)> =
        rays.par_iter().map(|ray| (bvh.intersect(ray), other.intersect(ray))).collect();
    let hits = answers.iter().filter(|(a, _)| a.is_some()).count();
    let verdicts = rays.iter().zip(answers).map(|(ray, (a, b))| Verdict::on_hits(native, ray, a, b));
    (verdicts.filter(|&verdict| verdict != Verdict::Same).collect(), hits)
}

fn of_mesh(mesh: MeshPart) -> Geometry {
    Geometry::new(Vec::new(), &[mesh])
}

/// No disagreement is a fault; how many there are.
fn assert_explained(scene: &TestScene, rays: &[Ray]) -> usize {
    let (name, geometry) = (scene.name, &scene.geometry);
    let (verdicts, hits) = disagreements(geometry, geometry, rays);
    let of = |verdict| verdicts.iter().filter(|&&v| v == verdict).count();
    let (tie, edge, fault) = (of(Verdict::Tie), of(Verdict::Edge), of(Verdict::Other));
    let count = rays.len();
    println!("{name}: {count} rays, {hits} hits; ties {tie}, at an edge {edge}, other {fault}");
    assert!(hits > count / 4, "{name}: only {hits} hits");
    assert_eq!(fault, 0, "{name}: disagreements that f32 does not explain");
    verdicts.len()
}

/// Incoherent rays, of which one of 10,000 may get different answers.
fn assert_rare(scene: &TestScene, count: usize) {
    let triangles = scene.geometry.spaces[0].triangles.len();
    assert!(triangles >= 100_000, "{}: {triangles} triangles", scene.name);
    let differing = assert_explained(scene, &incoherent_rays(count, 81));
    assert!(differing * 10_000 <= count, "{}: {differing} of {count} rays disagree", scene.name);
}

fn sphere() -> TestScene {
    TestScene::of_meshes("sphere", vec![meshes::sphere(1.0, 320, 0.05, 82)], DVec3::ZERO)
}

fn soup() -> TestScene {
    TestScene::of_meshes("soup", vec![meshes::soup(100_000, 0.02, 83)], DVec3::ZERO)
}

#[test]
fn robust_accelerators_disagree_rarely_on_incoherent_rays() {
    assert_rare(&sphere(), 1_000_000);
    assert_rare(&soup(), 1_000_000);
}

#[test]
#[ignore = "10^7 rays a mesh"]
fn robust_accelerators_disagree_rarely_on_many_incoherent_rays() {
    assert_rare(&sphere(), 10_000_000);
    assert_rare(&soup(), 10_000_000);
    let terrain = TestScene::of_meshes("terrain", vec![meshes::terrain(224, 0.05, 84)], DVec3::ZERO);
    assert_rare(&terrain, 10_000_000);
}

/// Aimed at edges and corners, from inside and from up to 10^4 sizes away, many get different answers; all for a reason.
#[test]
fn robust_accelerators_disagree_only_where_f32_cannot_tell() {
    for scene in [sphere(), soup()] {
        let differing = assert_explained(&scene, &rays(&scene, 300_000, 87));
        assert!(differing > 100, "{}: only {differing} rays disagree", scene.name);
    }
}

/// The classification can fail: one accelerator sees the corners of every hundredth triangle a hundredth of its size
/// elsewhere.
#[test]
fn displaced_corners_are_a_fault() {
    let mesh = meshes::soup(2000, 0.2, 85);
    let mut other = mesh.clone();
    for triangle in mesh.triangles.iter().step_by(100) {
        other.positions[triangle[0] as usize] += DVec3::splat(1e-3);
    }
    let (verdicts, _) = disagreements(&of_mesh(mesh), &of_mesh(other), &incoherent_rays(20_000, 86));
    assert!(verdicts.contains(&Verdict::Other));
}
