//! Where the world's origin is.

use crate::math::{Bounds, DVec3};
use crate::scene::desc::{MeshDesc, ObjectDesc, ShapeDesc};
use std::collections::HashMap;
use std::sync::Arc;

/// Objects so many times larger than the median one do not count: the centre of a huge ground ball is far from
/// everything that is looked at.
const LARGE: f64 = 64.0;

/// The component-wise lower median of the positions of the objects that are not much larger than the others. Each
/// component is a number that stands in the file, so that moving the whole scene by amounts that its numbers can hold
/// moves it exactly.
pub(super) fn origin(objects: &[ObjectDesc]) -> DVec3 {
    let extents = extents(objects);
    let Some(middle) = lower_median(extents.clone()) else { return DVec3::ZERO };
    let counts = |&(_, &extent): &(&ObjectDesc, &f64)| extent <= middle * LARGE;
    let positions: Vec<DVec3> =
        objects.iter().zip(&extents).filter(counts).map(|(object, _)| position_of(&object.shape)).collect();
    let component = |axis: usize| lower_median(positions.iter().map(|p| p[axis]).collect()).unwrap_or(0.0);
    DVec3::new(component(0), component(1), component(2))
}

/// Where an object stands.
pub(super) fn position_of(shape: &ShapeDesc) -> DVec3 {
    match *shape {
        ShapeDesc::Ball { position, .. }
        | ShapeDesc::Box { position, .. }
        | ShapeDesc::Rectangle { position, .. }
        | ShapeDesc::TriangleMesh { position, .. } => position,
    }
}

/// The longest side of every object, before it is turned.
fn extents(objects: &[ObjectDesc]) -> Vec<f64> {
    let mut of_mesh: HashMap<*const MeshDesc, f64> = HashMap::new();
    let mut extent = |object: &ObjectDesc| match &object.shape {
        &ShapeDesc::Ball { radius, .. } => 2.0 * radius,
        ShapeDesc::Box { size, .. } => size.max_element(),
        ShapeDesc::Rectangle { width, height, .. } => width.max(*height),
        ShapeDesc::TriangleMesh { mesh, scale, .. } => {
            let around = || mesh.positions.iter().fold(Bounds::EMPTY, |b, &p| b.with_point(p.into()));
            *of_mesh.entry(Arc::as_ptr(mesh)).or_insert_with(|| around().extent()) * scale
        }
    };
    objects.iter().map(&mut extent).collect()
}

fn lower_median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len().checked_sub(1)? / 2).copied()
}
