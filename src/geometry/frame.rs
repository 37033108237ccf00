//! Local f32 space: where triangles and the nodes of accelerators live, and the way of a ray into it.

use super::Ray;
use crate::math::{Bounds, DVec3, Vec3, round_up};

/// A space that is the world's moved by `pivot` and scaled by a power of two, for the primitives within `bounds`.
#[derive(Clone, Copy, Debug)]
pub struct LocalFrame {
    /// The world's point that becomes the origin.
    pub pivot: DVec3,
    /// Local length of one world unit, a power of two.
    pub scale: f64,
    /// One over `scale`, exact.
    pub(super) inverse_scale: f64,
    /// Local box around what is in it.
    pub bounds: Bounds,
    center: DVec3,
    radius: f64,
    world_radius: f64,
}

/// A ray in local space, as every accelerator sees it: in f64 for the decision, rounded to f32 for what only finds
/// candidates.
#[derive(Clone, Copy, Debug)]
pub struct LocalRay {
    /// Start, rounded away from the surface that the ray leaves: within 2^-23 of the size of each component.
    pub origin: Vec3,
    /// Unit direction, rounded to nearest.
    pub direction: Vec3,
    origin64: DVec3,
    direction64: DVec3,
    /// Longest distance of interest in units of `direction`; finite.
    pub t_max: f64,
    /// World distance from the start of the path's ray to `origin`.
    pub shift: f64,
    /// Indices of triangles that can't be hit: the one it leaves, the one it goes to.
    excluded: [u32; 2],
}

impl LocalRay {
    /// The start in f64.
    #[inline(always)]
    pub fn origin64(&self) -> DVec3 {
        self.origin64
    }

    /// The unit direction in f64, the world's.
    #[inline(always)]
    pub fn direction64(&self) -> DVec3 {
        self.direction64
    }

    /// Whether the triangle with this index can't be hit by this ray.
    #[inline(always)]
    pub fn excludes(&self, triangle: u32) -> bool {
        self.excluded[0] == triangle || self.excluded[1] == triangle
    }

    /// `t_max` for an f32 kernel: rounded up.
    #[inline(always)]
    pub fn t_max32(&self) -> f32 {
        round_up(self.t_max)
    }
}

impl LocalFrame {
    /// The frame with the origin at `pivot` in which the largest side of `world` (a box in world space, not empty)
    /// lies in [1, 2).
    pub fn new(pivot: DVec3, world: Bounds) -> LocalFrame {
        let extent = (world.max - world.min).max_element();
        let exponent = if extent > 0.0 && extent.is_finite() { libm::ilogb(extent) } else { 0 };
        let scale = libm::ldexp(1.0, -exponent);
        let bounds = Bounds { min: (world.min - pivot) * scale, max: (world.max - pivot) * scale };
        let radius = ((bounds.max - bounds.min) * 0.5).length();
        let inverse_scale = libm::ldexp(1.0, exponent);
        let (center, world_radius) = (bounds.center(), radius * inverse_scale);
        LocalFrame { pivot, scale, inverse_scale, bounds, center, radius, world_radius }
    }

    /// The frame for what is within `bounds`, which may be empty, with the origin at `pivot`.
    pub(super) fn around(bounds: Bounds, pivot: DVec3) -> LocalFrame {
        if bounds.is_empty() {
            return LocalFrame::new(DVec3::ZERO, Bounds { min: DVec3::ZERO, max: DVec3::ONE });
        }
        LocalFrame::new(pivot, bounds)
    }

    /// From world to local, in f64.
    #[inline(always)]
    pub fn to_local(&self, p: DVec3) -> DVec3 {
        (p - self.pivot) * self.scale
    }

    /// From local to world, in f64.
    pub fn to_world(&self, p: DVec3) -> DVec3 {
        p * self.inverse_scale + self.pivot
    }

    /// The farthest from the local origin that a local ray starts, or a primitive lies.
    fn reach(&self) -> f64 {
        self.center.abs().max_element() + NEAR * self.radius
    }

    /// By how much a box must be widened for node tests that only hold to a few f32 roundings of the largest
    /// coordinate (Embree's user geometry): 2^-19 of it. Half of this was measured to be enough for boxes and origins
    /// of that size; the other half is for the rounding of the direction over the way through the frame.
    pub fn padding(&self) -> f64 {
        self.reach() / 524_288.0
    }

    /// A distance a little longer than `t_max`: a hit at exactly `t_max` stays in reach through the roundings between
    /// the two spaces.
    #[inline(always)]
    pub fn widen(&self, t_max: f64) -> f64 {
        (t_max + self.world_radius) * (1.0 + ROUNDING_SLACK) - self.world_radius
    }

    /// The ray in local space, for hits up to the world distance `t_max`; `None` if it misses everything in here.
    ///
    /// A ray that starts far away is first moved, in f64, to the sphere around the bounds, so that rounding it to f32
    /// costs no more than the size of what is in here. A ray that leaves a surface is rounded away from it, for kernels
    /// that decide in f32. `excluded` are the indices of the triangles that it can't hit.
    #[inline(always)]
    pub fn localize(&self, ray: &Ray, t_max: f64, excluded: [u32; 2]) -> Option<LocalRay> {
        let mut origin = self.to_local(ray.origin);
        let mut shift = 0.0;
        let offset = origin - self.center;
        let near = NEAR * self.radius;
        if offset.length_squared() > near * near {
            let advance = enter_sphere(offset, ray.direction, self.radius * 1.01)?;
            origin += ray.direction * advance;
            shift = advance * self.inverse_scale;
            // From so far away that the sphere drowns in the rounding, nothing can be told apart.
            let arrived = (origin - self.center).length_squared() <= near * near;
            if !arrived {
                return None;
            }
        }
        let local_t_max = (t_max - shift) * self.scale;
        if local_t_max <= 0.0 {
            return None;
        }
        let side = if shift == 0.0 { ray.side } else { DVec3::ZERO };
        Some(LocalRay {
            origin: round_away(origin, side),
            direction: ray.direction.as_vec3(),
            origin64: origin,
            direction64: ray.direction,
            t_max: local_t_max.min(f64::from(f32::MAX)),
            shift,
            excluded,
        })
    }
}

/// Rays that start within this many radii of the centre are taken as they are.
const NEAR: f64 = 4.0;

/// Local distances are exact to a few f32 roundings.
const ROUNDING_SLACK: f64 = 1.0 / 1_048_576.0;

/// Distance at which a ray from `offset` (relative to the centre, outside) enters the sphere.
#[cold]
fn enter_sphere(offset: DVec3, direction: DVec3, radius: f64) -> Option<f64> {
    let along = -offset.dot(direction);
    let perpendicular = (offset + direction * along).length();
    // Written so that an overflow is a miss.
    if !(along > 0.0 && perpendicular <= radius) {
        return None;
    }
    Some((along - ((radius - perpendicular) * (radius + perpendicular)).sqrt()).max(0.0))
}

/// Rounded to f32, each component to the side of `side`'s component (zero: to nearest): the result never lies behind
/// the plane through `p` with the normal `side`. Without branches: which way a number was rounded cannot be guessed.
#[inline(always)]
fn round_away(p: DVec3, side: DVec3) -> Vec3 {
    Vec3::new(round_towards(p.x, side.x), round_towards(p.y, side.y), round_towards(p.z, side.z))
}

/// [`round_away`] for one component.
#[inline(always)]
fn round_towards(p: f64, side: f64) -> f32 {
    let near = p as f32;
    let short = (f64::from(near) - p) * side < 0.0;
    step_towards(near, side.is_sign_negative(), u32::from(short))
}

/// The number `steps` (0 or 1) after `x` in the order of numbers, or before it if `down`.
#[inline(always)]
fn step_towards(x: f32, down: bool, steps: u32) -> f32 {
    let sign = u32::from(down) << 31;
    // Zero has two signs, of which only one leads to the next number.
    let bits = if x == 0.0 { sign } else { x.to_bits() };
    // Larger in size if the step goes on to the side on which the number is, else smaller.
    let inwards = 0u32.wrapping_sub((bits ^ sign) >> 31);
    f32::from_bits(bits.wrapping_add((steps ^ inwards).wrapping_sub(inwards)))
}
