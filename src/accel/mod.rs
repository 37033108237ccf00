//! What does the ray hit?
//!
//! An accelerator is a [`Kernel`], which finds candidates, behind the front that all of them share: it refuses rays
//! that are not finite, tries the few large solids, brings the ray into the kernel's f32 spaces and compares what comes
//! back by the key of [`crate::geometry`].
//!
//! ```
//! use pathtracer::accel::bvh::Bvh;
//! use pathtracer::accel::{Accelerator, BuildOptions};
//! use pathtracer::geometry::{PrimitiveId, Ray};
//! use pathtracer::math::DVec3;
//! use pathtracer::{scene, world::World};
//! use std::path::Path;
//!
//! # fn main() -> pathtracer::error::Result<()> {
//! let text = "
//! Camera: { Position: [-6, 0, 0], LookingAt: [0, 0, 0], Fov: 0.25, FocusDistance: 6 }
//! Objects:
//!   - Object: { Type: Ball, Position: [0, 0, 0], Radius: 2, Material: { Type: Diffuse } }
//! ";
//! let world = World::compile(&scene::parse(text, Path::new("ball.yaml"))?.desc)?;
//! let bvh = Bvh::build(&world.geometry, &BuildOptions::default())?;
//! let ray = Ray::new(DVec3::new(-5.0, 0.0, 0.0), DVec3::X);
//!
//! let hit = bvh.intersect(&ray).expect("the ball is in the way");
//! assert_eq!((hit.t, hit.object), (3.0, 0));
//! assert!(bvh.occluded(&ray, f64::INFINITY, PrimitiveId::NONE));
//! assert!(!bvh.occluded(&ray, 2.5, PrimitiveId::NONE));
//! # Ok(())
//! # }
//! ```

pub mod brute_force;
pub mod bvh;
#[cfg(feature = "embree")]
pub mod embree;
mod fault;

#[doc(hidden)]
pub use fault::Fault;

use crate::error::Result;
use crate::geometry::{Geometry, Hit, LocalRay, Nearest, PrimitiveId, Ray, Shape, TriangleHit};
use bvh::Instructions;
use serde::{Deserialize, Serialize};

/// How hits of mesh triangles are found. Solids are exact at every precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// The shared leaf decides: watertight, the same bits from every accelerator. The default, as it costs whole renders
    /// next to nothing.
    #[default]
    Exact,
    /// The accelerator's own watertight kernel; accelerators differ on ties and edges only.
    Robust,
    /// The accelerator's fastest kernel; rays may slip through edges.
    Fast,
}

/// An upper limit on the instructions used; the machine's best when `None` is given instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Isa {
    /// SSE2, which every x86-64 machine has.
    Sse2,
    /// AVX2 with FMA.
    Avx2,
    /// AVX-512 (F, BW, DQ, VL).
    Avx512,
}

/// How much time goes into the native tree, and into the trees of Embree's own triangles. It does not change hits, but
/// which of Embree's hits of equal distance at [`Precision::Robust`] and [`Precision::Fast`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BvhQuality {
    /// Built soonest, for a look.
    Fast,
    /// Built soon, traced fast.
    #[default]
    Default,
    /// Large triangles in pieces: a little larger, built later; traced faster where walls and beams lie
    /// slanting, slower where they stand along the axes.
    Quality,
}

impl Precision {
    /// The default first.
    pub const ALL: [Precision; 3] = [Precision::Exact, Precision::Robust, Precision::Fast];

    /// The name on the command line and in pictures.
    pub const fn name(self) -> &'static str {
        match self {
            Precision::Exact => "exact",
            Precision::Robust => "robust",
            Precision::Fast => "fast",
        }
    }
}

impl Isa {
    /// The smallest first; each has the instructions of those before.
    pub const ALL: [Isa; 3] = [Isa::Sse2, Isa::Avx2, Isa::Avx512];

    /// The name on the command line and in pictures.
    pub const fn name(self) -> &'static str {
        match self {
            Isa::Sse2 => "sse2",
            Isa::Avx2 => "avx2",
            Isa::Avx512 => "avx512",
        }
    }
}

impl BvhQuality {
    /// The soonest built first.
    pub const ALL: [BvhQuality; 3] = [BvhQuality::Fast, BvhQuality::Default, BvhQuality::Quality];

    /// The name on the command line and in pictures.
    pub const fn name(self) -> &'static str {
        match self {
            BvhQuality::Fast => "fast",
            BvhQuality::Default => "default",
            BvhQuality::Quality => "quality",
        }
    }
}

/// What an accelerator is built with.
#[derive(Clone, Copy, Debug, Default)]
pub struct BuildOptions {
    /// How hits of triangles are found.
    pub precision: Precision,
    /// The most that may be used, or `None` for the machine's best.
    pub isa: Option<Isa>,
    /// How the tree is built.
    pub quality: BvhQuality,
    /// The most bytes that Embree may take, or `None` for what the machine has.
    pub memory: Option<u64>,
    /// What is to be broken, for the tests of the tests; nothing is by default.
    #[doc(hidden)]
    pub fault: Option<Fault>,
}

/// Whether this machine has the instructions asked for.
///
/// # Errors
/// [`crate::error::Error::Usage`] with the best that it has.
pub fn check_isa(isa: Option<Isa>) -> Result<()> {
    used_isa(isa).map(drop)
}

/// The instructions that are used if these are asked for.
///
/// # Errors
/// As for [`check_isa`].
pub fn used_isa(isa: Option<Isa>) -> Result<Isa> {
    bvh::Instructions::choose(isa).map(bvh::Instructions::isa)
}

/// Answers for rays; see [`crate::geometry`] for what a hit is.
pub trait Accelerator: Sync {
    /// The closest hit, or `None`. The direction of `ray` may have any length; t is in units of it.
    fn intersect(&self, ray: &Ray) -> Option<Hit>;

    /// Whether anything but `target` is in the way, at t in (0, t_max). `t_max` may be infinite.
    fn occluded(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool;
}

/// Finds candidates in the local spaces of a [`Geometry`].
pub trait Kernel: Sync {
    /// What it was built over.
    fn geometry(&self) -> &Geometry;

    /// The hit with the smallest key (t, index) with t in (0, `ray.t_max`], of all triangles of a space but those the ray
    /// excludes. At [`Precision::Exact`] the shared leaf ([`crate::geometry::closest_in_block`]) decides; otherwise the
    /// kernel's own test may choose the triangle, and t, u, v are computed by [`crate::geometry::plane_hit`].
    fn closest_triangle(&self, space: u32, ray: &LocalRay) -> Option<TriangleHit>;

    /// Whether any triangle of a space but the excluded ones is hit with t in (0, `ray.t_max`).
    fn any_triangle(&self, space: u32, ray: &LocalRay) -> bool;

    /// The closest hit among `geometry().linear_solids`.
    fn closest_linear_solid(&self, ray: &Ray) -> Option<Hit> {
        closest_one_by_one(self, &self.geometry().linear_solids, ray, None)
    }

    /// Whether any of `linear_solids` but `target` is hit at t in (0, t_max).
    fn any_linear_solid(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        any_one_by_one(self, &self.geometry().linear_solids, ray, t_max, target)
    }

    /// The closest hit among `geometry().tree_solids` that comes before `best` (or, without one, at any t), else `best`.
    /// `local` is the ray in `geometry().solid_frame`, for the nodes ([`Geometry::solid_node_bounds`]);
    /// [`closest_in_solid`] decides with `ray`. Called only if there are such solids.
    fn closest_solid(&self, ray: &Ray, local: &LocalRay, best: Option<Hit>) -> Option<Hit>;

    /// Whether any of `tree_solids` but `target` is hit at t in (0, t_max), by [`any_in_solid`].
    fn any_solid(&self, ray: &Ray, local: &LocalRay, t_max: f64, target: PrimitiveId) -> bool;

    /// [`Accelerator::intersect`] of a finite ray with a unit direction: [`front_closest`], which a kernel may compile in its
    /// own instructions, but not change.
    #[inline]
    fn closest(&self, ray: &Ray) -> Option<Hit> {
        front_closest(self, ray)
    }

    /// [`Accelerator::occluded`] of a finite ray with a unit direction and a `t_max` above 0: [`front_any`], likewise.
    #[inline]
    fn any(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        front_any(self, ray, t_max, target)
    }
}

/// The hit of a solid if it comes before `best`, else `best`. What is in an instance is asked of the kernel.
#[inline]
pub fn closest_in_solid<K: Kernel + ?Sized>(
    kernel: &K,
    solid: u32,
    ray: &Ray,
    best: Option<Hit>,
) -> Option<Hit> {
    let geometry = kernel.geometry();
    let Shape::Instance(instance) = &geometry.solids[solid as usize].shape else {
        return nearer(best, geometry.intersect_solid(solid, ray, distance(&best)));
    };
    let space = geometry.space_of(instance);
    let reach = space.frame.widen(distance(&best) / instance.scale) * instance.scale;
    let Some(local) = instance.localize(space, solid, ray, reach, PrimitiveId::NONE) else { return best };
    let hit = kernel.closest_triangle(instance.space, &local);
    nearer(best, hit.map(|hit| geometry.instance_hit(solid, instance, &local, &hit)))
}

/// Whether a solid other than `target` is hit with t in (0, t_max). What is in an instance is asked of the kernel.
#[inline]
pub fn any_in_solid<K: Kernel + ?Sized>(
    kernel: &K,
    solid: u32,
    ray: &Ray,
    t_max: f64,
    target: PrimitiveId,
) -> bool {
    let geometry = kernel.geometry();
    let Shape::Instance(instance) = &geometry.solids[solid as usize].shape else {
        return target != PrimitiveId::solid(solid)
            && geometry.intersect_solid(solid, ray, t_max).is_some_and(|hit| hit.t < t_max);
    };
    let local = instance.localize(geometry.space_of(instance), solid, ray, t_max, target);
    local.is_some_and(|local| kernel.any_triangle(instance.space, &local))
}

/// The closest hit of `solids` if it comes before `best`, else `best`.
fn closest_one_by_one<K: Kernel + ?Sized>(
    kernel: &K,
    solids: &[u32],
    ray: &Ray,
    best: Option<Hit>,
) -> Option<Hit> {
    solids.iter().fold(best, |best, &solid| closest_in_solid(kernel, solid, ray, best))
}

/// Whether any of `solids` other than `target` is hit with t in (0, t_max).
fn any_one_by_one<K: Kernel + ?Sized>(
    kernel: &K,
    solids: &[u32],
    ray: &Ray,
    t_max: f64,
    target: PrimitiveId,
) -> bool {
    solids.iter().any(|&solid| any_in_solid(kernel, solid, ray, t_max, target))
}

/// [`Kernel::closest_linear_solid`] four abreast, and one by one only where that leaves a doubt.
#[inline]
fn closest_abreast<K: Kernel>(kernel: &K, instructions: Instructions, ray: &Ray) -> Option<Hit> {
    let geometry = kernel.geometry();
    let best = match instructions.closest_abreast(&geometry.abreast, ray) {
        Nearest::None => None,
        Nearest::Clear { solid, t } => geometry.clear_hit(solid, ray, t),
        Nearest::Unclear => return closest_one_by_one(kernel, &geometry.linear_solids, ray, None),
    };
    let best = match ray.leaving.as_solid() {
        Some(solid) if ray.inward => closest_in_solid(kernel, solid, ray, best),
        _ => best,
    };
    closest_one_by_one(kernel, geometry.abreast.rest(), ray, best)
}

/// [`Kernel::any_linear_solid`] four abreast, and one by one only where that leaves a doubt.
#[inline]
fn any_abreast<K: Kernel>(
    kernel: &K,
    instructions: Instructions,
    ray: &Ray,
    t_max: f64,
    target: PrimitiveId,
) -> bool {
    let geometry = kernel.geometry();
    if ray.inward
        && let Some(solid) = ray.leaving.as_solid()
        && any_in_solid(kernel, solid, ray, t_max, target)
    {
        return true;
    }
    match instructions.any_abreast(&geometry.abreast, ray, t_max, target) {
        Some(true) => true,
        Some(false) => any_one_by_one(kernel, geometry.abreast.rest(), ray, t_max, target),
        None => any_one_by_one(kernel, &geometry.linear_solids, ray, t_max, target),
    }
}

impl<K: Kernel> Accelerator for K {
    #[inline]
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        if is_unit(ray) {
            return self.closest(ray);
        }
        let (unit, length) = with_unit_direction(ray)?;
        self.closest(&unit).map(|hit| Hit { t: (hit.t / length).max(f64::MIN_POSITIVE), ..hit })
    }

    fn occluded(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        if t_max.is_nan() || t_max <= 0.0 {
            return false;
        }
        if is_unit(ray) {
            return self.any(ray, t_max, target);
        }
        with_unit_direction(ray).is_some_and(|(unit, length)| self.any(&unit, t_max * length, target))
    }
}

/// The closest hit of a ray with a unit direction.
#[inline(always)]
pub fn front_closest<K: Kernel + ?Sized>(kernel: &K, ray: &Ray) -> Option<Hit> {
    let geometry = kernel.geometry();
    let mut best = if geometry.linear_solids.is_empty() { None } else { kernel.closest_linear_solid(ray) };
    if !geometry.tree_solids.is_empty() {
        let frame = &geometry.solid_frame;
        if let Some(local) = frame.localize(ray, frame.widen(distance(&best)), NO_TRIANGLES) {
            best = kernel.closest_solid(ray, &local, best);
        }
    }
    for (space, mesh) in geometry.world_spaces() {
        let reach = mesh.frame.widen(distance(&best));
        if let Some(local) = geometry.localize(space, ray, reach, PrimitiveId::NONE)
            && let Some(triangle) = kernel.closest_triangle(space, &local)
        {
            let hit = geometry.world_hit(space, &local, &triangle);
            if best.is_none_or(|best| hit.before(&best)) {
                best = Some(hit);
            }
        }
    }
    best
}

/// Whether anything but `target` is in the way of a ray with a unit direction.
#[inline(always)]
pub fn front_any<K: Kernel + ?Sized>(kernel: &K, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
    let geometry = kernel.geometry();
    if !geometry.linear_solids.is_empty() && kernel.any_linear_solid(ray, t_max, target) {
        return true;
    }
    if !geometry.tree_solids.is_empty()
        && let Some(local) = geometry.solid_frame.localize(ray, t_max, NO_TRIANGLES)
        && kernel.any_solid(ray, &local, t_max, target)
    {
        return true;
    }
    // A loop, since closures are not inlined into other instructions for certain.
    for (space, _) in geometry.world_spaces() {
        if let Some(local) = geometry.localize(space, ray, t_max, target)
            && kernel.any_triangle(space, &local)
        {
            return true;
        }
    }
    false
}

/// For rays among solids, where no triangle is left out.
const NO_TRIANGLES: [u32; 2] = [PrimitiveId::NO_TRIANGLE; 2];

/// Whether a ray is finite and its direction has length 1, to far more than its roundings.
fn is_unit(ray: &Ray) -> bool {
    ray.origin.is_finite() && (ray.direction.length_squared() - 1.0).abs() < 1e-9
}

/// A ray with a direction of any length as one with a unit direction, and that length; `None` if it is not finite or
/// has no direction.
fn with_unit_direction(ray: &Ray) -> Option<(Ray, f64)> {
    let largest = ray.direction.abs().max_element();
    if !ray.is_finite() || largest < f64::MIN_POSITIVE {
        return None;
    }
    // A unit direction times a power of two loses no bit on the way back.
    let exponent = libm::ilogb(largest);
    for length in [exponent, exponent + 1].map(|exponent| libm::ldexp(1.0, exponent)) {
        let scaled = Ray { direction: ray.direction / length, ..*ray };
        if length.is_finite() && is_unit(&scaled) {
            return Some((scaled, length));
        }
    }
    // Scaled first: squares of components leave the range of numbers long before the components do.
    let scaled = ray.direction / largest;
    let length = scaled.length();
    Some((Ray { direction: scaled / length, ..*ray }, largest * length))
}

/// The first of two hits.
pub(crate) fn nearer(a: Option<Hit>, b: Option<Hit>) -> Option<Hit> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.before(&a) { b } else { a }),
        (a, b) => a.or(b),
    }
}

/// The distance of a hit; infinite without one.
pub(crate) fn distance(hit: &Option<Hit>) -> f64 {
    hit.as_ref().map_or(f64::INFINITY, |hit| hit.t)
}
