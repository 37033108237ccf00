//! The sky: its radiance, and how to choose a direction towards it.

use super::environment_map::EnvironmentMap;
use crate::math::elementary::{inverse_fifth_root, sin_cos_turns};
use crate::math::{DVec3, Rgb, luminance};
use crate::scene::desc::{EnvironmentDesc, EnvironmentMapDesc};

/// What a sky asks of the renderer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum SkyKind {
    /// No light at all.
    Black,
    /// The same from everywhere; a diffuse surface samples it perfectly by itself.
    Constant,
    /// Varies with the height.
    Gradient,
    /// A picture.
    Map,
}

impl SkyKind {
    /// Whether it pays to choose directions towards it.
    pub fn is_sampled(self) -> bool {
        matches!(self, SkyKind::Gradient | SkyKind::Map)
    }
}

/// Radiance by the z component of the direction, with a tabulated distribution to sample it.
#[derive(Clone, Debug)]
pub struct Sky {
    kind: SkyKind,
    sky: Rgb,
    horizon: Rgb,
    ground: Rgb,
    /// Cumulative probability at the borders of equal steps of z from -1 to 1; empty unless a gradient.
    cumulative: Vec<f64>,
    /// The step in which each of [`STEPS`] equal parts of the cumulative probability begins.
    guide: Vec<u16>,
    /// There if a picture, which is not constant.
    map: Option<Box<EnvironmentMap>>,
}

/// Steps of z in the table.
const STEPS: usize = 256;

impl Sky {
    /// The sky of a scene; a picture takes the place of the colours.
    pub(super) fn new(desc: &EnvironmentDesc, map: Option<&EnvironmentMapDesc>) -> Sky {
        let Some(map) = map else { return Sky::of_colors(desc) };
        let map = EnvironmentMap::new(map, desc.strength);
        match map.constant() {
            Some(color) => {
                Sky::of_colors(&EnvironmentDesc { sky: color, horizon: color, ground: color, strength: 1.0 })
            }
            None => Sky { kind: SkyKind::Map, map: Some(Box::new(map)), ..Sky::black() },
        }
    }

    fn black() -> Sky {
        let [sky, horizon, ground] = [Rgb::ZERO; 3];
        let (cumulative, guide) = (Vec::new(), Vec::new());
        Sky { kind: SkyKind::Black, sky, horizon, ground, cumulative, guide, map: None }
    }

    fn of_colors(desc: &EnvironmentDesc) -> Sky {
        let [sky, horizon, ground] = [desc.sky, desc.horizon, desc.ground].map(|color| color * desc.strength);
        let kind = if [sky, horizon, ground] == [Rgb::ZERO; 3] {
            SkyKind::Black
        } else if sky == horizon && horizon == ground {
            SkyKind::Constant
        } else {
            SkyKind::Gradient
        };
        let mut result = Sky { kind, sky, horizon, ground, ..Sky::black() };
        if kind == SkyKind::Gradient {
            result.cumulative = result.tabulate();
            result.guide = (0..STEPS).map(|part| result.step_of(part as f64 / STEPS as f64) as u16).collect();
        }
        result
    }

    /// What it asks of the renderer.
    pub fn kind(&self) -> SkyKind {
        self.kind
    }

    /// The most that a component of its radiance is.
    pub(super) fn brightest(&self) -> f64 {
        match &self.map {
            Some(map) => map.brightest(),
            None => self.sky.max(self.horizon).max(self.ground).max_element(),
        }
    }

    /// Radiance from the unit direction `d`.
    #[inline]
    pub fn radiance(&self, d: DVec3) -> Rgb {
        match self.kind {
            SkyKind::Black => Rgb::ZERO,
            SkyKind::Constant => self.horizon,
            SkyKind::Gradient => self.gradient(d.z),
            SkyKind::Map => self.map.as_ref().map_or(Rgb::ZERO, |map| map.radiance(d)),
        }
    }

    fn gradient(&self, z: f64) -> Rgb {
        let height = z.abs().min(1.0);
        let (end, share) =
            if z >= 0.0 { (self.sky, power_4_5(height)) } else { (self.ground, power_1_10(height)) };
        self.horizon + (end - self.horizon) * share
    }

    /// A unit direction towards the sky with its density per solid angle, from `u` in [0, 1)^2. Only for kinds that
    /// are sampled.
    pub fn sample(&self, u: [f64; 2]) -> (DVec3, f64) {
        if let Some(map) = &self.map {
            return map.sample(u);
        }
        let mut step = usize::from(self.guide[(u[0] * STEPS as f64) as usize]);
        while step + 1 < STEPS && self.cumulative[step + 1] <= u[0] {
            step += 1;
        }
        let share = self.cumulative[step + 1] - self.cumulative[step];
        let z = height(step as f64 + ((u[0] - self.cumulative[step]) / share).clamp(0.0, 1.0));
        let across = ((1.0 - z) * (1.0 + z)).max(0.0).sqrt();
        let (sin, cos) = sin_cos_turns(u[1]);
        (DVec3::new(across * cos, across * sin, z), density(share))
    }

    /// The step that holds a cumulative probability.
    fn step_of(&self, probability: f64) -> usize {
        self.cumulative.partition_point(|&c| c <= probability).clamp(1, STEPS) - 1
    }

    /// Density per solid angle with which [`Sky::sample`] chooses `d`; zero unless it is sampled.
    pub fn pdf(&self, d: DVec3) -> f64 {
        if let Some(map) = &self.map {
            return map.pdf(d);
        }
        if self.kind != SkyKind::Gradient {
            return 0.0;
        }
        let step = (((d.z + 1.0) * 0.5 * STEPS as f64) as usize).min(STEPS - 1);
        density(self.cumulative[step + 1] - self.cumulative[step])
    }

    /// Each step's share is its luminance, integrated by four points, and a little more so that none is zero.
    fn tabulate(&self) -> Vec<f64> {
        let part = |step: usize| -> f64 {
            (0..4).map(|i| luminance(self.gradient(height(step as f64 + (f64::from(i) + 0.5) / 4.0)))).sum()
        };
        let weights: Vec<f64> = (0..STEPS).map(part).collect();
        let floor = weights.iter().sum::<f64>() / STEPS as f64 * 0.01;
        let total: f64 = weights.iter().map(|w| w + floor).sum();
        let mut cumulative = vec![0.0];
        let mut sum = 0.0;
        for weight in &weights {
            sum += weight + floor;
            cumulative.push(sum / total);
        }
        cumulative
    }
}

/// x^0.8 for x in [0, 1].
fn power_4_5(x: f64) -> f64 {
    if x < f64::MIN_POSITIVE { 0.0 } else { x * inverse_fifth_root(x) }
}

/// x^0.1 for x in [0, 1].
fn power_1_10(x: f64) -> f64 {
    if x < f64::MIN_POSITIVE {
        return 0.0;
    }
    let root = x.sqrt();
    let y = inverse_fifth_root(root);
    root * (y * y) * (y * y)
}

/// z at a border of a step.
fn height(step: f64) -> f64 {
    2.0 * step / STEPS as f64 - 1.0
}

/// Density per solid angle in a step with this share.
fn density(share: f64) -> f64 {
    share * STEPS as f64 / (4.0 * std::f64::consts::PI)
}
