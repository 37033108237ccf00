//! Ray cones: how much of the scene a ray stands for, by which pictures of surfaces are looked up.
//!
//! After Akenine-Möller, Nilsson, Andersson, Barré-Brisebois, Toth and Karras, "Texture Level of Detail Strategies for
//! Real-Time Ray Tracing", Ray Tracing Gems, 2019, ch. 20. There a cone is as wide as what is seen; here it is never
//! wider, in any direction: it has the width across the ray, not the longer one along a surface that is seen at an angle,
//! and ends where a surface bends light in a way that is not followed. What the cone leaves out is averaged by the
//! samples, as all else is.

use super::World;
use crate::geometry::Shape;
use crate::material::{Material, Pdf, Scatter};
use crate::math::DVec3;
use std::f64::consts::PI;

/// How wide a view a ray stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Width at the start of the ray, in world units.
    pub width: f64,
    /// Growth of the width along the ray.
    pub spread: f64,
}

/// The spread behind a rough surface whose directions have the density 1 / pi, as a Lambertian's have at most: a four
/// hundredth of the hemisphere's directions.
const DIFFUSE_SPREAD: f64 = 0.1;

impl Cone {
    /// The width of a camera's cone, in pixels.
    pub const CAMERA_PIXELS: f64 = 0.25;

    /// Of a ray that stands for itself alone.
    pub const LINE: Cone = Cone { width: 0.0, spread: 0.0 };

    /// At the distance `t` along the ray.
    #[inline]
    pub fn at(self, t: f64) -> Cone {
        Cone { width: self.width + self.spread * t, ..self }
    }

    /// Behind a rough surface that chose its direction with the density `pdf`: the narrower the lobe, the narrower the
    /// cone.
    fn scattered(self, pdf: f64) -> Cone {
        Cone { spread: DIFFUSE_SPREAD / (PI * pdf).max(1.0).sqrt(), ..self }
    }
}

impl World {
    /// The cone of a path that arrived in the direction `arrived` with `cone`, and goes on as `scatter` says.
    pub fn cone_beyond(
        &self,
        cone: Cone,
        arrived: DVec3,
        at: &super::Interaction,
        material: &Material,
        scatter: &Scatter,
    ) -> Cone {
        if let Pdf::SolidAngle(pdf) = scatter.pdf {
            return cone.scattered(pdf);
        }
        let point = &at.receiver.point;
        let through = scatter.direction.dot(at.receiver.side) < 0.0;
        let solid = point.primitive.as_solid().map(|solid| &self.geometry.solids[solid as usize].shape);
        match (solid, material) {
            // A mirror ball seen from outside bends a cone least across the plane of reflection.
            (Some(Shape::Ball(ball)), _) if at.entering && !through => {
                let bend = 2.0 * cone.width * arrived.dot(at.normal).abs() / ball.radius;
                Cone { spread: cone.spread + bend, ..cone }
            }
            // Glass balls and hollow mirrors gather light.
            (Some(Shape::Ball(_)), _) => Cone::LINE,
            // So may smooth meshes.
            _ if at.normal != at.receiver.side => Cone::LINE,
            (_, Material::Refractive(glass)) if through => {
                let ratio = if at.entering { glass.ratio } else { 1.0 / glass.ratio };
                Cone { spread: cone.spread * ratio, ..cone }
            }
            _ => cone,
        }
    }
}
