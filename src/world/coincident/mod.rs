//! Surfaces that lie on one another, where they emit.
//!
//! Of hits at one distance the object that is listed first counts ([`crate::geometry`]). So of equal surfaces all but the
//! first are never met, and where surfaces are flush with one another the roundings of a distance may decide. A ray that is
//! aimed at a light asks for less: whether anything is in the way of a point just before it. Lights that are never met must
//! not be aimed at, and of those that share their place with another surface it takes the closest hit to tell whether they
//! are met. Which faces of lights these are is found once, when a scene is compiled, so that others cost nothing.

mod box_tree;
mod face;

use crate::geometry::{Ball, Geometry, PrimitiveId, Shape, Solid, SurfacePoint};
use crate::math::Bounds;
use box_tree::BoxTree;
use face::Face;
use rayon::prelude::*;
use std::collections::{BTreeMap, HashMap, HashSet};

/// What lies on the primitives that emit.
#[derive(Clone, Debug, Default)]
pub(super) struct Coincidences {
    /// Primitives that emit and are never met: an equal one comes before them.
    hidden: HashSet<PrimitiveId>,
    /// Faces of primitives that emit, which share some of their place with another one's.
    shared: HashSet<Face>,
}

impl Coincidences {
    /// Those of a scene, where the objects that `emits` names emit.
    pub(super) fn of(geometry: &Geometry, emits: impl Fn(u32) -> bool) -> Coincidences {
        let emitting = emitting(geometry, emits);
        if emitting.is_empty() {
            return Coincidences::default();
        }
        let mut hidden: HashSet<PrimitiveId> = repeats(geometry, &emitting).into_keys().collect();
        let first = emitting.into_iter().filter(|primitive| !hidden.contains(primitive));
        let search = Search::new(geometry, first);
        let mut shared = HashSet::new();
        for Found { light, other } in search.all() {
            shared.insert(light);
            if other < light.primitive && face::are_equal(geometry, light.primitive, other) {
                hidden.insert(light.primitive);
            }
        }
        Coincidences { hidden, shared }
    }

    /// Whether a primitive that emits is never met.
    #[inline]
    pub(super) fn hides(&self, primitive: PrimitiveId) -> bool {
        !self.hidden.is_empty() && self.hidden.contains(&primitive)
    }

    /// Whether it takes the closest hit to tell if a point of a primitive that emits is met.
    #[inline]
    pub(super) fn share(&self, geometry: &Geometry, point: &SurfacePoint) -> bool {
        !self.shared.is_empty() && self.shared.contains(&Face::at(geometry, point))
    }
}

/// The primitives that emit; those of a kind in the order in which ties are decided.
fn emitting(geometry: &Geometry, emits: impl Fn(u32) -> bool) -> Vec<PrimitiveId> {
    let solids = (0..).zip(&geometry.solids).filter(|(_, solid)| emits(solid.object));
    let mut all: Vec<PrimitiveId> = solids.map(|(index, _)| PrimitiveId::solid(index)).collect();
    for (space, mesh) in geometry.world_spaces() {
        let ranges = mesh.mesh_ranges().filter(|(entry, _)| emits(entry.object));
        all.extend(ranges.flat_map(|(_, range)| range).map(|index| PrimitiveId::triangle(space, index)));
    }
    all
}

/// Those that are equal to an earlier one, each with the first. By sorting: there may be millions, all of them equal.
fn repeats(geometry: &Geometry, primitives: &[PrimitiveId]) -> HashMap<PrimitiveId, PrimitiveId> {
    let hashed = primitives.par_iter().map(|&primitive| (face::hash(geometry, primitive), primitive));
    let mut hashed: Vec<(u64, PrimitiveId)> = hashed.collect();
    hashed.par_sort_unstable();
    let runs = hashed.chunk_by(|a, b| a.0 == b.0);
    let repeated = runs.flat_map(|run| {
        let (_, first) = run[0];
        let others = run[1..].iter().map(|&(_, other)| other);
        others.filter(move |&other| face::are_equal(geometry, first, other)).map(move |other| (other, first))
    });
    repeated.collect()
}

/// A face of those that are looked at, and the primitive that lies on it.
struct Found {
    light: Face,
    other: PrimitiveId,
}

/// Looks for what lies on some primitives.
struct Search<'g> {
    geometry: &'g Geometry,
    faces: Vec<Face>,
    /// Over the boxes around these faces.
    tree: BoxTree,
    tolerance: f64,
}

/// By what part of the scene's size surfaces may be apart of which roundings decide which one is met: 2^-44. A distance is
/// known to some 2^-50 of it.
const TOLERANCE: f64 = 1.0 / 17_592_186_044_416.0;

/// So many triangles of instances are looked at one by one. Beyond, what their boxes touch counts as shared, which costs
/// rays that are aimed there a little time.
const MOST_INSTANCED: usize = 1 << 26;

/// Distances below which surfaces of a scene lie on one another.
fn tolerance(geometry: &Geometry) -> f64 {
    let solids = (0..geometry.solids.len() as u32).map(|index| geometry.solid_bounds(index));
    let spaces = geometry.world_spaces().map(|(_, space)| {
        let Bounds { min, max } = space.frame.bounds;
        Bounds { min: space.frame.to_world(min), max: space.frame.to_world(max) }
    });
    let all = solids.chain(spaces).fold(Bounds::EMPTY, Bounds::union);
    if all.is_empty() { 0.0 } else { all.min.abs().max(all.max.abs()).max_element() * TOLERANCE }
}

/// Objects that lie on one that is listed before them, each with the first such: balls and rectangles that share some of
/// their place, and boxes that are equal. Boxes that only share some of a face are not meant: most stand on something.
pub(super) fn pairs(geometry: &Geometry) -> BTreeMap<u32, u32> {
    let is_body = |&(_, solid): &(u32, &Solid)| !matches!(solid.shape, Shape::Instance(_));
    let is_flat_or_round = |id: &PrimitiveId| {
        let shape = id.as_solid().map(|solid| &geometry.solids[solid as usize].shape);
        matches!(shape, Some(Shape::Ball(_) | Shape::Rectangle(_)))
    };
    let bodies = (0..).zip(&geometry.solids).filter(is_body);
    let bodies: Vec<PrimitiveId> = bodies.map(|(index, _)| PrimitiveId::solid(index)).collect();
    let repeated = repeats(geometry, &bodies);
    let once = bodies.into_iter().filter(|id| !repeated.contains_key(id)).filter(is_flat_or_round);
    let once: Vec<PrimitiveId> = once.collect();
    let search = Search::new(geometry, once.iter().copied());
    let faces = once.par_iter().flat_map_iter(|&id| Face::all_of(geometry, id));
    let touching: Vec<Found> = faces.flat_map_iter(|face| search.on(face)).collect();
    let touching = touching.into_iter().map(|Found { light, other }| (light.primitive, other));
    let object = |id: PrimitiveId| id.as_solid().map(|solid| geometry.solids[solid as usize].object);
    let mut pairs = BTreeMap::new();
    for (later, first) in repeated.into_iter().chain(touching).filter(|(later, first)| first < later) {
        if let (Some(later), Some(first)) = (object(later), object(first)) {
            let least = pairs.entry(later).or_insert(first);
            *least = first.min(*least);
        }
    }
    pairs
}

/// Whether another ball of the scene lies on the ball that is the solid `solid`.
pub(super) fn lies_on_another_ball(geometry: &Geometry, solid: u32, ball: &Ball) -> bool {
    let tolerance = tolerance(geometry);
    (0..).zip(&geometry.solids).any(|(index, other)| match &other.shape {
        Shape::Ball(other) if index != solid => face::balls_coincide(ball, other, tolerance),
        _ => false,
    })
}

impl<'g> Search<'g> {
    fn new(geometry: &'g Geometry, primitives: impl Iterator<Item = PrimitiveId>) -> Search<'g> {
        let faces: Vec<Face> = primitives.flat_map(|primitive| Face::all_of(geometry, primitive)).collect();
        let boxes: Vec<Bounds> = faces.par_iter().map(|face| face.outline(geometry).bounds()).collect();
        Search { geometry, faces, tree: BoxTree::new(&boxes), tolerance: tolerance(geometry) }
    }

    /// All that lies on the primitives.
    fn all(&self) -> Vec<Found> {
        let geometry = self.geometry;
        let solids = (0..geometry.solids.len() as u32).into_par_iter();
        let of_solid = |index| Face::all_of(geometry, PrimitiveId::solid(index));
        let mut found: Vec<Found> =
            solids.flat_map_iter(of_solid).flat_map_iter(|face| self.on(face)).collect();
        for (space, mesh) in geometry.world_spaces() {
            let triangle = |index| self.on(Face::of_triangle(PrimitiveId::triangle(space, index)));
            found.par_extend((0..mesh.triangles.len() as u32).into_par_iter().flat_map_iter(triangle));
        }
        self.add_instances(&mut found);
        found
    }

    /// What a face lies on.
    fn on(&self, face: Face) -> Vec<Found> {
        let outline = face.outline(self.geometry);
        let bounds = outline.bounds().padded(self.tolerance);
        let mut found = Vec::new();
        self.tree.touching(bounds, |index| {
            let light = self.faces[index as usize];
            if light.primitive == face.primitive {
                return;
            }
            let other = light.outline(self.geometry);
            if other.bounds().touches(bounds) && other.lies_on(&outline, self.tolerance) {
                found.push(Found { light, other: face.primitive });
            }
        });
        found
    }

    /// What the triangles of instances lie on.
    fn add_instances(&self, found: &mut Vec<Found>) {
        let geometry = self.geometry;
        let mut left = MOST_INSTANCED;
        for (solid, index) in geometry.solids.iter().zip(0..) {
            let Shape::Instance(instance) = solid.shape else { continue };
            let mut near = Vec::new();
            let bounds = geometry.solid_bounds(index).padded(self.tolerance);
            self.tree.touching(bounds, |face| near.push(face));
            let count = if near.is_empty() { 0 } else { geometry.space_of(&instance).triangles.len() };
            if count <= left {
                left -= count;
                let triangle =
                    |triangle| self.on(Face::of_triangle(PrimitiveId::of_instance(index, triangle)));
                found.par_extend((0..count as u32).into_par_iter().flat_map_iter(triangle));
            } else {
                let other = PrimitiveId::solid(index);
                let lights = near.into_iter().map(|face| self.faces[face as usize]);
                found.extend(lights.map(|light| Found { light, other }));
            }
        }
    }
}
