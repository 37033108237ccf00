//! A check of every node, for tests.

use super::node::{Child, MAX_DEPTH, Node, WIDTH};
use super::{Bvh, triangle_bounds};
use crate::geometry::MeshSpace;

impl Bvh<'_> {
    /// Checks that every triangle and every solid of the trees is in exactly one leaf, that every box holds everything
    /// below it, that no node is shared or out of reach, and that no path is longer than the stack allows.
    /// The first thing that is wrong, in words.
    pub fn validate(&self) -> Result<(), String> {
        for (space, tree) in self.geometry.spaces.iter().zip(&self.triangles) {
            let leaf = |leaf: u32| {
                let block = tree.blocks.get(leaf as usize).ok_or("a leaf that is not there")?;
                Ok(block.indices().map(|index| (index, exact_bounds(space, index))).collect())
            };
            check(&tree.nodes, tree.blocks.len(), (0..space.triangles.len() as u32).collect(), leaf)?;
        }
        let solid_leaf = |leaf: u32| {
            let &solid = self.solid_order.get(leaf as usize).ok_or("a leaf that is not there")?;
            Ok(vec![(solid, self.geometry.solid_node_bounds(solid))])
        };
        check(&self.solid_nodes, self.solid_order.len(), self.geometry.tree_solids.clone(), solid_leaf)
    }
}

/// Lower and upper corner.
type Corners = ([f32; 3], [f32; 3]);

fn exact_bounds(space: &MeshSpace, index: u32) -> Corners {
    let (low, high) = triangle_bounds(space, index);
    (low.map(|x| x as f32), high.map(|x| x as f32))
}

fn check(
    nodes: &[Node],
    leaves: usize,
    mut expected: Vec<u32>,
    leaf: impl Fn(u32) -> Result<Vec<(u32, Corners)>, &'static str>,
) -> Result<(), String> {
    let (mut seen_nodes, mut seen_leaves) = (vec![0u32; nodes.len()], vec![0u32; leaves]);
    let mut found = Vec::new();
    let everything = ([f32::NEG_INFINITY; 3], [f32::INFINITY; 3]);
    let mut todo = vec![(Child::ROOT, 0, everything)];
    while let Some((child, depth, outer)) = todo.pop() {
        let index = child.index() as usize;
        if child.is_leaf() {
            let primitives = leaf(child.index())?;
            seen_leaves[index] += 1;
            for (primitive, bounds) in primitives {
                inside(outer, bounds).ok_or_else(|| format!("primitive {primitive} leaves its box"))?;
                found.push(primitive);
            }
            continue;
        }
        let node = nodes.get(index).ok_or("a node that is not there")?;
        seen_nodes[index] += 1;
        if depth >= MAX_DEPTH {
            return Err(format!("node {index} is {depth} levels below the root"));
        }
        for lane in 0..WIDTH {
            let bounds = node.bounds(lane);
            if node.children[lane] == Child::NONE {
                let empty = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
                (bounds == empty).then_some(()).ok_or("a box without a child")?;
                continue;
            }
            inside(outer, bounds).ok_or_else(|| format!("a child leaves the box of node {index}"))?;
            todo.push((node.children[lane], depth + 1, bounds));
        }
    }
    if seen_nodes.iter().chain(&seen_leaves).any(|&times| times != 1) {
        return Err("a node or leaf is not reached exactly once".to_owned());
    }
    found.sort_unstable();
    expected.sort_unstable();
    if found != expected { Err("the leaves do not hold every primitive once".to_owned()) } else { Ok(()) }
}

fn inside(outer: Corners, inner: Corners) -> Option<()> {
    (0..3).all(|axis| outer.0[axis] <= inner.0[axis] && inner.1[axis] <= outer.1[axis]).then_some(())
}
