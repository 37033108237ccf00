//! A tree over many lights, by which one is chosen by how much light it may bring to a point: Conty Estevez and Kulla,
//! "Importance Sampling of Many Lights with Adaptive Tree Splitting" (2018), without the cones of their directions, since
//! lights emit on both sides, and without splitting.

use super::alias::BELOW_ONE;
use super::area::Receiver;
use crate::math::{Bounds, DVec3};

/// What a tree is built over.
#[derive(Clone, Copy, Debug)]
pub struct TreeItem {
    /// The box around it.
    pub bounds: Bounds,
    /// Luminance times area, >= 0 and finite.
    pub power: f64,
}

/// A binary tree of boxes and powers.
#[derive(Clone, Debug, Default)]
pub struct LightTree {
    /// Depth first: the left child of an inner node follows it.
    nodes: Vec<Node>,
    /// Items in the order of the leaves.
    order: Vec<u32>,
    /// Where in that order each item is.
    places: Vec<u32>,
    /// Powers in that order.
    powers: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    center: DVec3,
    /// Of a ball around the box.
    radius: f64,
    power: f64,
    /// Index of the right child; 0 of a leaf.
    right: u32,
    /// The first place of the right child's items, of a leaf of its own.
    first: u32,
    /// Items of a leaf.
    count: u32,
}

/// Up to this many items have leaves of their own; of more, several share one and are chosen by power.
const OWN_LEAVES: usize = 1 << 20;
/// The items that then share a leaf, at most.
const SHARED_LEAF: usize = 8;

/// The least factor for a receiver that sees the light at a glance: its ball may reach up from the horizon.
const GLANCE: f64 = 1.0 / 16.0;

/// The most that a node counts, so that two have a finite sum: of a light without extent at the receiver itself.
const MOST: f64 = f64::MAX / 4.0;

impl LightTree {
    /// The tree over some items.
    pub fn new(items: &[TreeItem]) -> LightTree {
        let mut order: Vec<u32> = (0..items.len() as u32).collect();
        let leaf = if items.len() <= OWN_LEAVES { 1 } else { SHARED_LEAF };
        let mut builder = Builder { items, nodes: Vec::new(), leaf };
        if !items.is_empty() {
            builder.add(&mut order, 0);
        }
        let mut places = vec![0; items.len()];
        order.iter().zip(0..).for_each(|(&item, place)| places[item as usize] = place);
        let powers = order.iter().map(|&item| items[item as usize].power).collect();
        LightTree { nodes: builder.nodes, order, places, powers }
    }

    /// An item, its probability, and `u` in [0, 1) made new; `None` where no item is above the receiver's surface.
    pub fn sample(&self, at: &Receiver, mut u: f64) -> Option<(u32, f64, f64)> {
        let (mut index, mut probability) = (0, 1.0);
        loop {
            let node = self.nodes.get(index)?;
            if node.count > 0 {
                let (place, share, u) = self.choose_in(node, u)?;
                return Some((self.order[place], probability * share, u));
            }
            let left = self.left_share(index, at)?;
            if u < left {
                u /= left;
                probability *= left;
                index += 1;
            } else {
                u = (u - left) / (1.0 - left);
                probability *= 1.0 - left;
                index = node.right as usize;
            }
            u = u.min(BELOW_ONE);
        }
    }

    /// The probability with which [`LightTree::sample`] chooses an item.
    pub fn probability(&self, at: &Receiver, item: u32) -> f64 {
        let Some(&place) = self.places.get(item as usize) else { return 0.0 };
        let (mut index, mut probability) = (0, 1.0);
        loop {
            let node = &self.nodes[index];
            if node.count > 0 {
                let total = node.power;
                return if total > 0.0 { probability * (self.powers[place as usize] / total) } else { 0.0 };
            }
            let Some(left) = self.left_share(index, at) else { return 0.0 };
            (index, probability) = if place < node.first {
                (index + 1, probability * left)
            } else {
                (node.right as usize, probability * (1.0 - left))
            };
        }
    }

    /// The probability of the left child of an inner node; `None` if both children are below the receiver's surface.
    #[inline]
    fn left_share(&self, index: usize, at: &Receiver) -> Option<f64> {
        let (left, right) = (&self.nodes[index + 1], &self.nodes[self.nodes[index].right as usize]);
        let (left, right) = (left.importance(at), right.importance(at));
        let total = left + right;
        (total > 0.0).then(|| left / total)
    }

    /// The place of an item of a leaf, by power.
    fn choose_in(&self, node: &Node, u: f64) -> Option<(usize, f64, f64)> {
        let places = node.first as usize..(node.first + node.count) as usize;
        if node.count == 1 {
            return (node.power > 0.0).then_some((places.start, 1.0, u));
        }
        let mut rest = u * node.power;
        let mut last = None;
        for place in places {
            let power = self.powers[place];
            if power == 0.0 {
                continue;
            }
            last = Some((place, power / node.power, BELOW_ONE));
            if rest < power {
                return Some((place, power / node.power, (rest / power).min(BELOW_ONE)));
            }
            rest -= power;
        }
        last
    }
}

impl Node {
    /// An estimate, without occlusion, of the light that reaches a receiver, at most: power over squared distance, times
    /// the largest cosine at the receiver; 0 only where no part of the ball is above the receiver's surface.
    #[inline]
    fn importance(&self, at: &Receiver) -> f64 {
        if self.power == 0.0 {
            return 0.0;
        }
        let to = self.center - at.point.position;
        let (distance2, radius2) = (to.length_squared(), self.radius * self.radius);
        if distance2 <= radius2 {
            return (self.power / radius2).min(MOST);
        }
        let above = to.dot(at.side);
        if above < -self.radius * (1.0 + 1e-9) {
            return 0.0;
        }
        // cos(max(0, a - b)) of the angles a to the centre and b to the rim: cos a cos b + sin a sin b.
        let (cos, sin_rim) = (above, self.radius);
        let sin = (distance2 - above * above).max(0.0).sqrt();
        let cos_rim = (distance2 - radius2).sqrt();
        let facing = if cos >= cos_rim { 1.0 } else { (cos * cos_rim + sin * sin_rim) / distance2 };
        (self.power * facing.max(GLANCE) / distance2).min(MOST)
    }
}

/// Builds a tree.
struct Builder<'i> {
    items: &'i [TreeItem],
    nodes: Vec<Node>,
    leaf: usize,
}

impl Builder<'_> {
    /// Adds the subtree over `order`, whose first item has the place `first`.
    fn add(&mut self, order: &mut [u32], first: u32) {
        let all = || order.iter().map(|&item| &self.items[item as usize]);
        let bounds = all().fold(Bounds::EMPTY, |bounds, item| bounds.union(item.bounds));
        let middles = all().fold(Bounds::EMPTY, |bounds, item| bounds.with_point(item.bounds.center()));
        let index = self.nodes.len();
        self.nodes.push(Node {
            center: bounds.center(),
            radius: ((bounds.max - bounds.min) * 0.5).length(),
            power: all().map(|item| item.power).sum(),
            right: 0,
            first,
            count: order.len() as u32,
        });
        if order.len() <= self.leaf {
            return;
        }
        let axis = middles.longest_axis();
        let middle = order.len() / 2;
        let key = |item: u32| self.items[item as usize].bounds.center()[axis];
        order.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
        let (left, right) = order.split_at_mut(middle);
        let second = first + middle as u32;
        self.add(left, first);
        let right_child = self.nodes.len() as u32;
        self.add(right, second);
        let node = &mut self.nodes[index];
        (node.right, node.first, node.count) = (right_child, second, 0);
    }
}
