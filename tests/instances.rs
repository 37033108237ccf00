//! Meshes that several objects name: when they are shared, and that nobody can tell from the picture.

use crate::support::build::*;
use crate::support::meshes;
use crate::support::random::Random;
use crate::support::watch::Unwatched;
use pathtracer::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use pathtracer::accel::embree::Embree;
use pathtracer::accel::{Accelerator, BuildOptions, Precision};
use pathtracer::geometry::{Geometry, Instance, MeshPart, MeshSpace, PrimitiveId, Shape, Solid};
use pathtracer::math::{DMat3, DVec3, Rgb};
use pathtracer::render::{AccelKind, Settings, render};
use pathtracer::scene::desc::{Axes, EnvironmentDesc, MeshDesc, ObjectDesc, SceneDesc, ShapeDesc};
use pathtracer::world::World;
use std::sync::Arc;

/// A bumpy sphere with normals that are not those of its faces.
fn bumpy() -> ShapeDesc {
    let MeshPart { positions, triangles, .. } = meshes::sphere(0.5, 24, 0.3, 91);
    let desc = MeshDesc {
        normals: positions.iter().map(|p| p.normalize().as_vec3().to_array()).collect(),
        positions: positions.iter().map(DVec3::to_array).collect(),
        normal_indices: triangles.clone(),
        triangles,
        ..MeshDesc::default()
    };
    ShapeDesc::TriangleMesh {
        file: "bumpy.obj".into(),
        mesh: Arc::new(desc),
        scale: 1.0,
        position: DVec3::ZERO,
        rotation: DVec3::ZERO,
        axes: Axes::YUp,
        smooth: true,
    }
}

fn with(shape: ShapeDesc, axes: Axes, smooth: bool) -> ShapeDesc {
    match shape {
        ShapeDesc::TriangleMesh { file, mesh, scale, position, rotation, .. } => {
            ShapeDesc::TriangleMesh { file, mesh, scale, position, rotation, axes, smooth }
        }
        other => other,
    }
}

/// Five copies on a floor under a gradient sky: turned, scaled, mirrored, smooth and flat.
fn five() -> SceneDesc {
    let at = |i: i32, y: f64| DVec3::new(f64::from(i % 2), y, 0.5);
    let copies = [
        placed(bumpy(), at(0, -2.0), 1.0, DVec3::ZERO),
        placed(bumpy(), at(1, -1.0), 1.5, DVec3::new(20.0, 30.0, 40.0)),
        with(placed(bumpy(), at(2, 0.0), 1.0, DVec3::new(0.0, 70.0, 0.0)), Axes::SwapYZ, true),
        with(placed(bumpy(), at(3, 1.0), 0.75, DVec3::new(-50.0, 0.0, 10.0)), Axes::ZUp, false),
        with(placed(bumpy(), at(4, 2.0), 1.0, DVec3::new(0.0, 0.0, 200.0)), Axes::SwapYZ, false),
    ];
    let mut objects = vec![(square(DVec3::ZERO, 40.0), diffuse(grey(0.5)))];
    objects.extend(copies.into_iter().map(|copy| (copy, diffuse(DVec3::new(0.8, 0.6, 0.4)))));
    let mut desc = scene(DVec3::new(-6.0, 0.0, 3.0), DVec3::new(0.0, 0.0, 0.5), objects);
    desc.camera.fov = 0.25;
    desc.environment = EnvironmentDesc {
        sky: DVec3::new(0.2, 0.5, 1.0),
        horizon: grey(0.7),
        ground: grey(0.1),
        strength: 1.0,
    };
    share(&mut desc);
    desc
}

/// Makes all meshes the same one.
fn share(desc: &mut SceneDesc) {
    let mut first: Option<Arc<MeshDesc>> = None;
    for mesh in desc.objects.iter_mut().filter_map(mesh_of) {
        *mesh = first.get_or_insert_with(|| mesh.clone()).clone();
    }
}

/// Gives every object a mesh of its own.
fn unshare(desc: &mut SceneDesc) {
    for mesh in desc.objects.iter_mut().filter_map(mesh_of) {
        *mesh = Arc::new(MeshDesc::clone(mesh));
    }
}

fn mesh_of(object: &mut ObjectDesc) -> Option<&mut Arc<MeshDesc>> {
    match &mut object.shape {
        ShapeDesc::TriangleMesh { mesh, .. } => Some(mesh),
        _ => None,
    }
}

fn picture(desc: &SceneDesc, settings: &Settings) -> Vec<Rgb> {
    let world = World::compile(desc).expect("a valid scene");
    render(&world, &desc.camera, settings, &Unwatched).expect("a render").film.means().collect()
}

fn settings(accel: AccelKind) -> Settings {
    Settings { accel, threads: Some(1), ..Settings::new(96, 48, 4, 5) }
}

fn kinds() -> Vec<AccelKind> {
    if cfg!(feature = "embree") {
        vec![AccelKind::Native, AccelKind::Embree]
    } else {
        vec![AccelKind::Native]
    }
}

#[test]
fn a_mesh_that_several_objects_show_is_there_once() {
    let shared = World::compile(&five()).expect("a valid scene");
    let triangles = shared.requires.triangles;
    assert_eq!((shared.requires.instances, shared.geometry.instanced_spaces().len()), (5, 1));
    let mut desc = five();
    unshare(&mut desc);
    let copied = World::compile(&desc).expect("a valid scene");
    assert_eq!((copied.requires.instances, copied.requires.triangles), (0, 5 * triangles));
    // Shown once, it lies in the world.
    desc.objects.truncate(2);
    let single = World::compile(&desc).expect("a valid scene");
    assert_eq!((single.requires.instances, single.requires.triangles), (0, triangles));
}

#[test]
fn meshes_that_emit_lie_in_the_world() {
    let mut desc = five();
    for object in &mut desc.objects[1..3] {
        object.material.kind = glowing(grey(0.5), grey(1.0));
    }
    let world = World::compile(&desc).expect("a valid scene");
    assert_eq!((world.requires.instances, world.requires.area_lights), (3, 2));
}

/// Corners of instances are rounded elsewhere than those of copies, by 2^-24 of the mesh: samples of few pixels change
/// sides at an edge. A wrong turn, scale, mirror or normal changes them by far more.
#[test]
fn instances_look_like_copies() {
    let instances = five();
    let mut copies = instances.clone();
    unshare(&mut copies);
    for accel in kinds() {
        let (a, b) = (picture(&instances, &settings(accel)), picture(&copies, &settings(accel)));
        let differing = a.iter().zip(&b).filter(|(a, b)| (**a - **b).abs().max_element() > 1e-4).count();
        assert!(differing <= a.len() / 500, "{accel:?}: {differing} of {} pixels differ", a.len());
    }
}

#[test]
fn accelerators_and_threads_change_no_bit_of_instances() {
    let desc = five();
    let expected = picture(&desc, &settings(AccelKind::Native));
    for accel in kinds() {
        for (threads, tile) in [(1, 8), (2, 64), (8, 16)] {
            let settings = Settings { threads: Some(threads), tile: Some(tile), ..settings(accel) };
            assert!(picture(&desc, &settings) == expected, "{accel:?}, {threads} threads");
        }
    }
}

/// Eight triangles, convex whatever is rounded.
fn octahedron(center: DVec3, size: f64) -> MeshPart {
    let positions =
        DVec3::AXES.iter().flat_map(|&axis| [axis, -axis]).map(|tip| center + tip * size).collect();
    let face = |i: u32| {
        let [x, y, z] = [i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2 & 1)];
        if i.count_ones().is_multiple_of(2) { [x, y, z] } else { [x, z, y] }
    };
    MeshPart { object: 0, positions, triangles: (0..8).map(face).collect() }
}

/// An instance of any size and place.
fn anywhere(seed: u64) -> Geometry {
    let mut random = Random::new(seed);
    let mut magnitude = || libm::pow(10.0, random.between(-6.0, 6.0));
    let (size, scale, away, origin) = (magnitude(), magnitude(), magnitude(), magnitude());
    let mesh = octahedron(random.direction() * (origin * size), size);
    let x = random.direction();
    let y = x.cross(random.direction()).normalize();
    let rotation = DMat3::from_cols(x, y, x.cross(y) * if seed.is_multiple_of(2) { 1.0 } else { -1.0 });
    let position = random.direction() * (away * size * scale);
    let space = MeshSpace::new(vec![mesh.clone()]);
    let instance = Instance::new(0, &space, rotation, scale, position);
    let solids = vec![Solid { object: 0, shape: Shape::Instance(instance) }];
    Geometry::with_instances(solids, Vec::new(), vec![space])
}

#[test]
fn rays_that_leave_an_instance_do_not_meet_it_again() {
    for seed in 0..100 {
        let geometry = anywhere(seed);
        let options = BuildOptions::default();
        let native = Bvh::build(&geometry, &options).expect("a tree");
        #[cfg(feature = "embree")]
        let embree = Embree::build(&geometry, &options).expect("a tree");
        let mut random = Random::new(1000 + seed);
        let triangles = geometry.spaces[0].triangles.len();
        for _ in 0..1000 {
            let primitive = PrimitiveId::of_instance(0, random.index(triangles) as u32);
            let (u, v) = (random.unit() * 0.5, random.unit() * 0.5);
            let point = geometry.triangle_point(primitive, u, v);
            let outward = random.direction();
            let outward = if outward.dot(point.normal) < 0.0 { -outward } else { outward };
            // From the outside nothing is met, from the inside always another triangle.
            for (direction, expected) in [(outward, false), (-outward, true)] {
                let ray = point.leave(direction);
                let hits = [
                    native.intersect(&ray),
                    #[cfg(feature = "embree")]
                    embree.intersect(&ray),
                ];
                for hit in hits {
                    assert_eq!(hit.is_some(), expected, "{seed}: {ray:?}");
                    assert!(hit.is_none_or(|hit| hit.primitive != primitive), "{seed}: {ray:?}");
                }
            }
        }
    }
}

/// 10,000 copies of 100,000 triangles: 10^9 triangles are seen, and 16 MB of mesh and its tree are held.
#[test]
fn a_billion_triangles_take_the_memory_of_one_mesh() {
    let mesh = meshes::sphere(0.5, 316, 0.1, 93);
    let seen = mesh.triangles.len() as f64 * 1e4;
    let space = MeshSpace::new(vec![mesh.clone()]);
    let solids = (0..10_000u32).map(|object| {
        let position = DVec3::new(f64::from(object % 100), f64::from(object / 100), 0.0);
        let instance = Instance::new(0, &space, DMat3::IDENTITY, 1.0, position);
        Solid { object, shape: Shape::Instance(instance) }
    });
    let solids = solids.collect();
    let geometry = Geometry::with_instances(solids, Vec::new(), vec![space]);
    assert!(seen > 9.9e8);
    let native = Bvh::build(&geometry, &BuildOptions { precision: Precision::Exact, ..Default::default() });
    let native = native.expect("a tree");
    assert_eq!(native.validate(), Ok(()));
    let held = native.bytes() + geometry.spaces[0].bytes() + size_of_val(&geometry.solids[..]);
    assert!(held < 16_000_000, "{held} bytes");
}
