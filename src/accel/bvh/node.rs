//! The node of the tree: the boxes of up to eight children, structure of arrays, and the ray that is tried against
//! them.

use crate::accel::fault::SHRINK;
use crate::geometry::LocalRay;

/// Children of a node.
pub(super) const WIDTH: usize = 8;

/// No path from the root has more nodes than this; it bounds the stack of a traversal. The builder splits by surface
/// area for [`super::build::SAH_DEPTH`] levels and then into equal eighths, of which 2^31 primitives allow eleven.
pub(super) const MAX_DEPTH: usize = super::build::SAH_DEPTH + 11;

/// A child: a node or a leaf, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub(super) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;

    /// The root of every tree.
    pub(super) const ROOT: Child = Child(0);

    /// What unused lanes hold; never reached, because the box there is empty.
    pub(super) const NONE: Child = Child(u32::MAX);

    pub(super) fn node(index: u32) -> Child {
        Child(index)
    }

    pub(super) fn leaf(index: u32) -> Child {
        Child(index | Child::LEAF)
    }

    #[inline(always)]
    pub(super) fn is_leaf(self) -> bool {
        self.0 & Child::LEAF != 0
    }

    /// Index among the nodes, or among the leaves.
    #[inline(always)]
    pub(super) fn index(self) -> u32 {
        self.0 & !Child::LEAF
    }

    #[inline(always)]
    pub(super) fn bits(self) -> u32 {
        self.0
    }

    #[inline(always)]
    pub(super) fn from_bits(bits: u32) -> Child {
        Child(bits)
    }
}

/// The boxes of eight children. Empty lanes reach from plus to minus infinity.
#[derive(Clone, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Node {
    /// By axis, the lower and the upper ones.
    pub(super) planes: [[[f32; WIDTH]; 2]; 3],
    /// What is in the boxes; [`Child::NONE`] in empty lanes, which come last.
    pub(super) children: [Child; WIDTH],
    /// A bit for every lane, from the lowest on, that holds a leaf.
    pub(super) leaves: u32,
}

impl Node {
    pub(super) const EMPTY: Node = {
        let (low, high) = ([f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]);
        Node { planes: [[low, high]; 3], children: [Child::NONE; WIDTH], leaves: 0 }
    };

    /// Puts a child into a lane.
    pub(super) fn set(&mut self, lane: usize, low: [f32; 3], high: [f32; 3], child: Child) {
        for axis in 0..3 {
            self.planes[axis][0][lane] = low[axis];
            self.planes[axis][1][lane] = high[axis];
        }
        self.children[lane] = child;
        self.leaves |= u32::from(child.is_leaf()) << lane;
    }

    /// The planes across an axis: those that are met first, and those that are met last by a ray that goes `backwards`
    /// (0 or 1) along it.
    #[inline(always)]
    pub(super) fn planes_along(&self, axis: usize, backwards: usize) -> (&[f32; WIDTH], &[f32; WIDTH]) {
        let planes = &self.planes[axis];
        (&planes[backwards & 1], &planes[(backwards & 1) ^ 1])
    }

    /// Makes the boxes too small, as [`crate::accel::Fault::Padding`] has it.
    pub(super) fn shrink(&mut self) {
        for [low, high] in &mut self.planes {
            for lane in (0..WIDTH).filter(|&lane| self.children[lane] != Child::NONE) {
                let by = (high[lane] - low[lane]) * SHRINK;
                low[lane] += by;
                high[lane] -= by;
            }
        }
    }

    /// Lower and upper corner of a lane's box.
    pub(super) fn bounds(&self, lane: usize) -> ([f32; 3], [f32; 3]) {
        let corner = |side: usize| [0, 1, 2].map(|axis| self.planes[axis][side][lane]);
        (corner(0), corner(1))
    }
}

/// A ray as the node test needs it. Distances are `(plane - origin) * reciprocal`.
///
/// The test is conservative for the f64 ray: with u = 2^-24, the roundings of the difference, of the reciprocal, of the
/// direction and of the product change a distance by a factor within (1 +- u)^4. That is as if the plane were moved by
/// 4.01 u |plane - origin|, at most 4.01 u (|plane| + |origin|). The builder moves planes by more than 4.01 u |plane|; here
/// the origin is moved by 8 u of itself, where 4.01 u are needed, 2 u for its own rounding to f32 and 1 u for this one:
/// back for planes that are met first, on for planes that are met last.
///
/// A component of the direction below 1e-18 is taken as that. It moves nothing by more than the second term of the
/// boxes' padding on the way through the frame, and there are no infinite reciprocals, which would give NaN.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeRay {
    /// Start for the planes that are met first.
    pub(super) near_origin: [f32; 3],
    /// Start for the planes that are met last.
    pub(super) far_origin: [f32; 3],
    /// One over the direction.
    pub(super) reciprocal: [f32; 3],
    /// Whether the upper plane is met first: 0 or 1.
    pub(super) backwards: [usize; 3],
}

/// 8 * 2^-24.
const SLACK: f32 = 4.0 * f32::EPSILON;

/// The least size of a component of the direction.
const LEAST: f32 = 1e-18;

impl NodeRay {
    #[inline(always)]
    pub(super) fn new(ray: &LocalRay) -> NodeRay {
        let (o, d) = (ray.origin, ray.direction);
        let slack = [step(o.x, d.x), step(o.y, d.y), step(o.z, d.z)];
        NodeRay {
            near_origin: [o.x + slack[0], o.y + slack[1], o.z + slack[2]],
            far_origin: [o.x - slack[0], o.y - slack[1], o.z - slack[2]],
            reciprocal: [reciprocal(d.x), reciprocal(d.y), reciprocal(d.z)],
            backwards: [
                usize::from(d.x.is_sign_negative()),
                usize::from(d.y.is_sign_negative()),
                usize::from(d.z.is_sign_negative()),
            ],
        }
    }
}

/// By how much an origin is moved along the ray.
#[inline(always)]
fn step(origin: f32, direction: f32) -> f32 {
    (origin * SLACK).copysign(direction)
}

#[inline(always)]
fn reciprocal(direction: f32) -> f32 {
    1.0 / direction.abs().max(LEAST).copysign(direction)
}
