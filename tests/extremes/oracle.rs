//! Hits of meshes in the world and of instances, against the same triangles in world space in double-double arithmetic:
//! what all accelerators share, the way of a ray into a mesh's space, is not taken for granted here.

use super::accelerators;
use crate::support::exact::{Meeting, Vector, corners, meeting, shown};
use crate::support::meshes;
use crate::support::random::Random;
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{Geometry, Hit, Instance, MeshPart, MeshSpace, PrimitiveId, Ray, Shape, Solid};
use pathtracer::math::{DMat3, DVec3, EPSILON};

const SCENES: u64 = 60;
const ALL_SCENES: u64 = 2000;
const RAYS: usize = 200;

/// 10^U(low, high).
fn magnitude(random: &mut Random, low: f64, high: f64) -> f64 {
    libm::pow(10.0, random.between(low, high))
}

/// A mesh of any size, anywhere in its own coordinates, and where its middle is.
fn any_mesh(random: &mut Random) -> (MeshPart, f64, DVec3) {
    let seed = random.bits();
    let mesh = match random.index(3) {
        0 => meshes::sphere(1.0, 10, 0.2, seed),
        1 => meshes::soup(60, 0.5, seed),
        _ => meshes::terrain(5, 0.4, seed),
    };
    let size = magnitude(random, -3.0, 3.0);
    let middle = random.direction() * size * magnitude(random, -2.0, 4.0);
    let positions = mesh.positions.iter().map(|&p| p * size + middle).collect();
    (MeshPart { positions, ..mesh }, size, middle)
}

fn any_rotation(random: &mut Random) -> DMat3 {
    let x = random.direction();
    let y = x.cross(random.direction()).normalize();
    DMat3::from_cols(x, y, x.cross(y) * if random.unit() < 0.5 { -1.0 } else { 1.0 })
}

/// Instances of three meshes, turned, mirrored, of sizes of 0.3 to 3, around a place; two meshes in the world among them.
fn any_scene(random: &mut Random) -> Geometry {
    let place = random.direction() * magnitude(random, -2.0, 5.0);
    let shared: Vec<_> = (0..3).map(|_| any_mesh(random)).collect();
    let spaces: Vec<MeshSpace> = shared.iter().map(|(mesh, ..)| MeshSpace::new(vec![mesh.clone()])).collect();
    let instances = (0..12).map(|object| {
        let index = random.index(shared.len());
        let (_, size, middle) = shared[index];
        let rotation = any_rotation(random);
        let scale = magnitude(random, -0.5, 0.5) / size;
        let position = place + random.in_cube() * 3.0 - rotation * middle * scale;
        let instance = Instance::new(index as u32, &spaces[index], rotation, scale, position);
        Solid { object, shape: Shape::Instance(instance) }
    });
    let solids: Vec<Solid> = instances.collect();
    let in_world = [(12, 1.0), (13, 1e-3)].map(|(object, size)| {
        let mesh = meshes::sphere(size, 10, 0.3, random.bits());
        MeshPart { object, ..meshes::moved(mesh, place + random.in_cube()) }
    });
    Geometry::with_instances(solids, in_world.to_vec(), spaces)
}

/// A triangle of a scene as it lies in the world.
struct Placed {
    primitive: PrimitiveId,
    corners: [Vector; 3],
    /// Its middle, and how far its corners are from there.
    middle: DVec3,
    radius: f64,
    /// The sizes of all numbers that take part in placing it.
    reach: f64,
}

impl Placed {
    fn new(primitive: PrimitiveId, corners: [Vector; 3], reach: f64) -> Placed {
        let rounded = corners.map(|corner| corner.to_f64());
        let middle = (rounded[0] + rounded[1] + rounded[2]) / 3.0;
        let radius = rounded.map(|corner| corner.distance(middle)).into_iter().fold(0.0, f64::max);
        Placed { primitive, corners, middle, radius, reach }
    }
}

fn norm1(v: DVec3) -> f64 {
    v.abs().element_sum()
}

/// All triangles of a scene.
fn triangles(geometry: &Geometry) -> Vec<Placed> {
    let size = |space: &MeshSpace| {
        norm1(space.frame.pivot) + norm1(space.frame.bounds.max - space.frame.bounds.min) / space.frame.scale
    };
    let count = |space: &MeshSpace| 0..space.triangles.len() as u32;
    let mut all = Vec::new();
    for (index, space) in geometry.world_spaces() {
        all.extend(count(space).map(|triangle| {
            Placed::new(PrimitiveId::triangle(index, triangle), corners(space, triangle), size(space))
        }));
    }
    for (solid, Solid { shape, .. }) in (0..).zip(&geometry.solids) {
        let Shape::Instance(instance) = shape else { continue };
        let space = geometry.space_of(instance);
        let reach = norm1(instance.position) + instance.scale * size(space);
        all.extend(count(space).map(|triangle| {
            let placed = corners(space, triangle).map(|corner| shown(instance, corner));
            Placed::new(PrimitiveId::of_instance(solid, triangle), placed, reach)
        }));
    }
    all
}

/// By how much, at most, the line and a triangle are moved against each other by roundings.
///
/// Into the space of an instance the origin is subtracted, scaled and turned, which is 1, 1 and 5 roundings (and the
/// columns of the turn are a few roundings off a right angle: 4); its pivot is subtracted, it is moved to the mesh and its
/// corners are seen from there, 1, 2 and 3; the direction is turned too, 9 roundings over the whole way. All are of
/// numbers no larger than `reach`, the origin and the way together: 26, and no more than twice as many along three axes.
fn moved(ray: &Ray, triangle: &Placed, t: f64) -> f64 {
    52.0 * EPSILON * (norm1(ray.origin) + triangle.reach + t.abs())
}

/// What double-double arithmetic says of a ray and a triangle.
struct Said {
    primitive: PrimitiveId,
    meeting: Meeting,
    /// Bound of what roundings do to t.
    error: f64,
    /// Whether the line is beyond doubt inside the triangle.
    clear: bool,
}

/// The triangles that are hit, or might be.
fn ask(ray: &Ray, triangles: &[Placed]) -> Vec<Said> {
    let near = |placed: &&Placed| {
        let to = placed.middle - ray.origin;
        let beside = to.cross(ray.direction).length();
        beside <= placed.radius * 1.01 + 1e-12 * (norm1(ray.origin) + placed.reach + norm1(to))
    };
    let said = |placed: &Placed| {
        let meeting = meeting(ray.origin, ray.direction, placed.corners)?;
        let doubt = moved(ray, placed, meeting.t);
        let clear = meeting.inside && meeting.outline > doubt;
        // Rounded normals lean by a few roundings of the product of the edges, which is in the slope.
        let error = 2.0 * doubt * meeting.slope;
        let possible = meeting.inside || meeting.outline <= doubt;
        (possible && meeting.t > -error).then_some(Said {
            primitive: placed.primitive,
            meeting,
            error,
            clear,
        })
    };
    triangles.iter().filter(near).filter_map(said).collect()
}

/// Fails if a hit is not what double-double arithmetic says. Whether it left no doubt.
fn check(what: &str, geometry: &Geometry, ray: &Ray, hit: Option<Hit>, said: &[Said]) -> bool {
    let clear = said.iter().filter(|said| said.clear && said.meeting.t > said.error);
    let first = clear.min_by(|a, b| a.meeting.t.total_cmp(&b.meeting.t));
    let Some(hit) = hit else {
        assert!(first.is_none_or(|said| said.error > said.meeting.t), "{what}: {ray:?} misses a triangle");
        return said.is_empty();
    };
    let Some(own) = said.iter().find(|said| said.primitive == hit.primitive) else {
        panic!("{what}: {ray:?} is far from {hit:?}")
    };
    let Meeting { t, point, .. } = own.meeting;
    assert!((hit.t - t).abs() <= own.error, "{what}: {ray:?}: t {} not {t} ({:e})", hit.t, own.error);
    if own.clear {
        let found = geometry.surface(ray, &hit).position;
        assert!(found.distance(point) <= 2.0 * own.error, "{what}: {ray:?}: {found} instead of {point}");
    }
    let Some(first) = first else { return false };
    assert!(t <= first.meeting.t + first.error + own.error, "{what}: {ray:?} passes through a triangle");
    // Whatever might come first is the clear one.
    let rivals = said.iter().filter(|said| said.meeting.t - said.error <= first.meeting.t + first.error);
    let single = rivals.count() == 1;
    assert!(!single || hit.primitive == first.primitive, "{what}: {ray:?}: another triangle");
    single
}

/// A ray at a triangle: anywhere, beside an edge or a corner by down to 1e-16 of it, or at those.
fn any_ray(triangles: &[Placed], random: &mut Random) -> Ray {
    let placed = &triangles[random.index(triangles.len())];
    let [a, b, c] = placed.corners.map(|corner| corner.to_f64());
    let near = |random: &mut Random| 0.5 * magnitude(random, -16.0, 0.0);
    let (u, v) = match random.index(5) {
        0 => (0.0, random.unit()),
        1 => (0.0, 0.0),
        2 => (near(random), near(random)),
        3 => (near(random), 0.5 * random.unit()),
        _ => (0.5 * random.unit(), 0.5 * random.unit()),
    };
    let target = a + (b - a) * u + (c - a) * v;
    let origin = target + random.direction() * magnitude(random, -1.0, 4.0);
    Ray::new(origin, (target - origin).normalize())
}

fn assert_agree(scenes: u64) {
    let (mut single, mut asked) = (0, 0);
    for seed in 0..scenes {
        let mut random = Random::new(1600 + seed);
        let geometry = any_scene(&mut random);
        let triangles = triangles(&geometry);
        let rays: Vec<Ray> = (0..RAYS).map(|_| any_ray(&triangles, &mut random)).collect();
        let said: Vec<Vec<Said>> = rays.iter().map(|ray| ask(ray, &triangles)).collect();
        for accelerator in accelerators(&geometry, Precision::Exact) {
            let what = format!("{seed}, {}", accelerator.name);
            for (ray, said) in rays.iter().zip(&said) {
                single += u32::from(check(&what, &geometry, ray, accelerator.intersect(ray), said));
                asked += 1;
            }
        }
    }
    assert!(2 * single > asked, "only {single} of {asked} rays were beyond doubt");
}

#[test]
fn hits_of_instances_and_meshes_are_those_of_double_double() {
    assert_agree(SCENES);
}

#[test]
#[ignore = "long: 400,000 rays against all triangles; run by `cargo test --release -- --ignored`"]
fn hits_in_2000_scenes_are_those_of_double_double() {
    assert_agree(ALL_SCENES);
}
