//! Objects against the precision of their places.

use super::{SIGNIFICANT, diagnostic, severity};
use crate::error::{Diagnostic, Severity};
use crate::geometry::{MeshEntry, MeshSpace, Shape};
use crate::math::{Bounds, DVec3};
use crate::scene::desc::{ObjectDesc, SceneDesc, ShapeDesc};
use crate::world::{World, coincident};
use rayon::prelude::*;
use std::ops::Range;

const MOVE: &str = "bring the objects closer together, or make this one larger";

/// An object as the renderer holds it.
struct Placed<'d> {
    /// Its place among the objects.
    index: u32,
    desc: &'d ObjectDesc,
    /// The smallest length in it that should be seen: a radius, the shortest edge, the largest side of a mesh.
    size: f64,
    /// Points of it are known to within this.
    error: f64,
    bounds: Bounds,
}

pub(super) fn check(world: &World, desc: &SceneDesc) -> Vec<Diagnostic> {
    let placed: Vec<Placed<'_>> = solids(world, desc).chain(meshes(world, desc)).collect();
    let mut found: Vec<(u32, Diagnostic)> = Vec::new();
    for object in &placed {
        let alone = against_its_place(object).into_iter().chain(against_last_digit(object));
        found.extend(alone.map(|diagnostic| (object.index, diagnostic)));
    }
    found.extend(mangled_triangles(world, desc));
    found.extend(against_the_coarsest(&placed));
    found.extend(on_one_another(world, desc));
    found.sort_by_key(|(index, _)| *index);
    found.into_iter().map(|(_, diagnostic)| diagnostic).collect()
}

fn solids<'d>(world: &World, desc: &'d SceneDesc) -> impl Iterator<Item = Placed<'d>> {
    let geometry = &world.geometry;
    geometry.solids.iter().zip(0..).filter_map(move |(solid, index)| {
        let bounds = geometry.solid_bounds(index);
        let (center, size) = match solid.shape {
            Shape::Ball(ball) => (ball.center, ball.radius),
            Shape::Cuboid(cuboid) => (cuboid.center, 2.0 * cuboid.half.min_element()),
            Shape::Rectangle(r) => (r.center, r.edge_u.length().min(r.edge_v.length())),
            Shape::Instance(_) => (bounds.center(), (bounds.max - bounds.min).max_element()),
        };
        let error = geometry.solid_point(index, center, DVec3::ZERO, DVec3::X).error.max_element();
        let error = match solid.shape {
            Shape::Instance(instance) => {
                error.max(geometry.space_of(&instance).meshes[0].rounding * instance.scale)
            }
            _ => error,
        };
        let desc = desc.objects.get(solid.object as usize)?;
        Some(Placed { index: solid.object, desc, size, error, bounds })
    })
}

/// The meshes that lie in the world.
fn meshes<'d>(world: &World, desc: &'d SceneDesc) -> impl Iterator<Item = Placed<'d>> {
    world.geometry.world_spaces().flat_map(|(_, space)| {
        space.mesh_ranges().filter_map(|(mesh, triangles)| {
            let &MeshEntry { object, extent: size, rounding: error, .. } = mesh;
            let around =
                |triangle| space.corners(triangle).into_iter().fold(Bounds::EMPTY, Bounds::with_point);
            let each = triangles.into_par_iter().with_min_len(4096).map(around);
            let local = each.reduce(|| Bounds::EMPTY, Bounds::union);
            let bounds =
                Bounds { min: space.frame.to_world(local.min), max: space.frame.to_world(local.max) };
            let desc = desc.objects.get(object as usize)?;
            (!local.is_empty()).then_some(Placed { index: object, desc, size, error, bounds })
        })
    })
}

/// The object is too small for where it is in the scene.
fn against_its_place(object: &Placed<'_>) -> Option<Diagnostic> {
    let Placed { desc, size, error, bounds, .. } = object;
    let severity = severity(*size, *error)?;
    let away = bounds.min.abs().max(bounds.max.abs()).max_element();
    let what = match desc.shape {
        ShapeDesc::TriangleMesh { .. } => "its corners are rounded by up to",
        _ => "its points are known to within",
    };
    let message = format!(
        "the object is {size:.1e} in size, but {what} {error:.1e}, since it reaches {away:.1e} away from the middle \
         of the scene"
    );
    Some(diagnostic(severity, Some(&desc.location), message, MOVE))
}

/// The object is too small for the digits of its position in the file.
fn against_last_digit(object: &Placed<'_>) -> Option<Diagnostic> {
    let position = match object.desc.shape {
        ShapeDesc::Ball { position, .. }
        | ShapeDesc::Box { position, .. }
        | ShapeDesc::Rectangle { position, .. }
        | ShapeDesc::TriangleMesh { position, .. } => position.abs().max_element(),
    };
    let step = position * f64::EPSILON;
    let message = || {
        format!(
            "the object is {:.1e} in size, but coordinates of {position:.1e} have steps of {step:.1e}",
            object.size
        )
    };
    let help = "move the scene towards the origin";
    (step * SIGNIFICANT > object.size)
        .then(|| diagnostic(Severity::Warning, Some(&object.desc.location), message(), help))
}

/// A triangle is as it should be to the eye if its corners were moved by less than this part of it.
const SLIGHT: f64 = 1.0 / 64.0;

/// What rounding has done to the triangles of a mesh.
#[derive(Clone, Copy)]
struct Damage {
    /// Triangles that were moved by more than their size, or have no area left.
    lost: usize,
    /// Other triangles that were moved by more than [`SLIGHT`] of their size.
    bent: usize,
    /// The size of the smallest of both, in outer units.
    smallest: f64,
}

impl Damage {
    fn of(space: &MeshSpace, mesh: &MeshEntry, triangles: Range<u32>) -> Damage {
        let none = Damage { lost: 0, bent: 0, smallest: f64::INFINITY };
        let look = |triangle: u32| {
            let [a, b, c] = space.corners(triangle);
            let bounds = [a, b, c].into_iter().fold(Bounds::EMPTY, Bounds::with_point);
            let size = bounds.extent() / space.frame.scale;
            // A coordinate is rounded by half a step at most.
            let farthest = bounds.min.abs().max(bounds.max.abs()).max_element();
            let error = (farthest / space.frame.scale * f64::from(f32::EPSILON) / 2.0).min(mesh.rounding);
            let lost = error >= size || (b - a).cross(c - a) == DVec3::ZERO;
            let bent = !lost && error > SLIGHT * size;
            let smallest = if lost || bent { size } else { f64::INFINITY };
            Damage { lost: lost.into(), bent: bent.into(), smallest }
        };
        let join = |a: Damage, b: Damage| Damage {
            lost: a.lost + b.lost,
            bent: a.bent + b.bent,
            smallest: a.smallest.min(b.smallest),
        };
        triangles.into_par_iter().with_min_len(4096).map(look).reduce(|| none, join)
    }
}

/// Triangles that rounding has taken away or bent; of a mesh that has instances it is said of the first.
fn mangled_triangles(world: &World, desc: &SceneDesc) -> Vec<(u32, Diagnostic)> {
    let geometry = &world.geometry;
    // Of the first instance of every shared mesh: its object, and how many times as large as the mesh it is.
    let first_instance = |space: usize| {
        geometry.solids.iter().find_map(|solid| match solid.shape {
            Shape::Instance(instance) if instance.space as usize == space => {
                Some((solid.object, instance.scale))
            }
            _ => None,
        })
    };
    let shared = geometry.instanced_spaces().iter().enumerate().filter_map(|(index, space)| {
        let (object, scale) = first_instance(index)?;
        let (mesh, triangles) = space.mesh_ranges().next()?;
        Some((object, scale, space, mesh, triangles))
    });
    let in_world = geometry.world_spaces().flat_map(|(_, space)| {
        space.mesh_ranges().map(move |(mesh, triangles)| (mesh.object, 1.0, space, mesh, triangles))
    });
    let mut found = Vec::new();
    for (object, scale, space, mesh, triangles) in shared.chain(in_world) {
        let (count, damage) = (triangles.len(), Damage::of(space, mesh, triangles));
        let Some(desc) = desc.objects.get(object as usize) else { continue };
        let (error, smallest) = (mesh.rounding * scale, damage.smallest * scale);
        let mut say = |severity, message| {
            found.push((object, diagnostic(severity, Some(&desc.location), message, MOVE)));
        };
        if damage.lost > 0 {
            let severity = if damage.lost == count { Severity::Error } else { Severity::Warning };
            let message = format!(
                "{} of the {count} triangles of this mesh are not drawn right: little or nothing is left of them when \
                 corners are rounded, by up to {error:.1e}",
                damage.lost
            );
            say(severity, message);
        }
        if damage.bent > 0 {
            let message = format!(
                "{} of the {count} triangles of this mesh are bent: some are no larger than {smallest:.1e}, and corners \
                 are rounded by up to {error:.1e}",
                damage.bent
            );
            say(Severity::Warning, message);
        }
    }
    found
}

/// So many of the objects whose points are known least are held against the others.
const COARSEST: usize = 16;

/// Small objects that touch one whose points are known far less.
fn against_the_coarsest(placed: &[Placed<'_>]) -> Vec<(u32, Diagnostic)> {
    let mut coarsest: Vec<&Placed<'_>> = placed.iter().collect();
    coarsest.sort_by(|a, b| b.error.total_cmp(&a.error));
    coarsest.truncate(COARSEST);
    let touch =
        |object: &Placed<'_>, coarse: &Placed<'_>| object.bounds.touches(coarse.bounds.padded(coarse.error));
    placed
        .iter()
        .filter_map(|object| {
            let hides = |coarse: &&&Placed<'_>| {
                coarse.index != object.index
                    && coarse.error * SIGNIFICANT > object.size
                    && coarse.error > object.error
                    && touch(object, coarse)
            };
            let coarse = coarsest.iter().find(hides)?;
            let message = format!(
                "the object is {:.1e} in size, but points of the object at {}, which it may touch, are known to within \
                 {:.1e}",
                object.size, coarse.desc.location, coarse.error
            );
            let help = "make the larger object smaller, or this one larger";
            Some((object.index, diagnostic(Severity::Warning, Some(&object.desc.location), message, help)))
        })
        .collect()
}

/// Objects that lie on others, so that it does not show in the file what is seen.
fn on_one_another(world: &World, desc: &SceneDesc) -> Vec<(u32, Diagnostic)> {
    let said = |(later, first): (u32, u32)| {
        let (object, under) = (desc.objects.get(later as usize)?, desc.objects.get(first as usize)?);
        let message = format!(
            "the object lies on the one at {}: where both are, the one that comes first in the file is seen, or, if \
             they are not equal, the one that roundings bring nearer",
            under.location
        );
        let help = "move one of them, or leave one out";
        Some((later, diagnostic(Severity::Warning, Some(&object.location), message, help)))
    };
    coincident::pairs(&world.geometry).into_iter().filter_map(said).collect()
}
