//! The only file that calls Embree: devices and scenes as owned, checked values, and the callbacks.
//!
//! A [`Scene`] knows the type of what its callbacks read, so its queries are safe to call. Callbacks must not unwind
//! into Embree: they are `extern "C"`, which aborts instead, and what they call does not panic on indices that Embree
//! was given.
#![allow(unsafe_code)]

use crate::accel::{BuildOptions, BvhQuality, Isa, Precision};
use crate::error::{Error, Result};
use crate::geometry::{LocalRay, MeshSpace};
use crate::math::round_up;
use crate::memory::available_bytes;
use crate::words::bytes;
use embree_sys::*;
use std::ffi::{CStr, CString, c_char, c_void};
use std::marker::PhantomData;
use std::ptr;
use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Lower and upper corner.
pub(super) type BoundingBox = ([f32; 3], [f32; 3]);

/// How far a search goes on for hits up to `t`: beyond it, so that boxes around another hit at `t` are entered.
pub(super) fn reach(t: f64) -> f32 {
    round_up(t) * (1.0 + 1.0 / 1_048_576.0)
}

/// What the callbacks of a scene read and write.
pub(super) trait Queries {
    /// Of a search for the closest hit.
    type Closest<'q>;
    /// Of a search for any hit.
    type Any<'q>;
}

/// Primitives with a box, decided here.
pub(super) trait UserGeometry: Queries + Sync {
    /// The box of a primitive, `None` to leave it out.
    fn bounds(&self, primitive: u32) -> Option<BoundingBox>;

    /// Takes a primitive into account; the [`reach`] of the search from now on, `None` to leave it as it is.
    fn closest(query: &mut Self::Closest<'_>, primitive: u32) -> Option<f32>;

    /// Whether the primitive is hit.
    fn any(query: &mut Self::Any<'_>, primitive: u32) -> bool;
}

/// The last word on the triangles that Embree proposes.
pub(super) trait Filter: Queries {
    /// Whether a candidate for the closest hit counts.
    fn keeps_closest(query: &mut Self::Closest<'_>, triangle: u32) -> bool;

    /// Whether a candidate for any hit counts.
    fn keeps_any(query: &mut Self::Any<'_>, triangle: u32) -> bool;
}

/// What Embree said went wrong.
struct Failure {
    code: RTCError,
    text: String,
}

/// What Embree holds and may hold, in bytes.
struct Memory {
    bytes: AtomicI64,
    most: i64,
}

/// Embree, while scenes are built. Scenes keep what they need of it alive.
pub(super) struct Device {
    raw: RTCDevice,
    /// The first error since the last [`Device::check`]; Embree's threads write it.
    error: Box<Mutex<Option<Failure>>>,
    /// Bytes that Embree holds; its threads write it.
    memory: Box<Memory>,
    /// Whether callbacks may use AVX2.
    avx2: bool,
}

impl Device {
    /// Starts Embree with the instructions and the memory that the options leave it.
    pub(super) fn new(options: &BuildOptions) -> Result<Device> {
        let isa = options.isa;
        let threads = rayon::current_num_threads();
        let instructions = match isa {
            None => "",
            Some(Isa::Sse2) => ",isa=sse2",
            Some(Isa::Avx2) => ",isa=avx2",
            Some(Isa::Avx512) => ",isa=avx512",
        };
        let config = CString::new(format!("threads={threads}{instructions}")).unwrap_or_default();
        // SAFETY: a C string that outlives the call.
        let raw = unsafe { rtcNewDevice(config.as_ptr()) };
        if raw.is_null() {
            // SAFETY: without a device this asks why the last rtcNewDevice of this thread failed.
            let code = unsafe { rtcGetDeviceError(ptr::null_mut()) };
            let message = format!("Embree does not start: {}", error_text(code));
            return Err(match (code, isa) {
                (RTC_ERROR_UNSUPPORTED_CPU, Some(_)) => Error::Usage(message),
                (RTC_ERROR_UNSUPPORTED_CPU, None) => Error::Unavailable(message),
                _ => Error::Accelerator(message),
            });
        }
        let device = Device {
            raw,
            error: Box::default(),
            memory: Box::new(Memory::new(options)),
            avx2: allows_avx2(isa),
        };
        let slot = (&raw const *device.error).cast_mut().cast();
        let memory = (&raw const *device.memory).cast_mut().cast();
        // SAFETY: mutex and counter stay where they are until the drop of `device` takes the callbacks away.
        unsafe {
            rtcSetDeviceErrorFunction(raw, Some(record_error), slot);
            rtcSetDeviceMemoryMonitorFunction(raw, Some(count_bytes), memory);
        }
        device.check_version()?;
        Ok(device)
    }

    /// The library must be what was bound, or a later one of the same layout: `RTCHit` last grew in 4.3.
    fn check_version(&self) -> Result<()> {
        let [major, minor] = [RTC_DEVICE_PROPERTY_VERSION_MAJOR, RTC_DEVICE_PROPERTY_VERSION_MINOR]
            // SAFETY: the device is live.
            .map(|property| unsafe { rtcGetDeviceProperty(self.raw, property) });
        let bound = (RTC_VERSION_MAJOR as isize, RTC_VERSION_MINOR as isize);
        let later = major == bound.0 && minor > bound.1 && bound >= (4, 3);
        if (major, minor) == bound || later {
            return Ok(());
        }
        Err(Error::Unavailable(format!(
            "this program was built for Embree {}.{}, but Embree {major}.{minor} was loaded: build it again, or set \
             LD_LIBRARY_PATH",
            bound.0, bound.1
        )))
    }

    /// The first failure since the last call; `doing` reads like "building a tree".
    fn check(&self, doing: &str) -> Result<()> {
        let failure = self.error.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(Failure { code, text }) = failure else { return Ok(()) };
        let more = match code {
            RTC_ERROR_OUT_OF_MEMORY => format!(
                "; it may take {}. Coarser meshes or files that several objects show take less, and so does `--accel native`",
                bytes(self.memory.most.unsigned_abs())
            ),
            _ => String::new(),
        };
        Err(Error::Accelerator(format!("Embree failed when {doing}: {text}{more}")))
    }

    /// Bytes that Embree holds for all scenes of this device: trees, leaves and what its allocator keeps in reserve.
    pub(super) fn bytes(&self) -> usize {
        usize::try_from(self.memory.bytes.load(Ordering::Relaxed)).unwrap_or(0)
    }

    fn new_geometry(&self, kind: RTCGeometryType) -> Result<GeometryHandle> {
        // SAFETY: the device is live.
        let raw = unsafe { new_geometry(self.raw, kind) };
        self.check("making a geometry")?;
        Ok(GeometryHandle { raw })
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: the device is live; scenes that are left hold references of their own and find no callback.
        unsafe {
            rtcSetDeviceErrorFunction(self.raw, None, ptr::null_mut());
            rtcSetDeviceMemoryMonitorFunction(self.raw, None, ptr::null_mut());
            rtcReleaseDevice(self.raw);
        }
    }
}

/// Whether this machine has AVX2 and `isa` lets it be used.
fn allows_avx2(isa: Option<Isa>) -> bool {
    #[cfg(target_arch = "x86_64")]
    return isa != Some(Isa::Sse2) && is_x86_feature_detected!("avx2");
    #[cfg(not(target_arch = "x86_64"))]
    return false;
}

/// Keeps the first error for [`Device::check`].
unsafe extern "C" fn record_error(slot: *mut c_void, code: RTCError, text: *const c_char) {
    // SAFETY: `slot` is the mutex of a live Device.
    let error = unsafe { &*slot.cast::<Mutex<Option<Failure>>>() };
    let details = match text.is_null() {
        true => Default::default(),
        // SAFETY: Embree passes a C string.
        false => unsafe { CStr::from_ptr(text) }.to_string_lossy(),
    };
    let mut error = error.lock().unwrap_or_else(PoisonError::into_inner);
    let kind = error_text(code);
    let text = || if details == kind { kind.into() } else { format!("{kind} ({details})") };
    error.get_or_insert_with(|| Failure { code, text: text() });
}

/// Adds what Embree allocates, or frees (a negative number), for [`Device::bytes`]. Where it would be too much, Embree gives
/// up with [`RTC_ERROR_OUT_OF_MEMORY`] before the system ends the program.
unsafe extern "C" fn count_bytes(slot: *mut c_void, bytes: isize, post: bool) -> bool {
    // SAFETY: `slot` is the Memory of a live Device.
    let memory = unsafe { &*slot.cast::<Memory>() };
    let before = memory.bytes.fetch_add(bytes as i64, Ordering::Relaxed);
    let fits = bytes <= 0 || post || before.saturating_add(bytes as i64) <= memory.most;
    if !fits {
        // It will not be allocated.
        memory.bytes.fetch_sub(bytes as i64, Ordering::Relaxed);
    }
    fits
}

impl Memory {
    fn new(options: &BuildOptions) -> Memory {
        let most = options.memory.or_else(available_bytes).and_then(|bytes| i64::try_from(bytes).ok());
        Memory { bytes: AtomicI64::new(0), most: most.unwrap_or(i64::MAX) }
    }
}

/// The triangles of a space in words.
pub(super) fn contents(space: &MeshSpace) -> String {
    let count = space.triangles.len();
    let ranges = space.mesh_ranges().map(|(mesh, range)| (range.len(), mesh.object));
    // Objects are numbered from 1, as in the channel of pictures that names them.
    match (space.meshes.len(), ranges.max()) {
        (1, Some((_, object))) => format!("the {count} triangles of object {}", u64::from(object) + 1),
        (meshes, Some((most, object))) => {
            let object = u64::from(object) + 1;
            format!("the {count} triangles of {meshes} objects, of which object {object} has {most}")
        }
        _ => format!("{count} triangles"),
    }
}

/// A geometry that this side holds a reference to.
struct GeometryHandle {
    raw: RTCGeometry,
}

impl Drop for GeometryHandle {
    fn drop(&mut self) {
        // SAFETY: this is the reference that was made with the geometry.
        unsafe { rtcReleaseGeometry(self.raw) };
    }
}

/// A committed scene whose callbacks work with `Q`, over buffers of `'g`.
pub(super) struct Scene<'g, Q> {
    raw: RTCScene,
    buffers: PhantomData<&'g MeshSpace>,
    queries: PhantomData<fn() -> Q>,
}

// SAFETY: only queries and the release are left to do. The manual (introduction): "In general, API calls that access the
// same object are not thread-safe, unless specified differently. However, attaching geometries to the same scene and
// performing ray queries in a scene is thread-safe."
unsafe impl<Q> Send for Scene<'_, Q> {}
// SAFETY: as above.
unsafe impl<Q> Sync for Scene<'_, Q> {}

impl<Q> Drop for Scene<'_, Q> {
    fn drop(&mut self) {
        // SAFETY: this is the reference that was made with the scene.
        unsafe { rtcReleaseScene(self.raw) };
    }
}

impl<G: UserGeometry> Scene<'_, G> {
    /// The scene of the boxes of the primitives 0 to `count` - 1.
    pub(super) fn of_boxes(device: &Device, boxes: &G, count: usize, over: &str) -> Result<Self> {
        let count = u32::try_from(count)
            .map_err(|_| Error::Accelerator(format!("{count} primitives are more than Embree can hold")))?;
        let geometry = device.new_geometry(RTC_GEOMETRY_TYPE_USER)?;
        let callbacks = callbacks::<G>(device.avx2);
        // SAFETY: the geometry is live. `boxes` is read by `bounds` only, that is until the scene is committed below.
        unsafe {
            rtcSetGeometryUserPrimitiveCount(geometry.raw, count);
            rtcSetGeometryUserData(geometry.raw, (&raw const *boxes).cast_mut().cast());
            rtcSetGeometryBoundsFunction(geometry.raw, Some(bounds::<G>), ptr::null_mut());
            rtcSetGeometryIntersectFunction(geometry.raw, callbacks.0);
            rtcSetGeometryOccludedFunction(geometry.raw, callbacks.1);
        }
        Scene::commit(device, geometry, RTC_SCENE_FLAG_NONE, RTC_BUILD_QUALITY_MEDIUM, over)
    }
}

impl<'g, F: Filter> Scene<'g, F> {
    /// The scene of the triangles of `space`, whose buffers Embree reads but never writes.
    pub(super) fn of_triangles(
        device: &Device,
        space: &'g MeshSpace,
        options: &BuildOptions,
    ) -> Result<Self> {
        let mesh = device.new_geometry(RTC_GEOMETRY_TYPE_TRIANGLE)?;
        let (vertices, triangles) = (&space.vertices, &space.triangles);
        // The last vertex is padding: Embree loads 16 bytes from each.
        let (vertex_count, triangle_count) = (vertices.len().saturating_sub(1), triangles.len());
        let (vertices, triangles) = (vertices.as_ptr().cast(), triangles.as_ptr().cast());
        // SAFETY: both buffers hold that many items of 12 bytes, the vertices one more, and live for 'g.
        unsafe {
            let (vertex, index) = (RTC_BUFFER_TYPE_VERTEX, RTC_BUFFER_TYPE_INDEX);
            let (float3, uint3) = (RTC_FORMAT_FLOAT3, RTC_FORMAT_UINT3);
            rtcSetSharedGeometryBuffer(mesh.raw, vertex, 0, float3, vertices, 0, 12, vertex_count);
            rtcSetSharedGeometryBuffer(mesh.raw, index, 0, uint3, triangles, 0, 12, triangle_count);
            rtcSetGeometryIntersectFilterFunction(mesh.raw, Some(filter_closest::<F>));
            rtcSetGeometryOccludedFilterFunction(mesh.raw, Some(filter_any::<F>));
        }
        let robust = options.precision == Precision::Robust;
        // Without ROBUST the highest quality splits in space and pays; with it, Embree leaves that out.
        let quality = match options.quality {
            BvhQuality::Fast => RTC_BUILD_QUALITY_LOW,
            BvhQuality::Default if robust => RTC_BUILD_QUALITY_MEDIUM,
            BvhQuality::Default | BvhQuality::Quality => RTC_BUILD_QUALITY_HIGH,
        };
        let flags = if robust { RTC_SCENE_FLAG_ROBUST } else { RTC_SCENE_FLAG_NONE };
        Scene::commit(device, mesh, flags, quality, &contents(space))
    }
}

impl<Q> Scene<'_, Q> {
    /// Builds the tree over the only geometry of the scene; `over` says in messages what that is.
    fn commit(
        device: &Device,
        geometry: GeometryHandle,
        flags: u32,
        quality: u32,
        over: &str,
    ) -> Result<Self> {
        device.check(&format!("describing {over}"))?;
        // SAFETY: the device is live.
        let raw = unsafe { rtcNewScene(device.raw) };
        device.check("making a scene")?;
        let scene = Scene { raw, buffers: PhantomData, queries: PhantomData };
        // SAFETY: scene and geometry are live and of this device; the scene takes a reference to the geometry.
        unsafe {
            rtcSetGeometryBuildQuality(geometry.raw, quality);
            rtcCommitGeometry(geometry.raw);
            rtcAttachGeometry(raw, geometry.raw);
            rtcSetSceneFlags(raw, flags);
            rtcSetSceneBuildQuality(raw, quality);
            rtcCommitScene(raw);
        }
        device.check(&format!("building the tree over {over}"))?;
        Ok(scene)
    }
}

impl<Q: Queries> Scene<'_, Q> {
    /// Finds the closest hit; the primitive, if Embree knows it (of triangles, not of user geometry).
    #[inline]
    pub(super) fn intersect(&self, ray: &LocalRay, query: &mut Q::Closest<'_>) -> Option<u32> {
        let mut rayhit = RTCRayHit { ray: embree_ray(ray), hit: no_hit() };
        // SAFETY: the scene is committed, a LocalRay is finite, and the scene was made for `Q`.
        unsafe { intersect1(self.raw, &mut Query::new(query), &mut rayhit) };
        (rayhit.hit.geomID != INVALID_ID).then_some(rayhit.hit.primID)
    }

    /// Whether anything is hit.
    #[inline]
    pub(super) fn occluded(&self, ray: &LocalRay, query: &mut Q::Any<'_>) -> bool {
        let mut ray = embree_ray(ray);
        // SAFETY: as in `intersect`.
        unsafe { occluded1(self.raw, &mut Query::new(query), &mut ray) };
        ray.tfar < 0.0
    }
}

fn embree_ray(ray: &LocalRay) -> RTCRay {
    let (origin, direction) = (ray.origin, ray.direction);
    RTCRay {
        org_x: origin.x,
        org_y: origin.y,
        org_z: origin.z,
        tnear: 0.0,
        dir_x: direction.x,
        dir_y: direction.y,
        dir_z: direction.z,
        tfar: reach(ray.t_max),
        mask: u32::MAX,
        ..Default::default()
    }
}

unsafe extern "C" fn bounds<G: UserGeometry>(args: *const RTCBoundsFunctionArguments) {
    // SAFETY: Embree passes valid arguments, in which the user data is the G of `of_boxes`, shared by its threads.
    let (geometry, primitive, out) =
        unsafe { (&*(*args).geometryUserPtr.cast::<G>(), (*args).primID, &mut *(*args).bounds_o) };
    // Embree leaves out a primitive whose lower corner is above its upper one.
    let (low, high) = geometry.bounds(primitive).unwrap_or(([f32::MAX; 3], [f32::MIN; 3]));
    [out.lower_x, out.lower_y, out.lower_z] = low;
    [out.upper_x, out.upper_y, out.upper_z] = high;
}

/// Defines the two callbacks of user geometry, for one instruction set: what they call is inlined into them.
macro_rules! user_geometry_callbacks {
    ($closest:ident, $any:ident $(, $feature:literal)?) => {
        $(#[target_feature(enable = $feature)])?
        unsafe extern "C" fn $closest<G: UserGeometry>(args: *const RTCIntersectFunctionNArguments) {
            // SAFETY: Embree passes valid arguments, of a query that `Scene::<G>::intersect` made, with one ray.
            unsafe {
                let query = &mut **Query::<&mut G::Closest<'_>>::data((*args).context);
                if let Some(reach) = G::closest(query, (*args).primID) {
                    set_ray_tfar((*args).rayhit.cast(), reach);
                }
            }
        }

        $(#[target_feature(enable = $feature)])?
        unsafe extern "C" fn $any<G: UserGeometry>(args: *const RTCOccludedFunctionNArguments) {
            // SAFETY: Embree passes valid arguments, of a query that `Scene::<G>::occluded` made, with one ray.
            unsafe {
                let query = &mut **Query::<&mut G::Any<'_>>::data((*args).context);
                if G::any(query, (*args).primID) {
                    set_ray_tfar((*args).ray, f32::NEG_INFINITY);
                }
            }
        }
    };
}

user_geometry_callbacks!(closest_baseline, any_baseline);
#[cfg(target_arch = "x86_64")]
user_geometry_callbacks!(closest_avx2, any_avx2, "avx2");

fn callbacks<G: UserGeometry>(avx2: bool) -> (RTCIntersectFunctionN, RTCOccludedFunctionN) {
    #[cfg(target_arch = "x86_64")]
    if avx2 {
        return (Some(closest_avx2::<G>), Some(any_avx2::<G>));
    }
    (Some(closest_baseline::<G>), Some(any_baseline::<G>))
}

unsafe extern "C" fn filter_closest<F: Filter>(args: *const RTCFilterFunctionNArguments) {
    // SAFETY: Embree passes valid arguments, of a query that `Scene::<F>::intersect` made, with one ray.
    unsafe {
        let query = &mut **Query::<&mut F::Closest<'_>>::data((*args).context);
        if !F::keeps_closest(query, hit_ids((*args).hit).1) {
            *(*args).valid = 0;
        }
    }
}

unsafe extern "C" fn filter_any<F: Filter>(args: *const RTCFilterFunctionNArguments) {
    // SAFETY: Embree passes valid arguments, of a query that `Scene::<F>::occluded` made, with one ray.
    unsafe {
        let query = &mut **Query::<&mut F::Any<'_>>::data((*args).context);
        if !F::keeps_any(query, hit_ids((*args).hit).1) {
            *(*args).valid = 0;
        }
    }
}
