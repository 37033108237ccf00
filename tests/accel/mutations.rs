//! Tests of the identity test: it must fail when an accelerator is broken.

use pathtracer::accel::brute_force::BruteForce;
use pathtracer::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use pathtracer::accel::embree::Embree;
use pathtracer::accel::{BuildOptions, Fault, Kernel};
use pathtracer::geometry::{Geometry, Hit, LocalRay, PrimitiveId, Ray, TriangleHit, intersect_triangle};
use pathtracer::math::DVec3;

use crate::support::compare::differences;
use crate::support::rays::rays;
use crate::support::scenes::scene;

/// Another accelerator with the tie rule turned round: of equal distances the highest index.
struct LastOfTies<K>(K);

impl<K: Kernel> Kernel for LastOfTies<K> {
    fn geometry(&self) -> &Geometry {
        self.0.geometry()
    }

    fn closest_triangle(&self, space: u32, ray: &LocalRay) -> Option<TriangleHit> {
        let first = self.0.closest_triangle(space, ray)?;
        let others = (first.index..self.geometry().spaces[space as usize].triangles.len() as u32).rev();
        let mut ties = others.filter_map(|index| {
            let corners = self.geometry().spaces[space as usize].corners(index);
            let (t, u, v) = intersect_triangle(ray, corners)?;
            (t == first.t).then_some(TriangleHit { t, index, u, v })
        });
        ties.next()
    }

    fn any_triangle(&self, space: u32, ray: &LocalRay) -> bool {
        self.0.any_triangle(space, ray)
    }

    fn closest_solid(&self, ray: &Ray, local: &LocalRay, best: Option<Hit>) -> Option<Hit> {
        self.0.closest_solid(ray, local, best)
    }

    fn any_solid(&self, ray: &Ray, local: &LocalRay, t_max: f64, target: PrimitiveId) -> bool {
        self.0.any_solid(ray, local, t_max, target)
    }
}

/// How many of the identity test's rays show a difference to brute force.
fn reported<'s, K: Kernel>(kind: &'static str, build: impl Fn(&'s Geometry) -> K) -> usize {
    let scene = Box::leak(Box::new(scene(kind, DVec3::ZERO)));
    let rays = rays(scene, 20_000, 11);
    differences(&BruteForce::new(&scene.geometry), &build(&scene.geometry), &rays).len()
}

fn faulty(fault: Option<Fault>) -> BuildOptions {
    BuildOptions { fault, ..BuildOptions::default() }
}

fn broken_native(geometry: &Geometry, fault: Option<Fault>) -> Bvh<'_> {
    Bvh::build(geometry, &faulty(fault)).expect("a tree")
}

#[cfg(feature = "embree")]
fn broken_embree(geometry: &Geometry, fault: Option<Fault>) -> Embree<'_> {
    Embree::build(geometry, &faulty(fault)).expect("a tree")
}

#[test]
fn sound_accelerators_are_not_reported() {
    for kind in ["sphere", "duplicated faces", "terrain"] {
        assert_eq!(reported(kind, |geometry| broken_native(geometry, None)), 0, "{kind}");
        #[cfg(feature = "embree")]
        assert_eq!(reported(kind, |geometry| broken_embree(geometry, None)), 0, "{kind}");
    }
}

#[test]
fn a_broken_tie_rule_is_reported() {
    let kind = "duplicated faces";
    assert!(reported(kind, |geometry| LastOfTies(broken_native(geometry, None))) > 0);
    #[cfg(feature = "embree")]
    assert!(reported(kind, |geometry| LastOfTies(broken_embree(geometry, None))) > 0);
}

#[test]
fn shrunk_boxes_are_reported() {
    assert!(reported("sphere", |geometry| broken_native(geometry, Some(Fault::Padding))) > 0);
    #[cfg(feature = "embree")]
    assert!(reported("sphere", |geometry| broken_embree(geometry, Some(Fault::Padding))) > 0);
}

#[test]
fn a_broken_lane_is_reported() {
    assert!(reported("terrain", |geometry| broken_native(geometry, Some(Fault::Lane))) > 0);
    #[cfg(feature = "embree")]
    assert!(reported("terrain", |geometry| broken_embree(geometry, Some(Fault::Lane))) > 0);
}
