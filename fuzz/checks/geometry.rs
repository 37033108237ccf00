//! Triangles and solids through both accelerators at exact, against the oracle: the same hits to the last bit.

use pathtracer::accel::brute_force::BruteForce;
use pathtracer::accel::bvh::Bvh;
use pathtracer::accel::embree::Embree;
use pathtracer::accel::{Accelerator, BuildOptions};
use pathtracer::geometry::{
    Ball, Cuboid, Geometry, Hit, MeshPart, PrimitiveId, Ray, Rectangle, Shape, Solid,
};
use pathtracer::math::{DMat3, DVec3};
use std::path::Path;

/// The most triangles.
const MOST: usize = 64;
/// The most solids.
const MOST_SOLIDS: usize = 32;

/// Numbers made of the input's bytes: many are small and equal, so that shapes touch, and some are anything.
struct Input<'b>(&'b [u8]);

impl Input<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (&first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(first)
    }

    fn number(&mut self) -> Option<f64> {
        Some(match self.byte()? {
            kind @ 0..=199 => f64::from(kind % 20) - 10.0,
            kind @ 200..=229 => (f64::from(self.byte()?) - 128.0) * 2f64.powi(i32::from(kind) - 215),
            230..=244 => {
                let bytes = [self.byte()?, self.byte()?, self.byte()?, self.byte()?];
                let number = f64::from(f32::from_le_bytes(bytes));
                // Beyond this the scene would have been refused.
                if number.abs() < 1e15 { number } else { 0.5 }
            }
            kind => f64::from(self.byte()?) / 255.0 + f64::from(kind - 245),
        })
    }

    fn vector(&mut self) -> Option<DVec3> {
        Some(DVec3::new(self.number()?, self.number()?, self.number()?))
    }

    fn size(&mut self) -> Option<f64> {
        Some(self.number()?.abs().max(1e-3))
    }

    fn solid(&mut self, kind: u8) -> Option<Shape> {
        let center = self.vector()?;
        Some(match kind % 3 {
            0 => Shape::Ball(Ball { center, radius: self.size()? }),
            1 => {
                let half = DVec3::new(self.size()?, self.size()?, self.size()?);
                let rotation =
                    DMat3::from_rotation_z(self.number()?) * DMat3::from_rotation_x(self.number()?);
                Shape::Cuboid(Cuboid { center, half, rotation })
            }
            _ => {
                let turn = DMat3::from_rotation_y(self.number()?);
                Shape::Rectangle(Rectangle::new(
                    center,
                    turn.x_axis * self.size()?,
                    turn.y_axis * self.size()?,
                ))
            }
        })
    }
}

fn geometry(input: &mut Input<'_>) -> Option<Geometry> {
    let (triangles, solids) = (usize::from(input.byte()?) % MOST, usize::from(input.byte()?) % MOST_SOLIDS);
    let solids = (0..solids).map(|object| {
        let kind = input.byte()?;
        Some(Solid { object: object as u32, shape: input.solid(kind)? })
    });
    let solids = solids.collect::<Option<Vec<Solid>>>()?;
    let positions = (0..3 * triangles).map(|_| input.vector()).collect::<Option<Vec<DVec3>>>()?;
    // Readers drop triangles without area.
    let corners = (0..triangles as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    let has_area = |[a, b, c]: &[u32; 3]| {
        let at = |i: u32| positions[i as usize];
        (at(*b) - at(*a)).cross(at(*c) - at(*a)) != DVec3::ZERO
    };
    let triangles: Vec<[u32; 3]> = corners.filter(has_area).collect();
    let mesh = MeshPart { object: solids.len() as u32, positions, triangles };
    let meshes = if mesh.triangles.is_empty() { Vec::new() } else { vec![mesh] };
    Some(Geometry::new(solids, &meshes))
}

fn bits(hit: Option<Hit>) -> Option<(u64, u64, u64, u32, PrimitiveId)> {
    hit.map(|hit| (hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits(), hit.object, hit.primitive))
}

/// Panics where the promise is broken.
pub(crate) fn check(_: &Path, bytes: &[u8]) {
    let mut input = Input(bytes);
    let Some(geometry) = geometry(&mut input) else { return };
    let options = BuildOptions::default();
    let native = Bvh::build(&geometry, &options).expect("a tree");
    let embree = Embree::build(&geometry, &options).expect("Embree's tree");
    let oracle = BruteForce::new(&geometry);
    for _ in 0..64 {
        let (Some(origin), Some(target)) = (input.vector(), input.vector()) else { return };
        let Some(direction) = (target - origin).try_normalize() else { continue };
        let ray = Ray::new(origin, direction);
        let expected = oracle.intersect(&ray);
        let end = expected.map_or(1.0, |hit| hit.t);
        let stops = [f64::INFINITY, end].map(|end| oracle.occluded(&ray, end, PrimitiveId::NONE));
        for accelerator in [&native as &dyn Accelerator, &embree] {
            assert_eq!(bits(accelerator.intersect(&ray)), bits(expected), "{ray:?}");
            let found = [f64::INFINITY, end].map(|end| accelerator.occluded(&ray, end, PrimitiveId::NONE));
            assert_eq!(found, stops, "{ray:?}");
        }
    }
}
