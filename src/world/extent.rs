//! How large a cone's footprint on a surface is in a picture that the surface shows.

use crate::geometry::{Ball, Geometry, Hit, Shape};
use crate::math::DVec3;
use std::f64::consts::PI;

/// The square of the ellipse that a disk on a surface is in the coordinates of a picture, as a symmetric matrix.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    uu: f64,
    uv: f64,
    vv: f64,
}

impl Extent {
    /// Of a point.
    pub(super) const POINT: Extent = Extent { uu: 0.0, uv: 0.0, vv: 0.0 };

    /// Where the coordinates go along two axes at right angles, by so much over the disk's width.
    fn along_axes(u: f64, v: f64) -> Extent {
        Extent { uu: u * u, uv: 0.0, vv: v * v }
    }

    /// Of a disk `width` wide around a point of a ball with this normal: u goes around, v from pole to pole.
    fn of_ball(ball: &Ball, normal: DVec3, width: f64) -> Extent {
        let turn = width / (PI * ball.radius);
        Extent::along_axes(turn / (2.0 * normal.x.hypot(normal.y)), turn)
    }

    /// Of a disk of the width 1 on a triangle with these edges to its second and third corner, along which the coordinates
    /// of the picture change by `steps`.
    fn of_triangle([b, c]: [DVec3; 2], [[bu, bv], [cu, cv]]: [[f64; 2]; 2]) -> Extent {
        let (bb, bc, cc) = (b.dot(b), b.dot(c), c.dot(c));
        let scale = 1.0 / (bb * cc - bc * bc);
        Extent {
            uu: (cc * bu * bu - 2.0 * bc * bu * cu + bb * cu * cu) * scale,
            uv: (cc * bu * bv - bc * (bu * cv + cu * bv) + bb * cu * cv) * scale,
            vv: (cc * bv * bv - 2.0 * bc * bv * cv + bb * cv * cv) * scale,
        }
    }

    /// Of a disk `width` wide around a hit of a shape whose coordinates are the picture's. `normal` is the surface's.
    pub(super) fn on_solid(geometry: &Geometry, hit: &Hit, normal: DVec3, width: f64) -> Extent {
        match hit.primitive.as_solid().map(|solid| &geometry.solids[solid as usize].shape) {
            Some(Shape::Ball(ball)) => Extent::of_ball(ball, normal, width),
            Some(Shape::Rectangle(rectangle)) => {
                Extent::along_axes(width / rectangle.edge_u.length(), width / rectangle.edge_v.length())
            }
            Some(Shape::Cuboid(cuboid)) => {
                let [u, v] = cuboid.face_lengths(hit.part);
                Extent::along_axes(width / u, width / v)
            }
            Some(Shape::Instance(_)) | None => Extent::POINT,
        }
    }

    /// Of a disk `width` wide around a hit of a triangle, along whose edges the coordinates of the picture change by
    /// `steps`.
    pub(super) fn on_triangle(geometry: &Geometry, hit: &Hit, steps: [[f64; 2]; 2], width: f64) -> Extent {
        let Some(([b, c], unit)) = geometry.triangle_edges(hit.primitive) else { return Extent::POINT };
        // Lengths in widths of the disk, so that none is out of range.
        let scale = unit / width;
        Extent::of_triangle([b * scale, c * scale], steps)
    }

    /// The shorter axis in pixels of a picture of `width` x `height`; 0 or NaN if there is none.
    pub(super) fn shorter_axis(&self, [width, height]: [u32; 2]) -> f64 {
        let (width, height) = (f64::from(width), f64::from(height));
        let (a, b, d) = (self.uu * width * width, self.uv * width * height, self.vv * height * height);
        // The smaller eigenvalue, without the difference of large numbers that its formula has.
        let larger = 0.5 * (a + d + ((a - d) * (a - d) + 4.0 * b * b).sqrt());
        ((a * d - b * b) / larger).sqrt()
    }
}
