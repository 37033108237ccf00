//! The node of the tree: the boxes of up to eight children, structure of arrays, and the ray that is tried against
//! them.

use crate::geometry::LocalRay;

/// Children of a node.
pub(super) const WIDTH: usize = 8;

/// No path from the root has more nodes than this; it bounds the stack of a traversal. The builder splits by surface
/// area for [`super::build::SAH_DEPTH`] levels and then into equal eighths, of which 2^31 primitives allow eleven.
pub(super) const MAX_DEPTH: usize = super::build::SAH_DEPTH + 11;

/// A child: a node or a leaf, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// Lower x, y, z, then upper x, y, z.
    pub(super) planes: [[f32; WIDTH]; 6],
    /// What is in the boxes; [`Child::NONE`] in empty lanes, which come last.
    pub(super) children: [Child; WIDTH],
}

impl Node {
    pub(super) const EMPTY: Node = {
        let (low, high) = ([f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]);
        Node { planes: [low, low, low, high, high, high], children: [Child::NONE; WIDTH] }
    };

    /// Puts a child into a lane.
    pub(super) fn set(&mut self, lane: usize, low: [f32; 3], high: [f32; 3], child: Child) {
        for axis in 0..3 {
            self.planes[axis][lane] = low[axis];
            self.planes[axis + 3][lane] = high[axis];
        }
        self.children[lane] = child;
    }

    /// Lower and upper corner of a lane's box.
    pub(super) fn bounds(&self, lane: usize) -> ([f32; 3], [f32; 3]) {
        let corner = |first: usize| [0, 1, 2].map(|axis| self.planes[first + axis][lane]);
        (corner(0), corner(3))
    }
}

/// A ray as the node test needs it.
///
/// The test is conservative for the f64 ray. That one starts within one f32 step of the local ray's origin: so planes are
/// seen from a step nearer to where they are met first, and from a step farther from where they are met last. The
/// distance to a plane is `(plane - origin) * reciprocal`; its three roundings and that of the direction change it by a
/// factor within (1 +- 2^-24)^4 (Pharr, Jakob, Humphreys, "Physically Based Rendering" 4th ed., 6.8.2: gamma(4)). Instead
/// of widening the far distance in every node, the reciprocals are made smaller for near planes and larger for far planes
/// once a ray, by six roundings where five are needed.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeRay {
    /// Start for near planes.
    pub(super) near_origin: [f32; 3],
    /// Start for far planes.
    pub(super) far_origin: [f32; 3],
    /// Reciprocal direction for near planes: finite, no larger than the exact one.
    pub(super) near_reciprocal: [f32; 3],
    /// Reciprocal direction for far planes: no smaller than the exact one, infinite for 0. Then a far plane through the
    /// origin gives 0 * inf = NaN, which the test must ignore.
    pub(super) far_reciprocal: [f32; 3],
    /// Place in [`Node::planes`] of the plane that is met first on each axis: the lower or the upper one.
    pub(super) first_planes: [usize; 3],
}

impl NodeRay {
    #[inline(always)]
    pub(super) fn new(ray: &LocalRay) -> NodeRay {
        let (origin, direction) = (ray.origin.to_array(), ray.direction.to_array());
        let backwards = [0, 1, 2].map(|axis| direction[axis].is_sign_negative());
        let step = |axis: usize, up: bool| if up { origin[axis].next_up() } else { origin[axis].next_down() };
        NodeRay {
            near_origin: [0, 1, 2].map(|axis| step(axis, !backwards[axis])),
            far_origin: [0, 1, 2].map(|axis| step(axis, backwards[axis])),
            near_reciprocal: direction.map(near_reciprocal),
            far_reciprocal: direction.map(far_reciprocal),
            first_planes: [0, 1, 2].map(|axis| axis + 3 * usize::from(backwards[axis])),
        }
    }
}

/// Six roundings.
const SLACK: f32 = 3.0 * f32::EPSILON;

fn near_reciprocal(d: f32) -> f32 {
    let reciprocal = 1.0 / d;
    if reciprocal.is_subnormal() {
        return 0f32.copysign(d);
    }
    (reciprocal * (1.0 - SLACK)).clamp(-f32::MAX, f32::MAX)
}

fn far_reciprocal(d: f32) -> f32 {
    let reciprocal = 1.0 / d;
    if reciprocal.is_subnormal() {
        return f32::MIN_POSITIVE.copysign(d);
    }
    reciprocal * (1.0 + SLACK)
}
