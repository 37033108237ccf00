//! Normals of mesh files, interpolated over triangles.

use super::meshes::Placement;
use crate::geometry::Hit;
use crate::math::{DMat3, DVec3};
use crate::scene::desc::MeshDesc;
use rayon::prelude::*;
use std::collections::HashMap;

/// Normals in the coordinates of their files; empty where no mesh of the scene is smooth.
#[derive(Clone, Debug, Default)]
pub(super) struct ShadingNormals {
    meshes: Vec<MeshNormals>,
    /// Of every object up to the last smooth one.
    of_object: Vec<Option<Turned>>,
}

/// The normals of a mesh.
#[derive(Clone, Debug)]
struct MeshNormals {
    /// Unit normals; zero where the file's have no direction.
    normals: Vec<[f32; 3]>,
    /// Three indices into `normals` for every triangle; `u32::MAX` where it is flat.
    indices: Vec<[u32; 3]>,
}

/// Normals of a mesh, and how they are turned into the world.
#[derive(Clone, Copy, Debug)]
struct Turned {
    mesh: u32,
    rotation: DMat3,
}

/// What is added, with the meshes that several objects use once.
#[derive(Default)]
pub(super) struct NormalsBuilder {
    normals: ShadingNormals,
    shared: HashMap<*const MeshDesc, u32>,
}

impl NormalsBuilder {
    /// Shades the triangles of an object by the normals of its mesh. The triangles of instances stand as in the file,
    /// others as [`Placement::winding`] says.
    pub(super) fn add(&mut self, object: u32, mesh: &MeshDesc, placement: &Placement, is_instance: bool) {
        if mesh.normal_indices.is_empty() {
            return;
        }
        let normals = &mut self.normals;
        let mut append = |winding: &dyn Fn([u32; 3]) -> [u32; 3]| {
            let indices = mesh.normal_indices.iter().map(|&corners| winding(corners)).collect();
            let units = mesh.normals.par_iter().with_min_len(1024).map(unit).collect();
            normals.meshes.push(MeshNormals { normals: units, indices });
            normals.meshes.len() as u32 - 1
        };
        let index = match is_instance {
            true => *self.shared.entry(mesh).or_insert_with(|| append(&|corners| corners)),
            false => append(&|corners| placement.winding(corners)),
        };
        normals.of_object.resize(object as usize + 1, None);
        normals.of_object[object as usize] = Some(Turned { mesh: index, rotation: placement.rotation });
    }

    /// What was added.
    pub(super) fn finish(self) -> ShadingNormals {
        self.normals
    }
}

fn unit(normal: &[f32; 3]) -> [f32; 3] {
    DVec3::from(normal.map(f64::from)).normalize_or_zero().as_vec3().to_array()
}

impl ShadingNormals {
    /// Whether no mesh is smooth.
    pub(super) fn is_empty(&self) -> bool {
        self.meshes.is_empty()
    }

    /// The unit normal at a hit, on the side of the file's normals; `None` where the surface is flat.
    #[inline]
    pub(super) fn at(&self, hit: &Hit) -> Option<DVec3> {
        let Turned { mesh, rotation } = self.of_object.get(hit.object as usize)?.as_ref()?;
        let mesh = &self.meshes[*mesh as usize];
        let indices = mesh.indices[hit.part as usize];
        if indices.contains(&u32::MAX) {
            return None;
        }
        let [a, b, c] = indices.map(|index| {
            let [x, y, z] = mesh.normals[index as usize];
            DVec3::new(x.into(), y.into(), z.into())
        });
        let sum = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
        let length = sum.length();
        (length > 0.0).then(|| *rotation * (sum / length))
    }
}
