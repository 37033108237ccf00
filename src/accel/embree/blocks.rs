//! Exact: Embree finds the boxes around blocks of triangles, the shared leaf decides.

use super::scene::{BoundingBox, Device, Queries, Scene, UserGeometry, contents, reach};
use crate::accel::BuildOptions;
use crate::accel::bvh::{Instructions, triangle_blocks};
use crate::accel::fault::{Fault, SHRINK};
use crate::error::Result;
use crate::geometry::{LocalRay, MeshSpace, ShearedRay, TriangleBlock, TriangleHit};
use crate::math::{round_down, round_up};

/// A scene of user primitives, each a block of up to eight triangles.
pub(super) struct Blocks {
    scene: Scene<'static, BlockBoxes>,
    blocks: Vec<TriangleBlock>,
    instructions: Instructions,
}

impl Blocks {
    pub(super) fn build(device: &Device, space: &MeshSpace, options: &BuildOptions) -> Result<Blocks> {
        let instructions = Instructions::choose(options.isa)?;
        let mut blocks = triangle_blocks(space, options.quality);
        let mut padding = space.frame.padding();
        if let Some(fault) = options.fault {
            fault.spoil(&mut blocks);
            // Of the frame, whose size is 1 to 2.
            padding = if fault == Fault::Padding { -f64::from(SHRINK) } else { padding };
        }
        let boxes = BlockBoxes { blocks, padding };
        let scene = Scene::of_boxes(device, &boxes, boxes.blocks.len(), &contents(space))?;
        Ok(Blocks { scene, blocks: boxes.blocks, instructions })
    }

    /// Bytes of the blocks, which are not Embree's.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&self.blocks[..])
    }

    pub(super) fn closest(&self, ray: &LocalRay) -> Option<TriangleHit> {
        let mut query = Closest {
            blocks: &self.blocks,
            ray: ShearedRay::new(ray),
            best: None,
            instructions: self.instructions,
        };
        self.scene.intersect(ray, &mut query);
        query.best
    }

    pub(super) fn any(&self, ray: &LocalRay) -> bool {
        self.scene.occluded(
            ray,
            &mut Any { blocks: &self.blocks, ray: ShearedRay::new(ray), instructions: self.instructions },
        )
    }
}

struct BlockBoxes {
    blocks: Vec<TriangleBlock>,
    padding: f64,
}

struct Closest<'q> {
    blocks: &'q [TriangleBlock],
    ray: ShearedRay<'q>,
    best: Option<TriangleHit>,
    instructions: Instructions,
}

struct Any<'q> {
    blocks: &'q [TriangleBlock],
    ray: ShearedRay<'q>,
    instructions: Instructions,
}

impl Queries for BlockBoxes {
    type Closest<'q> = Closest<'q>;
    type Any<'q> = Any<'q>;
}

impl UserGeometry for BlockBoxes {
    fn bounds(&self, primitive: u32) -> Option<BoundingBox> {
        let (low, high) = self.blocks.get(primitive as usize)?.bounds();
        let low = low.map(|x| round_down(f64::from(x) - self.padding));
        Some((low, high.map(|x| round_up(f64::from(x) + self.padding))))
    }

    #[inline(always)]
    fn closest(query: &mut Closest<'_>, primitive: u32) -> Option<f32> {
        let block = query.blocks.get(primitive as usize)?;
        let nearer = query.instructions.closest_in_block(block, &query.ray, &mut query.best);
        if nearer { query.best.map(|best| reach(best.t)) } else { None }
    }

    #[inline(always)]
    fn any(query: &mut Any<'_>, primitive: u32) -> bool {
        let block = query.blocks.get(primitive as usize);
        block.is_some_and(|block| query.instructions.any_in_block(block, &query.ray))
    }
}
