//! The way of a ray through the tree: closest hit and any hit, generic over instructions and leaves.
//!
//! Everything here is inlined into the entry points of [`super::simd`], which are compiled for one instruction set
//! each.

use super::node::{Child, Node, NodeRay};
use super::simd::{Entry, NodeTest, Stack, prefetch};
use crate::geometry::Lanes;

/// What is in the leaves of a tree, and the best hit so far.
pub(super) trait Leaf {
    /// How far a box may begin and still be of interest: the best hit's distance or the ray's end, rounded up. Equal
    /// distances stay in: the index decides between them.
    fn limit(&self) -> f32;

    /// Tries a leaf and keeps the best hit.
    fn closest<L: Lanes>(&mut self, leaf: u32, lanes: L);

    /// Whether anything in a leaf is hit.
    fn any<L: Lanes>(&mut self, leaf: u32, lanes: L) -> bool;

    /// Where a leaf is in memory.
    fn address(&self, leaf: u32) -> *const u8;
}

/// Finds the closest hit; `leaf` holds it afterwards.
#[inline(always)]
pub(super) fn closest<L: Leaf, S: NodeTest>(nodes: &[Node], ray: &NodeRay, leaf: &mut L, lanes: S) {
    let ray = lanes.prepare(ray);
    let mut stack = Stack::new();
    let mut limit = leaf.limit();
    let mut child = Child::ROOT;
    loop {
        if child.is_leaf() {
            leaf.closest(child.index(), lanes);
            limit = leaf.limit();
        } else {
            let node = &nodes[child.index() as usize];
            let (mask, near) = lanes.enter(node, &ray, limit);
            if mask != 0 {
                child = nearest(nodes, node, leaf, mask, near, &mut stack, lanes);
                continue;
            }
        }
        match stack.pop_within(limit) {
            Some(next) => child = next,
            None => return,
        }
    }
}

/// The nearest of the children in `mask`, at least one; the others go on the stack, the farthest first.
#[inline(always)]
fn nearest<L: Leaf, S: NodeTest>(
    nodes: &[Node],
    node: &Node,
    leaf: &L,
    mask: u32,
    near: S::Floats,
    stack: &mut Stack,
    lanes: S,
) -> Child {
    let first = lowest(mask);
    let rest = mask & (mask - 1);
    if rest == 0 {
        return node.children[first];
    }
    let second = lowest(rest);
    if rest & (rest - 1) == 0 {
        let near = lanes.to_array(near);
        let (first, second) = if near[first] < near[second] { (first, second) } else { (second, first) };
        fetch(nodes, leaf, node.children[second]);
        stack.push(Entry::new(near[second], node.children[second]));
        return node.children[first];
    }
    lanes.push_sorted(node, mask, near, stack);
    stack.pop().map_or(Child::NONE, Entry::child)
}

/// The lowest lane in a mask.
#[inline(always)]
fn lowest(mask: u32) -> usize {
    mask.trailing_zeros() as usize & 7
}

/// Asks for the memory of a child that will be visited later.
#[inline(always)]
fn fetch<L: Leaf>(nodes: &[Node], leaf: &L, child: Child) {
    // Both addresses, so that no branch has to be guessed.
    let inner = nodes.as_ptr().wrapping_add(child.index() as usize).cast::<u8>();
    let outer = leaf.address(child.index());
    prefetch::<5>(if child.is_leaf() { outer } else { inner });
}

/// Whether anything is hit; leaves end the search. The leaves of a node are tried at once: high up in the tree they hold
/// what is large, such as walls, and one of them ends the search before the clutter in front of it is looked at. The
/// inner children follow the near ones first, since what is in the way is often near.
#[inline(always)]
pub(super) fn any<L: Leaf, S: NodeTest>(nodes: &[Node], ray: &NodeRay, leaf: &mut L, lanes: S) -> bool {
    let ray = lanes.prepare(ray);
    let mut stack = Stack::new();
    let limit = leaf.limit();
    let mut child = Child::ROOT;
    loop {
        let node = &nodes[child.index() as usize];
        let (mask, near) = lanes.enter(node, &ray, limit);
        let mut outer = mask & node.leaves;
        while outer != 0 {
            if leaf.any(node.children[lowest(outer)].index(), lanes) {
                return true;
            }
            outer &= outer - 1;
        }
        let inner = mask & !node.leaves;
        if inner != 0 {
            child = nearest(nodes, node, leaf, inner, near, &mut stack, lanes);
            continue;
        }
        match stack.pop() {
            Some(next) => child = next.child(),
            None => return false,
        }
    }
}
