//! Cells on the sphere about the mirror direction, of about equal probability, in which samples of a lobe are
//! counted and its density is integrated.
//!
//! A lobe of specularity s >= 1/2 ends at the angle asin((1 - s) / s) with an integrable pole. Inside, the
//! coordinate x is linear in psi with sin(angle) = (1 - s) / s sin(psi), which cancels the pole.

use crate::support::stats::chi_square;
use pathtracer::math::{DVec3, Frame};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const RINGS: usize = 80;
const SECTORS: usize = 160;

/// Parts of a cell along x for the quadrature: densities have kinks where the horizon or the second root sets in,
/// and at normal incidence a kink runs along a whole ring.
const PANELS: usize = 4;

/// Abscissas and weights of Gauss and Legendre's quadrature with 3 points on [0, 1].
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// What a comparison of samples with a density found.
#[derive(Debug)]
pub(super) struct Verdict {
    /// Of the chi-square test.
    pub(super) p_value: f64,
    /// Of the density over the sphere.
    pub(super) integral: f64,
    /// Samples at which the density is zero.
    pub(super) outside: u64,
}

/// Polar coordinates about the mirror direction, x in [0, 2] for the angle.
struct LobeCoordinates {
    frame: Frame,
    /// The sine of the angle at which the lobe ends, where it does.
    rim: Option<f64>,
}

impl LobeCoordinates {
    fn new(mirror: DVec3, specularity: f64) -> Self {
        let rim = (specularity >= 0.5).then(|| (1.0 - specularity) / specularity);
        LobeCoordinates { frame: Frame::around(mirror), rim }
    }

    /// Sine and cosine of the angle at x, and the derivative of the angle.
    fn angle(&self, x: f64) -> (f64, f64, f64) {
        match self.rim {
            Some(rim) if x < 1.0 => {
                let sin = rim * libm::sin(FRAC_PI_2 * x);
                let cos = (1.0 - sin * sin).sqrt();
                (sin, cos, rim * FRAC_PI_2 * libm::cos(FRAC_PI_2 * x) / cos)
            }
            Some(rim) => {
                let (first, rest) = (libm::asin(rim), PI - libm::asin(rim));
                let angle = first + (x - 1.0) * rest;
                (libm::sin(angle), libm::cos(angle), rest)
            }
            None => (libm::sin(FRAC_PI_2 * x), libm::cos(FRAC_PI_2 * x), FRAC_PI_2),
        }
    }

    /// x and the azimuth in [0, 1] of a direction.
    fn of(&self, w: DVec3) -> (f64, f64) {
        let local = self.frame.to_local(w);
        let (sin, cos) = (local.x.hypot(local.y), local.z);
        let azimuth = libm::atan2(local.y, local.x) / TAU + 0.5;
        let x = match self.rim {
            // On the rim the sine is good to a few roundings of unit vectors.
            Some(rim) if cos > 0.0 && sin <= rim + 8.0 * f64::EPSILON => {
                libm::asin((sin / rim).min(1.0)) / FRAC_PI_2
            }
            Some(rim) => {
                let first = libm::asin(rim);
                1.0 + ((libm::atan2(sin, cos) - first) / (PI - first)).max(0.0)
            }
            None => libm::atan2(sin, cos) / FRAC_PI_2,
        };
        (x.min(2.0), azimuth)
    }

    /// The direction at an angle of the given sine and cosine and an azimuth in [0, 1].
    fn direction(&self, sin: f64, cos: f64, azimuth: f64) -> DVec3 {
        let phi = TAU * (azimuth - 0.5);
        self.frame.to_world(DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos))
    }

    /// The integral of a density over a cell.
    fn integrate(&self, pdf: &impl Fn(DVec3) -> f64, x: [f64; 2], azimuth: [f64; 2]) -> f64 {
        let mut sum = 0.0;
        for (panel, (a, weight_a)) in (0..PANELS).flat_map(|panel| GAUSS.map(|point| (panel, point))) {
            let (sin, cos, derivative) =
                self.angle(x[0] + (panel as f64 + a) / PANELS as f64 * (x[1] - x[0]));
            for (b, weight_b) in GAUSS {
                let w = self.direction(sin, cos, azimuth[0] + b * (azimuth[1] - azimuth[0]));
                sum += weight_a * weight_b * sin * derivative * pdf(w);
            }
        }
        sum / PANELS as f64 * (x[1] - x[0]) * TAU * (azimuth[1] - azimuth[0])
    }

    /// The integral of a density over a cell, made positive if its support reaches into the cell between the points
    /// of the quadrature.
    fn mass(&self, pdf: &impl Fn(DVec3) -> f64, x: [f64; 2], azimuth: [f64; 2]) -> f64 {
        let mass = self.integrate(pdf, x, azimuth);
        let at = |a: f64, b: f64| {
            let (sin, cos, _) = self.angle(x[0] + a * (x[1] - x[0]));
            pdf(self.direction(sin, cos, azimuth[0] + b * (azimuth[1] - azimuth[0])))
        };
        let border =
            [(0.0, 0.0), (0.0, 0.5), (0.0, 1.0), (0.5, 1.0), (1.0, 1.0), (1.0, 0.5), (1.0, 0.0), (0.5, 0.0)];
        match mass == 0.0 && border.into_iter().any(|(a, b)| at(a, b) > 0.0) {
            true => f64::MIN_POSITIVE,
            false => mass,
        }
    }

    /// Borders of rings, of about equal probability inside the lobe's rim and of about equal probability outside.
    fn rings(&self, pdf: &impl Fn(DVec3) -> f64) -> Vec<f64> {
        const FINE: usize = 400;
        let fine = |i: usize| i as f64 / FINE as f64;
        let mass: Vec<f64> = (0..2 * FINE)
            .map(|i| {
                let sector = |j| [f64::from(j) / 16.0, f64::from(j + 1) / 16.0];
                (0..16).map(|j| self.integrate(pdf, [fine(i), fine(i + 1)], sector(j))).sum()
            })
            .collect();
        let (inside, outside) = mass.split_at(FINE);
        let share = inside.iter().sum::<f64>() / mass.iter().sum::<f64>();
        let count = ((share * RINGS as f64) as usize).clamp(RINGS / 2, RINGS - 8);
        let mut borders = equal_parts(inside, 0.0, count);
        borders.extend(equal_parts(outside, 1.0, RINGS - count));
        borders.push(2.0);
        borders
    }
}

/// Lower borders of `count` parts of [start, start + 1] with equal shares of a mass given for equal steps, mixed
/// with a uniform one so that no part is too wide for the quadrature.
fn equal_parts(mass: &[f64], start: f64, count: usize) -> Vec<f64> {
    let uniform = (0.5 * mass.iter().sum::<f64>()).max(1e-9) / mass.len() as f64;
    let total: f64 = mass.iter().map(|step| step + uniform).sum();
    let (mut borders, mut below) = (vec![start], 0.0);
    for (i, step) in mass.iter().map(|step| step + uniform).enumerate() {
        while borders.len() < count && total * borders.len() as f64 / count as f64 <= below + step {
            let inside = (total * borders.len() as f64 / count as f64 - below) / step;
            borders.push(start + (i as f64 + inside) / mass.len() as f64);
        }
        below += step;
    }
    borders
}

/// Compares directions sampled about `mirror` with the density that they claim.
pub(super) fn compare(
    samples: impl Iterator<Item = DVec3>,
    pdf: impl Fn(DVec3) -> f64,
    mirror: DVec3,
    specularity: f64,
) -> Verdict {
    let coordinates = LobeCoordinates::new(mirror, specularity);
    let rings = coordinates.rings(&pdf);
    let sector = |j: usize| [j as f64 / SECTORS as f64, (j + 1) as f64 / SECTORS as f64];
    let masses: Vec<f64> = (0..RINGS * SECTORS)
        .map(|i| {
            let (ring, j) = (i / SECTORS, i % SECTORS);
            coordinates.mass(&pdf, [rings[ring], rings[ring + 1]], sector(j))
        })
        .collect();
    let integral: f64 = masses.iter().sum();

    let mut counts = vec![0; RINGS * SECTORS];
    let (mut total, mut outside) = (0, 0);
    for w in samples {
        let (x, azimuth) = coordinates.of(w);
        let ring = rings.partition_point(|&border| border <= x).clamp(1, RINGS) - 1;
        counts[ring * SECTORS + ((azimuth * SECTORS as f64) as usize).min(SECTORS - 1)] += 1;
        total += 1;
        outside += u64::from(pdf(w) <= 0.0);
    }
    let expected: Vec<f64> = masses.iter().map(|mass| mass / integral * total as f64).collect();
    Verdict { p_value: chi_square(&counts, &expected), integral, outside }
}
