//! Objects against the precision of their places.

use super::{SIGNIFICANT, diagnostic, severity};
use crate::error::{Diagnostic, Severity};
use crate::geometry::Shape;
use crate::math::{Bounds, DVec3};
use crate::scene::desc::{ObjectDesc, SceneDesc, ShapeDesc};
use crate::world::World;

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
    found.extend(collapsed_triangles(world, desc));
    found.extend(against_the_coarsest(&placed));
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
            Shape::Instance(instance) => error.max(geometry.space_of(&instance).rounding[0] * instance.scale),
            _ => error,
        };
        let desc = desc.objects.get(solid.object as usize)?;
        Some(Placed { index: solid.object, desc, size, error, bounds })
    })
}

/// The meshes that lie in the world.
fn meshes<'d>(world: &World, desc: &'d SceneDesc) -> impl Iterator<Item = Placed<'d>> {
    world.geometry.world_spaces().flat_map(|(_, space)| {
        space.mesh_ranges().zip(&space.rounding).filter_map(|((object, triangles), &error)| {
            let corners = triangles.flat_map(|triangle| space.corners(triangle));
            let local = corners.fold(Bounds::EMPTY, Bounds::with_point);
            let bounds =
                Bounds { min: space.frame.to_world(local.min), max: space.frame.to_world(local.max) };
            let size = (local.max - local.min).max_element() / space.frame.scale;
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

/// Triangles that have lost their area to rounding; of a mesh that has instances it is said of the first.
fn collapsed_triangles(world: &World, desc: &SceneDesc) -> Vec<(u32, Diagnostic)> {
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
        Some((object, space, 0..space.triangles.len() as u32, space.rounding[0] * scale))
    });
    let in_world = geometry.world_spaces().flat_map(|(_, space)| {
        let ranges = space.mesh_ranges().zip(&space.rounding);
        ranges.map(move |((object, triangles), &error)| (object, space, triangles, error))
    });
    shared
        .chain(in_world)
        .filter_map(|(object, space, triangles, error)| {
            let count = triangles.len();
            let has_no_area = |&triangle: &u32| {
                let [a, b, c] = space.corners(triangle);
                (b - a).cross(c - a) == DVec3::ZERO
            };
            let collapsed = triangles.filter(has_no_area).count();
            let desc = desc.objects.get(object as usize).filter(|_| collapsed > 0)?;
            let severity = if collapsed == count { Severity::Error } else { Severity::Warning };
            let message = format!(
                "{collapsed} of the {count} triangles of this mesh are not drawn: nothing is left of their area when \
                 corners are rounded, by up to {error:.1e}"
            );
            Some((object, diagnostic(severity, Some(&desc.location), message, MOVE)))
        })
        .collect()
}

/// Small objects that touch the one whose points are known least.
fn against_the_coarsest(placed: &[Placed<'_>]) -> Vec<(u32, Diagnostic)> {
    let Some(coarsest) = placed.iter().max_by(|a, b| a.error.total_cmp(&b.error)) else { return Vec::new() };
    let touches = |object: &&Placed<'_>| {
        let (a, b) = (object.bounds, coarsest.bounds);
        a.min.cmple(b.max + coarsest.error).all() && b.min.cmple(a.max + coarsest.error).all()
    };
    let small =
        |object: &&Placed<'_>| !std::ptr::eq(*object, coarsest) && coarsest.error * SIGNIFICANT > object.size;
    placed
        .iter()
        .filter(small)
        .filter(touches)
        .map(|object| {
            let message = format!(
                "the object is {:.1e} in size, but points of the object at {}, which it may touch, are known to within \
                 {:.1e}",
                object.size, coarsest.desc.location, coarsest.error
            );
            let help = "make the larger object smaller, or this one larger";
            (object.index, diagnostic(Severity::Warning, Some(&object.desc.location), message, help))
        })
        .collect()
}
