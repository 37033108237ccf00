//! FLIP: what a viewer notices who flips between two pictures.
//!
//! After Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström and Fairchild, "FLIP: A Difference Evaluator for
//! Alternating Images", HPG 2020: the pictures are blurred as the eye's contrast sensitivity does, their colours compared
//! in a perceptual space, and the result raised where edges or points differ. It is LDR-FLIP: the pictures are clipped to
//! 0..1 as a display does, so light beyond white does not count.

mod filter;

use crate::math::DVec3;
use filter::{Kernel, Plane};

/// Pixels in a degree of the view: a screen 0.7 m wide of 3840 pixels, seen from 0.7 m.
pub const PIXELS_PER_DEGREE: f64 = 0.7 * 3840.0 / 0.7 * std::f64::consts::PI / 180.0;

/// Exponents and levels of the paper's sections 4.1.3 and 4.3.
const COLOR_EXPONENT: f64 = 0.7;
const FEATURE_EXPONENT: f64 = 0.5;
/// Colours this share of the largest difference apart ...
const KNEE: f64 = 0.4;
/// ... are this much of the largest error.
const KNEE_ERROR: f64 = 0.95;

/// A picture with what FLIP needs of it: to be compared with several others at the cost of one.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// CIELAB of the blurred picture with Hunt's adjustment.
    colors: Vec<DVec3>,
    /// Lengths of the gradient and of the second derivative of the luminance.
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Prepared {
    /// Of linear R G B in rows of `width` pixels, which is not 0.
    pub fn new(pixels: &[f32], width: usize) -> Prepared {
        let opponent: Vec<DVec3> = pixels
            .chunks_exact(3)
            .map(|pixel| {
                let linear = DVec3::new(pixel[0].into(), pixel[1].into(), pixel[2].into());
                opponent_of_xyz(xyz_of_linear(linear.clamp(DVec3::ZERO, DVec3::ONE)))
            })
            .collect();
        let plane = |channel: usize| Plane::new(opponent.iter().map(|c| c[channel]).collect(), width);
        let planes = [0, 1, 2].map(plane);
        let colors = seen(&planes);
        let [edges, points] = features(&planes[0]);
        Prepared { colors, edges, points }
    }

    /// The difference of every pixel, 0 (none is seen) to 1. It does not matter which of the two is the reference.
    pub fn difference(&self, other: &Prepared) -> Vec<f32> {
        let largest = largest_difference();
        let pixels = 0..self.colors.len().min(other.colors.len());
        pixels
            .map(|i| {
                let color = color_error(hyab(self.colors[i], other.colors[i]), largest);
                let edge = (self.edges[i] - other.edges[i]).abs();
                let point = (self.points[i] - other.points[i]).abs();
                let feature =
                    libm::pow(edge.max(point) * std::f64::consts::FRAC_1_SQRT_2, FEATURE_EXPONENT).min(1.0);
                libm::pow(color, 1.0 - feature) as f32
            })
            .collect()
    }
}

/// The colours after the eye's blur.
fn seen(planes: &[Plane; 3]) -> Vec<DVec3> {
    // Each channel's contrast sensitivity as a sum of Gaussians, amplitude and width: the paper's table 1.
    const ACHROMATIC: &[(f64, f64)] = &[(1.0, 0.0047)];
    const RED_GREEN: &[(f64, f64)] = &[(1.0, 0.0053)];
    const BLUE_YELLOW: &[(f64, f64)] = &[(34.1, 0.04), (13.5, 0.025)];
    let channels = [ACHROMATIC, RED_GREEN, BLUE_YELLOW];
    let blurred = [0, 1, 2].map(|channel| blur(&planes[channel], channels[channel]));
    (0..blurred[0].len())
        .map(|i| {
            let color = DVec3::new(blurred[0][i], blurred[1][i], blurred[2][i]);
            let linear = linear_of_xyz(xyz_of_opponent(color)).clamp(DVec3::ZERO, DVec3::ONE);
            hunt(lab_of_xyz(xyz_of_linear(linear)))
        })
        .collect()
}

/// A channel through the sum of its Gaussians a sqrt(pi / b) exp(-pi^2 r^2 / b), r in degrees; the weights of the sum are 1.
fn blur(plane: &Plane, gaussians: &[(f64, f64)]) -> Vec<f64> {
    use std::f64::consts::PI;
    // Three deviations of the widest of all.
    const WIDEST: f64 = 0.04;
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE).ceil() as usize;
    let mut result = vec![0.0; plane.values.len()];
    let mut total = 0.0;
    for &(amplitude, b) in gaussians {
        let deviation = (b / (2.0 * PI * PI)).sqrt() * PIXELS_PER_DEGREE;
        let kernel = Kernel::gaussian(deviation, radius);
        let weight = amplitude * (PI / b).sqrt() * kernel.sum() * kernel.sum();
        let kernel = kernel.normalized();
        let part = plane.filtered(&kernel, &kernel);
        result.iter_mut().zip(&part.values).for_each(|(sum, value)| *sum += weight * value);
        total += weight;
    }
    result.iter_mut().for_each(|value| *value /= total);
    result
}

/// How strong edges and points are at every pixel (section 4.2).
fn features(luminance: &Plane) -> [Vec<f64>; 2] {
    /// Width of the detectors in degrees.
    const WIDTH: f64 = 0.082;
    let deviation = 0.5 * WIDTH * PIXELS_PER_DEGREE;
    let radius = (3.0 * deviation).ceil() as usize;
    let plane = Plane::new(luminance.values.iter().map(|y| (y + 16.0) / 116.0).collect(), luminance.width);
    let across = Kernel::gaussian(deviation, radius).normalized();
    let gaussian = |x: f64| libm::exp(-x * x / (2.0 * deviation * deviation));
    let edge = Kernel::new(radius, |x| -x * gaussian(x)).balanced();
    let point = Kernel::new(radius, |x| (x * x / (deviation * deviation) - 1.0) * gaussian(x)).balanced();
    [edge, point].map(|along| {
        let (x, y) = (plane.filtered(&along, &across), plane.filtered(&across, &along));
        x.values.iter().zip(&y.values).map(|(x, y)| libm::hypot(*x, *y)).collect()
    })
}

/// A difference of colours as an error in 0..1: most of the range for those that can be told apart at a glance.
fn color_error(difference: f64, largest: f64) -> f64 {
    let power = libm::pow(difference, COLOR_EXPONENT);
    let knee = KNEE * largest;
    if power < knee {
        KNEE_ERROR / knee * power
    } else {
        KNEE_ERROR + (power - knee) / (largest - knee) * (1.0 - KNEE_ERROR)
    }
}

/// That of green and blue, to the exponent.
fn largest_difference() -> f64 {
    let of = |linear| hunt(lab_of_xyz(xyz_of_linear(linear)));
    libm::pow(hyab(of(DVec3::Y), of(DVec3::Z)), COLOR_EXPONENT)
}

/// Lightness by its absolute, hue by its Euclidean distance (Abasi, Tehran, Fairchild 2020).
fn hyab(a: DVec3, b: DVec3) -> f64 {
    (a.x - b.x).abs() + libm::hypot(a.y - b.y, a.z - b.z)
}

/// Hunt's effect: colours look more colourful where it is bright.
fn hunt(lab: DVec3) -> DVec3 {
    DVec3::new(lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z)
}

/// The rows of the matrix from linear sRGB to XYZ, by its primaries and D65.
const TO_XYZ: [DVec3; 3] = [
    DVec3::new(10_135_552.0 / 24_577_794.0, 8_788_810.0 / 24_577_794.0, 4_435_075.0 / 24_577_794.0),
    DVec3::new(2_613_072.0 / 12_288_897.0, 8_788_810.0 / 12_288_897.0, 887_015.0 / 12_288_897.0),
    DVec3::new(1_425_312.0 / 73_733_382.0, 8_788_810.0 / 73_733_382.0, 70_074_185.0 / 73_733_382.0),
];

fn xyz_of_linear(linear: DVec3) -> DVec3 {
    DVec3::from_array(TO_XYZ.map(|row| row.dot(linear)))
}

fn linear_of_xyz(xyz: DVec3) -> DVec3 {
    let [a, b, c] = TO_XYZ;
    let columns = [b.cross(c), c.cross(a), a.cross(b)];
    (columns[0] * xyz.x + columns[1] * xyz.y + columns[2] * xyz.z) / a.dot(columns[0])
}

/// XYZ of white.
fn white() -> DVec3 {
    xyz_of_linear(DVec3::ONE)
}

/// YCxCz, a linear opponent space whose axes are those of CIELAB without its cube roots.
fn opponent_of_xyz(xyz: DVec3) -> DVec3 {
    let n = xyz / white();
    DVec3::new(116.0 * n.y - 16.0, 500.0 * (n.x - n.y), 200.0 * (n.y - n.z))
}

fn xyz_of_opponent(c: DVec3) -> DVec3 {
    let y = (c.x + 16.0) / 116.0;
    DVec3::new(y + c.y / 500.0, y, y - c.z / 200.0) * white()
}

/// CIELAB, from its definition in CIE 15.
fn lab_of_xyz(xyz: DVec3) -> DVec3 {
    const DELTA: f64 = 6.0 / 29.0;
    let root = |t: f64| {
        if t > DELTA * DELTA * DELTA { libm::cbrt(t) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    };
    let f = DVec3::from_array((xyz / white()).to_array().map(root));
    DVec3::new(116.0 * f.y - 16.0, 500.0 * (f.x - f.y), 200.0 * (f.y - f.z))
}
