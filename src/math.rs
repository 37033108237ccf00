//! The words that everything uses: vectors, colours, rays' frames, rounding.
//!
//! Shading and shapes compute in f64; only the triangle meshes and the nodes of the accelerators are f32.
//! Transcendental functions come from `libm`, so that equal inputs give equal bits on every machine.

pub mod elementary;

pub use glam::{DMat3, DVec3, Vec3};

/// A linear RGB radiance, reflectance or weight, in the components x, y, z.
pub type Rgb = DVec3;

/// One over pi.
pub const INV_PI: f64 = std::f64::consts::FRAC_1_PI;

/// The largest relative error of one f64 operation, 2^-53.
pub const EPSILON: f64 = f64::EPSILON / 2.0;

/// Luminance of a linear RGB colour (Rec. 709 primaries).
pub fn luminance(c: Rgb) -> f64 {
    0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z
}

/// An orthonormal right-handed basis around a unit vector.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// First tangent.
    pub x: DVec3,
    /// Second tangent.
    pub y: DVec3,
    /// The given unit vector.
    pub z: DVec3,
}

impl Frame {
    /// The basis around the unit vector `z` (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1) 2017).
    #[inline]
    pub fn around(z: DVec3) -> Frame {
        let sign = 1f64.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        let x = DVec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x);
        let y = DVec3::new(b, sign + z.y * z.y * a, -z.y);
        Frame { x, y, z }
    }

    /// From coordinates in this basis to the world.
    #[inline]
    pub fn to_world(&self, v: DVec3) -> DVec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// From the world to coordinates in this basis.
    pub fn to_local(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }
}

/// An axis-aligned box in f64; empty if `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lower corner.
    pub min: DVec3,
    /// Upper corner.
    pub max: DVec3,
}

impl Bounds {
    /// Holds nothing.
    pub const EMPTY: Bounds = Bounds { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around both.
    pub fn union(self, other: Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The smallest box around this one and `p`.
    pub fn with_point(self, p: DVec3) -> Bounds {
        Bounds { min: self.min.min(p), max: self.max.max(p) }
    }

    /// The point in the middle.
    pub fn center(self) -> DVec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// The length of its longest side; negative if nothing is in it.
    pub fn extent(self) -> f64 {
        (self.max - self.min).max_element()
    }

    /// The axis of its longest side, the first of several.
    pub fn longest_axis(self) -> usize {
        let extent = self.max - self.min;
        (0..3).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best })
    }

    /// The box that is wider by `margin` on all sides.
    pub fn padded(self, margin: f64) -> Bounds {
        Bounds { min: self.min - margin, max: self.max + margin }
    }

    /// Whether both have a point in common.
    pub fn touches(self, other: Bounds) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Whether nothing is in it.
    pub fn is_empty(self) -> bool {
        !(self.min.cmple(self.max).all())
    }
}

/// `x` rounded to f32 towards plus infinity.
#[inline]
pub fn round_up(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) < x { near.next_up() } else { near }
}

/// `x` rounded to f32 towards minus infinity.
#[inline]
pub fn round_down(x: f64) -> f32 {
    let near = x as f32;
    if f64::from(near) > x { near.next_down() } else { near }
}

/// The sine and cosine of an angle in degrees; exact at multiples of 90.
pub fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turn = degrees % 360.0;
    let quarters = libm::rint(turn / 90.0);
    let rest = (turn - quarters * 90.0).to_radians();
    let (s, c) = (libm::sin(rest), libm::cos(rest));
    match (quarters as i32).rem_euclid(4) {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}
