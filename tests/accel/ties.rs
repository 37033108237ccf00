//! Of triangles at the same distance, the one with the lowest index is hit.

use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{Geometry, MeshPart, PrimitiveId, Ray};
use pathtracer::math::DVec3;

use super::every_isa;
use crate::support::random::Random;

/// `count` meshes of the same triangle, each an object of its own.
fn copies(count: u32) -> Geometry {
    let positions = vec![DVec3::new(-1.0, -1.0, 0.1), DVec3::new(1.0, -1.0, 0.2), DVec3::new(0.0, 1.0, 0.3)];
    let mesh = |object| MeshPart { object, positions: positions.clone(), triangles: vec![[0, 1, 2]] };
    Geometry::new(Vec::new(), &(0..count).map(mesh).collect::<Vec<_>>())
}

#[test]
fn the_lowest_of_equal_triangles_wins() {
    let mut random = Random::new(41);
    for count in [2, 3, 8, 9, 17, 64, 100, 1000] {
        let geometry = copies(count);
        for precision in [Precision::Exact, Precision::Fast] {
            for kernel in every_isa(&geometry, precision) {
                for _ in 0..200 {
                    let target = DVec3::new(random.between(-0.2, 0.2), random.between(-0.2, 0.2), 0.2);
                    let origin = random.direction() * 3.0;
                    let ray = Ray::new(origin, (target - origin).normalize());
                    // Rays almost in the plane may miss.
                    if let Some(hit) = kernel.intersect(&ray) {
                        assert_eq!((hit.object, hit.part), (0, 0), "{count} copies, {precision:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_triangle_that_the_ray_leaves_gives_way_to_its_copy() {
    let geometry = copies(20);
    let ray = Ray::new(DVec3::new(0.0, 0.0, 5.0), DVec3::new(0.0, 0.0, -1.0));
    for kernel in every_isa(&geometry, Precision::Exact) {
        let first = kernel.intersect(&ray).unwrap();
        let second = kernel.intersect(&Ray { leaving: first.primitive, ..ray }).unwrap();
        assert_eq!((first.object, second.object), (0, 1));
    }
}

#[test]
fn a_ray_that_leaves_one_of_equal_triangles_hits_none_of_them() {
    let mut random = Random::new(42);
    let geometry = copies(20);
    for precision in Precision::ALL {
        for kernel in every_isa(&geometry, precision) {
            for _ in 0..500 {
                let target = DVec3::new(random.between(-0.2, 0.2), random.between(-0.2, 0.2), 0.2);
                let origin = random.direction() * 3.0;
                let ray = Ray::new(origin, (target - origin).normalize());
                let Some(hit) = kernel.intersect(&ray) else { continue };
                let next = geometry.surface(&ray, &hit).leave(random.direction());
                assert_eq!(kernel.intersect(&next), None, "{precision:?}");
                assert!(!kernel.occluded(&next, f64::INFINITY, PrimitiveId::NONE), "{precision:?}");
            }
        }
    }
}
