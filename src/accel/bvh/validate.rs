//! A check of every node, for tests.

use super::node::{Child, MAX_DEPTH, Node, WIDTH};
use super::{Bvh, triangle_bounds};
use crate::accel::BvhQuality;
use crate::geometry::MeshSpace;
use crate::math::DVec3;

impl Bvh<'_> {
    /// Checks that every triangle and every solid of the trees is in exactly one leaf, that every box holds everything
    /// below it, that no node is shared or out of reach, and that no path is longer than the stack allows. A triangle in
    /// pieces may be in several leaves, whose boxes hold it together.
    ///
    /// # Errors
    /// The first thing that is wrong, in words.
    pub fn validate(&self) -> Result<(), String> {
        for (space, tree) in self.geometry.spaces.iter().zip(&self.triangles) {
            let leaf = |leaf: u32| {
                let block = tree.blocks.get(leaf as usize).ok_or("a leaf that is not there")?;
                Ok(block.indices().collect())
            };
            let mut triangles = check(&tree.nodes, tree.blocks.len(), leaf)?;
            if self.quality == BvhQuality::Quality {
                pieces_hold(&mut triangles, space)?;
            } else {
                holds_each(&triangles, |index| exact_bounds(space, index))?;
            }
            all_are_there(triangles, (0..space.triangles.len() as u32).collect())?;
        }
        let solid_leaf = |leaf: u32| {
            let &solid = self.solid_order.get(leaf as usize).ok_or("a leaf that is not there")?;
            Ok(vec![solid])
        };
        let solids = check(&self.solid_nodes, self.solid_order.len(), solid_leaf)?;
        holds_each(&solids, |solid| self.geometry.solid_node_bounds(solid))?;
        all_are_there(solids, self.geometry.tree_solids.clone())
    }
}

/// Lower and upper corner.
type Corners = ([f32; 3], [f32; 3]);

fn exact_bounds(space: &MeshSpace, index: u32) -> Corners {
    let (low, high) = triangle_bounds(space, index);
    (low.map(|x| x as f32), high.map(|x| x as f32))
}

/// Every primitive that is found lies in the box of its leaf.
fn holds_each(found: &[(u32, Corners)], bounds: impl Fn(u32) -> Corners) -> Result<(), String> {
    let outside = found.iter().find(|&&(primitive, outer)| inside(outer, bounds(primitive)).is_none());
    outside.map_or(Ok(()), |(primitive, _)| Err(format!("primitive {primitive} leaves its box")))
}

/// Points all over every triangle lie in one of the boxes of its leaves. Leaves every triangle once.
fn pieces_hold(found: &mut Vec<(u32, Corners)>, space: &MeshSpace) -> Result<(), String> {
    const STEPS: u32 = 12;
    found.sort_unstable_by_key(|&(triangle, _)| triangle);
    for pieces in found.chunk_by(|a, b| a.0 == b.0) {
        let triangle = pieces[0].0;
        let [a, b, c] = space.corners(triangle);
        for (i, j) in (0..=STEPS).flat_map(|i| (0..=STEPS - i).map(move |j| (i, j))) {
            let (u, v) = (f64::from(i) / f64::from(STEPS), f64::from(j) / f64::from(STEPS));
            let point = a + (b - a) * u + (c - a) * v;
            if !pieces.iter().any(|&(_, piece)| has_point(piece, point)) {
                return Err(format!("no box of triangle {triangle} holds {point}"));
            }
        }
    }
    found.dedup_by_key(|&mut (triangle, _)| triangle);
    Ok(())
}

fn has_point((low, high): Corners, p: DVec3) -> bool {
    (0..3).all(|axis| f64::from(low[axis]) <= p[axis] && p[axis] <= f64::from(high[axis]))
}

fn all_are_there(found: Vec<(u32, Corners)>, mut expected: Vec<u32>) -> Result<(), String> {
    let mut found: Vec<u32> = found.into_iter().map(|(primitive, _)| primitive).collect();
    found.sort_unstable();
    expected.sort_unstable();
    if found != expected { Err("the leaves do not hold every primitive once".to_owned()) } else { Ok(()) }
}

/// Checks the nodes; what is in the leaves, and the boxes of the leaves.
fn check(
    nodes: &[Node],
    leaves: usize,
    leaf: impl Fn(u32) -> Result<Vec<u32>, &'static str>,
) -> Result<Vec<(u32, Corners)>, String> {
    let (mut seen_nodes, mut seen_leaves) = (vec![0u32; nodes.len()], vec![0u32; leaves]);
    let mut found = Vec::new();
    let everything = ([f32::NEG_INFINITY; 3], [f32::INFINITY; 3]);
    let mut todo = vec![(Child::ROOT, 0, everything)];
    while let Some((child, depth, outer)) = todo.pop() {
        let index = child.index() as usize;
        if child.is_leaf() {
            found.extend(leaf(child.index())?.into_iter().map(|primitive| (primitive, outer)));
            seen_leaves[index] += 1;
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
    Ok(found)
}

fn inside(outer: Corners, inner: Corners) -> Option<()> {
    (0..3).all(|axis| outer.0[axis] <= inner.0[axis] && inner.1[axis] <= outer.1[axis]).then_some(())
}
