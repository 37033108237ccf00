//! What may not change a hit: the length of the direction, the order of the primitives, which hand is left.

use super::accelerators;
use crate::support::random::Random;
use crate::support::rays::rays;
use crate::support::scenes::{FAR, KINDS, TestScene, scene};
use pathtracer::accel::{Accelerator, Precision};
use pathtracer::geometry::{
    Ball, Cuboid, Geometry, Hit, Instance, MeshPart, MeshSpace, PrimitiveId, Ray, Rectangle, Shape, Solid,
};
use pathtracer::math::{DMat3, DVec3};
use std::collections::HashMap;

/// Rays of each kind of scene.
const COUNT: usize = 3000;

const PRECISIONS: [Precision; 3] = [Precision::Exact, Precision::Robust, Precision::Fast];

/// Of unit directions too, and of others.
#[test]
fn directions_times_a_power_of_two_scale_distances_exactly() {
    for kind in KINDS {
        let scene = scene(kind, FAR);
        let rays = rays(&scene, COUNT, 151);
        for accelerator in PRECISIONS.into_iter().flat_map(|p| accelerators(&scene.geometry, p)) {
            for (ray, times) in rays.iter().zip([1.0, 3.7].into_iter().cycle()) {
                let ray = Ray { direction: ray.direction * times, ..*ray };
                let hit = accelerator.intersect(&ray);
                for exponent in [-900, -30, -1, 1, 30, 900] {
                    let length = libm::ldexp(1.0, exponent);
                    let longer = Ray { direction: ray.direction * length, ..ray };
                    let expected = hit.map(|hit| Hit { t: hit.t / length, ..hit });
                    let what = format!("{kind}, {}, 2^{exponent}: {ray:?}", accelerator.name);
                    assert_eq!(accelerator.intersect(&longer), expected, "{what}");
                    let Some(hit) = hit else { continue };
                    for end in [hit.t, hit.t * (1.0 + 1e-12)] {
                        let occluded = |ray, end| accelerator.occluded(ray, end, PrimitiveId::NONE);
                        assert_eq!(occluded(&longer, end / length), occluded(&ray, end), "{what}");
                    }
                }
            }
        }
    }
}

/// What a scene is made of.
struct Parts {
    solids: Vec<Solid>,
    in_world: Vec<MeshPart>,
    shared: Vec<MeshPart>,
}

impl Parts {
    fn of(scene: &TestScene) -> Parts {
        Parts {
            solids: scene.geometry.solids.clone(),
            in_world: scene.parts[..scene.in_world].to_vec(),
            shared: scene.shared.clone(),
        }
    }

    fn geometry(self) -> Geometry {
        let spaces: Vec<MeshSpace> = self.shared.into_iter().map(|mesh| MeshSpace::new(vec![mesh])).collect();
        let with_space = |Solid { object, shape }: Solid| match shape {
            Shape::Instance(Instance { space, rotation, scale, position, .. }) => {
                let instance = Instance::new(space, &spaces[space as usize], rotation, scale, position);
                Solid { object, shape: Shape::Instance(instance) }
            }
            shape => Solid { object, shape },
        };
        let solids = self.solids.into_iter().map(with_space).collect();
        Geometry::with_instances(solids, self.in_world, spaces)
    }
}

/// The same in a mirror across the plane x = 0.
fn in_mirror(v: DVec3) -> DVec3 {
    DVec3::new(-v.x, v.y, v.z)
}

fn turn_in_mirror(m: DMat3) -> DMat3 {
    DMat3::from_cols(in_mirror(m.x_axis), in_mirror(m.y_axis), in_mirror(m.z_axis))
}

fn shape_in_mirror(shape: Shape) -> Shape {
    match shape {
        Shape::Ball(Ball { center, radius }) => Shape::Ball(Ball { center: in_mirror(center), radius }),
        Shape::Cuboid(Cuboid { center, half, rotation }) => {
            Shape::Cuboid(Cuboid { center: in_mirror(center), half, rotation: turn_in_mirror(rotation) })
        }
        Shape::Rectangle(Rectangle { center, edge_u, edge_v, .. }) => Shape::Rectangle(Rectangle::new(
            in_mirror(center),
            in_mirror(edge_u * 0.5),
            in_mirror(edge_v * 0.5),
        )),
        Shape::Instance(mut instance) => {
            instance.position = in_mirror(instance.position);
            instance.rotation = turn_in_mirror(instance.rotation);
            Shape::Instance(instance)
        }
    }
}

#[test]
fn a_mirror_changes_no_bit_of_a_hit() {
    for kind in KINDS {
        for center in [DVec3::ZERO, FAR] {
            let scene = scene(kind, center);
            let mut mirrored = Parts::of(&scene);
            mirrored.solids.iter_mut().for_each(|solid| solid.shape = shape_in_mirror(solid.shape));
            for p in mirrored.in_world.iter_mut().flat_map(|mesh| &mut mesh.positions) {
                *p = in_mirror(*p);
            }
            let mirrored = mirrored.geometry();
            let (here, there) =
                (accelerators(&scene.geometry, Precision::Exact), accelerators(&mirrored, Precision::Exact));
            for ray in rays(&scene, COUNT, 152) {
                let other = Ray::new(in_mirror(ray.origin), in_mirror(ray.direction));
                for (a, b) in here.iter().zip(&there) {
                    assert_eq!(a.intersect(&ray), b.intersect(&other), "{kind}, {}: {ray:?}", a.name);
                }
            }
        }
    }
}

/// The numbers 0 to `count` in another order.
fn shuffled(count: usize, random: &mut Random) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count as u32).collect();
    random.shuffle(&mut order);
    order
}

/// The mesh with corners and triangles in another order, and where each triangle has gone.
fn shuffle_mesh(mesh: &mut MeshPart, random: &mut Random) -> Vec<u32> {
    let corners = shuffled(mesh.positions.len(), random);
    let mut positions = mesh.positions.clone();
    for (&new, &position) in corners.iter().zip(&mesh.positions) {
        positions[new as usize] = position;
    }
    let order = shuffled(mesh.triangles.len(), random);
    let mut triangles = mesh.triangles.clone();
    for (&new, triangle) in order.iter().zip(&mesh.triangles) {
        triangles[new as usize] = triangle.map(|corner| corners[corner as usize]);
    }
    *mesh = MeshPart { object: mesh.object, positions, triangles };
    order
}

/// Shuffles objects and the triangles of meshes; returns how to name what was (object, part) before.
fn shuffle(parts: &mut Parts, random: &mut Random) -> impl Fn(u32, u32) -> (u32, u32) + use<> {
    let objects = parts.solids.iter().map(|solid| solid.object);
    let count = objects.chain(parts.in_world.iter().map(|mesh| mesh.object)).max().unwrap_or(0) + 1;
    let order = shuffled(count as usize, random);
    let mut triangles: HashMap<u32, Vec<u32>> = HashMap::new();
    let shared: Vec<Vec<u32>> = parts.shared.iter_mut().map(|mesh| shuffle_mesh(mesh, random)).collect();
    for mesh in &mut parts.in_world {
        triangles.insert(mesh.object, shuffle_mesh(mesh, random));
        mesh.object = order[mesh.object as usize];
    }
    for solid in &mut parts.solids {
        if let Shape::Instance(instance) = &solid.shape {
            triangles.insert(solid.object, shared[instance.space as usize].clone());
        }
        solid.object = order[solid.object as usize];
    }
    parts.in_world.sort_by_key(|mesh| mesh.object);
    parts.solids.sort_by_key(|solid| solid.object);
    move |object, part| {
        let part = triangles.get(&object).map_or(part, |order| order[part as usize]);
        (order[object as usize], part)
    }
}

#[test]
fn the_order_of_primitives_changes_their_names_alone() {
    let mut random = Random::new(153);
    // Without those in which surfaces coincide.
    for kind in ["sphere", "soup", "terrain", "slivers", "mixed", "instances"] {
        for center in [DVec3::ZERO, FAR] {
            let scene = scene(kind, center);
            let mut parts = Parts::of(&scene);
            // The last instance is the first once more.
            if kind == "instances" {
                parts.solids.pop();
            }
            let ordered = Parts { solids: parts.solids.clone(), ..Parts::of(&scene) }.geometry();
            let renamed = shuffle(&mut parts, &mut random);
            let other = parts.geometry();
            let (first, second) =
                (accelerators(&ordered, Precision::Exact), accelerators(&other, Precision::Exact));
            // Every third is aimed at no edge and no corner, where two triangles are met at once.
            for ray in rays(&scene, 3 * COUNT, 154).into_iter().step_by(3) {
                for (a, b) in first.iter().zip(&second) {
                    let seen = |hit: Hit| (hit.t.to_bits(), hit.u.to_bits(), hit.v.to_bits());
                    let expected = a.intersect(&ray).map(|hit| (seen(hit), renamed(hit.object, hit.part)));
                    let found = b.intersect(&ray).map(|hit| (seen(hit), (hit.object, hit.part)));
                    assert_eq!(found, expected, "{kind}, {}: {ray:?}", a.name);
                }
            }
        }
    }
}
