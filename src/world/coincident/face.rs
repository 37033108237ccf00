//! The faces of primitives: balls, and flat polygons of three or four corners.

use crate::geometry::{Ball, Geometry, PrimitiveId, Shape, SurfacePoint};
use crate::math::{Bounds, DMat3, DVec3};
use std::hash::{DefaultHasher, Hash, Hasher};

/// Names a face: of a box one of six, of others the whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Face {
    pub(super) primitive: PrimitiveId,
    side: u32,
}

/// Where a face lies.
pub(super) enum Outline {
    Ball(Ball),
    /// Corners in order around it; the first `usize` of them.
    Flat([DVec3; 4], usize),
}

/// Sine of the angle up to which planes are parallel: those at larger angles are near to one another in a strip alone,
/// which is too narrow to be seen.
const PARALLEL: f64 = 1e-6;

/// Polygons that overlap by less than this part of their width are side by side.
const BESIDE: f64 = 1e-6;

impl Face {
    /// The faces of a primitive; none of an instance as a whole.
    pub(super) fn all_of(geometry: &Geometry, primitive: PrimitiveId) -> impl Iterator<Item = Face> + use<> {
        let count = match primitive.as_solid().map(|solid| &geometry.solids[solid as usize].shape) {
            Some(Shape::Cuboid(_)) => 6,
            Some(Shape::Instance(_)) => 0,
            _ => 1,
        };
        (0..count).map(move |side| Face { primitive, side })
    }

    /// The face that a triangle is.
    pub(super) fn of_triangle(primitive: PrimitiveId) -> Face {
        Face { primitive, side: 0 }
    }

    /// The face that a point of a primitive is on.
    pub(super) fn at(geometry: &Geometry, point: &SurfacePoint) -> Face {
        let primitive = point.primitive;
        let side = match primitive.as_solid().map(|solid| &geometry.solids[solid as usize].shape) {
            Some(Shape::Cuboid(cuboid)) => cuboid.face_at(point.position, point.normal),
            _ => 0,
        };
        Face { primitive, side }
    }

    pub(super) fn outline(&self, geometry: &Geometry) -> Outline {
        let shape = self.primitive.as_solid().map(|solid| &geometry.solids[solid as usize].shape);
        let triangle = self.primitive.as_triangle().unwrap_or_default();
        let corners = match shape {
            Some(&Shape::Ball(ball)) => return Outline::Ball(ball),
            Some(Shape::Rectangle(rectangle)) => return Outline::Flat(rectangle.corners(), 4),
            Some(Shape::Cuboid(cuboid)) => return Outline::Flat(cuboid.face(self.side).corners(), 4),
            Some(Shape::Instance(instance)) => {
                let space = geometry.space_of(instance);
                space.corners(triangle).map(|corner| instance.to_world(space.frame.to_world(corner)))
            }
            None => {
                let space = &geometry.spaces[self.primitive.space().unwrap_or_default() as usize];
                space.corners(triangle).map(|corner| space.frame.to_world(corner))
            }
        };
        let [a, b, c] = corners;
        Outline::Flat([a, b, c, c], 3)
    }
}

impl Outline {
    pub(super) fn bounds(&self) -> Bounds {
        match self {
            Outline::Ball(ball) => ball.bounds(),
            Outline::Flat(corners, count) => {
                corners[..*count].iter().fold(Bounds::EMPTY, |bounds, &corner| bounds.with_point(corner))
            }
        }
    }

    /// Whether both have an area in common, to within `tolerance` across it.
    pub(super) fn lies_on(&self, other: &Outline, tolerance: f64) -> bool {
        match (self, other) {
            (Outline::Ball(a), Outline::Ball(b)) => balls_coincide(a, b, tolerance),
            (&Outline::Flat(a, a_count), &Outline::Flat(b, b_count)) => {
                flats_overlap(&a[..a_count], &b[..b_count], tolerance)
            }
            _ => false,
        }
    }
}

/// Whether the surfaces of two balls are nowhere farther apart than `tolerance`.
pub(super) fn balls_coincide(a: &Ball, b: &Ball, tolerance: f64) -> bool {
    a.center.distance(b.center) + (a.radius - b.radius).abs() <= tolerance
}

/// A normal of a polygon, of any length; zero without area.
fn normal(corners: &[DVec3]) -> DVec3 {
    (corners[1] - corners[0]).cross(corners[corners.len() - 1] - corners[0])
}

/// Whether two vectors are parallel to within [`PARALLEL`]. Of most it takes no root to see that they are not; where squares
/// leave the range of numbers the roots tell.
fn are_parallel(a: DVec3, b: DVec3) -> bool {
    let across = a.cross(b).length_squared();
    if across > PARALLEL * PARALLEL * a.length_squared() * b.length_squared() {
        return false;
    }
    let (a, b) = (a.normalize_or_zero(), b.normalize_or_zero());
    a != DVec3::ZERO && b != DVec3::ZERO && a.cross(b).length() <= PARALLEL
}

/// Whether polygons lie in one plane and overlap: no line along an edge separates them.
fn flats_overlap(a: &[DVec3], b: &[DVec3], tolerance: f64) -> bool {
    let up = normal(a);
    if !are_parallel(up, normal(b)) {
        return false;
    }
    let (up, from) = (up.normalize_or_zero(), a[0]);
    let (below, above) = range(b, from, up);
    if below > tolerance || above < -tolerance {
        return false;
    }
    let edges = |corners: &[DVec3]| {
        let count = corners.len();
        (0..count).map(|i| corners[(i + 1) % count] - corners[i]).collect::<Vec<_>>()
    };
    edges(a).into_iter().chain(edges(b)).all(|edge| {
        let across = edge.cross(up);
        let ((a_low, a_high), (b_low, b_high)) = (range(a, from, across), range(b, from, across));
        let common = a_high.min(b_high) - a_low.max(b_low);
        common > BESIDE * (a_high - a_low).min(b_high - b_low)
    })
}

/// The least and the greatest coordinate of points along `axis`, from `from` on.
fn range(points: &[DVec3], from: DVec3, axis: DVec3) -> (f64, f64) {
    points
        .iter()
        .map(|&point| (point - from).dot(axis))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// Whether a ray meets both at one distance, to the last bit.
pub(super) fn are_equal(geometry: &Geometry, a: PrimitiveId, b: PrimitiveId) -> bool {
    match (a.as_solid(), b.as_solid()) {
        (Some(a), Some(b)) => {
            match (&geometry.solids[a as usize].shape, &geometry.solids[b as usize].shape) {
                (Shape::Ball(a), Shape::Ball(b)) => a == b,
                (Shape::Cuboid(a), Shape::Cuboid(b)) => a == b,
                (Shape::Rectangle(a), Shape::Rectangle(b)) => a == b,
                _ => false,
            }
        }
        (None, None) => a.space() == b.space() && corners(geometry, a) == corners(geometry, b),
        _ => false,
    }
}

/// Equal for primitives that are equal, but for the sign of a zero.
pub(super) fn hash(geometry: &Geometry, primitive: PrimitiveId) -> u64 {
    let mut hasher = DefaultHasher::new();
    let mut add = |v: DVec3| v.to_array().map(f64::to_bits).hash(&mut hasher);
    match primitive.as_solid().map(|solid| &geometry.solids[solid as usize].shape) {
        Some(Shape::Ball(ball)) => [ball.center, DVec3::splat(ball.radius)].into_iter().for_each(add),
        Some(Shape::Cuboid(cuboid)) => {
            let DMat3 { x_axis, y_axis, z_axis } = cuboid.rotation;
            [cuboid.center, cuboid.half, x_axis, y_axis, z_axis].into_iter().for_each(add);
        }
        Some(Shape::Rectangle(r)) => [r.center, r.edge_u, r.edge_v].into_iter().for_each(add),
        Some(Shape::Instance(_)) => add(DVec3::ZERO),
        None => corners(geometry, primitive).map(|corner| corner.map(f32::to_bits)).hash(&mut hasher),
    }
    hasher.finish()
}

/// The corners of a triangle that lies in the world, as they are kept.
fn corners(geometry: &Geometry, triangle: PrimitiveId) -> [[f32; 3]; 3] {
    let space = &geometry.spaces[triangle.space().unwrap_or_default() as usize];
    space.corners32(triangle.as_triangle().unwrap_or_default())
}
