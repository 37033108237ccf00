//! Which meshes lie in the world, and which are instances of one that several objects name.

use crate::geometry::{Instance, MeshPart, MeshSpace};
use crate::math::{DMat3, DVec3};
use crate::scene::desc::{Axes, MeshDesc, ObjectDesc, ShapeDesc};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// How the coordinates of a mesh file become the world's.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    /// From the file's axes to the world's: orthonormal; mirrors for [`Axes::SwapYZ`].
    pub(super) rotation: DMat3,
    /// World length of a unit of the file.
    pub(super) scale: f64,
    /// Where the file's origin goes.
    pub(super) position: DVec3,
    /// Whether it mirrors.
    pub(super) mirrors: bool,
}

impl Placement {
    /// `turn` is the object's rotation.
    pub(super) fn new(turn: DMat3, axes: Axes, scale: f64, position: DVec3) -> Placement {
        // Where the file's x, y and z point before the object is turned.
        let axes_of_file = match axes {
            Axes::YUp => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
            Axes::ZUp => DMat3::IDENTITY,
            Axes::SwapYZ => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::Y),
        };
        let mirrors = axes == Axes::SwapYZ;
        Placement { rotation: turn * axes_of_file, scale, position, mirrors }
    }

    /// The mesh as it lies in the world.
    pub(super) fn part(&self, object: u32, mesh: &MeshDesc) -> MeshPart {
        let place = |&p| self.rotation * (DVec3::from(p) * self.scale) + self.position;
        let positions = mesh.positions.par_iter().with_min_len(1024).map(place);
        let triangles = mesh.triangles.iter().map(|&corners| self.winding(corners));
        MeshPart { object, positions: positions.collect(), triangles: triangles.collect() }
    }

    /// The mesh of a space as it is seen from here.
    pub(super) fn instance(&self, index: u32, space: &MeshSpace) -> Instance {
        Instance::new(index, space, self.rotation, self.scale, self.position)
    }

    /// A mirrored mesh keeps its outside: the corners are taken the other way round.
    pub(super) fn winding(&self, [a, b, c]: [u32; 3]) -> [u32; 3] {
        if self.mirrors { [a, c, b] } else { [a, b, c] }
    }
}

/// The meshes that several objects name, each in a space of its own.
#[derive(Default)]
pub(super) struct SharedMeshes {
    /// In the coordinates of the files.
    pub(super) spaces: Vec<MeshSpace>,
    by_mesh: HashMap<*const MeshDesc, u32>,
}

impl SharedMeshes {
    /// Finds them. Emitting objects do not count: the triangles of a light are looked up one by one, in the world.
    pub(super) fn of(objects: &[ObjectDesc]) -> SharedMeshes {
        let mut uses: HashMap<*const MeshDesc, usize> = HashMap::new();
        for mesh in objects.iter().filter_map(dark_mesh) {
            *uses.entry(Arc::as_ptr(mesh)).or_default() += 1;
        }
        let mut shared = SharedMeshes::default();
        for mesh in objects.iter().filter_map(dark_mesh) {
            let key = Arc::as_ptr(mesh);
            if uses[&key] > 1 && !shared.by_mesh.contains_key(&key) {
                shared.by_mesh.insert(key, shared.spaces.len() as u32);
                shared.add(mesh);
            }
        }
        shared
    }

    fn add(&mut self, mesh: &MeshDesc) {
        let positions = mesh.positions.iter().map(|&p| DVec3::from(p)).collect();
        let part = MeshPart { object: 0, positions, triangles: mesh.triangles.clone() };
        self.spaces.push(MeshSpace::new(vec![part]));
    }

    /// The space of the mesh of an object, if it is shared.
    pub(super) fn space_of(&self, object: &ObjectDesc) -> Option<u32> {
        self.by_mesh.get(&Arc::as_ptr(dark_mesh(object)?)).copied()
    }
}

/// The mesh of an object that does not emit.
fn dark_mesh(object: &ObjectDesc) -> Option<&Arc<MeshDesc>> {
    match &object.shape {
        ShapeDesc::TriangleMesh { mesh, .. } if !object.material.kind.emits() => Some(mesh),
        _ => None,
    }
}
