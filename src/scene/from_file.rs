//! `Material: FromFile`: the faces of a mesh with the materials that its own files give them.

use super::desc::{MaterialDesc, MaterialKind, MeshDesc, TexturesDesc};
use super::diagnostic::{Finding, quote};
use super::mtl::{Library, Mtl};
use super::read::Context;
use super::yaml::value::Value;
use crate::error::Severity;
use crate::math::Rgb;
use crate::scene::meshes::report_fault;
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// A part of a mesh, as an object of its own.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// Its triangles.
    pub(crate) mesh: Arc<MeshDesc>,
    /// The material of the first.
    pub(crate) material: Arc<MaterialDesc>,
    /// Where other materials begin.
    pub(crate) faces: Vec<(u32, Arc<MaterialDesc>)>,
}

/// Faces before the first `usemtl`, and of meshes without.
const PLAIN: MaterialKind = MaterialKind::Diffuse { color: Rgb::splat(0.8), emission: Rgb::ZERO };

/// The mesh in the file at `path` with its materials: the dark faces together, and those of each emitting material.
/// `None` after an error.
pub(crate) fn parts(
    path: &Path,
    mesh: &Arc<MeshDesc>,
    value: Value<'_>,
    context: &mut Context<'_>,
) -> Option<Vec<Part>> {
    let library = libraries(path, mesh, value, context)?;
    let plain = Arc::new(MaterialDesc { name: None, kind: PLAIN, textures: TexturesDesc::default() });
    let mut made: HashMap<&str, Arc<MaterialDesc>> = HashMap::new();
    let mut starts: Vec<(u32, Arc<MaterialDesc>)> = Vec::new();
    if mesh.materials.first().is_none_or(|(first, _)| *first > 0) {
        starts.push((0, plain));
    }
    for (first, name) in &mesh.materials {
        if !made.contains_key(name.as_str()) {
            let Some(mtl) = library.get(name.as_str()) else {
                let text = format!(
                    " is FromFile, but {} has no material {}",
                    mesh.libraries.join(", "),
                    quote(name)
                );
                value.error(text.trim_start(), None, context.report);
                return None;
            };
            made.insert(name, Arc::new(material(mtl, path, mesh, value, context)?));
        }
        starts.push((*first, made[name.as_str()].clone()));
    }
    Some(split(mesh, &starts))
}

/// Every material of the libraries that a mesh names, by its name.
fn libraries(
    path: &Path,
    mesh: &MeshDesc,
    value: Value<'_>,
    context: &mut Context<'_>,
) -> Option<HashMap<String, Mtl>> {
    let mut all = HashMap::new();
    for name in &mesh.libraries {
        let file = path.with_file_name(name.replace('\\', "/"));
        let bytes = match fs::read(&file) {
            Ok(bytes) => bytes,
            Err(error) => {
                let shown = quote(&file.display().to_string());
                value.error(
                    &format!("is FromFile, but {shown} cannot be read: {error}"),
                    None,
                    context.report,
                );
                return None;
            }
        };
        context.meshes.add_file(file.clone(), &bytes);
        let library = Library::parse(&bytes);
        let is_good = library.faults.is_empty();
        library.faults.into_iter().for_each(|fault| report_fault(fault, &file, value, context.report));
        if !is_good {
            return None;
        }
        if !library.ignored.is_empty() {
            let shown = quote(&file.display().to_string());
            context.report.push(Finding {
                severity: Severity::Warning,
                subject: value.path.to_string(),
                text: format!(": {} of {shown} ignored", library.ignored.join(", ")),
                help: None,
                place: value.place(),
                elsewhere: None,
            });
        }
        all.extend(library.materials.into_iter().map(|material| (material.name.clone(), material)));
    }
    Some(all)
}

fn material(
    mtl: &Mtl,
    path: &Path,
    mesh: &MeshDesc,
    value: Value<'_>,
    context: &mut Context<'_>,
) -> Option<MaterialDesc> {
    let mut textures = TexturesDesc::default();
    let has_coordinates = !mesh.texcoord_indices.is_empty();
    if let Some(name) = mtl.picture.as_ref().filter(|_| !has_coordinates) {
        let (name, material) = (quote(name), quote(&mtl.name));
        context.report.push(Finding {
            severity: Severity::Warning,
            subject: value.path.to_string(),
            text: format!(
                ": the picture {name} of {material} is not used, as the mesh has no texture coordinates (vt)"
            ),
            help: None,
            place: value.place(),
            elsewhere: None,
        });
    }
    if let Some(name) = mtl.picture.as_ref().filter(|_| has_coordinates) {
        let file = path.with_file_name(name);
        match context.pictures.open(&file, None) {
            Ok(picture) => textures.color = Some(picture?),
            Err(error) => {
                let shown = quote(&file.display().to_string());
                let text = format!("is FromFile, but the picture {shown} can't be used: {error}");
                value.error(&text, None, context.report);
                return None;
            }
        }
    }
    Some(MaterialDesc { name: Some(mtl.name.clone()), kind: mtl.kind(), textures })
}

/// The dark triangles together, then those of each emitting material.
fn split(mesh: &Arc<MeshDesc>, starts: &[(u32, Arc<MaterialDesc>)]) -> Vec<Part> {
    if !starts.iter().any(|(_, material)| material.kind.emits()) {
        let (first, rest) = (&starts[0].1, &starts[1..]);
        return vec![Part { mesh: mesh.clone(), material: first.clone(), faces: rest.to_vec() }];
    }
    let ends = starts.iter().skip(1).map(|(first, _)| *first as usize).chain([mesh.triangles.len()]);
    let ranges: Vec<_> =
        starts.iter().zip(ends).map(|((first, material), end)| (*first as usize..end, material)).collect();
    let mut parts = Vec::new();
    let mut add = |chosen: &dyn Fn(&Arc<MaterialDesc>) -> bool| {
        let mut triangles = Vec::new();
        let mut faces: Vec<(u32, Arc<MaterialDesc>)> = Vec::new();
        for (range, material) in ranges.iter().filter(|(_, material)| chosen(material)) {
            if faces.last().is_none_or(|(_, last)| !Arc::ptr_eq(last, material)) {
                faces.push((triangles.len() as u32, (*material).clone()));
            }
            triangles.extend(range.clone());
        }
        if !faces.is_empty() {
            let material = faces.remove(0).1;
            parts.push(Part { mesh: Arc::new(subset(mesh, &triangles)), material, faces });
        }
    };
    add(&|material| !material.kind.emits());
    let mut seen: Vec<&Arc<MaterialDesc>> = Vec::new();
    for (_, lit) in starts.iter().filter(|(_, material)| material.kind.emits()) {
        if !seen.iter().any(|other| Arc::ptr_eq(other, lit)) {
            seen.push(lit);
            add(&|material| Arc::ptr_eq(material, lit));
        }
    }
    parts
}

/// Some triangles of a mesh, with the values that they use.
fn subset(mesh: &MeshDesc, triangles: &[usize]) -> MeshDesc {
    let (positions, corners) = used(&mesh.positions, &mesh.triangles, triangles);
    let (texcoords, texcoord_indices) = used(&mesh.texcoords, &mesh.texcoord_indices, triangles);
    let (normals, normal_indices) = used(&mesh.normals, &mesh.normal_indices, triangles);
    MeshDesc {
        positions,
        texcoords,
        normals,
        triangles: corners,
        texcoord_indices,
        normal_indices,
        ..MeshDesc::default()
    }
}

/// The values that some triangles use, in the order of their use, and the triangles' indices into them.
fn used<T: Copy>(values: &[T], indices: &[[u32; 3]], triangles: &[usize]) -> (Vec<T>, Vec<[u32; 3]>) {
    let mut places = vec![u32::MAX; values.len()];
    let mut kept = Vec::new();
    let chosen = triangles.iter().filter_map(|&triangle| indices.get(triangle));
    let indices = chosen.map(|corners| {
        corners.map(|corner| {
            let Some(place) = places.get_mut(corner as usize) else { return corner };
            if *place == u32::MAX {
                *place = kept.len() as u32;
                kept.push(values[corner as usize]);
            }
            *place
        })
    });
    let indices = indices.collect();
    (kept, indices)
}
