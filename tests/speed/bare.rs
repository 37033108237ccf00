//! Embree's own calls: rays in f32, one triangle geometry, and nothing of this program around them.

use embree_sys::*;
use pathtracer::geometry::{MeshPart, Ray};
use std::ptr;

/// A scene of one mesh, static and of default build quality.
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
            rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
            rtcCommitGeometry(geometry);
            rtcAttachGeometry(scene, geometry);
            rtcReleaseGeometry(geometry);
            rtcSetSceneFlags(scene, flags);
            rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
            rtcCommitScene(scene);
            assert_eq!(rtcGetDeviceError(device), RTC_ERROR_NONE);
            Bare { device, scene, _corners: corners, _triangles: triangles }
        }
    }

    /// Asks for the closest hit of every ray, or for any hit; how many are hit.
    pub(super) fn trace(&self, rays: &[RTCRay], asks_any: bool) -> u64 {
        let mut query = Query::new(());
        let mut is_hit = |&ray: &RTCRay| {
            if asks_any {
                let mut ray = ray;
                // SAFETY: the scene is committed and has no callbacks, and the ray is finite.
                unsafe { occluded1(self.scene, &mut query, &mut ray) };
                return ray.tfar < 0.0;
            }
            let mut rayhit = RTCRayHit { ray, hit: no_hit() };
            // SAFETY: as above.
            unsafe { intersect1(self.scene, &mut query, &mut rayhit) };
            rayhit.hit.geomID != no_hit().geomID
        };
        rays.iter().map(|ray| u64::from(is_hit(ray))).sum()
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

/// A ray that ends at `t_max`, which may be infinite.
pub(super) fn in_f32(ray: &Ray, t_max: f64) -> RTCRay {
    let [origin, direction] = [ray.origin, ray.direction].map(|v| v.to_array().map(|x| x as f32));
    RTCRay {
        org_x: origin[0],
        org_y: origin[1],
        org_z: origin[2],
        dir_x: direction[0],
        dir_y: direction[1],
        dir_z: direction[2],
        tfar: t_max as f32,
        mask: u32::MAX,
        ..Default::default()
    }
}
