//! Surfaces that emit: choosing a point of one as seen from another point, and the density of that choice.

use super::WEIGHED;
use super::alias::{AliasTable, BELOW_ONE};
use super::spherical_rectangle::{Pane, SphericalRectangle};
use super::tree::{LightTree, TreeItem};
use crate::geometry::{Ball, Cuboid, Geometry, MeshSpace, PrimitiveId, Rectangle, Shape, SurfacePoint};
use crate::math::{Bounds, DVec3, Frame, Rgb, luminance};
use crate::sampling::warp::{cone_pdf, square_to_cone, square_to_triangle};
use std::ops::Range;

/// Where light arrives: a point with the side of its surface that is lit.
#[derive(Clone, Copy, Debug)]
pub struct Receiver {
    /// The point.
    pub point: SurfacePoint,
    /// Its geometric normal, on the lit side.
    pub side: DVec3,
}

/// An object that emits the same radiance everywhere, on both sides.
#[derive(Clone, Debug)]
pub(super) struct AreaLight {
    /// Emitted radiance.
    pub(super) radiance: Rgb,
    shape: LightShape,
    /// Luminance times area.
    pub(super) power: f64,
    bounds: Bounds,
    center: DVec3,
    bounding_radius: f64,
}

#[derive(Clone, Debug)]
enum LightShape {
    Ball {
        solid: u32,
        ball: Ball,
    },
    Cuboid {
        solid: u32,
        cuboid: Cuboid,
        faces: Box<[Face; 6]>,
    },
    Rectangle {
        solid: u32,
        rectangle: Rectangle,
        pane: Pane,
    },
    /// Triangles of a space, chosen by area.
    FewTriangles {
        space: u32,
        triangles: Vec<u32>,
        area: f64,
        table: AliasTable,
    },
    /// Triangles of a space from `first` on, chosen by the light that they may bring.
    Triangles {
        space: u32,
        first: u32,
        /// Of every triangle.
        areas: Vec<f64>,
        tree: LightTree,
    },
}

/// A face of a box that emits.
#[derive(Clone, Copy, Debug)]
struct Face {
    rectangle: Rectangle,
    pane: Pane,
}

/// A point of a light, and its density per solid angle.
pub(super) type PointSample = (SurfacePoint, f64);

impl AreaLight {
    /// The light of a solid; none of an instance: meshes that emit lie in the world.
    pub(super) fn of_solid(geometry: &Geometry, solid: u32, radiance: Rgb) -> Option<AreaLight> {
        let (shape, area) = match geometry.solids[solid as usize].shape {
            Shape::Ball(ball) => {
                let area = 4.0 * std::f64::consts::PI * ball.radius * ball.radius;
                (LightShape::Ball { solid, ball }, area)
            }
            Shape::Cuboid(cuboid) => {
                let faces: Box<[Face; 6]> =
                    Box::new(std::array::from_fn(|face| Face::of(cuboid.face(face as u32))));
                let area = faces.iter().map(|face| face.rectangle.area()).sum();
                (LightShape::Cuboid { solid, cuboid, faces }, area)
            }
            Shape::Rectangle(rectangle) => {
                let pane = Pane::new(&rectangle);
                (LightShape::Rectangle { solid, rectangle, pane }, rectangle.area())
            }
            Shape::Instance(_) => return None,
        };
        let bounds = geometry.solid_bounds(solid);
        let bounding_radius = ((bounds.max - bounds.min) * 0.5).length();
        Some(AreaLight {
            radiance,
            shape,
            power: luminance(radiance) * area,
            bounds,
            center: bounds.center(),
            bounding_radius,
        })
    }

    /// The light of a mesh: those of some triangles of the space `space` that are not `hidden`; `None` if all are.
    pub(super) fn of_mesh(
        mesh: &MeshSpace,
        space: u32,
        triangles: Range<u32>,
        radiance: Rgb,
        hidden: impl Fn(u32) -> bool,
    ) -> Option<AreaLight> {
        let first = triangles.start;
        let item = |index: u32| {
            let [a, b, c] = mesh.corners(index).map(|corner| mesh.frame.to_world(corner));
            let bounds = [a, b, c].into_iter().fold(Bounds::EMPTY, Bounds::with_point);
            let area = if hidden(index) { 0.0 } else { 0.5 * (b - a).cross(c - a).length() };
            TreeItem { bounds, power: area }
        };
        let items: Vec<TreeItem> = triangles.clone().map(item).collect();
        let seen: Vec<u32> = triangles.filter(|&index| !hidden(index)).collect();
        if seen.is_empty() {
            return None;
        }
        let bounds = items.iter().fold(Bounds::EMPTY, |bounds, item| bounds.union(item.bounds));
        let areas: Vec<f64> = items.iter().map(|item| item.power).collect();
        let area: f64 = areas.iter().sum();
        let shape = if seen.len() <= WEIGHED {
            let areas: Vec<f64> = seen.iter().map(|&index| areas[(index - first) as usize]).collect();
            LightShape::FewTriangles { space, triangles: seen, area, table: AliasTable::new(&areas) }
        } else {
            LightShape::Triangles { space, first, areas, tree: LightTree::new(&items) }
        };
        Some(AreaLight {
            radiance,
            shape,
            power: luminance(radiance) * area,
            bounds,
            center: bounds.center(),
            bounding_radius: ((bounds.max - bounds.min) * 0.5).length(),
        })
    }

    /// As a tree over lights sees it.
    pub(super) fn item(&self) -> TreeItem {
        TreeItem { bounds: self.bounds, power: self.power }
    }

    /// An estimate, without occlusion, of the light that reaches a receiver: power over squared distance; 0 only where
    /// no point of the light is above the receiver's surface.
    pub(super) fn importance(&self, at: &Receiver) -> f64 {
        let to = self.center - at.point.position;
        if to.dot(at.side) < -self.bounding_radius * (1.0 + 1e-9) {
            return 0.0;
        }
        self.power / to.length_squared().max(self.bounding_radius * self.bounding_radius)
    }

    /// A point as seen from the receiver, from `u` in [0, 1)^2; `None` where it can't be seen, or only by chance.
    #[inline]
    pub(super) fn sample(&self, geometry: &Geometry, at: &Receiver, u: [f64; 2]) -> Option<PointSample> {
        let p = at.point.position;
        match &self.shape {
            LightShape::Ball { solid, ball } => {
                let cone = Cone::of(ball, p).filter(|_| at.point.primitive != PrimitiveId::solid(*solid))?;
                let normal = cone.normal_of(square_to_cone(u, cone.one_minus_cos));
                let point = geometry.solid_point(*solid, ball.center, normal * ball.radius, normal);
                Some((point, cone_pdf(cone.one_minus_cos)))
            }
            LightShape::Rectangle { solid, rectangle, pane } => {
                if at.point.primitive == PrimitiveId::solid(*solid) {
                    return None;
                }
                let view = SphericalRectangle::new(pane, p);
                let (s, t) = view.sample(u);
                let offset = rectangle.offset_at(s, t);
                let point = geometry.solid_point(*solid, rectangle.center, offset, rectangle.normal);
                Some((point, view.pdf(point.position - p)))
            }
            LightShape::Cuboid { solid, cuboid, faces } => {
                let seen = VisibleFaces::new(*solid, cuboid, faces, at);
                let (face, u0) = seen.choose(u[0])?;
                let (s, t) = seen.views[face]?.0.sample([u0, u[1]]);
                let rectangle = &faces[face].rectangle;
                let offset = rectangle.center - cuboid.center + rectangle.offset_at(s, t);
                let point = geometry.solid_point(*solid, cuboid.center, offset, rectangle.normal);
                Some((point, seen.pdf(face, point.position - p)))
            }
            LightShape::FewTriangles { space, triangles, area, table } => {
                let (index, _, u0) = table.sample(u[0])?;
                let point = triangle_point(geometry, *space, triangles[index as usize], [u0, u[1]]);
                (point.primitive != at.point.primitive).then(|| (point, area_pdf(*area, &point, p)))
            }
            LightShape::Triangles { space, first, areas, tree } => {
                let (index, probability, u0) = tree.sample(at, u[0])?;
                let point = triangle_point(geometry, *space, first + index, [u0, u[1]]);
                let pdf = area_pdf(areas[index as usize], &point, p) * probability;
                (point.primitive != at.point.primitive).then_some((point, pdf))
            }
        }
    }

    /// Density per solid angle with which [`AreaLight::sample`] chooses `point`, on the part `part` of the light.
    pub(super) fn pdf(&self, at: &Receiver, point: &SurfacePoint, part: u32) -> f64 {
        let p = at.point.position;
        match &self.shape {
            LightShape::Ball { solid, ball } => Cone::of(ball, p)
                .filter(|_| at.point.primitive != PrimitiveId::solid(*solid))
                .map_or(0.0, |cone| cone_pdf(cone.one_minus_cos)),
            LightShape::Rectangle { pane, .. } => SphericalRectangle::new(pane, p).pdf(point.position - p),
            LightShape::Cuboid { solid, cuboid, faces } => {
                VisibleFaces::new(*solid, cuboid, faces, at).pdf(part as usize, point.position - p)
            }
            LightShape::FewTriangles { area, .. } => area_pdf(*area, point, p),
            LightShape::Triangles { areas, tree, .. } => {
                area_pdf(areas[part as usize], point, p) * tree.probability(at, part)
            }
        }
    }
}

/// A point of a triangle, uniform over its area.
fn triangle_point(geometry: &Geometry, space: u32, triangle: u32, u: [f64; 2]) -> SurfacePoint {
    let [s, t] = square_to_triangle(u);
    geometry.triangle_point(PrimitiveId::triangle(space, triangle), s, t)
}

/// Density per solid angle of a point that is uniform over an area.
fn area_pdf(area: f64, point: &SurfacePoint, from: DVec3) -> f64 {
    let to = point.position - from;
    let distance2 = to.length_squared();
    distance2 * distance2.sqrt() / (area * to.dot(point.normal).abs())
}

impl Face {
    fn of(rectangle: Rectangle) -> Face {
        Face { rectangle, pane: Pane::new(&rectangle) }
    }
}

/// The cone of directions in which a ball is seen from outside.
struct Cone {
    frame: Frame,
    one_minus_cos: f64,
    /// Sine of the half angle: radius over distance.
    sin: f64,
    /// Distance over radius.
    distance: f64,
}

impl Cone {
    /// `None` from inside and from the surface.
    fn of(ball: &Ball, p: DVec3) -> Option<Cone> {
        let to = ball.center - p;
        let distance = to.length();
        if distance <= ball.radius {
            return None;
        }
        let sin = ball.radius / distance;
        let cos = ((distance - ball.radius) * (distance + ball.radius)).sqrt() / distance;
        // 1 - cos without cancellation.
        let one_minus_cos = sin * sin / (1.0 + cos);
        Some(Cone {
            frame: Frame::around(to / distance),
            one_minus_cos,
            sin,
            distance: distance / ball.radius,
        })
    }

    /// The ball's unit normal where a direction of the cone, given about its axis, first meets the ball.
    fn normal_of(&self, local: DVec3) -> DVec3 {
        let sin2 = local.x * local.x + local.y * local.y;
        // In units of the radius: the near root of the quadratic, with the perpendicular distance * sin.
        let root = ((self.sin * self.sin - sin2).max(0.0)).sqrt() * self.distance;
        let t = self.distance * local.z - root;
        self.frame.to_world(DVec3::new(local.x * t, local.y * t, local.z * t - self.distance)).normalize()
    }
}

/// The faces of a box that a receiver sees: up to three from outside, all from inside.
struct VisibleFaces {
    /// With their solid angles.
    views: [Option<(SphericalRectangle, f64)>; 6],
    total: f64,
}

impl VisibleFaces {
    fn new(solid: u32, cuboid: &Cuboid, faces: &[Face; 6], at: &Receiver) -> VisibleFaces {
        let p = at.point.position;
        let own = at.point.primitive == PrimitiveId::solid(solid);
        let local = cuboid.to_local(p - cuboid.center);
        let outside = if own {
            // On the box itself the lit side tells, not the rounding of the position.
            at.side.dot(at.point.normal) > 0.0
        } else {
            local.abs().cmpgt(cuboid.half).any()
        };
        let mut seen = VisibleFaces { views: [None; 6], total: 0.0 };
        if own && outside {
            return seen;
        }
        for (face, Face { rectangle, pane }) in faces.iter().enumerate() {
            let axis = face / 2;
            let beyond = if face % 2 == 0 { -local[axis] } else { local[axis] } > cuboid.half[axis];
            let own_face = own && rectangle.normal.dot(at.point.normal) > 0.5;
            if beyond == outside && !own_face {
                let view = SphericalRectangle::new(pane, p);
                let angle = view.solid_angle();
                seen.total += angle;
                seen.views[face] = Some((view, angle));
            }
        }
        seen
    }

    /// A face in proportion to its solid angle, and `u` made new.
    fn choose(&self, u: f64) -> Option<(usize, f64)> {
        let mut rest = u * self.total;
        let mut last = None;
        for (face, view) in self.views.iter().enumerate() {
            let angle = view.map_or(0.0, |(_, angle)| angle);
            if angle == 0.0 {
                continue;
            }
            if rest < angle {
                return Some((face, (rest / angle).min(BELOW_ONE)));
            }
            rest -= angle;
            last = Some((face, BELOW_ONE));
        }
        last
    }

    fn pdf(&self, face: usize, to: DVec3) -> f64 {
        let view = self.views.get(face).copied().flatten();
        view.map_or(0.0, |(view, angle)| view.pdf(to) * (angle / self.total))
    }
}
