//! Tests of the identity test: it must fail when an accelerator is broken.

use pathtracer::accel::brute_force::BruteForce;
use pathtracer::accel::bvh::triangle_blocks;
use pathtracer::accel::{BvhQuality, Kernel};
use pathtracer::geometry::{
    Geometry, Hit, LocalRay, PrimitiveId, Ray, TriangleBlock, TriangleHit, any_in_block, closest_in_block,
    intersect_triangle,
};
use pathtracer::math::DVec3;

use super::native;
use crate::support::compare::differences;
use crate::support::rays::rays;
use crate::support::scenes::scene;

/// The shared leaf, over one space, in blocks whose boxes are tried first: the smallest accelerator, which is then broken.
struct Blocks<'g> {
    geometry: &'g Geometry,
    blocks: Vec<TriangleBlock>,
    /// Added to the boxes on all sides.
    padding: f32,
}

impl<'g> Blocks<'g> {
    fn new(geometry: &'g Geometry, padding: f32) -> Blocks<'g> {
        Blocks { geometry, blocks: triangle_blocks(&geometry.spaces[0], BvhQuality::Default), padding }
    }

    fn visited<'r>(&'r self, ray: &'r LocalRay) -> impl Iterator<Item = &'r TriangleBlock> {
        self.blocks.iter().filter(move |block| {
            let (low, high) = block.bounds();
            let (o, d) = (ray.origin.to_array(), ray.direction.to_array());
            let (mut near, mut far) = (0f32, f32::INFINITY);
            for axis in 0..3 {
                let first = (low[axis] - self.padding - o[axis]) / d[axis];
                let last = (high[axis] + self.padding - o[axis]) / d[axis];
                near = near.max(first.min(last));
                far = far.min(first.max(last));
            }
            near <= far
        })
    }
}

impl Kernel for Blocks<'_> {
    fn geometry(&self) -> &Geometry {
        self.geometry
    }

    fn closest_triangle(&self, _: u32, ray: &LocalRay) -> Option<TriangleHit> {
        let mut best = None;
        for block in self.visited(ray) {
            closest_in_block(block, ray, &mut best);
        }
        best
    }

    fn any_triangle(&self, _: u32, ray: &LocalRay) -> bool {
        self.visited(ray).any(|block| any_in_block(block, ray))
    }

    fn closest_solid(&self, ray: &Ray, local: &LocalRay, best: Option<Hit>) -> Option<Hit> {
        BruteForce::new(self.geometry).closest_solid(ray, local, best)
    }

    fn any_solid(&self, ray: &Ray, local: &LocalRay, t_max: f64, target: PrimitiveId) -> bool {
        BruteForce::new(self.geometry).any_solid(ray, local, t_max, target)
    }
}

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

#[test]
fn a_sound_block_kernel_is_not_reported() {
    for kind in ["sphere", "duplicated faces"] {
        // Widened by far more than its plain slab test errs.
        assert_eq!(reported(kind, |geometry| Blocks::new(geometry, 1e-4)), 0, "{kind}");
    }
}

#[test]
fn a_broken_tie_rule_is_reported() {
    assert!(reported("duplicated faces", |geometry| LastOfTies(native(geometry))) > 0);
}

#[test]
fn shrunk_boxes_are_reported() {
    assert!(reported("sphere", |geometry| Blocks::new(geometry, -1e-6)) > 0);
}

#[test]
fn a_broken_lane_is_reported() {
    let broken = |geometry| {
        let mut kernel = Blocks::new(geometry, 1e-4);
        for block in &mut kernel.blocks {
            let kept = block.indices().enumerate().filter(|&(lane, _)| lane != 3);
            *block = TriangleBlock::new(kept.map(|(_, index)| (index, geometry.spaces[0].corners32(index))));
        }
        kernel
    };
    assert!(reported("terrain", broken) > 0);
}
