//! The way of a ray through the tree: closest hit and any hit, generic over instructions and leaves.
//!
//! Everything here is inlined into the entry points of [`super::simd`], which are compiled for one instruction set
//! each.

use super::node::{Child, Node, NodeRay};
use super::simd::Lanes;
use super::stack::{Entry, Stack};

/// What is in the leaves of a tree, and the best hit so far.
pub(super) trait Leaf {
    /// How far a box may begin and still be of interest: the best hit's distance or the ray's end, rounded up. Equal
    /// distances stay in: the index decides between them.
    fn limit(&self) -> f32;

    /// Tries a leaf and keeps the best hit.
    fn closest(&mut self, leaf: u32);

    /// Whether anything in a leaf is hit.
    fn any(&self, leaf: u32) -> bool;
}

/// Finds the closest hit; `leaf` holds it afterwards.
#[inline(always)]
pub(super) fn closest<L: Leaf, S: Lanes>(nodes: &[Node], ray: &NodeRay, leaf: &mut L, lanes: S) {
    let mut stack = Stack::new();
    let mut limit = leaf.limit();
    let mut child = Child::ROOT;
    loop {
        if child.is_leaf() {
            leaf.closest(child.index());
            limit = leaf.limit();
        } else {
            let node = &nodes[child.index() as usize];
            let (mask, near) = lanes.enter(node, ray, limit);
            if mask != 0 {
                child = nearest(node, mask, &near, &mut stack);
                continue;
            }
        }
        match stack.pop_within(limit) {
            Some(next) => child = next,
            None => return,
        }
    }
}

/// The nearest of the children that are hit; the others go on the stack, the farthest first.
#[inline(always)]
fn nearest(node: &Node, mut mask: u32, near: &[f32; 8], stack: &mut Stack) -> Child {
    let mut take = || {
        let lane = mask.trailing_zeros() as usize & 7;
        mask &= mask - 1;
        (Entry::new(near[lane], node.children[lane]), mask == 0)
    };
    let (first, alone) = take();
    if alone {
        return first.child();
    }
    let (second, last) = take();
    let (closer, farther) = if first < second { (first, second) } else { (second, first) };
    if last {
        stack.push(farther);
        return closer.child();
    }
    stack.push(farther);
    stack.push(closer);
    let mut count = 2;
    loop {
        let (next, last) = take();
        stack.push(next);
        count += 1;
        if last {
            break;
        }
    }
    stack.sort_top(count)
}

/// Whether anything is hit; leaves end the search.
#[inline(always)]
pub(super) fn any<L: Leaf, S: Lanes>(nodes: &[Node], ray: &NodeRay, leaf: &L, lanes: S) -> bool {
    let mut stack = Stack::new();
    let limit = leaf.limit();
    let mut child = Child::ROOT;
    loop {
        if child.is_leaf() {
            if leaf.any(child.index()) {
                return true;
            }
        } else {
            let node = &nodes[child.index() as usize];
            let (mut mask, _) = lanes.enter(node, ray, limit);
            while mask != 0 {
                stack.push(Entry::new(0.0, node.children[mask.trailing_zeros() as usize & 7]));
                mask &= mask - 1;
            }
        }
        match stack.pop_within(limit) {
            Some(next) => child = next,
            None => return false,
        }
    }
}
