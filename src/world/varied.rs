//! Materials that change over their object: pictures as colours, and faces of a mesh with materials of their own.

use super::compile::material_of;
use super::extent::Extent;
use super::meshes::Placement;
use super::texture::Texture;
use crate::geometry::{Geometry, Hit};
use crate::material::Material;
use crate::math::{DVec3, Rgb};
use crate::picture::Decoded;
use crate::scene::desc::{MaterialDesc, MeshDesc, ObjectDesc, PictureDesc, ShapeDesc, TexturesDesc};
use std::collections::HashMap;
use std::f64::consts::PI;
use std::sync::Arc;

/// The varied materials of a scene; empty where there are none.
#[derive(Clone, Debug, Default)]
pub(super) struct Varied {
    textures: Vec<Texture>,
    coordinates: Vec<MeshCoordinates>,
    /// Of every object up to the last varied one.
    of_object: Vec<Option<VariedObject>>,
}

/// How the material of an object varies.
#[derive(Clone, Debug)]
struct VariedObject {
    mapping: Mapping,
    pictures: Pictures,
    /// Where other materials begin among its triangles.
    faces: Arc<[(u32, Material, Pictures)]>,
}

/// Indices of the pictures of a colour, and of a coat's.
#[derive(Clone, Copy, Debug, Default)]
struct Pictures {
    color: Option<u32>,
    coat_color: Option<u32>,
}

/// From a point of a surface to a point of the picture.
#[derive(Clone, Copy, Debug)]
enum Mapping {
    /// By azimuth and height.
    Ball,
    /// By the coordinates of the hit.
    Face,
    /// By the texture coordinates of a mesh.
    Mesh(u32),
}

/// The texture coordinates of a mesh.
#[derive(Clone, Debug)]
struct MeshCoordinates {
    texcoords: Vec<[f32; 2]>,
    /// Three indices for every triangle; `u32::MAX` where it has none.
    indices: Vec<[u32; 3]>,
}

/// What is seen of a surface.
pub(super) struct Seen<'s> {
    /// The shapes of the scene.
    pub(super) geometry: &'s Geometry,
    /// Where.
    pub(super) hit: &'s Hit,
    /// The outer normal of the surface there.
    pub(super) normal: DVec3,
    /// How wide, in world units.
    pub(super) width: f64,
}

/// What is added, with what several objects use once.
#[derive(Default)]
pub(super) struct VariedBuilder {
    varied: Varied,
    /// By the content and whether it is encoded.
    textures: HashMap<(*const Decoded, bool), u32>,
    /// By the mesh and whether it is mirrored.
    coordinates: HashMap<(*const MeshDesc, bool), u32>,
}

impl VariedBuilder {
    /// Varies the material of an object, if it has pictures. `placement` is that of a mesh that lies in the world; the
    /// triangles of an instance stand as in the file.
    pub(super) fn add(&mut self, index: u32, object: &ObjectDesc, placement: Option<&Placement>) {
        let pictures = self.pictures(&object.material);
        let faces: Vec<(u32, Material, Pictures)> = object
            .faces
            .iter()
            .map(|(first, material)| (*first, material_of(&material.kind), self.pictures(material)))
            .collect();
        let has_picture = |pictures: &Pictures| pictures.color.or(pictures.coat_color).is_some();
        let any_picture =
            has_picture(&pictures) || faces.iter().any(|(_, _, pictures)| has_picture(pictures));
        if !any_picture && faces.is_empty() {
            return;
        }
        let mapping = match &object.shape {
            ShapeDesc::Ball { .. } => Mapping::Ball,
            ShapeDesc::TriangleMesh { mesh, .. } if any_picture => {
                Mapping::Mesh(self.coordinates(mesh, placement))
            }
            _ => Mapping::Face,
        };
        let objects = &mut self.varied.of_object;
        objects.resize(index as usize + 1, None);
        objects[index as usize] = Some(VariedObject { mapping, pictures, faces: faces.into() });
    }

    fn pictures(&mut self, material: &MaterialDesc) -> Pictures {
        let mut index = |picture: &Option<PictureDesc>| picture.as_ref().map(|picture| self.texture(picture));
        let TexturesDesc { color, coat_color } = &material.textures;
        Pictures { color: index(color), coat_color: index(coat_color) }
    }

    fn texture(&mut self, picture: &PictureDesc) -> u32 {
        let textures = &mut self.varied.textures;
        *self.textures.entry((Arc::as_ptr(&picture.picture), picture.is_encoded)).or_insert_with(|| {
            textures.push(Texture::new(picture));
            textures.len() as u32 - 1
        })
    }

    fn coordinates(&mut self, mesh: &Arc<MeshDesc>, placement: Option<&Placement>) -> u32 {
        let coordinates = &mut self.varied.coordinates;
        let mirrors = placement.is_some_and(|placement| placement.mirrors);
        *self.coordinates.entry((Arc::as_ptr(mesh), mirrors)).or_insert_with(|| {
            let winding = |&corners: &[u32; 3]| placement.map_or(corners, |p| p.winding(corners));
            let indices = mesh.texcoord_indices.iter().map(winding).collect();
            coordinates.push(MeshCoordinates { texcoords: mesh.texcoords.clone(), indices });
            coordinates.len() as u32 - 1
        })
    }

    /// What was added.
    pub(super) fn finish(self) -> Varied {
        self.varied
    }
}

impl Varied {
    /// The materials of faces.
    pub(super) fn face_materials(&self) -> impl Iterator<Item = &Material> {
        self.of_object
            .iter()
            .flatten()
            .flat_map(|object| object.faces.iter().map(|(_, material, _)| material))
    }

    /// Whether the material of an object is not the same everywhere.
    pub(super) fn varies(&self, object: u32) -> bool {
        self.of_object.get(object as usize).is_some_and(Option::is_some)
    }

    /// Number of pictures.
    pub(super) fn textures(&self) -> usize {
        self.textures.len()
    }

    /// The material at a hit, if it varies: `material` with its colours multiplied by those of the pictures there.
    #[inline]
    pub(super) fn material(&self, seen: &Seen<'_>, material: &Material) -> Option<Material> {
        let varied = self.of_object.get(seen.hit.object as usize)?.as_ref()?;
        Some(self.vary(varied, seen, *material))
    }

    #[inline(never)]
    fn vary(&self, varied: &VariedObject, seen: &Seen<'_>, first: Material) -> Material {
        let Seen { hit, normal, .. } = *seen;
        let faces = varied.faces.partition_point(|(start, _, _)| *start <= hit.part);
        let (mut material, pictures) = match faces.checked_sub(1).map(|face| &varied.faces[face]) {
            Some((_, material, pictures)) => (*material, *pictures),
            None => (first, varied.pictures),
        };
        if pictures.color.or(pictures.coat_color).is_none() {
            return material;
        }
        let place = match varied.mapping {
            Mapping::Ball => [libm::atan2(normal.y, normal.x) / (2.0 * PI), height(normal)],
            Mapping::Face => [hit.u, hit.v],
            Mapping::Mesh(index) => self.coordinates[index as usize].at(hit),
        };
        let extent = self.extent(varied.mapping, seen);
        let color = |texture: Option<u32>| {
            texture.map_or(Rgb::ONE, |index| self.textures[index as usize].at(place, &extent))
        };
        match &mut material {
            Material::Diffuse(diffuse) => diffuse.color *= color(pictures.color),
            Material::Reflective(reflective) => reflective.color *= color(pictures.color),
            Material::Refractive(refractive) => refractive.color *= color(pictures.color),
            Material::ClearCoat(coated) => {
                coated.base.color *= color(pictures.color);
                coated.coat.color *= color(pictures.coat_color);
            }
        }
        material
    }

    /// How much of a picture is seen.
    fn extent(&self, mapping: Mapping, &Seen { geometry, hit, normal, width }: &Seen<'_>) -> Extent {
        match mapping {
            _ if width == 0.0 => Extent::POINT,
            Mapping::Ball | Mapping::Face => Extent::on_solid(geometry, hit, normal, width),
            Mapping::Mesh(index) => match self.coordinates[index as usize].steps(hit) {
                Some(steps) => Extent::on_triangle(geometry, hit, steps, width),
                None => Extent::POINT,
            },
        }
    }
}

/// From 0 at -z to 1 at +z, evenly in the angle.
fn height(normal: DVec3) -> f64 {
    1.0 - libm::atan2(normal.x.hypot(normal.y), normal.z) / PI
}

impl MeshCoordinates {
    /// Those of the corners of a triangle; `None` where the file has none.
    fn corners(&self, hit: &Hit) -> Option<[[f64; 2]; 3]> {
        let indices = self.indices.get(hit.part as usize).filter(|indices| !indices.contains(&u32::MAX))?;
        Some(indices.map(|index| self.texcoords[index as usize].map(f64::from)))
    }

    /// By how much they change from the first corner to the second and the third.
    fn steps(&self, hit: &Hit) -> Option<[[f64; 2]; 2]> {
        let [a, b, c] = self.corners(hit)?;
        Some([b, c].map(|corner| [corner[0] - a[0], corner[1] - a[1]]))
    }

    /// The texture coordinates of a hit; the lower left corner where the file has none.
    fn at(&self, hit: &Hit) -> [f64; 2] {
        let Some([a, b, c]) = self.corners(hit) else { return [0.0; 2] };
        [0, 1].map(|i| a[i] * (1.0 - hit.u - hit.v) + b[i] * hit.u + c[i] * hit.v)
    }
}
