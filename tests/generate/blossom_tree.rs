//! A tree in blossom, grown by recursion: trunk, limbs, boughs, twigs; flowers and young leaves along the twigs.
//!
//! The axes are those of OBJ files: y up, the trunk rises from the origin, about 4 units high.

use super::mesh::{Corner, Mesh};
use super::random::Random;
use super::tube::{Joint, add_tube};
use glam::DVec3;
use std::f64::consts::TAU;

/// The tree in the parts that have different materials.
#[derive(Default)]
pub(crate) struct Tree {
    /// Trunk, limbs, boughs and twigs: closed tubes with smooth normals.
    pub(crate) bark: Mesh,
    /// Flowers of five petals, two triangles each.
    pub(crate) blossoms: Mesh,
    /// Leaves of two triangles.
    pub(crate) leaves: Mesh,
    /// Petals that lie on the ground y = 0.
    pub(crate) petals: Mesh,
}

/// How the branches of one level look and how they bear the next.
struct Level {
    /// Sides of the tube.
    sides: usize,
    /// Joints of the curve after its first.
    segments: usize,
    /// How much the direction wanders at each joint.
    wander: f64,
    /// How much it bends up at each joint.
    uplift: f64,
    /// Branches of the next level that it bears.
    children: usize,
    /// The part of its length after which it bears them.
    bare: f64,
    /// Length of a child in lengths of its parent, at the start and at the end of the bearing part.
    child_length: (f64, f64),
    /// Angle between a child and its parent in radians.
    child_angle: f64,
}

/// Trunk, limbs, boughs, twigs.
const LEVELS: [Level; 4] = [
    Level {
        sides: 14,
        segments: 10,
        wander: 0.13,
        uplift: 0.06,
        children: 12,
        bare: 0.36,
        child_length: (0.8, 0.42),
        child_angle: 1.1,
    },
    Level {
        sides: 8,
        segments: 7,
        wander: 0.17,
        uplift: 0.05,
        children: 8,
        bare: 0.3,
        child_length: (0.58, 0.36),
        child_angle: 0.85,
    },
    Level {
        sides: 5,
        segments: 5,
        wander: 0.2,
        uplift: 0.06,
        children: 6,
        bare: 0.2,
        child_length: (0.55, 0.4),
        child_angle: 0.8,
    },
    Level {
        sides: 4,
        segments: 3,
        wander: 0.2,
        uplift: 0.08,
        children: 0,
        bare: 0.15,
        child_length: (0.0, 0.0),
        child_angle: 0.0,
    },
];

/// The radius that no branch starts below.
const THINNEST: f64 = 0.006;

/// Flowers and leaves along a twig.
const BUDS: usize = 7;

/// The part of the buds that are flowers.
const FLOWERS: f64 = 0.55;

/// Petals on the ground.
const FALLEN: usize = 260;

/// The azimuth from one child to the next, the golden angle, which spreads them evenly.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Grows the tree.
pub(crate) fn grow() -> Tree {
    let mut tree = Tree::default();
    let mut random = Random::new(2);
    tree.branch(&mut random, 0, Joint { position: DVec3::ZERO, radius: 0.26 }, DVec3::Y, 2.55);
    for _ in 0..FALLEN {
        add_fallen_petal(&mut tree.petals, &mut random);
    }
    tree
}

impl Tree {
    /// Adds a branch of a level with all that it bears.
    fn branch(&mut self, random: &mut Random, level: usize, start: Joint, direction: DVec3, length: f64) {
        let form = &LEVELS[level];
        let curve = curve(random, form, start, direction, length, level == 0);
        add_tube(&mut self.bark, &curve, form.sides);
        if level + 1 == LEVELS.len() {
            self.dress(random, &curve);
            return;
        }
        let turn = random.between(0.0, TAU);
        for child in 0..form.children {
            let along = child as f64 / (form.children - 1) as f64;
            let at = form.bare + (0.97 - form.bare) * along;
            let (joint, tangent) = point_on(&curve, at);
            let azimuth = turn + GOLDEN_ANGLE * child as f64;
            let angle = form.child_angle * (1.0 - 0.45 * along) * random.between(0.85, 1.15);
            let direction = tilted(tangent, angle, azimuth);
            let (first, last) = form.child_length;
            let share = (first + (last - first) * along) * random.between(0.85, 1.15);
            let radius = (joint.radius * 0.72).min(start.radius * 0.42).max(THINNEST);
            self.branch(
                random,
                level + 1,
                Joint { position: joint.position, radius },
                direction,
                length * share,
            );
        }
    }

    /// Adds the flowers and leaves of a twig.
    fn dress(&mut self, random: &mut Random, twig: &[Joint]) {
        for bud in 0..BUDS {
            let at = LEVELS[LEVELS.len() - 1].bare + 0.85 * bud as f64 / (BUDS - 1) as f64;
            let (joint, tangent) = point_on(twig, at.min(0.999));
            let outward = tilted(tangent, random.between(0.5, 1.2), GOLDEN_ANGLE * bud as f64);
            let base = joint.position + outward * joint.radius;
            let size = random.between(0.8, 1.2);
            if random.unit() < FLOWERS {
                add_flower(&mut self.blossoms, base, outward, 0.068 * size, random.between(0.0, TAU));
            } else {
                add_leaf(&mut self.leaves, base, outward, 0.12 * size);
            }
        }
    }
}

/// The curve of a branch, wandering and bending up, thinner towards its end. A trunk flares at its foot.
fn curve(
    random: &mut Random,
    form: &Level,
    start: Joint,
    direction: DVec3,
    length: f64,
    flare: bool,
) -> Vec<Joint> {
    let mut curve = vec![start];
    let (mut position, mut direction) = (start.position, direction);
    let step = length / form.segments as f64;
    for k in 1..=form.segments {
        let t = k as f64 / form.segments as f64;
        position += direction * step;
        let thickness = if flare { 0.12 + 0.6 * (1.0 - t) } else { 0.15 + 0.85 * (1.0 - t) };
        curve.push(Joint { position, radius: start.radius * thickness });
        let mut any = || random.between(-form.wander, form.wander);
        let wandering = DVec3::new(any(), any(), any());
        direction = (direction + wandering + DVec3::Y * form.uplift).normalize();
    }
    curve
}

/// The point at the part `at` in [0, 1) of a curve, and the direction there.
fn point_on(curve: &[Joint], at: f64) -> (Joint, DVec3) {
    let along = at * (curve.len() - 1) as f64;
    let k = along as usize;
    let t = along - k as f64;
    let (a, b) = (curve[k], curve[k + 1]);
    let position = a.position.lerp(b.position, t);
    (Joint { position, radius: a.radius + (b.radius - a.radius) * t }, (b.position - a.position).normalize())
}

/// A direction at an angle from `axis`, turned about it.
fn tilted(axis: DVec3, angle: f64, azimuth: f64) -> DVec3 {
    let (x, y) = axis.any_orthonormal_pair();
    let across = x * libm::cos(azimuth) + y * libm::sin(azimuth);
    axis * libm::cos(angle) + across * libm::sin(angle)
}

/// Adds a flower of five petals that open around `axis`.
fn add_flower(mesh: &mut Mesh, base: DVec3, axis: DVec3, size: f64, turn: f64) {
    for petal in 0..5 {
        let azimuth = turn + TAU * f64::from(petal) / 5.0;
        let along = tilted(axis, 1.05, azimuth);
        add_blade(mesh, base + axis * 0.25 * size, along, axis, size, 0.42);
    }
}

/// Adds a leaf along a direction, its upper side as far up as can be.
fn add_leaf(mesh: &mut Mesh, base: DVec3, along: DVec3, size: f64) {
    add_blade(mesh, base, along, DVec3::Y, size, 0.24);
}

/// Adds a petal on the ground, more likely near the trunk than far from it.
fn add_fallen_petal(mesh: &mut Mesh, random: &mut Random) {
    let around = |angle: f64| DVec3::new(libm::cos(angle), 0.0, libm::sin(angle));
    let spot = around(random.between(0.0, TAU)) * random.between(0.2, 4.5);
    let along = around(random.between(0.0, TAU));
    add_blade(mesh, spot + DVec3::Y * 0.004, along, DVec3::Y, random.between(0.055, 0.08), 0.42);
}

/// Adds a blade of two triangles, folded along its middle, its length `size` and half its width `slim` x size.
fn add_blade(mesh: &mut Mesh, base: DVec3, along: DVec3, up: DVec3, size: f64, slim: f64) {
    let side = along.cross(up).normalize();
    let fold = side.cross(along) * 0.35;
    let first = mesh.positions.len();
    let widest = base + along * (0.55 * size);
    mesh.positions.extend([
        base,
        widest + (side + fold) * (slim * size),
        base + along * size,
        widest + (fold - side) * (slim * size),
    ]);
    let corner = |i: usize| Corner::flat(first + i);
    mesh.triangles.push([corner(0), corner(1), corner(2)]);
    mesh.triangles.push([corner(0), corner(2), corner(3)]);
}
