//! What does the ray hit?
//!
//! An accelerator is a [`Kernel`], which finds candidates, behind the front that all of them share: it refuses rays
//! that are not finite, tries the few large solids, brings the ray into the kernel's f32 spaces and compares what comes
//! back by the key of [`crate::geometry`].

pub mod brute_force;
pub mod bvh;
#[cfg(feature = "embree")]
pub mod embree;

use crate::geometry::{Geometry, Hit, LocalFrame, LocalRay, PrimitiveId, Ray, TriangleHit};

/// How hits of mesh triangles are found. Solids are exact at every precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BvhQuality {
    /// Built soonest, for a look.
    Fast,
    /// Built soon, traced fast.
    #[default]
    Default,
    /// Large triangles in pieces: a little larger, built later; traced faster where walls and beams are.
    Quality,
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
}

/// Answers for rays; see [`crate::geometry`] for what a hit is.
pub trait Accelerator: Sync {
    /// The closest hit, or `None`. The direction of `ray` may have any length; t is in units of it.
    fn intersect(&self, ray: &Ray) -> Option<Hit>;

    /// Whether anything but `target` is in the way, at t in (0, t_max). `t_max` may be infinite.
    fn occluded(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool;
}

/// Finds candidates in the two local spaces of a [`Geometry`].
pub trait Kernel: Sync {
    /// What it was built over.
    fn geometry(&self) -> &Geometry;

    /// The hit with the smallest key (t, index) with t in (0, `ray.t_max`], of all triangles but those the ray
    /// excludes. Called only if there are triangles. At [`Precision::Exact`] the shared leaf
    /// ([`crate::geometry::closest_in_block`]) decides; otherwise the kernel's own test may choose the triangle, and
    /// t, u, v are computed by [`crate::geometry::plane_hit`].
    fn closest_triangle(&self, ray: &LocalRay) -> Option<TriangleHit>;

    /// Whether any triangle but the excluded ones is hit with t in (0, `ray.t_max`).
    fn any_triangle(&self, ray: &LocalRay) -> bool;

    /// The closest hit among `geometry().tree_solids` that comes before `best` (or, without one, at any t), else `best`.
    /// `local` is the ray in `geometry().solid_frame`, for the nodes ([`Geometry::solid_node_bounds`]);
    /// [`Geometry::intersect_solid`] decides with `ray`. Called only if there are such solids.
    fn closest_solid(&self, ray: &Ray, local: &LocalRay, best: Option<Hit>) -> Option<Hit>;

    /// Whether any of `tree_solids` but `target` is hit at t in (0, t_max), by [`Geometry::solid_occludes`].
    fn any_solid(&self, ray: &Ray, local: &LocalRay, t_max: f64, target: PrimitiveId) -> bool;
}

impl<K: Kernel> Accelerator for K {
    #[inline]
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        if is_unit(ray) {
            return closest(self, ray);
        }
        let (unit, length) = with_unit_direction(ray)?;
        closest(self, &unit).map(|hit| Hit { t: (hit.t / length).max(f64::MIN_POSITIVE), ..hit })
    }

    fn occluded(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        if t_max.is_nan() || t_max <= 0.0 {
            return false;
        }
        if is_unit(ray) {
            return any(self, ray, t_max, target);
        }
        with_unit_direction(ray).is_some_and(|(unit, length)| any(self, &unit, t_max * length, target))
    }
}

/// The closest hit of a ray with a unit direction.
fn closest<K: Kernel>(kernel: &K, ray: &Ray) -> Option<Hit> {
    let geometry = kernel.geometry();
    let mut best: Option<Hit> = None;
    for &solid in &geometry.linear_solids {
        best = nearer(best, geometry.intersect_solid(solid, ray, distance(&best)));
    }
    if !geometry.tree_solids.is_empty()
        && let Some(local) = local_ray(&geometry.solid_frame, ray, &best)
    {
        best = kernel.closest_solid(ray, &local, best);
    }
    if !geometry.triangles.is_empty()
        && let Some(local) = local_ray(&geometry.mesh_frame, ray, &best)
        && let Some(triangle) = kernel.closest_triangle(&local)
    {
        let hit = geometry.world_hit(&local, &triangle);
        if best.is_none_or(|best| hit.before(&best)) {
            return Some(hit);
        }
    }
    best
}

/// Whether anything but `target` is in the way of a ray with a unit direction.
fn any<K: Kernel>(kernel: &K, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
    let geometry = kernel.geometry();
    let linear = geometry.linear_solids.iter();
    if linear.into_iter().any(|&solid| geometry.solid_occludes(solid, ray, t_max, target)) {
        return true;
    }
    if !geometry.tree_solids.is_empty()
        && let Some(local) = geometry.solid_frame.localize(ray, t_max, target)
        && kernel.any_solid(ray, &local, t_max, target)
    {
        return true;
    }
    !geometry.triangles.is_empty()
        && geometry.mesh_frame.localize(ray, t_max, target).is_some_and(|local| kernel.any_triangle(&local))
}

/// Whether a ray is finite and its direction has length 1, to far more than its roundings.
fn is_unit(ray: &Ray) -> bool {
    ray.origin.is_finite() && (ray.direction.length_squared() - 1.0).abs() < 1e-9
}

/// A ray with a direction of any length as one with a unit direction, and that length; `None` if it is not finite or
/// has no direction.
fn with_unit_direction(ray: &Ray) -> Option<(Ray, f64)> {
    // Scaled first: squares of components leave the range of numbers long before the components do.
    let largest = ray.direction.abs().max_element();
    if !ray.is_finite() || largest < f64::MIN_POSITIVE {
        return None;
    }
    let scaled = ray.direction / largest;
    let length = scaled.length();
    Some((Ray { direction: scaled / length, ..*ray }, largest * length))
}

/// The ray in a local space, for hits that may come before `best`.
#[inline(always)]
fn local_ray(frame: &LocalFrame, ray: &Ray, best: &Option<Hit>) -> Option<LocalRay> {
    frame.localize(ray, frame.widen(distance(best)), PrimitiveId::NONE)
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
