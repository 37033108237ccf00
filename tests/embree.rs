//! Embree behind the front: the oracle's answers at exact, the promises of robust and fast, refusals, errors.

use pathtracer::accel::brute_force::BruteForce;
use pathtracer::accel::embree::Embree;
use pathtracer::accel::{Accelerator, BuildOptions, Isa, Precision};
use pathtracer::error::Error;
use pathtracer::geometry::{
    Ball, Cuboid, Geometry, Hit, MeshPart, PrimitiveId, Ray, Rectangle, Shape, Solid,
};
use pathtracer::math::{DMat3, DVec3};

/// Uniform numbers (SplitMix64).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// In the cube of side 2 around the origin.
    fn cube(&mut self) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.cube();
            if p.length_squared() <= 1.0 && p.length_squared() > 0.01 {
                return p.normalize();
            }
        }
    }
}

/// A closed bumpy sphere of `2 * rings * (rings - 1) * 2` triangles around `center`.
fn sphere(object: u32, center: DVec3, rings: usize) -> MeshPart {
    let around = 2 * rings;
    let mut mesh = MeshPart { object, ..Default::default() };
    for ring in 0..=rings {
        for step in 0..around {
            let (sin_a, cos_a) = libm::sincos(std::f64::consts::PI * ring as f64 / rings as f64);
            let (sin_b, cos_b) = libm::sincos(std::f64::consts::PI * step as f64 / rings as f64);
            let radius = 1.0 + 0.1 * libm::sin(7.0 * (ring * step % 5) as f64);
            mesh.positions.push(center + DVec3::new(sin_a * cos_b, sin_a * sin_b, cos_a) * radius);
        }
    }
    let vertex = |ring: usize, step: usize| (ring * around + step % around) as u32;
    for ring in 0..rings {
        for step in 0..around {
            let (a, b) = (vertex(ring, step), vertex(ring, step + 1));
            let (c, d) = (vertex(ring + 1, step), vertex(ring + 1, step + 1));
            mesh.triangles.push([a, c, d]);
            mesh.triangles.push([a, d, b]);
        }
    }
    // At the poles half of the triangles have no area.
    let positions = &mesh.positions;
    mesh.triangles.retain(|t| {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        (b - a).cross(c - a).length() > 1e-9
    });
    mesh
}

/// Triangles of all sizes and shapes, a third of them twice.
fn soup(object: u32, center: DVec3, count: usize, random: &mut Random) -> MeshPart {
    let mut mesh = MeshPart { object, ..Default::default() };
    for i in 0..count as u32 {
        let (middle, size) = (random.cube(), libm::exp2(-8.0 * random.unit()));
        for _ in 0..3 {
            mesh.positions.push(center + middle + random.cube() * size);
        }
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        if i % 3 == 0 {
            mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
    }
    mesh
}

/// From near and far, at points inside triangles, on edges and at corners of the mesh.
fn rays_at(mesh: &MeshPart, center: DVec3, count: usize, random: &mut Random) -> Vec<Ray> {
    let ray = |i: usize| {
        let triangle = mesh.triangles[random.below(mesh.triangles.len())];
        let [a, b, c] = triangle.map(|corner| mesh.positions[corner as usize]);
        let (u, v) = (random.unit(), random.unit());
        let target = match i % 3 {
            0 => a + (b - a) * u.min(1.0 - u) + (c - a) * v.min(1.0 - v),
            1 => a + (b - a) * u,
            _ => a,
        };
        let distance = [0.5, 3.0, 1e2, 1e4][i / 3 % 4];
        let origin = center + random.direction() * distance;
        Ray::new(origin, (target - origin).normalize())
    };
    (0..count).map(ray).collect()
}

fn options(precision: Precision, isa: Option<Isa>) -> BuildOptions {
    BuildOptions { precision, isa, ..Default::default() }
}

fn bits(hit: Option<Hit>) -> Option<([u64; 3], u32, PrimitiveId, u32)> {
    hit.map(|h| ([h.t, h.u, h.v].map(f64::to_bits), h.object, h.primitive, h.part))
}

/// Distances below, at and above the hit's.
fn limits(hit: Option<Hit>) -> [f64; 4] {
    let t = hit.map_or(1.0, |hit| hit.t);
    [t * 0.5, t, t * 1.5, f64::INFINITY]
}

fn assert_identical(geometry: &Geometry, rays: &[Ray], isa: Option<Isa>) {
    let embree = match Embree::build(geometry, &options(Precision::Exact, isa)) {
        Err(Error::Usage(message)) => return eprintln!("left out: {message}"),
        built => built.unwrap(),
    };
    let oracle = BruteForce::new(geometry);
    let mut hits = 0;
    for ray in rays {
        let expected = oracle.intersect(ray);
        assert_eq!(bits(embree.intersect(ray)), bits(expected), "{ray:?}");
        for limit in limits(expected) {
            let target = expected.map_or(PrimitiveId::NONE, |hit| hit.primitive);
            for target in [PrimitiveId::NONE, target] {
                let blocked = oracle.occluded(ray, limit, target);
                assert_eq!(embree.occluded(ray, limit, target), blocked, "{ray:?} up to {limit}");
            }
        }
        hits += usize::from(expected.is_some());
    }
    assert!(hits > rays.len() / 4, "only {hits} rays of {} hit", rays.len());
}

/// Far from the origin f32 has steps of 1/64.
const FAR: DVec3 = DVec3::new(148376.0, 1234.0, -223423.0);

#[test]
fn exact_meshes_are_hit_as_the_oracle_says() {
    let mut random = Random(1);
    for center in [DVec3::ZERO, FAR] {
        for mesh in [sphere(0, center, 24), soup(0, center, 1000, &mut random)] {
            let rays = rays_at(&mesh, center, 2400, &mut random);
            assert_identical(&Geometry::new(Vec::new(), &[mesh]), &rays, None);
        }
    }
}

#[test]
fn exact_does_not_depend_on_the_instruction_set() {
    let mut random = Random(2);
    let mesh = sphere(0, DVec3::ZERO, 12);
    let rays = rays_at(&mesh, DVec3::ZERO, 1200, &mut random);
    let geometry = Geometry::new(Vec::new(), &[mesh]);
    for isa in [Isa::Sse2, Isa::Avx2, Isa::Avx512] {
        assert_identical(&geometry, &rays, Some(isa));
    }
}

/// Balls, boxes and rectangles in turn, in a cube of side 6.
fn solids(count: u32, random: &mut Random) -> Vec<Solid> {
    let shape = |i: u32, random: &mut Random| {
        let (center, size) = (random.cube() * 3.0, 0.2 + 0.4 * random.unit());
        let rotation = DMat3::from_axis_angle(random.direction(), random.unit());
        match i % 3 {
            0 => Shape::Ball(Ball { center, radius: size }),
            1 => Shape::Cuboid(Cuboid { center, half: DVec3::new(size, 0.5 * size, 0.2), rotation }),
            _ => Shape::Rectangle(Rectangle::new(center, rotation.x_axis * size, rotation.y_axis * 0.3)),
        }
    };
    (0..count).map(|object| Solid { object, shape: shape(object, random) }).collect()
}

#[test]
fn solids_and_meshes_are_hit_as_the_oracle_says() {
    let mut random = Random(3);
    let mut all = solids(200, &mut random);
    // The same ball again: the lower object wins.
    all.push(Solid { object: 200, ..all[0] });
    let mesh = sphere(201, DVec3::ZERO, 12);
    let rays: Vec<Ray> = (0..3000).map(|_| Ray::new(random.cube() * 4.0, random.direction())).collect();
    assert_identical(&Geometry::new(all, &[mesh]), &rays, None);
}

#[test]
fn robust_and_fast_agree_with_exact_inside_triangles() {
    let mut random = Random(4);
    let mesh = sphere(0, DVec3::ZERO, 24);
    let geometry = Geometry::new(Vec::new(), std::slice::from_ref(&mesh));
    let oracle = BruteForce::new(&geometry);
    for precision in [Precision::Robust, Precision::Fast] {
        let embree = Embree::build(&geometry, &options(precision, None)).unwrap();
        for _ in 0..2000 {
            let [a, b, c] = mesh.triangles[random.below(mesh.triangles.len())]
                .map(|corner| mesh.positions[corner as usize]);
            let origin = random.cube() * 0.3;
            let target = a * 0.4 + b * 0.3 + c * 0.3;
            let ray = Ray::new(origin, (target - origin).normalize());
            assert_eq!(bits(embree.intersect(&ray)), bits(oracle.intersect(&ray)), "{precision:?} {ray:?}");
        }
    }
}

#[test]
fn robust_lets_no_ray_out_of_a_closed_mesh() {
    let mut random = Random(5);
    let mesh = sphere(0, DVec3::ZERO, 24);
    let geometry = Geometry::new(Vec::new(), std::slice::from_ref(&mesh));
    let embree = Embree::build(&geometry, &options(Precision::Robust, None)).unwrap();
    for _ in 0..20_000 {
        let origin = random.cube() * 0.3;
        let corners = mesh.triangles[random.below(mesh.triangles.len())];
        let [a, b, _] = corners.map(|corner| mesh.positions[corner as usize]);
        let on_edge = a + (b - a) * random.unit();
        let ray = Ray::new(origin, (on_edge - origin).normalize());
        assert!(embree.intersect(&ray).is_some(), "{ray:?}");
        assert!(embree.occluded(&ray, f64::INFINITY, PrimitiveId::NONE), "{ray:?}");
    }
}

#[test]
fn a_ray_never_meets_the_triangle_that_it_leaves() {
    let mut random = Random(6);
    let mesh = soup(0, FAR, 300, &mut random);
    let rays = rays_at(&mesh, FAR, 1200, &mut random);
    let geometry = Geometry::new(Vec::new(), &[mesh]);
    for precision in [Precision::Exact, Precision::Robust, Precision::Fast] {
        let embree = Embree::build(&geometry, &options(precision, None)).unwrap();
        for ray in &rays {
            let Some(hit) = embree.intersect(ray) else { continue };
            let point = geometry.surface(ray, &hit);
            for _ in 0..10 {
                let next = point.leave(random.direction());
                let again = embree.intersect(&next);
                assert_ne!(again.map(|hit| hit.primitive), Some(hit.primitive), "{precision:?} {next:?}");
                let blocked = embree.occluded(&next, f64::INFINITY, PrimitiveId::NONE);
                assert_eq!(blocked, again.is_some(), "{precision:?} {next:?}");
            }
        }
    }
}

#[test]
fn the_target_does_not_hide_itself() {
    let mut random = Random(7);
    let mesh = sphere(0, DVec3::ZERO, 12);
    let geometry = Geometry::new(Vec::new(), &[mesh]);
    for precision in [Precision::Exact, Precision::Robust, Precision::Fast] {
        let embree = Embree::build(&geometry, &options(precision, None)).unwrap();
        for _ in 0..500 {
            let ray = Ray::new(random.cube() * 0.3, random.direction());
            let hit = embree.intersect(&ray).unwrap();
            let beyond = hit.t * (1.0 + 1e-6);
            assert!(embree.occluded(&ray, beyond, PrimitiveId::NONE), "{precision:?} {ray:?}");
            assert!(!embree.occluded(&ray, hit.t * 0.999, PrimitiveId::NONE), "{precision:?} {ray:?}");
        }
        let ray = Ray::new(DVec3::ZERO, DVec3::new(0.3, 0.2, 0.9).normalize());
        let hit = embree.intersect(&ray).unwrap();
        assert!(!embree.occluded(&ray, f64::INFINITY, hit.primitive), "{precision:?}");
    }
}

#[test]
fn rays_that_are_not_finite_and_scenes_without_triangles_miss() {
    let mesh = sphere(0, DVec3::ZERO, 4);
    for geometry in [Geometry::new(Vec::new(), &[mesh]), Geometry::new(Vec::new(), &[])] {
        for precision in [Precision::Exact, Precision::Robust, Precision::Fast] {
            let embree = Embree::build(&geometry, &options(precision, None)).unwrap();
            for bad in [f64::NAN, f64::INFINITY] {
                for ray in [Ray::new(DVec3::splat(bad), -DVec3::X), Ray::new(DVec3::X, DVec3::splat(bad))] {
                    assert_eq!(embree.intersect(&ray), None, "{ray:?}");
                    assert!(!embree.occluded(&ray, f64::INFINITY, PrimitiveId::NONE), "{ray:?}");
                }
            }
        }
    }
}

/// Debian's Embree is built with assertions: it ends the program if a coordinate of a ray is above 1.8e18.
#[test]
fn rays_from_everywhere_get_an_answer() {
    let mesh = sphere(0, DVec3::ZERO, 4);
    for scale in [1.0, 1e-30, 1e-200] {
        let mut mesh = mesh.clone();
        mesh.positions.iter_mut().for_each(|p| *p *= scale);
        let geometry = Geometry::new(Vec::new(), &[mesh]);
        let mut random = Random(8);
        for precision in [Precision::Exact, Precision::Robust, Precision::Fast] {
            let embree = Embree::build(&geometry, &options(precision, None)).unwrap();
            for exponent in (-300..=300).step_by(10) {
                let origin = random.direction() * libm::pow(10.0, f64::from(exponent));
                let ray = Ray::new(origin, -origin.normalize());
                let hit = embree.intersect(&ray);
                assert_eq!(bits(BruteForce::new(&geometry).intersect(&ray)).is_some(), hit.is_some());
                embree.occluded(&ray, f64::INFINITY, PrimitiveId::NONE);
            }
        }
    }
}
