//! From the groups that `tobj` read to one mesh of triangles.

use super::Loaded;
use super::cleaner::Survey;
use super::polygon;
use super::statement::FaceForm;
use crate::math::DVec3;
use crate::scene::desc::MeshDesc;
use std::ops::Range;

/// Stands for the indices of a face that has none.
const NO_INDICES: [u32; 3] = [u32::MAX; 3];

/// Joins the groups. Vertices that several groups use are there once for each.
pub(super) fn assemble(models: Vec<tobj::Model>, survey: &Survey) -> Loaded {
    let mut loaded = Loaded::default();
    let mut forms = survey.faces.iter();
    for model in models {
        append(&mut loaded, model.mesh, &mut forms);
    }
    let mesh = &mut loaded.mesh;
    if mesh.normal_indices.iter().all(|indices| *indices == NO_INDICES) {
        (mesh.normals, mesh.normal_indices) = (Vec::new(), Vec::new());
    }
    if mesh.texcoord_indices.iter().all(|indices| *indices == NO_INDICES) {
        (mesh.texcoords, mesh.texcoord_indices) = (Vec::new(), Vec::new());
    }
    loaded
}

/// Appends a group; `forms` yields the form of each of its faces.
fn append<'f>(loaded: &mut Loaded, mut group: tobj::Mesh, forms: &mut impl Iterator<Item = &'f FaceForm>) {
    let mesh = &mut loaded.mesh;
    let bases = [mesh.positions.len(), mesh.texcoords.len(), mesh.normals.len()].map(|length| length as u32);
    let positions = std::mem::take(&mut group.positions);
    mesh.positions.extend_from_slice(positions.as_chunks().0);
    mesh.normals.extend(group.normals.as_chunks().0.iter().map(single_precision));
    mesh.texcoords.extend(group.texcoords.as_chunks().0.iter().map(|uv: &[f64; 2]| uv.map(|x| x as f32)));
    let group = Group { mesh: group, bases };
    let mut end = 0;
    for face in 0.. {
        let start = end;
        end += group.mesh.face_arities.get(face).map_or(3, |&arity| arity as usize);
        if end > group.mesh.indices.len() {
            break;
        }
        let Some(form) = forms.next() else { break };
        group.add_face(start..end, *form, loaded);
    }
}

/// A normal in f32, rescaled if it would overflow or vanish there. A normal of length 0 has no direction; nothing
/// refers to what stands for it.
fn single_precision(normal: &[f64; 3]) -> [f32; 3] {
    let near = normal.map(|x| x as f32);
    let largest = normal.iter().fold(0f64, |largest, x| largest.max(x.abs()));
    if largest == 0.0 {
        [0.0, 0.0, 1.0]
    } else if (1e-30..1e30).contains(&largest) {
        near
    } else {
        normal.map(|x| (x / largest) as f32)
    }
}

/// A group without its positions, and where its indices start in the whole mesh.
struct Group {
    mesh: tobj::Mesh,
    /// Of positions, texture coordinates and normals.
    bases: [u32; 3],
}

impl Group {
    /// Appends the triangles of the face with the given corners.
    fn add_face(&self, corners: Range<usize>, form: FaceForm, loaded: &mut Loaded) {
        let first = corners.start;
        let mesh = &mut loaded.mesh;
        let added = if corners.len() == 3 {
            self.add_triangle([first, first + 1, first + 2], form, mesh)
        } else {
            let points: Vec<DVec3> = corners.map(|corner| self.position(corner, mesh)).collect();
            let split = polygon::split(&points);
            loaded.fanned += usize::from(split.fanned);
            let add = |triangle: &[usize; 3]| self.add_triangle(triangle.map(|i| first + i), form, mesh);
            split.triangles.iter().map(add).filter(|added| *added).count() > 0
        };
        loaded.dropped += usize::from(!added);
    }

    /// Appends the triangle of three corners; false if it has no area.
    fn add_triangle(&self, corners: [usize; 3], form: FaceForm, mesh: &mut MeshDesc) -> bool {
        let [a, b, c] = corners.map(|corner| self.position(corner, mesh));
        if (b - a).cross(c - a) == DVec3::ZERO {
            return false;
        }
        let [position, texcoord, normal] = self.bases;
        let group = &self.mesh;
        mesh.triangles.push(corners.map(|corner| position + group.indices[corner]));
        let texcoords = corners.map(|corner| group.texcoord_indices.get(corner));
        mesh.texcoord_indices.push(match texcoords {
            [Some(a), Some(b), Some(c)] if form.texcoords => [a, b, c].map(|index| texcoord + index),
            _ => NO_INDICES,
        });
        let normals =
            corners.map(|corner| group.normal_indices.get(corner).filter(|&&n| self.has_direction(n)));
        mesh.normal_indices.push(match normals {
            [Some(a), Some(b), Some(c)] if form.normals => [a, b, c].map(|index| normal + index),
            _ => NO_INDICES,
        });
        true
    }

    /// The position of a corner. The group's positions stand at the end of those of the mesh.
    fn position(&self, corner: usize, mesh: &MeshDesc) -> DVec3 {
        DVec3::from(mesh.positions[(self.bases[0] + self.mesh.indices[corner]) as usize])
    }

    /// Whether a normal of the group is longer than 0.
    fn has_direction(&self, normal: u32) -> bool {
        let first = normal as usize * 3;
        self.mesh.normals.get(first..first + 3).is_some_and(|normal| normal.iter().any(|x| *x != 0.0))
    }
}
