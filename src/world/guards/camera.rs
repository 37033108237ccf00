//! The camera against the scene.

use super::diagnostic;
use crate::error::{Diagnostic, Severity};
use crate::geometry::{MeshSpace, Shape, Solid};
use crate::material::Material;
use crate::math::{Bounds, DVec3, EPSILON, Rgb};
use crate::scene::desc::{ObjectDesc, SceneDesc};
use crate::world::World;
use crate::world::compile::LARGEST;
use rayon::prelude::*;
use std::ops::Range;

pub(super) fn check(world: &World, desc: &SceneDesc, width: u32) -> Vec<Diagnostic> {
    let mut found: Vec<Diagnostic> =
        [range(world, desc), view(desc, width), direction(desc, width), lens(world, desc)]
            .into_iter()
            .flatten()
            .collect();
    let position = desc.camera.position - world.origin;
    let reach = world.camera(&desc.camera, width, 1).lens_radius;
    for (solid, index) in world.geometry.solids.iter().zip(0..) {
        let Some(object) = desc.objects.get(solid.object as usize) else { continue };
        let error = world
            .geometry
            .solid_point(index, world.geometry.solid_bounds(index).center(), DVec3::ZERO, DVec3::X)
            .error;
        let Some(height) = height_above(solid, position) else { continue };
        if height.abs() <= reach.max(error.max_element()) {
            found.push(on_the_surface(object, height, reach));
        } else if height < 0.0 && is_dark_inside(world, solid.object, world.geometry.solid_bounds(index)) {
            found.push(in_the_dark(object));
        }
    }
    for (object, height) in meshes_at(world, position, reach) {
        found.extend(desc.objects.get(object as usize).map(|object| on_the_surface(object, height, reach)));
    }
    let dark = dark_meshes_around(world, position);
    found.extend(dark.into_iter().filter_map(|object| desc.objects.get(object as usize)).map(in_the_dark));
    found
}

/// Width of a pixel in the middle of the picture, in radians.
fn pixel_angle(desc: &SceneDesc, width: u32) -> f64 {
    2.0 * libm::tan(desc.camera.fov * std::f64::consts::FRAC_PI_2) / f64::from(width.max(1))
}

/// A place or a length that leaves no room for the products of lengths.
fn range(world: &World, desc: &SceneDesc) -> Option<Diagnostic> {
    let camera = &desc.camera;
    let (position, target) = (camera.position - world.origin, camera.looking_at - camera.position);
    let lens_radius = world.camera(camera, 1, 1).lens_radius;
    let places = position.abs().max_element().max(target.abs().max_element());
    let largest = places.max(camera.focus_distance).max(lens_radius);
    let message = format!(
        "the camera's place, direction, FocusDistance or lens reaches {largest:e} units, farther than {LARGEST:e}"
    );
    let help = "bring the camera's numbers into the range that numbers can hold";
    (largest > LARGEST).then(|| diagnostic(Severity::Error, None, message, help))
}

/// Neighbouring pixels see the same.
fn view(desc: &SceneDesc, width: u32) -> Option<Diagnostic> {
    let (fov, angle) = (desc.camera.fov, pixel_angle(desc, width));
    let message = format!(
        "the camera sees the same in all pixels: a field of view of {fov:.1e} over {width} pixels makes {angle:.1e} \
         radians a pixel, and directions have steps of {EPSILON:.1e}"
    );
    (angle < 4.0 * EPSILON).then(|| diagnostic(Severity::Error, None, message, "make Fov larger"))
}

/// Position and point looked at are so close, or so far out, that their difference is mostly rounding.
fn direction(desc: &SceneDesc, width: u32) -> Option<Diagnostic> {
    let (from, to) = (desc.camera.position, desc.camera.looking_at);
    let (farthest, distance) = (from.abs().max(to.abs()).max_element(), (to - from).length());
    let error = farthest * EPSILON / distance;
    let angle = pixel_angle(desc, width);
    if error <= angle {
        return None;
    }
    let meaningless = error > 0.25 || error > angle * f64::from(width);
    let severity = if meaningless { Severity::Error } else { Severity::Warning };
    let message = format!(
        "the camera's direction is known to within {error:.1e} radians and a pixel is {angle:.1e}: coordinates of \
         {farthest:.1e} have steps of {:.1e}, and LookingAt is {distance:.1e} away from Position",
        farthest * f64::EPSILON
    );
    Some(diagnostic(
        severity,
        None,
        message,
        "move LookingAt away from the camera, or the scene towards the origin",
    ))
}

/// A lens that is larger than the distance it is focused at.
fn lens(world: &World, desc: &SceneDesc) -> Option<Diagnostic> {
    let radius = world.camera(&desc.camera, 1, 1).lens_radius;
    let focus = desc.camera.focus_distance;
    let message = format!(
        "the lens has a radius of {radius:.1e}, more than the distance of {focus:.1e} it is focused at"
    );
    let help = "make DepthOfField or ApertureRadius smaller, or FocusDistance larger";
    (radius > focus).then(|| diagnostic(Severity::Warning, None, message, help))
}

/// How far a point is outside of a body, or from a rectangle; negative inside, `None` of instances.
fn height_above(solid: &Solid, p: DVec3) -> Option<f64> {
    match solid.shape {
        Shape::Ball(ball) => Some((p - ball.center).length() - ball.radius),
        Shape::Cuboid(cuboid) => {
            let beyond = cuboid.to_local(p - cuboid.center).abs() - cuboid.half;
            let outside = beyond.max(DVec3::ZERO).length();
            Some(if outside > 0.0 { outside } else { beyond.max_element() })
        }
        Shape::Rectangle(rectangle) => {
            let [a, b, c, d] = rectangle.corners();
            Some(distance_to_triangle(p, [a, b, c]).min(distance_to_triangle(p, [a, c, d])))
        }
        Shape::Instance(_) => None,
    }
}

/// The objects of the meshes that a point is on, and how far it is from them at most: within `reach`, or what the corners
/// were moved by when they were rounded.
fn meshes_at(world: &World, p: DVec3, reach: f64) -> Vec<(u32, f64)> {
    let geometry = &world.geometry;
    let look = |space: &MeshSpace, p: DVec3, triangles: Range<u32>, reach: f64| {
        let (local, reach) = (space.frame.to_local(p), reach * space.frame.scale);
        let distance = |triangle: u32| {
            let corners = space.corners(triangle);
            let around = corners.into_iter().fold(Bounds::EMPTY, Bounds::with_point);
            // A coordinate is rounded by half a step at most.
            let farthest = around.min.abs().max(around.max.abs()).max_element();
            let reach = reach.max(farthest * f64::from(f32::EPSILON) / 2.0);
            let is_near = around.padded(reach).touches(Bounds { min: local, max: local });
            let distance = if is_near { distance_to_triangle(local, corners) } else { f64::INFINITY };
            if distance <= reach { distance } else { f64::INFINITY }
        };
        let all = triangles.into_par_iter().with_min_len(4096).map(distance);
        let nearest = all.reduce(|| f64::INFINITY, f64::min);
        (nearest < f64::INFINITY).then_some(nearest / space.frame.scale)
    };
    let in_world = geometry.world_spaces().flat_map(|(_, space)| {
        space
            .mesh_ranges()
            .filter_map(move |(mesh, triangles)| Some((mesh.object, look(space, p, triangles, reach)?)))
    });
    let instances = geometry.solids.iter().filter_map(|solid| {
        let Shape::Instance(instance) = &solid.shape else { return None };
        let space = geometry.space_of(instance);
        let triangles = 0..space.triangles.len() as u32;
        let distance = look(space, instance.in_mesh(p), triangles, reach / instance.scale)?;
        Some((solid.object, distance * instance.scale))
    });
    in_world.chain(instances).collect()
}

/// The distance of a point from a triangle.
fn distance_to_triangle(p: DVec3, corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let edges = [(a, b), (b, c), (c, a)];
    let is_over = edges.iter().all(|&(from, to)| (to - from).cross(p - from).dot(normal) >= 0.0);
    if is_over && normal != DVec3::ZERO {
        return (p - a).dot(normal).abs();
    }
    let to_edge = |&(from, to): &(DVec3, DVec3)| {
        let along = to - from;
        let length2 = along.length_squared();
        let share = if length2 > 0.0 { ((p - from).dot(along) / length2).clamp(0.0, 1.0) } else { 0.0 };
        (p - from - along * share).length()
    };
    edges.iter().map(to_edge).fold(f64::INFINITY, f64::min)
}

fn on_the_surface(object: &ObjectDesc, height: f64, reach: f64) -> Diagnostic {
    let message = if reach > 0.0 {
        format!("the camera's lens, with a radius of {reach:.1e}, reaches through the surface of this object")
    } else {
        format!(
            "the camera is on the surface of this object ({height:.1e} above it): rounding decides what it sees"
        )
    };
    diagnostic(
        Severity::Warning,
        Some(&object.location),
        message,
        "move the camera, or make the lens smaller",
    )
}

/// The objects of the closed meshes that a point is in and no light is.
fn dark_meshes_around(world: &World, p: DVec3) -> Vec<u32> {
    let geometry = &world.geometry;
    let mut found = Vec::new();
    let mut look = |space: &MeshSpace, p: DVec3, triangles: Range<u32>, object: u32, bounds: Bounds| {
        let Bounds { min, max } = space.frame.bounds;
        let local = space.frame.to_local(p);
        let is_near = min.cmple(local).all() && local.cmple(max).all();
        if is_near && is_dark_inside(world, object, bounds) && is_inside(space.winding(triangles, p)) {
            found.push(object);
        }
    };
    for (_, space) in geometry.world_spaces() {
        let Bounds { min, max } = space.frame.bounds;
        let bounds = Bounds { min: space.frame.to_world(min), max: space.frame.to_world(max) };
        for (mesh, triangles) in space.mesh_ranges() {
            look(space, p, triangles, mesh.object, bounds);
        }
    }
    for solid in &geometry.solids {
        let Shape::Instance(instance) = &solid.shape else { continue };
        let space = geometry.space_of(instance);
        let triangles = 0..space.triangles.len() as u32;
        look(space, instance.in_mesh(p), triangles, solid.object, instance.bounds(space));
    }
    found
}

/// Whether a winding number is that of a place inside a closed mesh, to roundings.
fn is_inside(winding: f64) -> bool {
    (winding.abs() - 1.0).abs() < 1e-6
}

/// Whether an object lets no light through, and neither shines nor may have a light in the box around it.
fn is_dark_inside(world: &World, object: u32, a: Bounds) -> bool {
    let geometry = &world.geometry;
    let is_light = |object: u32| world.emission(object) != Rgb::ZERO;
    let overlaps = |b: Bounds| a.min.cmple(b.max).all() && b.min.cmple(a.max).all();
    let mut solids = geometry.solids.iter().zip(0..);
    let has_light = solids
        .any(|(other, index)| is_light(other.object) && overlaps(geometry.solid_bounds(index)))
        || geometry.world_spaces().any(|(_, space)| space.meshes.iter().any(|mesh| is_light(mesh.object)));
    let is_glass = |material: &Material| matches!(material, Material::Refractive(_));
    !world.varied.face_materials().any(is_glass) && !is_glass(world.material(object)) && !has_light
}

fn in_the_dark(object: &ObjectDesc) -> Diagnostic {
    let message =
        "the camera is inside this object, which is opaque and has no light in it: the picture is black";
    diagnostic(
        Severity::Warning,
        Some(&object.location),
        message.into(),
        "move the camera out, or put a light in",
    )
}
