//! What a render will take of the machine's memory, before it takes it.

use super::{Settings, film_bytes};
use crate::error::{Error, Result};
use crate::integrator::Features;
use crate::memory::available_bytes;
use crate::scene::desc::{MeshDesc, SceneDesc, ShapeDesc};
use crate::words;
use crate::world::{environment_map_bytes, texture_bytes};
use std::collections::HashSet;
use std::sync::Arc;

/// Bytes that an accelerator takes for a triangle while it is built: nodes, leaves, and the lists that are sorted.
const TREE_BYTES: u64 = 160;
/// Bytes a pixel that denoising takes: colour, albedo, normal and result in f32, and the network's tiles.
const DENOISER_BYTES: u64 = 4 * 12 + 200;

/// The large parts of what is still to be allocated once the scene has been read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Estimate {
    /// In bytes: what it is, how much, what makes it smaller.
    parts: Vec<(&'static str, u64, &'static str)>,
}

impl Estimate {
    /// Of a render of a scene; `denoise`: whether its picture is denoised.
    pub fn new(desc: &SceneDesc, settings: &Settings, denoise: bool) -> Estimate {
        let pixels = settings.area();
        let features = if settings.features { pixels * 2 * size_of::<Features>() as u64 } else { 0 };
        let mut seen = HashSet::new();
        let meshes = desc.objects.iter().filter_map(|object| match &object.shape {
            ShapeDesc::TriangleMesh { mesh, .. } => Some(mesh),
            _ => None,
        });
        let (mut arrays, mut trees) = (0, 0);
        for mesh in meshes.filter(|mesh| seen.insert(Arc::as_ptr(mesh))) {
            arrays += world_bytes(mesh);
            trees += mesh.triangles.len() as u64 * TREE_BYTES;
        }
        let sky = desc.environment_map.as_ref().map_or(0, environment_map_bytes);
        let coarser = "coarser meshes take less, and files that several objects show are kept once";
        let parts = vec![
            ("the film", film_bytes(settings), "fewer pixels take less"),
            ("channels of features", features, "without --aov and --denoise there are none"),
            ("meshes", arrays, coarser),
            ("trees over the meshes", trees, coarser),
            ("textures", textures(desc), "pictures of bytes and smaller ones take less"),
            ("the environment map", sky, "a smaller picture takes less"),
            (
                "the denoiser",
                if denoise { pixels * DENOISER_BYTES } else { 0 },
                "without --denoise there is none",
            ),
        ];
        Estimate { parts }
    }

    /// All of it, in bytes.
    pub fn bytes(&self) -> u64 {
        self.parts.iter().fold(0, |sum, (_, bytes, _)| sum.saturating_add(*bytes))
    }

    /// Whether it fits into the memory that is free now; passes where the system does not say.
    ///
    /// # Errors
    /// It does not; as [`Estimate::check_against`].
    pub fn check(&self) -> Result<()> {
        available_bytes().map_or(Ok(()), |available| self.check_against(available))
    }

    /// Whether it fits into so many bytes.
    ///
    /// # Errors
    /// It does not; what is large is named, and what would make it smaller.
    pub fn check_against(&self, available: u64) -> Result<()> {
        if self.bytes() <= available {
            return Ok(());
        }
        let mut parts = self.parts.clone();
        parts.sort_by_key(|(_, bytes, _)| std::cmp::Reverse(*bytes));
        let named = parts.iter().filter(|(_, bytes, _)| *bytes >= self.bytes() / 100);
        let named: Vec<String> =
            named.map(|(name, bytes, _)| format!("{name} {}", words::bytes(*bytes))).collect();
        Err(Error::Usage(format!(
            "the render needs about {} of memory, and {} are free: {}; {}",
            words::bytes(self.bytes()),
            words::bytes(available),
            named.join(", "),
            parts[0].2
        )))
    }
}

/// What the compiled scene takes for its textures, each once.
fn textures(desc: &SceneDesc) -> u64 {
    let materials = desc.objects.iter().flat_map(|object| {
        let faces = object.faces.iter().map(|(_, material)| &**material);
        std::iter::once(&object.material).chain(faces)
    });
    let pictures = materials.flat_map(|material| [&material.textures.color, &material.textures.coat_color]);
    let mut seen = HashSet::new();
    let once =
        pictures.flatten().filter(|picture| seen.insert((Arc::as_ptr(&picture.picture), picture.is_encoded)));
    once.map(texture_bytes).sum()
}

/// What the compiled scene takes of a mesh.
fn world_bytes(mesh: &MeshDesc) -> u64 {
    let MeshDesc { positions, normals, texcoords, triangles, normal_indices, texcoord_indices, .. } = mesh;
    let arrays = [size_of_val(&positions[..]), size_of_val(&normals[..]), size_of_val(&texcoords[..])];
    let indices = [&triangles, &normal_indices, &texcoord_indices].map(|indices| size_of_val(&indices[..]));
    arrays.iter().chain(&indices).sum::<usize>() as u64
}
