//! A sky that is a picture: latitude and longitude, interpolated between pixels, sampled in proportion to its luminance.
//!
//! The distribution is a mixture of tents, one a pixel, with the pixel's luminance times the sine of its colatitude as
//! weight. A mixture of tents of two pixels' width is what bilinear interpolation makes of the weights; so the density
//! follows the interpolated radiance and the two stay in proportion beside a sun of one pixel too, where a density that is
//! constant over each pixel would leave the sun's slopes to chance.

use crate::math::{DVec3, Rgb, luminance};
use crate::scene::desc::EnvironmentMapDesc;
use std::f64::consts::PI;

/// A picture of the whole sphere.
#[derive(Clone, Debug)]
pub(super) struct EnvironmentMap {
    width: usize,
    height: usize,
    /// Linear R G B, row by row from the top.
    texels: Vec<[f32; 3]>,
    strength: f64,
    /// Turns of the picture about z.
    turns: f64,
    /// Cumulative probability of the rows.
    rows: Vec<f64>,
    /// Cumulative probability within every row.
    columns: Vec<f64>,
    /// Weight of every row, per column; the sum of all weights is `height` x `width`.
    scale: f64,
}

/// Two neighbouring columns or rows, and the second one's share.
type Pair = (usize, usize, f64);

/// The most bytes that an environment map takes at once beside its picture: its linear values, and either these once more
/// or the probabilities.
pub fn environment_map_bytes(desc: &EnvironmentMapDesc) -> u64 {
    let pixels = u64::from(desc.picture.picture.width) * u64::from(desc.picture.picture.height);
    pixels * 2 * size_of::<[f32; 3]>() as u64
}

impl EnvironmentMap {
    /// The picture of a scene; finite and not negative.
    pub(super) fn new(desc: &EnvironmentMapDesc, strength: f64) -> EnvironmentMap {
        let picture = &desc.picture.picture;
        let linear = picture.to_linear(desc.picture.is_encoded);
        let texels: Vec<[f32; 3]> = linear.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect();
        let (width, height) = (picture.width as usize, picture.height as usize);
        let turns = desc.rotation / 360.0;
        let mut map = EnvironmentMap {
            width,
            height,
            texels,
            strength,
            turns: turns - turns.floor(),
            rows: Vec::new(),
            columns: Vec::new(),
            scale: 0.0,
        };
        map.tabulate();
        map
    }

    /// The most that a component of its radiance is.
    pub(super) fn brightest(&self) -> f64 {
        self.strength * f64::from(self.texels.iter().flatten().fold(0.0, |most: f32, &x| most.max(x)))
    }

    /// The radiance, if it is the same everywhere.
    pub(super) fn constant(&self) -> Option<Rgb> {
        let first = self.texels[0];
        self.texels.iter().all(|texel| *texel == first).then(|| self.texel(0, 0) * self.strength)
    }

    fn tabulate(&mut self) {
        let mut columns = Vec::with_capacity(self.texels.len());
        let mut sums = Vec::with_capacity(self.height);
        for y in 0..self.height {
            let sine = self.sine(y);
            let start = columns.len();
            let mut sum = 0.0;
            for x in 0..self.width {
                sum += luminance(self.texel(x, y)) * sine;
                columns.push(sum);
            }
            columns[start..]
                .iter_mut()
                .for_each(|cumulative| *cumulative /= if sum > 0.0 { sum } else { 1.0 });
            sums.push(sum);
        }
        let total: f64 = sums.iter().sum();
        let mut sum = 0.0;
        self.rows = sums
            .iter()
            .map(|row| {
                sum += row;
                sum / total
            })
            .collect();
        self.columns = columns;
        self.scale = (self.width * self.height) as f64 / total;
    }

    /// Sine of the colatitude in the middle of a row.
    fn sine(&self, y: usize) -> f64 {
        libm::sin((y as f64 + 0.5) / self.height as f64 * PI)
    }

    fn texel(&self, x: usize, y: usize) -> Rgb {
        let [r, g, b] = self.texels[y * self.width + x];
        Rgb::new(r.into(), g.into(), b.into())
    }

    /// Radiance from the unit direction `d`.
    pub(super) fn radiance(&self, d: DVec3) -> Rgb {
        let ((left, right, across), (upper, lower, down)) = self.place(d);
        let row = |y| self.texel(left, y) * (1.0 - across) + self.texel(right, y) * across;
        (row(upper) * (1.0 - down) + row(lower) * down) * self.strength
    }

    /// The pixels around the direction `d`. Columns go round, the first and last row reach to the poles.
    fn place(&self, d: DVec3) -> (Pair, Pair) {
        let x = (0.5 - libm::atan2(d.y, d.x) / (2.0 * PI) + self.turns) * self.width as f64 - 0.5;
        let y = libm::atan2(d.x.hypot(d.y), d.z) / PI * self.height as f64 - 0.5;
        let y = y.clamp(0.0, (self.height - 1) as f64);
        let (left, upper) = (x.floor(), y.floor());
        let column = |x: f64| (x as i64).rem_euclid(self.width as i64) as usize;
        let lower = (upper as usize + 1).min(self.height - 1);
        ((column(left), column(left + 1.0), x - left), (upper as usize, lower, y - upper))
    }

    /// A unit direction with its density per solid angle, from `u` in [0, 1)^2.
    pub(super) fn sample(&self, u: [f64; 2]) -> (DVec3, f64) {
        let (y, v) = choose(&self.rows, u[0]);
        let (x, w) = choose(&self.columns[y * self.width..(y + 1) * self.width], u[1]);
        let reaches_pole = (y == 0 && v < 0.5) || (y == self.height - 1 && v >= 0.5);
        let down = if reaches_pole { v - 0.5 } else { tent(v) };
        let colatitude = (y as f64 + 0.5 + down) / self.height as f64 * PI;
        let turn = 0.5 - (x as f64 + 0.5 + tent(w)) / self.width as f64 + self.turns;
        let (sine, cosine) = libm::sincos(colatitude);
        let (y, x) = libm::sincos(turn * 2.0 * PI);
        let direction = DVec3::new(sine * x, sine * y, cosine);
        (direction, self.pdf(direction))
    }

    /// Density per solid angle with which [`EnvironmentMap::sample`] chooses `d`.
    pub(super) fn pdf(&self, d: DVec3) -> f64 {
        let ((left, right, across), (upper, lower, down)) = self.place(d);
        let weight = |x, y| luminance(self.texel(x, y));
        let row = |y| (weight(left, y) * (1.0 - across) + weight(right, y) * across) * self.sine(y);
        let sine = d.x.hypot(d.y).max(f64::MIN_POSITIVE);
        (row(upper) * (1.0 - down) + row(lower) * down) * self.scale / (2.0 * PI * PI * sine)
    }
}

/// The index in which a cumulative probability lies, and where in it, in [0, 1).
fn choose(cumulative: &[f64], u: f64) -> (usize, f64) {
    let index = cumulative.partition_point(|&c| c <= u).min(cumulative.len() - 1);
    let before = if index == 0 { 0.0 } else { cumulative[index - 1] };
    let share = cumulative[index] - before;
    let within = if share > 0.0 { (u - before) / share } else { 0.5 };
    (index, within.clamp(0.0, BELOW_ONE))
}

/// The largest number below 1.
const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

/// A number in (-1, 1) with the density 1 - |t|.
fn tent(u: f64) -> f64 {
    if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() }
}
