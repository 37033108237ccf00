//! The native accelerator: a tree of boxes, eight children a node, in pure Rust.
//!
//! A tree for every space of triangles, in blocks of up to eight a leaf, and one for the solids, one a leaf. All share the
//! builder (`build`), the node (`node`) and the traversal (`traverse`); only the leaves differ (`leaf`,
//! `fast`). A ray's whole way through the triangles of the world is compiled for each instruction set (`front`). The boxes
//! and the node test are conservative, the shared leaf decides: so hits are those of [`super::brute_force::BruteForce`],
//! bit by bit, in every instruction set.

mod build;
mod fast;
mod front;
mod leaf;
mod node;
mod presplit;
mod simd;
mod split;
mod traverse;
mod validate;

use rayon::prelude::*;

use self::build::Tree;
use self::fast::FastTriangles;
use self::leaf::{ExactTriangles, Solids};
use self::node::{Node, NodeRay};
pub(super) use self::simd::Instructions;
use self::split::PrimRef;
use super::fault::Fault;
use super::{BuildOptions, BvhQuality, Isa, Kernel, Precision, any_abreast, closest_abreast};
use crate::error::Result;
use crate::geometry::{Geometry, Hit, LocalRay, MeshSpace, PrimitiveId, Ray, TriangleBlock, TriangleHit};
use crate::math::{round_down, round_up};
use crate::memory::advise_huge_pages;

/// Trees over the triangles and the solids of a [`Geometry`].
pub struct Bvh<'g> {
    geometry: &'g Geometry,
    /// Of every space.
    triangles: Vec<TriangleTree>,
    solid_nodes: Vec<Node>,
    solid_order: Vec<u32>,
    precision: Precision,
    quality: BvhQuality,
    instructions: Instructions,
}

/// The tree over the triangles of a space.
#[derive(PartialEq)]
struct TriangleTree {
    nodes: Vec<Node>,
    blocks: Vec<TriangleBlock>,
}

impl TriangleTree {
    fn over(space: &MeshSpace, quality: BvhQuality) -> TriangleTree {
        let tree = triangle_tree(space, quality);
        let blocks = pack(space, &tree);
        TriangleTree { nodes: tree.nodes, blocks }
    }

    fn spoil(&mut self, fault: Fault) {
        fault.spoil(&mut self.blocks);
        if fault == Fault::Padding {
            self.nodes.iter_mut().for_each(Node::shrink);
        }
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.blocks[..])
    }
}

impl<'g> Bvh<'g> {
    /// Builds the trees with rayon's current pool; the result does not depend on the number of threads.
    ///
    /// # Errors
    /// [`crate::error::Error::Usage`] if the machine lacks the instruction set asked for.
    pub fn build(geometry: &'g Geometry, options: &BuildOptions) -> Result<Bvh<'g>> {
        let instructions = Instructions::choose(options.isa)?;
        let over = |space| {
            let mut tree = TriangleTree::over(space, options.quality);
            options.fault.into_iter().for_each(|fault| tree.spoil(fault));
            tree
        };
        let triangles = match options.quality {
            // Side by side they are there sooner, and take more memory at once.
            BvhQuality::Fast => geometry.spaces.par_iter().map(over).collect(),
            BvhQuality::Default | BvhQuality::Quality => geometry.spaces.iter().map(over).collect(),
        };
        let solids = solid_tree(geometry);
        // One solid a leaf: the leaf's index is the place in the order.
        let solid_order = solids.order;
        Ok(Bvh {
            geometry,
            triangles,
            solid_nodes: solids.nodes,
            solid_order,
            precision: options.precision,
            quality: options.quality,
            instructions,
        })
    }

    /// The instruction set in use.
    pub fn isa(&self) -> Isa {
        self.instructions.isa()
    }

    /// Bytes of nodes and leaves, without the geometry's own arrays.
    pub fn bytes(&self) -> usize {
        self.triangles.iter().map(TriangleTree::bytes).sum::<usize>()
            + size_of_val(&self.solid_nodes[..])
            + size_of_val(&self.solid_order[..])
    }
}

impl PartialEq for Bvh<'_> {
    /// The same nodes and leaves in the same places.
    fn eq(&self, other: &Self) -> bool {
        self.triangles == other.triangles
            && self.solid_nodes == other.solid_nodes
            && self.solid_order == other.solid_order
    }
}

/// The triangles of a space in blocks of up to eight, grouped by the surface area heuristic; every triangle is in one block.
pub fn triangle_blocks(space: &MeshSpace, quality: BvhQuality) -> Vec<TriangleBlock> {
    let whole = if quality == BvhQuality::Quality { BvhQuality::Default } else { quality };
    pack(space, &triangle_tree(space, whole))
}

fn pack(space: &MeshSpace, tree: &Tree) -> Vec<TriangleBlock> {
    let block = |leaf: &std::ops::Range<u32>| {
        let indices = &tree.order[leaf.start as usize..leaf.end as usize];
        // Of several pieces of a triangle one is enough.
        let first = |&(place, index): &(usize, &u32)| !indices[..place].contains(index);
        let indices = indices.iter().enumerate().filter(first);
        TriangleBlock::new(indices.map(|(_, &index)| (index, space.corners32(index))))
    };
    let mut blocks = Vec::with_capacity(tree.leaves.len());
    advise_huge_pages(&mut blocks);
    tree.leaves.par_iter().map(block).collect_into_vec(&mut blocks);
    blocks
}

fn triangle_tree(space: &MeshSpace, quality: BvhQuality) -> Tree {
    let prims = match quality {
        BvhQuality::Quality => presplit::pieces(space),
        BvhQuality::Fast | BvhQuality::Default => whole_triangles(space),
    };
    build::build(prims, TriangleBlock::LANES, quality == BvhQuality::Fast)
}

fn whole_triangles(space: &MeshSpace) -> Vec<PrimRef> {
    let triangles = 0..space.triangles.len() as u32;
    let prims = triangles.into_par_iter().map(|index| {
        let (low, high) = triangle_bounds(space, index);
        let padding = triangle_padding(space, low, high);
        PrimRef::new(index, low.map(|x| round_down(x - padding)), high.map(|x| round_up(x + padding)))
    });
    prims.collect()
}

fn triangle_bounds(space: &MeshSpace, index: u32) -> ([f64; 3], [f64; 3]) {
    let [a, b, c] = space.corners(index);
    (a.min(b).min(c).to_array(), a.max(b).max(c).to_array())
}

/// By how much a triangle's box is widened: 2^-21 of its own largest coordinate, and 2^-48 of the farthest that a local
/// ray starts.
///
/// The node test itself is conservative for the ray that the leaf decides about ([`NodeRay`]); this is for the leaf's own
/// roundings. Corners are projected along the ray with errors of a few 2^-53 |corner - origin|, so the leaf takes rays that
/// pass an edge at some 2^-51 of the distance. The first term is more than that for origins up to 2^28 times as far as the
/// triangle, the second for the rest. Being relative to the triangle, it costs a fine mesh nothing beside a huge one.
fn triangle_padding(space: &MeshSpace, low: [f64; 3], high: [f64; 3]) -> f64 {
    let largest = low.into_iter().chain(high).fold(0.0, |most: f64, x| most.max(x.abs()));
    largest / 2_097_152.0 + space.frame.padding() / 536_870_912.0
}

fn solid_tree(geometry: &Geometry) -> Tree {
    let prims = geometry.tree_solids.par_iter().map(|&solid| {
        let (low, high) = geometry.solid_node_bounds(solid);
        PrimRef::new(solid, low, high)
    });
    build::build(prims.collect(), 1, false)
}

impl Bvh<'_> {
    fn solids<'t>(
        &'t self,
        ray: &'t Ray,
        local: &'t LocalRay,
        best: Option<Hit>,
        t_max: f64,
        target: PrimitiveId,
    ) -> Solids<'t> {
        Solids { kernel: self, order: &self.solid_order, ray, local, best, t_max, target }
    }
}

impl Kernel for Bvh<'_> {
    fn geometry(&self) -> &Geometry {
        self.geometry
    }

    #[inline(always)]
    fn closest_triangle(&self, space: u32, ray: &LocalRay) -> Option<TriangleHit> {
        let node_ray = NodeRay::new(ray);
        let TriangleTree { nodes, blocks } = &self.triangles[space as usize];
        if self.precision != Precision::Fast {
            let mut leaf = ExactTriangles::new(blocks, ray);
            self.instructions.closest(nodes, &node_ray, &mut leaf);
            return leaf.best;
        }
        let mut leaf = FastTriangles::new(blocks, ray);
        self.instructions.closest(nodes, &node_ray, &mut leaf);
        leaf.hit()
    }

    #[inline(always)]
    fn any_triangle(&self, space: u32, ray: &LocalRay) -> bool {
        let node_ray = NodeRay::new(ray);
        let TriangleTree { nodes, blocks } = &self.triangles[space as usize];
        if self.precision != Precision::Fast {
            let mut leaf = ExactTriangles::new(blocks, ray);
            return self.instructions.any(nodes, &node_ray, &mut leaf);
        }
        let mut leaf = FastTriangles::new(blocks, ray);
        self.instructions.any(nodes, &node_ray, &mut leaf)
    }

    fn closest_linear_solid(&self, ray: &Ray) -> Option<Hit> {
        closest_abreast(self, self.instructions, ray)
    }

    fn any_linear_solid(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        any_abreast(self, self.instructions, ray, t_max, target)
    }

    fn closest_solid(&self, ray: &Ray, local: &LocalRay, best: Option<Hit>) -> Option<Hit> {
        let mut leaf = self.solids(ray, local, best, f64::INFINITY, PrimitiveId::NONE);
        self.instructions.closest(&self.solid_nodes, &NodeRay::new(local), &mut leaf);
        leaf.best
    }

    fn any_solid(&self, ray: &Ray, local: &LocalRay, t_max: f64, target: PrimitiveId) -> bool {
        let mut leaf = self.solids(ray, local, None, t_max, target);
        self.instructions.any(&self.solid_nodes, &NodeRay::new(local), &mut leaf)
    }

    #[inline]
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        if self.precision == Precision::Fast {
            self.instructions.front_closest::<true>(self, ray)
        } else {
            self.instructions.front_closest::<false>(self, ray)
        }
    }

    #[inline]
    fn any(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        if self.precision == Precision::Fast {
            self.instructions.front_any::<true>(self, ray, t_max, target)
        } else {
            self.instructions.front_any::<false>(self, ray, t_max, target)
        }
    }
}
