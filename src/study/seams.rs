//! Rays onto the meshes of any scene that must hit: through the seams between triangles, where leaks are.
//!
//! A ray is aimed at a point inside a triangle, at the middle of an edge that two triangles share, or at a corner that is
//! closed all around by triangles, and only from where all of them are seen from the same side: then they cover the
//! point, so that something is hit there or before, whatever the rest of the scene is.

use super::leaks::Aim;
use super::random::Random;
use super::triangles::as_instance;
use crate::accel::Accelerator;
use crate::geometry::{Geometry, Instance, MeshSpace, Ray};
use crate::math::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;

/// A ray, and the distance at which it has hit at the latest.
#[derive(Clone, Copy, Debug)]
pub struct Sure {
    /// The ray.
    pub ray: Ray,
    /// With a margin for the roundings of f32, far less than the thickness of things.
    pub reach: f64,
}

/// A mesh with more triangles is left out: its corners take too long to match.
const MOST_TRIANGLES: usize = 2_000_000;

/// The least cosine between the ray and the normals of the triangles that it is aimed at.
const STEEPEST: f64 = 0.1;

/// Up to `count` rays; none if there are no meshes, or none that are closed at any seam.
pub fn rays(geometry: &Geometry, aim: Aim, count: usize, seed: u64) -> Vec<Sure> {
    let mut random = Random::new(seed);
    let meshes = placed(geometry);
    let total: usize = meshes.iter().map(|mesh| mesh.space.triangles.len()).sum();
    let mut rays = Vec::new();
    // In a mesh of loose triangles there is nothing to find.
    for _ in 0..10 * count {
        if rays.len() == count || total == 0 {
            break;
        }
        let mut index = random.index(total);
        let Some(mesh) = meshes.iter().find(|mesh| {
            let triangles = mesh.space.triangles.len();
            let found = index < triangles;
            index -= if found { 0 } else { triangles };
            found
        }) else {
            break;
        };
        rays.extend(
            mesh.target(aim, index as u32, &mut random).and_then(|seam| mesh.aimed(&seam, &mut random)),
        );
    }
    rays
}

/// How many of the rays hit nothing up to where they must have.
pub fn lost(accelerator: &dyn Accelerator, rays: &[Sure]) -> u64 {
    let is_lost = |sure: &Sure| accelerator.intersect(&sure.ray).is_none_or(|hit| hit.t > sure.reach);
    rays.par_iter().map(|sure| u64::from(is_lost(sure))).sum()
}

/// A mesh at one of its places in the world.
struct Placed<'g> {
    space: &'g MeshSpace,
    instance: Option<&'g Instance>,
    corners: std::rc::Rc<Corners>,
}

/// The triangles at every corner; corners at one place are one.
type Corners = HashMap<[u32; 3], Vec<u32>>;

/// A point that triangles cover, in local coordinates.
struct Seam {
    point: DVec3,
    normals: Vec<DVec3>,
}

fn placed(geometry: &Geometry) -> Vec<Placed<'_>> {
    let small = |space: &MeshSpace| (1..=MOST_TRIANGLES).contains(&space.triangles.len());
    let in_world = geometry.world_spaces().filter(|(_, space)| small(space)).map(|(_, space)| Placed {
        space,
        instance: None,
        corners: corners(space).into(),
    });
    let mut all: Vec<Placed<'_>> = in_world.collect();
    let mut known: HashMap<u32, std::rc::Rc<Corners>> = HashMap::new();
    for instance in geometry.solids.iter().filter_map(as_instance) {
        let space = geometry.space_of(instance);
        if small(space) {
            let corners = known.entry(instance.space).or_insert_with(|| corners(space).into()).clone();
            all.push(Placed { space, instance: Some(instance), corners });
        }
    }
    all
}

fn corners(space: &MeshSpace) -> Corners {
    let mut corners = Corners::new();
    for triangle in 0..space.triangles.len() as u32 {
        for key in keys(space, triangle) {
            corners.entry(key).or_default().push(triangle);
        }
    }
    corners
}

/// The places of a triangle's corners.
fn keys(space: &MeshSpace, triangle: u32) -> [[u32; 3]; 3] {
    // Zero has two signs.
    space.corners32(triangle).map(|corner| corner.map(|x| (x + 0.0).to_bits()))
}

impl Placed<'_> {
    fn target(&self, aim: Aim, triangle: u32, random: &mut Random) -> Option<Seam> {
        let [a, b, c] = self.space.corners(triangle);
        let first = random.index(3);
        match aim {
            Aim::Vertex => self.vertex(triangle, first),
            Aim::Edge => self.edge(triangle, first),
            _ => {
                let (u, v) = (random.between(0.2, 0.4), random.between(0.2, 0.4));
                Some(Seam { point: a + (b - a) * u + (c - a) * v, normals: vec![self.normal(triangle)?] })
            }
        }
    }

    /// The corner if every edge at it has a triangle on both sides and all are wound alike.
    fn vertex(&self, triangle: u32, first: usize) -> Option<Seam> {
        let key = keys(self.space, triangle)[first];
        let around = self.corners.get(&key)?;
        let mut after = HashMap::new();
        for &other in around {
            let corners = keys(self.space, other);
            let place = corners.iter().position(|corner| *corner == key)?;
            let (next, last) = (corners[(place + 1) % 3], corners[(place + 2) % 3]);
            // Two triangles that go on from the same edge: wound differently, or several sheets.
            if after.insert(next, last).is_some() {
                return None;
            }
        }
        let start = keys(self.space, triangle)[(first + 1) % 3];
        let mut at = start;
        for _ in 1..around.len() {
            at = *after.get(&at)?;
            if at == start {
                return None;
            }
        }
        (after.get(&at) == Some(&start)).then_some(())?;
        let normals = around.iter().map(|&other| self.normal(other)).collect::<Option<Vec<DVec3>>>()?;
        Some(Seam { point: self.space.corners(triangle)[first], normals })
    }

    /// The middle of an edge if exactly one other triangle has it, wound alike.
    fn edge(&self, triangle: u32, first: usize) -> Option<Seam> {
        let corners = keys(self.space, triangle);
        let (from, to) = (corners[first], corners[(first + 1) % 3]);
        let mut others = self
            .corners
            .get(&from)?
            .iter()
            .filter(|&&other| other != triangle && keys(self.space, other).contains(&to));
        let (&other, None) = (others.next()?, others.next()) else { return None };
        let theirs = keys(self.space, other);
        (0..3).find(|&i| theirs[i] == to && theirs[(i + 1) % 3] == from)?;
        let places = self.space.corners(triangle);
        let point = places[first].midpoint(places[(first + 1) % 3]);
        Some(Seam { point, normals: vec![self.normal(triangle)?, self.normal(other)?] })
    }

    fn normal(&self, triangle: u32) -> Option<DVec3> {
        let [a, b, c] = self.space.corners(triangle);
        (b - a).cross(c - a).try_normalize()
    }

    /// A ray from where all triangles are seen from the same side, as far away as the mesh is large.
    fn aimed(&self, seam: &Seam, random: &mut Random) -> Option<Sure> {
        const TRIES: usize = 8;
        let bounds = &self.space.frame.bounds;
        let (from, point) = (0..TRIES).find_map(|_| {
            let direction = random.direction();
            let cosines = || seam.normals.iter().map(|normal| normal.dot(direction));
            let agree = cosines().all(|cos| cos > STEEPEST) || cosines().all(|cos| cos < -STEEPEST);
            agree.then(|| (seam.point + direction * bounds.extent(), seam.point))
        })?;
        let (from, point) = (self.to_world(from), self.to_world(point));
        let way = point - from;
        let direction = way.try_normalize()?;
        // Nothing of interest is as thin as a hundred thousandth of its distance.
        Some(Sure { ray: Ray::new(from, direction), reach: way.length() * (1.0 + 1e-5) })
    }

    fn to_world(&self, local: DVec3) -> DVec3 {
        let point = self.space.frame.to_world(local);
        self.instance.map_or(point, |instance| instance.to_world(point))
    }
}
