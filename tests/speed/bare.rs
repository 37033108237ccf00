//! Embree's own calls: rays in f32, one triangle geometry, and nothing of this program around them.

use embree_sys::*;
use pathtracer::geometry::{MeshPart, Ray};
use std::hint::black_box;
use std::ptr;
use std::time::Instant;

/// A scene of one mesh, static and of high build quality.
pub(super) struct Bare {
    device: RTCDevice,
    scene: RTCScene,
    /// Embree reads them while it traces; a number behind the last corner, since it loads four.
    _corners: Vec<f32>,
    _triangles: Vec<[u32; 3]>,
}

impl Bare {
    /// With the robust kernels, or with the default ones.
    pub(super) fn new(mesh: &MeshPart, is_robust: bool) -> Bare {
        let corners = mesh.positions.iter().flat_map(|p| p.to_array()).chain([0.0]);
        let corners: Vec<f32> = corners.map(|x| x as f32).collect();
        let triangles = mesh.triangles.clone();
        let flags = if is_robust { RTC_SCENE_FLAG_ROBUST } else { RTC_SCENE_FLAG_NONE };
        // SAFETY: every handle is used while it lives; both arrays have the numbers that are said and live as long as the scene.
        unsafe {
            let device = rtcNewDevice(ptr::null());
            assert!(!device.is_null());
            let scene = rtcNewScene(device);
            let geometry = new_geometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
            let (v, i) = (corners.as_ptr().cast(), triangles.as_ptr().cast());
            let (vertices, faces) = (mesh.positions.len(), triangles.len());
            rtcSetSharedGeometryBuffer(
                geometry,
                RTC_BUFFER_TYPE_VERTEX,
                0,
                RTC_FORMAT_FLOAT3,
                v,
                0,
                12,
                vertices,
            );
            rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, i, 0, 12, faces);
            rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(scene, geometry);
            rtcReleaseGeometry(geometry);
            rtcSetSceneFlags(scene, flags);
            rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
            rtcCommitScene(scene);
            assert_eq!(rtcGetDeviceError(device), RTC_ERROR_NONE);
            Bare { device, scene, _corners: corners, _triangles: triangles }
        }
    }

    /// Nanoseconds a ray for the closest and for any hit.
    pub(super) fn measure(&self, rays: &[Ray]) -> [f64; 2] {
        let rays: Vec<RTCRay> = rays.iter().map(in_f32).collect();
        let per_ray = |start: Instant| start.elapsed().as_secs_f64() * 1e9 / rays.len() as f64;
        let mut query = Query::new(());
        let start = Instant::now();
        for &ray in &rays {
            let mut rayhit = RTCRayHit { ray, hit: no_hit() };
            // SAFETY: the scene is committed and has no callbacks, and the ray is finite.
            unsafe { intersect1(self.scene, &mut query, &mut rayhit) };
            black_box(rayhit);
        }
        let closest = per_ray(start);
        let start = Instant::now();
        for &ray in &rays {
            let mut ray = ray;
            // SAFETY: as above.
            unsafe { occluded1(self.scene, &mut query, &mut ray) };
            black_box(ray);
        }
        [closest, per_ray(start)]
    }
}

impl Drop for Bare {
    fn drop(&mut self) {
        // SAFETY: both handles are live and used nowhere else.
        unsafe {
            rtcReleaseScene(self.scene);
            rtcReleaseDevice(self.device);
        }
    }
}

fn in_f32(ray: &Ray) -> RTCRay {
    let [origin, direction] = [ray.origin, ray.direction].map(|v| v.to_array().map(|x| x as f32));
    RTCRay {
        org_x: origin[0],
        org_y: origin[1],
        org_z: origin[2],
        dir_x: direction[0],
        dir_y: direction[1],
        dir_z: direction[2],
        tfar: f32::INFINITY,
        mask: u32::MAX,
        ..Default::default()
    }
}
