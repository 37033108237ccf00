//! Builds the tree from boxes: splits by the surface area heuristic over bins, eight children a node, in parallel.
//!
//! The result does not depend on the number of threads: work is cut at fixed places, and partial results are joined in
//! the order of the pieces.

use std::ops::Range;

use glam::Vec4;
use rayon::prelude::*;

use super::node::{Child, Node, WIDTH};
use super::split::{Aabb, PrimRef, bounds_of, split};
use crate::memory::advise_huge_pages;

/// Levels that the surface area heuristic may shape; deeper ones are cut into equal eighths.
pub(super) const SAH_DEPTH: usize = 32;

/// Subtrees over more primitives than this are built by other threads.
const PARALLEL: usize = 4096;

/// A tree, and what its leaves hold.
pub(super) struct Tree {
    /// The root is the first.
    pub(super) nodes: Vec<Node>,
    /// Ranges in `order`, by the index of the leaf.
    pub(super) leaves: Vec<Range<u32>>,
    /// Indices of the primitives.
    pub(super) order: Vec<u32>,
}

/// Some of the primitives, with the boxes around them and around their centres.
pub(super) struct Part<'p> {
    pub(super) prims: &'p mut [PrimRef],
    /// Place of the first in the whole array.
    pub(super) start: usize,
    pub(super) bounds: Aabb,
    pub(super) centroids: Aabb,
}

/// How parts are split.
pub(super) struct Rules {
    /// Primitives that fit into a leaf.
    pub(super) block: usize,
    /// Whether only cuts across the longest axis are looked at.
    pub(super) hasty: bool,
}

/// What the recursion finds, before it is known where in memory it comes to lie.
enum Subtree {
    Leaf(Range<u32>),
    Inner { children: Vec<(Aabb, Subtree)>, nodes: usize, leaves: usize },
}

impl Subtree {
    fn nodes(&self) -> usize {
        match self {
            Subtree::Leaf(_) => 0,
            Subtree::Inner { nodes, .. } => *nodes,
        }
    }

    fn leaves(&self) -> usize {
        match self {
            Subtree::Leaf(_) => 1,
            Subtree::Inner { leaves, .. } => *leaves,
        }
    }
}

/// The tree over `prims`, with up to `block` primitives a leaf; `hasty` looks along one axis only.
pub(super) fn build(mut prims: Vec<PrimRef>, block: usize, hasty: bool) -> Tree {
    if prims.is_empty() {
        return Tree { nodes: vec![Node::EMPTY], leaves: Vec::new(), order: Vec::new() };
    }
    let (bounds, centroids) = bounds_of(&prims);
    let rules = Rules { block, hasty };
    let root = inner(Part { prims: &mut prims, start: 0, bounds, centroids }, &rules, 0);
    let mut nodes = Vec::with_capacity(root.nodes());
    advise_huge_pages(&mut nodes);
    (0..root.nodes()).into_par_iter().map(|_| Node::EMPTY).collect_into_vec(&mut nodes);
    let mut leaves = vec![0..0; root.leaves()];
    place(root, &mut nodes, &mut leaves, 0, 0);
    Tree { nodes, leaves, order: prims.par_iter().map(PrimRef::index).collect() }
}

fn subtree(part: Part, rules: &Rules, depth: usize) -> Subtree {
    if part.prims.len() <= rules.block {
        let start = part.start as u32;
        return Subtree::Leaf(start..start + part.prims.len() as u32);
    }
    inner(part, rules, depth)
}

/// A node over a part: the child with the largest box is split until there are eight.
fn inner(part: Part, rules: &Rules, depth: usize) -> Subtree {
    let parallel = part.prims.len() > PARALLEL;
    let mut parts = Vec::with_capacity(WIDTH);
    parts.push(part);
    while parts.len() < WIDTH {
        let Some(widest) = widest(&parts, rules.block, depth) else { break };
        let (left, right) = split(parts.swap_remove(widest), rules, depth < SAH_DEPTH);
        parts.push(left);
        parts.push(right);
    }
    // Along the array, so that leaves that follow each other in memory are near each other in space.
    parts.sort_by_key(|part| part.start);
    let build = |part: Part| (part.bounds, subtree(part, rules, depth + 1));
    let children: Vec<_> = if parallel {
        parts.into_par_iter().map(build).collect()
    } else {
        parts.into_iter().map(build).collect()
    };
    let nodes = 1 + children.iter().map(|(_, child)| child.nodes()).sum::<usize>();
    let leaves = children.iter().map(|(_, child)| child.leaves()).sum();
    Subtree::Inner { children, nodes, leaves }
}

/// Which of the parts that are too large for a leaf is to be split next: the one with the largest box, or with the
/// most primitives where depth is to be bounded.
fn widest(parts: &[Part], block: usize, depth: usize) -> Option<usize> {
    let size = |part: &Part| {
        if depth < SAH_DEPTH { part.bounds.half_area() } else { part.prims.len() as f32 }
    };
    let splittable = (0..parts.len()).filter(|&i| parts[i].prims.len() > block);
    splittable.max_by(|&a, &b| size(&parts[a]).total_cmp(&size(&parts[b])))
}

/// Writes a subtree to its place: its node first, then its children's, one after the other.
fn place(tree: Subtree, nodes: &mut [Node], leaves: &mut [Range<u32>], first_node: usize, first_leaf: usize) {
    let (children, parallel) = match tree {
        Subtree::Leaf(range) => {
            leaves[0] = range;
            return;
        }
        Subtree::Inner { children, nodes, .. } => (children, nodes > PARALLEL / WIDTH),
    };
    let (root, mut nodes) = nodes.split_at_mut(1);
    let (mut leaves, mut node, mut leaf) = (leaves, first_node + 1, first_leaf);
    let mut jobs = Vec::with_capacity(WIDTH);
    let lanes = by_size(&children);
    for ((bounds, child), lane) in children.into_iter().zip(lanes) {
        let reference = match child {
            Subtree::Leaf(_) => Child::leaf(leaf as u32),
            Subtree::Inner { .. } => Child::node(node as u32),
        };
        root[0].set(lane, xyz(bounds.low), xyz(bounds.high), reference);
        let (own_nodes, other_nodes) = nodes.split_at_mut(child.nodes());
        let (own_leaves, other_leaves) = leaves.split_at_mut(child.leaves());
        let next = (node + child.nodes(), leaf + child.leaves());
        jobs.push((child, own_nodes, own_leaves, node, leaf));
        (nodes, leaves, (node, leaf)) = (other_nodes, other_leaves, next);
    }
    let run = |(child, nodes, leaves, node, leaf)| place(child, nodes, leaves, node, leaf);
    if parallel { jobs.into_par_iter().for_each(run) } else { jobs.into_iter().for_each(run) }
}

/// The lane of each child: the largest box comes first, so that a search for any hit tries large leaves first.
fn by_size(children: &[(Aabb, Subtree)]) -> [usize; WIDTH] {
    let area = |child: &usize| children[*child].0.half_area();
    let mut order: Vec<usize> = (0..children.len()).collect();
    order.sort_by(|a, b| area(b).total_cmp(&area(a)));
    let mut lanes = [0; WIDTH];
    order.into_iter().enumerate().for_each(|(lane, child)| lanes[child] = lane);
    lanes
}

fn xyz(v: Vec4) -> [f32; 3] {
    [v.x, v.y, v.z]
}
