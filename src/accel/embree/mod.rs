//! Embree finds the candidates.
//!
//! | precision | triangles | who decides |
//! |---|---|---|
//! | exact | user geometry: boxes around blocks of up to eight triangles (`blocks`) | the shared leaf |
//! | robust | triangle geometry, `RTC_SCENE_FLAG_ROBUST` (`native`) | Embree chooses the triangle, t, u, v are computed in f64 |
//! | fast | triangle geometry, with spatial splits unless the fast build is asked for | the same |
//!
//! Solids are user geometry of a scene of their own, in their own local space (`solids`), and always exact. Instances are
//! among them, at every precision: their callback brings the ray into the space of the mesh by the shared routine and
//! traces that space's scene. Embree's own instances would transform the ray in f32.
//!
//! At exact Embree only has to enter every box whose content may be hit. It does: its node test for user geometry errs
//! by a few roundings of the largest coordinate, the boxes are widened by more ([`LocalFrame::padding`]), and after a
//! hit the search goes on a little beyond it, so that a tie is still met.
//!
//! [`LocalFrame::padding`]: crate::geometry::LocalFrame::padding

mod blocks;
mod native;
mod scene;
mod solids;

use super::bvh::Instructions;
use super::{BuildOptions, Kernel, Precision, any_abreast, closest_abreast};
use crate::error::Result;
use crate::geometry::{Geometry, Hit, LocalRay, MeshSpace, PrimitiveId, Ray, TriangleHit};
use blocks::Blocks;
use native::NativeTriangles;
use scene::Device;
use solids::Solids;

/// The accelerator that asks Embree.
pub struct Embree<'g> {
    geometry: &'g Geometry,
    /// Of every space.
    triangles: Vec<Triangles<'g>>,
    solids: Option<Solids<'g>>,
    bytes: usize,
    instructions: Instructions,
}

/// The scene over the triangles of a space.
enum Triangles<'g> {
    Exact(Blocks),
    Native(NativeTriangles<'g>),
}

impl Triangles<'_> {
    /// Bytes that are not Embree's.
    fn block_bytes(&self) -> usize {
        if let Triangles::Exact(blocks) = self { blocks.bytes() } else { 0 }
    }
}

impl<'g> Embree<'g> {
    /// Builds the scenes that `geometry` needs, on as many threads as the current rayon pool has.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::error::Error::Usage) if the machine lacks the instruction set asked for,
    /// [`Error::Unavailable`](crate::error::Error::Unavailable) if the machine lacks what Embree needs,
    /// [`Error::Accelerator`](crate::error::Error::Accelerator) with Embree's words for every other failure, such as
    /// too little memory.
    pub fn build(geometry: &'g Geometry, options: &BuildOptions) -> Result<Embree<'g>> {
        let device = Device::new(options)?;
        let instructions = Instructions::choose(options.isa)?;
        let build = |space: &'g MeshSpace| {
            Ok(match options.precision {
                Precision::Exact => Triangles::Exact(Blocks::build(&device, space, options)?),
                Precision::Robust | Precision::Fast => {
                    Triangles::Native(NativeTriangles::build(&device, space, options)?)
                }
            })
        };
        let triangles = geometry.spaces.iter().map(build).collect::<Result<Vec<_>>>()?;
        let some_solids = !geometry.tree_solids.is_empty();
        let solids = some_solids.then(|| Solids::build(&device, geometry)).transpose()?;
        let blocks: usize = triangles.iter().map(Triangles::block_bytes).sum();
        Ok(Embree { geometry, triangles, solids, bytes: device.bytes() + blocks, instructions })
    }

    /// Bytes of trees and leaves as Embree counts them, and of the blocks of exact, without the geometry's own arrays.
    pub fn bytes(&self) -> usize {
        self.bytes
    }
}

impl Kernel for Embree<'_> {
    fn geometry(&self) -> &Geometry {
        self.geometry
    }

    fn closest_triangle(&self, space: u32, ray: &LocalRay) -> Option<TriangleHit> {
        match &self.triangles[space as usize] {
            Triangles::Exact(blocks) => blocks.closest(ray),
            Triangles::Native(triangles) => triangles.closest(ray),
        }
    }

    fn any_triangle(&self, space: u32, ray: &LocalRay) -> bool {
        match &self.triangles[space as usize] {
            Triangles::Exact(blocks) => blocks.any(ray),
            Triangles::Native(triangles) => triangles.any(ray),
        }
    }

    fn closest_linear_solid(&self, ray: &Ray) -> Option<Hit> {
        closest_abreast(self, self.instructions, ray)
    }

    fn any_linear_solid(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        any_abreast(self, self.instructions, ray, t_max, target)
    }

    fn closest_solid(&self, ray: &Ray, local: &LocalRay, best: Option<Hit>) -> Option<Hit> {
        match &self.solids {
            Some(solids) => solids.closest(self, ray, local, best),
            None => best,
        }
    }

    fn any_solid(&self, ray: &Ray, local: &LocalRay, t_max: f64, target: PrimitiveId) -> bool {
        self.solids.as_ref().is_some_and(|solids| solids.any(self, ray, local, t_max, target))
    }
}
