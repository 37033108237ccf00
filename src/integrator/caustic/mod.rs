//! Light that reaches a surface by way of a mirror or glass ball: found by solving for the path, where waiting for paths
//! that happen to meet the light would leave a few very bright samples.
//!
//! Where a path meets a surface that is no mirror, one of the balls and a number of chords inside it are chosen, and a
//! point of a light; every path between that point and the surface by way of this ball is added
//! (`chain`). Paths that were found by the material's choice instead are weighed against these by multiple importance
//! sampling, each by its own density; so nothing counts twice, and where a caustic is so sharp that the solution's
//! weight would be without bound the material's choice takes over. A path that the solver would not have found keeps its
//! whole weight: the sum is unbiased whatever the solver misses.

mod chain;
mod connect;

use crate::geometry::{Ball, Hit, PrimitiveId, SurfacePoint};
use crate::material::Interface;
use crate::math::{DVec3, Rgb};
use crate::world::light::Receiver;
use crate::world::{MOST_SMOOTH_BALLS, SmoothBall, World};
use chain::{Chain, Ends, MOST_CHORDS};

/// The balls of a scene by which light is sought.
#[derive(Clone, Debug)]
pub(super) struct Caustics {
    balls: Vec<SpecularBall>,
}

/// A smooth ball, with how often paths with 0, 1, ... chords are looked for.
#[derive(Clone, Copy, Debug)]
struct SpecularBall {
    smooth: SmoothBall,
    shares: [f64; MOST_CHORDS as usize + 1],
}

/// A way to look for light.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice {
    /// Which of the balls.
    ball: usize,
    /// Number of chords inside it; with none, its outside reflects.
    chords: u32,
    /// Probability of the choice.
    probability: f64,
}

/// How a path that has left a surface goes through a ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage {
    ball: usize,
    chords: u32,
    /// Whether it is in the ball now.
    inside: bool,
    /// The direction in which it left the surface.
    first: DVec3,
}

/// A path that was solved for.
pub(super) struct Found {
    /// Where it meets the ball, in order.
    points: [SurfacePoint; MOST_CHORDS as usize + 1],
    count: usize,
    /// Density of finding it times the cosine at the light as seen from the ball's centre.
    spread: f64,
    /// Factor of all interfaces without the Fresnel terms, and these: also the probability of the material's choices.
    color: Rgb,
    fresnel: f64,
}

impl Found {
    /// Where it meets the ball, in order.
    pub(super) fn points(&self) -> &[SurfacePoint] {
        &self.points[..self.count]
    }

    /// What the light's radiance is multiplied by to be what arrives by the path, on average, if the surface sends on
    /// `pdf` is the density with which its material chooses the path's first direction.
    pub(super) fn factor(&self, choice: &Choice, light: &LightEnd, cosine: f64, pdf: f64) -> Rgb {
        let arriving = self.fresnel * self.spread * cosine;
        let density = light.pdf * light.cosine * choice.probability;
        self.color * (arriving / (density + pdf * arriving))
    }
}

/// A point of a light as it was chosen from the centre of a ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightEnd {
    /// Density per solid angle at the centre.
    pub(super) pdf: f64,
    /// Cosine of the way to the centre with the light's normal.
    pub(super) cosine: f64,
}

/// How often glass is asked for reflections, for light that goes through it, and for light that is reflected inside.
const GLASS: [f64; 3] = [0.1, 0.8, 0.1];
/// How often a mirror is, which only reflects.
const MIRROR: [f64; 3] = [1.0, 0.0, 0.0];

impl Caustics {
    /// Those of a world; `None` where it has none.
    pub(super) fn of(world: &World) -> Option<Caustics> {
        let shares = |smooth: &SmoothBall| if smooth.ratio.is_some() { GLASS } else { MIRROR };
        let balls: Vec<SpecularBall> = world
            .smooth_balls()
            .into_iter()
            .map(|smooth| SpecularBall { smooth, shares: shares(&smooth) })
            .collect();
        (!balls.is_empty()).then_some(Caustics { balls })
    }

    /// Where to look for light at a point, from `u` in [0, 1).
    pub(super) fn choose(&self, at: &Receiver, u: f64) -> Option<Choice> {
        let weights = self.weights(at);
        let total: f64 = weights.iter().sum();
        let mut rest = u * total;
        for (ball, weight) in weights.into_iter().enumerate().take(self.balls.len()) {
            for (chords, share) in self.balls[ball].shares.into_iter().enumerate() {
                let weight = weight * share;
                if rest < weight {
                    return Some(Choice { ball, chords: chords as u32, probability: weight / total });
                }
                rest -= weight;
            }
        }
        None
    }

    /// The probability with which [`Caustics::choose`] would have looked for the path that went this way.
    fn probability(&self, at: &Receiver, passage: &Passage) -> f64 {
        let weights = self.weights(at);
        let total: f64 = weights.iter().sum();
        weights[passage.ball] * self.balls[passage.ball].shares[passage.chords as usize] / total
    }

    /// How much each ball may bring: the solid angle that it takes.
    fn weights(&self, at: &Receiver) -> [f64; MOST_SMOOTH_BALLS] {
        let mut weights = [0.0; MOST_SMOOTH_BALLS];
        for (weight, SpecularBall { smooth: SmoothBall { ball, .. }, .. }) in
            weights.iter_mut().zip(&self.balls)
        {
            let to = ball.center - at.point.position;
            let distance2 = to.length_squared();
            if distance2 > ball.radius * ball.radius && to.dot(at.side) > -ball.radius {
                *weight = ball.radius * ball.radius / distance2;
            }
        }
        weights
    }

    /// Where the light for a choice is to be chosen from: the centre of the ball.
    pub(super) fn center(&self, choice: &Choice) -> Receiver {
        center(&self.balls[choice.ball].smooth.ball)
    }

    /// How many segments a path of this choice has.
    pub(super) fn segments(choice: &Choice) -> u32 {
        choice.chords + 2
    }

    /// Calls `found` with every path of a choice from `at` to a light's point.
    pub(super) fn paths(
        &self,
        world: &World,
        choice: &Choice,
        at: DVec3,
        light: DVec3,
        mut found: impl FnMut(&Found),
    ) {
        let specular = &self.balls[choice.ball].smooth;
        let Some(ends) = Ends::new(&specular.ball, at, light) else { return };
        ends.chains(choice.chords, specular.ratio.unwrap_or(1.0), |chain| {
            let count = choice.chords as usize + 1;
            let points = ends.normals(chain, choice.chords).map(|normal| {
                let ball = ends.ball();
                world.geometry.solid_point(specular.solid, ball.center, normal * ball.radius, normal)
            });
            found(&Found {
                points,
                count,
                spread: chain.spread,
                color: (0..count).fold(Rgb::ONE, |color, _| color * specular.color),
                fresnel: fresnel(specular, chain, choice.chords),
            });
        });
    }

    /// How a path that left a surface in the direction `first` goes on after it has met a ball from outside.
    pub(super) fn enter(&self, met: PrimitiveId, first: DVec3, inside: bool) -> Option<Passage> {
        let ball = self.balls.iter().position(|ball| PrimitiveId::solid(ball.smooth.solid) == met)?;
        Some(Passage { ball, chords: 0, inside, first })
    }

    /// How it goes on after it has met the ball from inside; `None` if that is no longer looked for.
    pub(super) fn go_on(&self, passage: &Passage, met: PrimitiveId, inside: bool) -> Option<Passage> {
        let same = PrimitiveId::solid(self.balls[passage.ball].smooth.solid) == met;
        let chords = passage.chords + 1;
        (passage.inside && same && chords <= MOST_CHORDS).then_some(Passage { chords, inside, ..*passage })
    }

    /// The weight of light that a path has met after its way through a ball, that began with the density `pdf` at `at`.
    pub(super) fn weight(
        &self,
        world: &World,
        passage: &Passage,
        (at, pdf): (&Receiver, f64),
        (light, hit, direction): (&SurfacePoint, &Hit, DVec3),
    ) -> f64 {
        let SpecularBall { smooth: specular, shares } = &self.balls[passage.ball];
        if passage.inside || shares[passage.chords as usize] == 0.0 {
            return 1.0;
        }
        let Some(ends) = Ends::new(&specular.ball, at.point.position, light.position) else { return 1.0 };
        let mut weight = 1.0;
        ends.chains(passage.chords, specular.ratio.unwrap_or(1.0), |chain| {
            if ends.is(chain, passage.first) {
                let center = center(&specular.ball);
                let light_pdf = world.lights.pdf_area(&center, hit, light);
                let way = (light.position - specular.ball.center).normalize();
                let density = light_pdf * light.normal.dot(way).abs() * self.probability(at, passage);
                let cosine = light.normal.dot(direction).abs();
                let met = pdf * fresnel(specular, chain, passage.chords) * chain.spread * cosine;
                weight = met / (met + density);
            }
        });
        weight
    }
}

/// The centre of a ball, which sees lights on all sides.
fn center(ball: &Ball) -> Receiver {
    Receiver { point: SurfacePoint::nowhere(ball.center), side: DVec3::ZERO }
}

/// The product of the Fresnel terms of a path.
fn fresnel(ball: &SmoothBall, chain: &Chain, chords: u32) -> f64 {
    let Some(ratio) = ball.ratio else { return 1.0 };
    let reflected = Interface::new(ratio, true).at(chain.cos).reflectance;
    match chords {
        0 => reflected,
        _ => (1.0 - reflected) * (1.0 - reflected) * (1..chords).fold(1.0, |product, _| product * reflected),
    }
}
