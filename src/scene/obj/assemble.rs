//! From the pieces of a file to one mesh of triangles.

use super::Loaded;
use super::piece::{Piece, Run};
use super::polygon::Splitter;
use crate::math::DVec3;
use crate::scene::desc::MeshDesc;
use crate::scene::digest::Digest;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Stands for the indices of a face that has none.
const NO_INDICES: [u32; 3] = [u32::MAX; 3];

/// Joins the pieces, in their order. `None` if a face names something that does not exist.
pub(super) fn assemble(mut pieces: Vec<Piece>, digest: Digest) -> Option<Loaded> {
    let lengths = pieces.iter().map(|p| [p.positions.len(), p.texcoords.len(), p.normals.len()]).collect();
    let (before, total) = running_sums(lengths);
    let mut mesh = MeshDesc {
        positions: join(pieces.iter_mut().map(|piece| std::mem::take(&mut piece.positions)).collect()),
        texcoords: join(pieces.iter_mut().map(|piece| std::mem::take(&mut piece.texcoords)).collect()),
        normals: join(pieces.iter_mut().map(|piece| std::mem::take(&mut piece.normals)).collect()),
        ..MeshDesc::default()
    };
    let libraries = pieces.iter_mut().flat_map(|piece| std::mem::take(&mut piece.libraries)).collect();
    let mut faces = Faces::room_for(&pieces);
    let outputs = faces.split(&pieces);
    let builders = pieces.into_par_iter().zip(outputs).zip(before).map(|((mut piece, output), before)| {
        piece.resolve(before, total)?;
        Some(Builder { mesh: &mesh, piece: &piece, output, made: Made::default() }.build())
    });
    let made: Vec<Made> = builders.collect::<Option<_>>()?;
    faces.close_gaps(&made);
    mesh.materials = materials(&made);
    mesh.libraries = libraries;
    drop_unused(&mut mesh.positions, &mut faces.triangles);
    drop_unused(&mut mesh.texcoords, &mut faces.texcoords);
    drop_unused(&mut mesh.normals, &mut faces.normals);
    (mesh.triangles, mesh.texcoord_indices, mesh.normal_indices) =
        (faces.triangles, faces.texcoords, faces.normals);
    let sum = |count: fn(&Made) -> usize| made.iter().map(count).sum();
    Some(Loaded { mesh, digest, dropped: sum(|made| made.dropped), fanned: sum(|made| made.fanned) })
}

/// Where materials begin, by the triangles that were made.
fn materials(made: &[Made]) -> Vec<(u32, String)> {
    let mut before = 0;
    let mut all: Vec<(u32, String)> = Vec::new();
    for made in made {
        for (triangle, name) in &made.materials {
            let start = (before + triangle) as u32;
            // One without triangles is none.
            if all.last().is_some_and(|(last, _)| *last == start) {
                all.pop();
            }
            if all.last().is_none_or(|(_, last)| last != name) {
                all.push((start, name.clone()));
            }
        }
        before += made.triangles;
    }
    if all.last().is_some_and(|(last, _)| *last == before as u32) {
        all.pop();
    }
    all
}

/// The sums of the counts before each entry, and of all.
fn running_sums(mut counts: Vec<[usize; 3]>) -> (Vec<[usize; 3]>, [usize; 3]) {
    let mut total = [0; 3];
    for counts in &mut counts {
        for (count, total) in counts.iter_mut().zip(&mut total) {
            (*count, *total) = (*total, *total + *count);
        }
    }
    (counts, total)
}

/// One after the other. Each part is freed when it has been copied.
fn join<T: Copy + Default + Send + Sync>(parts: Vec<Vec<T>>) -> Vec<T> {
    let mut whole = vec![T::default(); parts.iter().map(Vec::len).sum()];
    let mut rest = &mut whole[..];
    let places: Vec<&mut [T]> =
        parts.iter().map(|part| rest.split_off_mut(..part.len()).unwrap_or_default()).collect();
    parts.into_par_iter().zip(places).for_each(|(part, place)| place.copy_from_slice(&part));
    whole
}

/// The indices of triangles into positions, texture coordinates and normals. The last two are empty if no face gives
/// them.
#[derive(Default)]
struct Faces {
    triangles: Vec<[u32; 3]>,
    texcoords: Vec<[u32; 3]>,
    normals: Vec<[u32; 3]>,
}

/// Where the triangles of one piece go.
struct Output<'m> {
    triangles: &'m mut [[u32; 3]],
    texcoords: &'m mut [[u32; 3]],
    normals: &'m mut [[u32; 3]],
}

impl Faces {
    /// Room for all triangles of the pieces.
    fn room_for(pieces: &[Piece]) -> Faces {
        let count = pieces.iter().map(Piece::triangles).sum();
        let room = |kind: usize| {
            let is_given = pieces.iter().any(|piece| !piece.corners[kind].is_empty());
            vec![[0; 3]; if is_given { count } else { 0 }]
        };
        Faces { triangles: room(0), texcoords: room(1), normals: room(2) }
    }

    /// The room of each piece.
    fn split(&mut self, pieces: &[Piece]) -> Vec<Output<'_>> {
        let Faces { triangles, texcoords, normals } = self;
        let (mut triangles, mut texcoords, mut normals) =
            (&mut triangles[..], &mut texcoords[..], &mut normals[..]);
        let cut = |piece: &Piece| {
            let count = piece.triangles();
            Output {
                triangles: triangles.split_off_mut(..count).unwrap_or_default(),
                texcoords: texcoords.split_off_mut(..count).unwrap_or_default(),
                normals: normals.split_off_mut(..count).unwrap_or_default(),
            }
        };
        pieces.iter().map(cut).collect()
    }

    /// Removes the room that was left over because triangles were dropped, and the indices that no triangle has.
    fn close_gaps(&mut self, made: &[Made]) {
        for indices in [&mut self.triangles, &mut self.texcoords, &mut self.normals] {
            if indices.is_empty() {
                continue;
            }
            let (mut from, mut to) = (0, 0);
            for Made { triangles, room, .. } in made {
                if from != to {
                    indices.copy_within(from..from + triangles, to);
                }
                (from, to) = (from + room, to + triangles);
            }
            indices.truncate(to);
            if indices.par_iter().all(|indices| *indices == NO_INDICES) {
                indices.clear();
            }
            indices.shrink_to_fit();
        }
    }
}

/// Removes the values that no triangle uses.
fn drop_unused<T: Copy + Send + Sync>(values: &mut Vec<T>, indices: &mut [[u32; 3]]) {
    let used: Vec<AtomicBool> = values.iter().map(|_| AtomicBool::new(false)).collect();
    indices.as_flattened().par_iter().filter_map(|&index| used.get(index as usize)).for_each(|used| {
        // Threads that only read the flag of a shared vertex do not disturb each other.
        if !used.load(Relaxed) {
            used.store(true, Relaxed);
        }
    });
    let used: Vec<bool> = used.into_iter().map(AtomicBool::into_inner).collect();
    if used.iter().all(|used| *used) {
        return;
    }
    let places: Vec<u32> = used
        .iter()
        .scan(0, |kept, &used| {
            let place = *kept;
            *kept += u32::from(used);
            Some(place)
        })
        .collect();
    let mut flags = used.into_iter();
    values.retain(|_| flags.next().unwrap_or(false));
    values.shrink_to_fit();
    indices.as_flattened_mut().par_iter_mut().for_each(|index| {
        *index = places.get(*index as usize).copied().unwrap_or(*index);
    });
}

/// What became of the faces of a piece.
#[derive(Default)]
struct Made {
    /// Triangles made.
    triangles: usize,
    /// Triangles for which there was room.
    room: usize,
    /// Faces without area.
    dropped: usize,
    /// Concave faces split as if they were convex.
    fanned: usize,
    /// Where materials begin: the triangle in the piece, and the name.
    materials: Vec<(usize, String)>,
}

/// Makes the triangles of a piece.
struct Builder<'m> {
    /// The mesh without its triangles.
    mesh: &'m MeshDesc,
    piece: &'m Piece,
    output: Output<'m>,
    made: Made,
}

impl Builder<'_> {
    fn build(mut self) -> Made {
        let mut splitter = Splitter::default();
        // Where the corners of the next face start in each list of the piece.
        let mut starts = [0; 3];
        let mut materials = self.piece.materials.iter().peekable();
        for (index, run) in self.piece.runs.iter().enumerate() {
            while let Some((_, name)) = materials.next_if(|(first, _)| *first <= index) {
                self.made.materials.push((self.made.triangles, name.clone()));
            }
            let arity = run.arity as usize;
            let steps =
                [arity, if run.form.texcoords { arity } else { 0 }, if run.form.normals { arity } else { 0 }];
            for _ in 0..run.faces {
                self.add_face(run, starts, &mut splitter);
                for (start, step) in starts.iter_mut().zip(steps) {
                    *start += step;
                }
            }
        }
        self.made.materials.extend(materials.map(|(_, name)| (self.made.triangles, name.clone())));
        self.made.room = self.output.triangles.len();
        self.made
    }

    /// Appends the triangles of a face.
    fn add_face(&mut self, run: &Run, starts: [usize; 3], splitter: &mut Splitter) {
        let added = if run.arity == 3 {
            self.add_triangle([0, 1, 2], run, starts)
        } else {
            let corners: Range<usize> = starts[0]..starts[0] + run.arity as usize;
            let split = splitter.split(corners.map(|corner| self.position(corner)));
            self.made.fanned += usize::from(split.fanned);
            split.triangles.iter().filter(|triangle| self.add_triangle(**triangle, run, starts)).count() > 0
        };
        self.made.dropped += usize::from(!added);
    }

    /// Appends the triangle of three corners of a face; false if it has no area.
    fn add_triangle(&mut self, corners: [usize; 3], run: &Run, starts: [usize; 3]) -> bool {
        let [a, b, c] = corners.map(|corner| self.position(starts[0] + corner));
        if (b - a).cross(c - a) == DVec3::ZERO {
            return false;
        }
        let indices = |kind: usize| corners.map(|corner| self.piece.corners[kind][starts[kind] + corner]);
        let at = self.made.triangles;
        self.output.triangles[at] = indices(0);
        if let Some(texcoords) = self.output.texcoords.get_mut(at) {
            *texcoords = if run.form.texcoords { indices(1) } else { NO_INDICES };
        }
        if let Some(normals) = self.output.normals.get_mut(at) {
            let given = if run.form.normals { indices(2) } else { NO_INDICES };
            // A normal of length 0 has no direction.
            let has_direction = |index: &u32| self.mesh.normals.get(*index as usize) != Some(&[0.0; 3]);
            *normals = if given.iter().all(has_direction) { given } else { NO_INDICES };
        }
        self.made.triangles += 1;
        true
    }

    /// The position of a corner of the piece.
    #[inline]
    fn position(&self, corner: usize) -> DVec3 {
        DVec3::from(self.mesh.positions[self.piece.corners[0][corner] as usize])
    }
}
