//! Normals of mesh files, interpolated over triangles.

use crate::geometry::Hit;
use crate::math::DVec3;

/// Normals in world space; empty where no mesh of the scene is smooth.
#[derive(Clone, Debug, Default)]
pub(super) struct ShadingNormals {
    /// Unit normals.
    pub(super) normals: Vec<[f32; 3]>,
    /// Three indices into `normals` for every triangle of the geometry; `u32::MAX` where it is flat.
    pub(super) indices: Vec<[u32; 3]>,
}

impl ShadingNormals {
    /// The unit normal at a hit; `None` where the surface is flat.
    #[inline]
    pub(super) fn at(&self, hit: &Hit) -> Option<DVec3> {
        if self.indices.is_empty() {
            return None;
        }
        let indices = self.indices[hit.primitive.as_triangle()? as usize];
        if indices.contains(&u32::MAX) {
            return None;
        }
        let [a, b, c] = indices.map(|index| {
            let [x, y, z] = self.normals[index as usize];
            DVec3::new(x.into(), y.into(), z.into())
        });
        let sum = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
        let length = sum.length();
        (length > 0.0).then(|| sum / length)
    }
}
