//! Embree 3.13 and 4.x behind one surface. Nothing here is safe, and nothing decides anything: the C interface, less
//! the differences between the two versions.
//!
//! The bindings are made at build time from the headers found (`build.rs`), because the layouts differ: a `RTCRayHit`
//! has 80 bytes in 3.13.5 and 96 in 4.4. The names are Embree's, and its manual pages (`man 3 rtcNewScene`)
//! describe them. What is hidden:
//!
//! * `rtcIntersect1` and `rtcOccluded1` take a context in version 3 and arguments in version 4: [`intersect1`],
//!   [`occluded1`], and [`Query`], which also carries the caller's data to the callbacks.
//! * The mask of a new geometry is all ones in version 3 and 1 in version 4: [`new_geometry`] sets all ones.
//!
//! # Callbacks
//! Under `intersect1` and `occluded1` the callbacks of user geometry and the filters see exactly one ray: `N` is 1.
//! The accessors at the end of this page read it. The rules of both versions:
//!
//! * `valid[0]` is -1 for a ray to look at and 0 otherwise. A filter sets it to 0 to refuse the candidate. A
//!   user-geometry callback leaves it alone.
//! * A user-geometry callback may run although the ray misses the primitive's bounds (a scene of one primitive).
//! * A filter sees the candidate's distance as the ray's `tfar`. If it refuses, Embree puts the old one back.
//! * An intersect callback reports a hit by lowering the ray's `tfar`; an occluded callback by setting it to minus
//!   infinity.
//! * A callback must not unwind.

mod raw {
    #![allow(missing_docs, non_camel_case_types, non_snake_case, non_upper_case_globals)]
    #![allow(unreachable_pub, dead_code, clippy::all, clippy::undocumented_unsafe_blocks)]
    include!(concat!(env!("OUT_DIR"), "/bindings.rs"));
}

pub use raw::{
    RTC_BUFFER_TYPE_INDEX, RTC_BUFFER_TYPE_VERTEX, RTC_BUILD_QUALITY_HIGH, RTC_BUILD_QUALITY_LOW,
    RTC_BUILD_QUALITY_MEDIUM, RTC_DEVICE_PROPERTY_VERSION_MAJOR, RTC_DEVICE_PROPERTY_VERSION_MINOR,
    RTC_DEVICE_PROPERTY_VERSION_PATCH, RTC_ERROR_CANCELLED, RTC_ERROR_INVALID_ARGUMENT,
    RTC_ERROR_INVALID_OPERATION, RTC_ERROR_NONE, RTC_ERROR_OUT_OF_MEMORY, RTC_ERROR_UNKNOWN,
    RTC_ERROR_UNSUPPORTED_CPU, RTC_FORMAT_FLOAT3, RTC_FORMAT_UINT3, RTC_GEOMETRY_TYPE_TRIANGLE,
    RTC_GEOMETRY_TYPE_USER, RTC_SCENE_FLAG_COMPACT, RTC_SCENE_FLAG_NONE, RTC_SCENE_FLAG_ROBUST,
    RTC_VERSION_MAJOR, RTC_VERSION_MINOR, RTC_VERSION_PATCH, RTCBounds, RTCBoundsFunction,
    RTCBoundsFunctionArguments, RTCDevice, RTCError, RTCErrorFunction, RTCFilterFunctionN,
    RTCFilterFunctionNArguments, RTCGeometry, RTCGeometryType, RTCHit, RTCHitN, RTCIntersectFunctionN,
    RTCIntersectFunctionNArguments, RTCOccludedFunctionN, RTCOccludedFunctionNArguments, RTCRay, RTCRayHit,
    RTCRayHitN, RTCRayN, RTCScene, rtcAttachGeometry, rtcAttachGeometryByID, rtcCommitGeometry,
    rtcCommitScene, rtcGetDeviceError, rtcGetDeviceProperty, rtcGetSceneBounds, rtcNewDevice, rtcNewScene,
    rtcReleaseDevice, rtcReleaseGeometry, rtcReleaseScene, rtcSetDeviceErrorFunction,
    rtcSetDeviceMemoryMonitorFunction, rtcSetGeometryBoundsFunction, rtcSetGeometryBuildQuality,
    rtcSetGeometryIntersectFilterFunction, rtcSetGeometryIntersectFunction,
    rtcSetGeometryOccludedFilterFunction, rtcSetGeometryOccludedFunction, rtcSetGeometryUserData,
    rtcSetGeometryUserPrimitiveCount, rtcSetSceneBuildQuality, rtcSetSceneFlags, rtcSetSharedGeometryBuffer,
};

/// The id of no geometry and no primitive.
pub const INVALID_ID: u32 = u32::MAX;

/// What Embree hands to the callbacks of a query: `RTCIntersectContext` in version 3.
#[cfg(embree3)]
pub type QueryContext = raw::RTCIntersectContext;

/// What Embree hands to the callbacks of a query: `RTCRayQueryContext` in version 4.
#[cfg(embree4)]
pub type QueryContext = raw::RTCRayQueryContext;

/// One ray query: Embree's context, and behind it the caller's data, which the callbacks reach by [`Query::data`].
#[repr(C)]
pub struct Query<T> {
    context: QueryContext,
    /// The caller's own.
    pub data: T,
}

impl<T> Query<T> {
    /// A query outside any instance, for incoherent rays.
    pub fn new(data: T) -> Query<T> {
        let outside = [INVALID_ID; raw::RTC_MAX_INSTANCE_LEVEL_COUNT as usize];
        Query { context: QueryContext { instID: outside, ..Default::default() }, data }
    }

    /// The data of the query whose callback is running.
    ///
    /// # Safety
    /// `context` is the one in the arguments of a callback, and the query is a `Query<T>` with this same `T`. The
    /// pointer is valid while the callback runs; nothing else uses the data then.
    pub unsafe fn data(context: *mut QueryContext) -> *mut T {
        let query = context.cast::<Query<T>>();
        // SAFETY: `context` is the first field of a live Query<T>, and both are repr(C).
        unsafe { &raw mut (*query).data }
    }
}

/// Finds the closest hit of `rayhit.ray` and puts it into `rayhit.hit`; without one, `hit.geomID` stays [`INVALID_ID`].
///
/// # Safety
/// `scene` is a committed scene that no other thread changes, and its buffers, user data and callbacks are alive. The
/// ray holds no NaN and no infinity but `tfar`, the hit is [`no_hit`], and `T` is what the callbacks of the scene
/// expect.
pub unsafe fn intersect1<T>(scene: RTCScene, query: &mut Query<T>, rayhit: &mut RTCRayHit) {
    let context = (&raw mut *query).cast::<QueryContext>();
    #[cfg(embree3)]
    // SAFETY: the caller vouches for the scene and the ray; `context` may be read and written for the whole Query<T>.
    unsafe {
        raw::rtcIntersect1(scene, context, rayhit)
    };
    #[cfg(embree4)]
    {
        let mut arguments = raw::RTCIntersectArguments {
            context,
            feature_mask: raw::RTC_FEATURE_FLAG_ALL,
            ..Default::default()
        };
        // SAFETY: as above; Embree does not keep the arguments.
        unsafe { raw::rtcIntersect1(scene, rayhit, &mut arguments) };
    }
}

/// Asks whether anything stops `ray`; if so, `ray.tfar` becomes minus infinity.
///
/// # Safety
/// As [`intersect1`].
pub unsafe fn occluded1<T>(scene: RTCScene, query: &mut Query<T>, ray: &mut RTCRay) {
    let context = (&raw mut *query).cast::<QueryContext>();
    #[cfg(embree3)]
    // SAFETY: the caller vouches for the scene and the ray; `context` may be read and written for the whole Query<T>.
    unsafe {
        raw::rtcOccluded1(scene, context, ray)
    };
    #[cfg(embree4)]
    {
        let mut arguments = raw::RTCOccludedArguments {
            context,
            feature_mask: raw::RTC_FEATURE_FLAG_ALL,
            ..Default::default()
        };
        // SAFETY: as above; Embree does not keep the arguments.
        unsafe { raw::rtcOccluded1(scene, ray, &mut arguments) };
    }
}

/// A new geometry that every ray sees, whatever its mask but 0. Null on failure; the device's error says why.
///
/// # Safety
/// `device` is a live device.
pub unsafe fn new_geometry(device: RTCDevice, kind: RTCGeometryType) -> RTCGeometry {
    // SAFETY: the device is live, and the mask is set only on a geometry that was made.
    unsafe {
        let geometry = raw::rtcNewGeometry(device, kind);
        if !geometry.is_null() {
            raw::rtcSetGeometryMask(geometry, u32::MAX);
        }
        geometry
    }
}

/// The hit of a ray before [`intersect1`].
pub fn no_hit() -> RTCHit {
    let outside = [INVALID_ID; raw::RTC_MAX_INSTANCE_LEVEL_COUNT as usize];
    RTCHit { geomID: INVALID_ID, primID: INVALID_ID, instID: outside, ..Default::default() }
}

/// What an error code means.
pub fn error_text(code: RTCError) -> &'static str {
    match code {
        RTC_ERROR_NONE => "no error",
        RTC_ERROR_INVALID_ARGUMENT => "invalid argument",
        RTC_ERROR_INVALID_OPERATION => "invalid operation",
        RTC_ERROR_OUT_OF_MEMORY => "out of memory",
        RTC_ERROR_UNSUPPORTED_CPU => "this processor lacks the instruction set",
        RTC_ERROR_CANCELLED => "cancelled",
        _ => "unknown error",
    }
}

/// The hit in the arguments of an intersect callback (`RTCRayHitN_HitN`, `N` = 1).
///
/// # Safety
/// `rayhit` comes from the arguments of an intersect callback that is running, with `N` = 1.
pub unsafe fn hit_of(rayhit: *mut RTCRayHitN) -> *mut RTCHitN {
    // SAFETY: a packet of one ray is 12 words, and the hit follows it.
    unsafe { rayhit.cast::<f32>().add(12).cast() }
}

/// The ray's `tfar` (`RTCRayN_tfar`, `N` = 1): the largest t wanted, in a filter the candidate's t.
///
/// # Safety
/// `ray` is the ray, or ray and hit, in the arguments of a callback that is running, with `N` = 1.
pub unsafe fn ray_tfar(ray: *const RTCRayN) -> f32 {
    // SAFETY: the ninth word of a packet of one ray.
    unsafe { ray.cast::<f32>().add(8).read() }
}

/// Changes the ray's `tfar`.
///
/// # Safety
/// As [`ray_tfar`].
pub unsafe fn set_ray_tfar(ray: *mut RTCRayN, tfar: f32) {
    // SAFETY: the ninth word of a packet of one ray.
    unsafe { ray.cast::<f32>().add(8).write(tfar) }
}

/// The candidate's (geometry, primitive) ids (`RTCHitN_geomID`, `RTCHitN_primID`, `N` = 1).
///
/// # Safety
/// `hit` is the hit in the arguments of a filter that is running, with `N` = 1.
pub unsafe fn hit_ids(hit: *const RTCHitN) -> (u32, u32) {
    let words = hit.cast::<u32>();
    // SAFETY: the seventh and sixth word of a packet of one hit.
    unsafe { (words.add(6).read(), words.add(5).read()) }
}

/// Stores a hit's (geometry, primitive) ids from an intersect callback.
///
/// # Safety
/// `hit` is what [`hit_of`] returned.
pub unsafe fn set_hit_ids(hit: *mut RTCHitN, geometry: u32, primitive: u32) {
    let words = hit.cast::<u32>();
    // SAFETY: the seventh and sixth word of a packet of one hit.
    unsafe {
        words.add(6).write(geometry);
        words.add(5).write(primitive);
    }
}
