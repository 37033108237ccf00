//! The balls by way of which light is sought.

use super::{World, coincident};
use crate::geometry::{Ball, Shape};
use crate::material::Material;
use crate::math::Rgb;

/// A mirror or glass ball whose surface is smooth and has the same colour everywhere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SmoothBall {
    /// Where it is, in world space.
    pub(crate) ball: Ball,
    /// Index of the solid.
    pub(crate) solid: u32,
    /// Factor at every interface.
    pub(crate) color: Rgb,
    /// n outside / n inside, below 1; `None` of a mirror.
    pub(crate) ratio: Option<f64>,
}

/// With more of them the light is left to chance: the one that is asked would seldom be the right one.
pub(crate) const MOST_SMOOTH_BALLS: usize = 16;

impl World {
    /// The balls by way of which light is sought, but for those that lie on another one, which paths may meet instead; none
    /// if there are no lights to find, or more than
    /// [`MOST_SMOOTH_BALLS`].
    pub(crate) fn smooth_balls(&self) -> Vec<SmoothBall> {
        if self.lights.count() == 0 {
            return Vec::new();
        }
        let solids = self.geometry.solids.iter().zip(0..);
        let smooth = solids.filter_map(|(solid, index)| {
            let Shape::Ball(ball) = solid.shape else { return None };
            // A picture as its colour would have to be looked up at every interface of a path.
            if self.varied.varies(solid.object) {
                return None;
            }
            let (color, ratio) = match self.material(solid.object) {
                Material::Refractive(glass) if glass.ratio < 1.0 => (glass.color, Some(glass.ratio)),
                material @ Material::Reflective(mirror) if material.is_delta() => (mirror.color, None),
                _ => return None,
            };
            Some(SmoothBall { ball, solid: index, color, ratio })
        });
        let mut balls: Vec<SmoothBall> = smooth.take(MOST_SMOOTH_BALLS + 1).collect();
        if balls.len() > MOST_SMOOTH_BALLS {
            return Vec::new();
        }
        balls.retain(|b| !coincident::lies_on_another_ball(&self.geometry, b.solid, &b.ball));
        balls
    }
}
