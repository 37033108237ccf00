//! A tree of boxes, to find those that touch another one.

use crate::math::Bounds;

/// A binary tree over boxes.
#[derive(Clone, Debug)]
pub(super) struct BoxTree {
    /// Depth first: the left child of an inner node follows it.
    nodes: Vec<Node>,
    /// Boxes in the order of the leaves.
    order: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    /// Index of the right child; 0 of a leaf.
    right: u32,
    /// Where in the order a leaf's boxes are.
    first: u32,
    count: u32,
}

/// The most boxes that share a leaf.
const LEAF: usize = 4;

impl BoxTree {
    /// The tree over some boxes.
    pub(super) fn new(boxes: &[Bounds]) -> BoxTree {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = Vec::new();
        if !boxes.is_empty() {
            add(&mut nodes, boxes, &mut order, 0);
        }
        BoxTree { nodes, order }
    }

    /// Calls `visit` with every box that may touch `bounds`.
    pub(super) fn touching(&self, bounds: Bounds, mut visit: impl FnMut(u32)) {
        let mut waiting = Vec::new();
        let mut next = 0;
        while let Some(node) = self.nodes.get(next) {
            let touches = node.bounds.touches(bounds);
            if touches && node.right > 0 {
                waiting.push(node.right as usize);
                next += 1;
                continue;
            }
            if touches {
                let places = node.first as usize..(node.first + node.count) as usize;
                self.order[places].iter().for_each(|&index| visit(index));
            }
            let Some(other) = waiting.pop() else { return };
            next = other;
        }
    }
}

/// Adds the subtree over `order`, which begins at the place `first`.
fn add(nodes: &mut Vec<Node>, boxes: &[Bounds], order: &mut [u32], first: u32) {
    let all = || order.iter().map(|&index| boxes[index as usize]);
    let bounds = all().fold(Bounds::EMPTY, Bounds::union);
    let index = nodes.len();
    nodes.push(Node { bounds, right: 0, first, count: order.len() as u32 });
    if order.len() <= LEAF {
        return;
    }
    let middles = all().fold(Bounds::EMPTY, |middles, around| middles.with_point(around.center()));
    let axis = middles.longest_axis();
    let middle = order.len() / 2;
    let key = |index: u32| boxes[index as usize].center()[axis];
    order.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
    let (left, right) = order.split_at_mut(middle);
    add(nodes, boxes, left, first);
    nodes[index].right = nodes.len() as u32;
    add(nodes, boxes, right, first + middle as u32);
}
