//! Embree finds the candidates.
//!
//! | precision | triangles | who decides |
//! |---|---|---|
//! | exact | user geometry: boxes around blocks of up to eight triangles (`blocks`) | the shared leaf |
//! | robust | triangle geometry, `RTC_SCENE_FLAG_ROBUST` (`native`) | Embree chooses the triangle, t, u, v are computed in f64 |
//! | fast | triangle geometry, with spatial splits unless the fast build is asked for | the same |
//!
//! Solids are user geometry of a scene of their own, in their own local space (`solids`), and always exact.
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

use super::{BuildOptions, Kernel, Precision};
use crate::error::Result;
use crate::geometry::{Geometry, Hit, LocalRay, PrimitiveId, Ray, TriangleHit};
use blocks::Blocks;
use native::NativeTriangles;
use scene::Device;
use solids::Solids;

/// The accelerator that asks Embree.
pub struct Embree<'g> {
    geometry: &'g Geometry,
    triangles: Triangles<'g>,
    solids: Option<Solids<'g>>,
}

/// The scene over the triangles.
enum Triangles<'g> {
    None,
    Exact(Blocks),
    Native(NativeTriangles<'g>),
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
        let device = Device::new(options.isa)?;
        let triangles = match options.precision {
            _ if geometry.triangles.is_empty() => Triangles::None,
            Precision::Exact => Triangles::Exact(Blocks::build(&device, geometry, options)?),
            Precision::Robust | Precision::Fast => {
                Triangles::Native(NativeTriangles::build(&device, geometry, options)?)
            }
        };
        let some_solids = !geometry.tree_solids.is_empty();
        let solids = some_solids.then(|| Solids::build(&device, geometry)).transpose()?;
        Ok(Embree { geometry, triangles, solids })
    }
}

impl Kernel for Embree<'_> {
    fn geometry(&self) -> &Geometry {
        self.geometry
    }

    fn closest_triangle(&self, ray: &LocalRay) -> Option<TriangleHit> {
        match &self.triangles {
            Triangles::None => None,
            Triangles::Exact(blocks) => blocks.closest(ray),
            Triangles::Native(triangles) => triangles.closest(ray),
        }
    }

    fn any_triangle(&self, ray: &LocalRay) -> bool {
        match &self.triangles {
            Triangles::None => false,
            Triangles::Exact(blocks) => blocks.any(ray),
            Triangles::Native(triangles) => triangles.any(ray),
        }
    }

    fn closest_solid(&self, ray: &Ray, local: &LocalRay, best: Option<Hit>) -> Option<Hit> {
        match &self.solids {
            Some(solids) => solids.closest(ray, local, best),
            None => best,
        }
    }

    fn any_solid(&self, ray: &Ray, local: &LocalRay, t_max: f64, target: PrimitiveId) -> bool {
        self.solids.as_ref().is_some_and(|solids| solids.any(ray, local, t_max, target))
    }
}
