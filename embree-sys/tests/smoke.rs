//! The whole surface once against the library found: a triangle, a user geometry, the filters, the errors.

use embree_sys::*;
use std::ffi::{CStr, c_char, c_void};
use std::ptr;

/// Height of the user primitive: a plane. Its callback does not look at x and y, for Embree may skip the bounds of a
/// single primitive.
const PLANE: f32 = -1.0;

/// What the callbacks see of a query.
#[derive(Default)]
struct Seen {
    user_calls: u32,
    filter_calls: u32,
    refuse: Option<(u32, u32)>,
}

struct Scene {
    device: RTCDevice,
    scene: RTCScene,
    triangle: u32,
    user: u32,
    _vertices: Box<[f32; 10]>,
    _indices: Box<[u32; 3]>,
}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: both handles are live and used nowhere else.
        unsafe {
            rtcReleaseScene(self.scene);
            rtcReleaseDevice(self.device);
        }
    }
}

unsafe extern "C" fn bounds(args: *const RTCBoundsFunctionArguments) {
    // SAFETY: Embree passes valid arguments.
    unsafe {
        let bounds = (*args).bounds_o;
        ((*bounds).lower_x, (*bounds).lower_y, (*bounds).lower_z) = (-1.0, -1.0, PLANE);
        ((*bounds).upper_x, (*bounds).upper_y, (*bounds).upper_z) = (1.0, 1.0, PLANE);
    }
}

/// The plane's t for rays along -z from z = 1.
const PLANE_T: f32 = 1.0 - PLANE;

unsafe extern "C" fn intersect(args: *const RTCIntersectFunctionNArguments) {
    // SAFETY: Embree passes valid arguments for one ray, of a `Query<Seen>`.
    unsafe {
        assert_eq!(((*args).N, *(*args).valid), (1, -1));
        (*Query::<Seen>::data((*args).context)).user_calls += 1;
        let ray = (*args).rayhit.cast::<RTCRayN>();
        if PLANE_T < ray_tfar(ray) {
            set_ray_tfar(ray, PLANE_T);
            set_hit_ids(hit_of((*args).rayhit), (*args).geomID, (*args).primID);
        }
    }
}

unsafe extern "C" fn occluded(args: *const RTCOccludedFunctionNArguments) {
    // SAFETY: Embree passes valid arguments for one ray, of a `Query<Seen>`.
    unsafe {
        (*Query::<Seen>::data((*args).context)).user_calls += 1;
        if PLANE_T < ray_tfar((*args).ray) {
            set_ray_tfar((*args).ray, f32::NEG_INFINITY);
        }
    }
}

/// Whether a distance is that of the triangle. Embree divides by an approximate reciprocal with one Newton step, which is
/// right to two units in the last place or so, and not the same on every machine.
fn is_at_one(t: f32) -> bool {
    (t - 1.0).abs() <= 2.0 * f32::EPSILON
}

unsafe extern "C" fn filter(args: *const RTCFilterFunctionNArguments) {
    // SAFETY: Embree passes valid arguments for one ray, of a `Query<Seen>`.
    unsafe {
        let seen = Query::<Seen>::data((*args).context);
        (*seen).filter_calls += 1;
        assert_eq!(((*args).N, *(*args).valid), (1, -1));
        assert!(is_at_one(ray_tfar((*args).ray)));
        if (*seen).refuse == Some(hit_ids((*args).hit)) {
            *(*args).valid = 0;
        }
    }
}

/// A triangle in z = 0 around the origin, and the plane below it.
fn scene() -> Scene {
    // SAFETY: every handle is used while it lives; the buffers live as long as the scene, the last vertex is padded.
    unsafe {
        let device = rtcNewDevice(ptr::null());
        assert!(!device.is_null());
        let scene = rtcNewScene(device);
        let vertices = Box::new([-1.0f32, -1.0, 0.0, 1.0, -1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
        let indices = Box::new([0u32, 1, 2]);
        let mesh = new_geometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        let (v, i) = (vertices.as_ptr().cast(), indices.as_ptr().cast());
        rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, v, 0, 12, 3);
        rtcSetSharedGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, i, 0, 12, 1);
        rtcSetGeometryIntersectFilterFunction(mesh, Some(filter));
        rtcSetGeometryOccludedFilterFunction(mesh, Some(filter));
        rtcCommitGeometry(mesh);
        let triangle = rtcAttachGeometry(scene, mesh);
        rtcReleaseGeometry(mesh);
        let plane = new_geometry(device, RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(plane, 1);
        rtcSetGeometryBoundsFunction(plane, Some(bounds), ptr::null_mut());
        rtcSetGeometryIntersectFunction(plane, Some(intersect));
        rtcSetGeometryOccludedFunction(plane, Some(occluded));
        rtcCommitGeometry(plane);
        let user = rtcAttachGeometry(scene, plane);
        rtcReleaseGeometry(plane);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene);
        assert_eq!(rtcGetDeviceError(device), RTC_ERROR_NONE);
        Scene { device, scene, triangle, user, _vertices: vertices, _indices: indices }
    }
}

/// Down from z = 1. Only the lowest bit of the mask is set: it must be seen whatever a new geometry's mask.
fn ray(x: f32, y: f32, tfar: f32, mask: u32) -> RTCRay {
    RTCRay { org_x: x, org_y: y, org_z: 1.0, dir_z: -1.0, tfar, mask, ..Default::default() }
}

fn closest(scene: &Scene, ray: RTCRay, refuse: Option<(u32, u32)>) -> (f32, u32, u32, Seen) {
    let mut rayhit = RTCRayHit { ray, hit: no_hit() };
    let mut query = Query::new(Seen { refuse, ..Default::default() });
    // SAFETY: the scene is committed, the ray is finite, and the callbacks expect `Seen`.
    unsafe { intersect1(scene.scene, &mut query, &mut rayhit) };
    (rayhit.ray.tfar, rayhit.hit.geomID, rayhit.hit.primID, query.data)
}

#[test]
fn the_library_is_not_older_than_the_header() {
    let scene = scene();
    let loaded = [RTC_DEVICE_PROPERTY_VERSION_MAJOR, RTC_DEVICE_PROPERTY_VERSION_MINOR]
        // SAFETY: the device is live.
        .map(|property| unsafe { rtcGetDeviceProperty(scene.device, property) });
    assert_eq!(loaded[0], RTC_VERSION_MAJOR as isize);
    assert!(loaded[1] >= RTC_VERSION_MINOR as isize, "{loaded:?}");
}

#[test]
fn the_closest_hit_has_the_ids_of_its_geometry() {
    let scene = scene();
    let (t, geometry, primitive, seen) = closest(&scene, ray(0.0, 0.0, 10.0, 1), None);
    assert!(is_at_one(t), "{t}");
    assert_eq!((geometry, primitive, seen.filter_calls), (scene.triangle, 0, 1));
    let (t, geometry, primitive, seen) = closest(&scene, ray(-0.9, 0.9, 10.0, 1), None);
    assert_eq!((t, geometry, primitive, seen.user_calls), (PLANE_T, scene.user, 0, 1));
    let (t, geometry, _, _) = closest(&scene, ray(0.0, 0.0, 0.5, 1), None);
    assert_eq!((t, geometry), (0.5, INVALID_ID));
}

#[test]
fn a_new_geometry_answers_every_bit_of_a_mask() {
    let scene = scene();
    assert_eq!(closest(&scene, ray(0.0, 0.0, 10.0, 1 << 31), None).1, scene.triangle);
}

#[test]
fn a_refused_candidate_is_passed_through() {
    let scene = scene();
    let (t, geometry, _, _) = closest(&scene, ray(0.0, 0.0, 10.0, 1), Some((scene.triangle, 0)));
    assert_eq!((t, geometry), (PLANE_T, scene.user));
}

#[test]
fn occlusion_respects_the_filter_and_the_range() {
    let scene = scene();
    let blocked = |tfar, refuse| {
        let mut ray = ray(0.0, 0.0, tfar, 1);
        let mut query = Query::new(Seen { refuse, ..Default::default() });
        // SAFETY: as in `closest`.
        unsafe { occluded1(scene.scene, &mut query, &mut ray) };
        ray.tfar < 0.0
    };
    assert!(blocked(10.0, None));
    assert!(!blocked(0.5, None));
    assert!(!blocked(1.5, Some((scene.triangle, 0))));
    assert!(blocked(2.5, Some((scene.triangle, 0))));
}

unsafe extern "C" fn record(user: *mut c_void, code: RTCError, text: *const c_char) {
    // SAFETY: `user` is the pair that the test registered, `text` a C string.
    // SAFETY: `user` is the pair that the test registered, `text` a C string.
    unsafe {
        *user.cast::<(RTCError, String)>() = (code, CStr::from_ptr(text).to_string_lossy().into_owned())
    };
}

#[test]
fn an_error_reaches_the_callback_with_its_code() {
    let scene = scene();
    let mut error = (RTC_ERROR_NONE, String::new());
    // SAFETY: the device outlives the geometry, and `error` the last call that may report one.
    unsafe {
        rtcSetDeviceErrorFunction(scene.device, Some(record), (&raw mut error).cast());
        let geometry = new_geometry(scene.device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetGeometryUserPrimitiveCount(geometry, 1);
        rtcReleaseGeometry(geometry);
        rtcSetDeviceErrorFunction(scene.device, None, ptr::null_mut());
    }
    assert_eq!(error_text(error.0), "invalid operation", "{}", error.1);
}
