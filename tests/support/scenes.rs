//! Scenes for the comparison of accelerators.

use pathtracer::geometry::{Ball, Cuboid, Geometry, Instance, MeshPart, MeshSpace, Rectangle, Shape, Solid};
use pathtracer::math::{DMat3, DVec3};

use super::meshes;
use super::random::Random;

/// A place far from the origin (Embree's test of watertightness uses it): one f32 step there is 2^-6.
pub(crate) const FAR: DVec3 = DVec3::new(148_376.0, 1234.0, -223_423.0);

/// Primitives, and what rays may be aimed at.
pub(crate) struct TestScene {
    pub(crate) name: &'static str,
    pub(crate) geometry: Geometry,
    pub(crate) center: DVec3,
    /// Half of the scene's extent.
    pub(crate) size: f64,
    /// The meshes as they are seen; corners and edges are targets.
    pub(crate) parts: Vec<MeshPart>,
    /// How many of `parts`, the first ones, lie in the world; instances show the others.
    pub(crate) in_world: usize,
    /// The meshes that have instances, in coordinates of their own.
    pub(crate) shared: Vec<MeshPart>,
}

impl TestScene {
    pub(crate) fn of_meshes(name: &'static str, parts: Vec<MeshPart>, center: DVec3) -> TestScene {
        TestScene::new(name, Vec::new(), parts, center, 1.0)
    }

    /// `parts` and `solids` lie around `center`.
    pub(crate) fn new(
        name: &'static str,
        solids: Vec<Solid>,
        parts: Vec<MeshPart>,
        center: DVec3,
        size: f64,
    ) -> TestScene {
        let (geometry, in_world) = (Geometry::new(solids, &parts), parts.len());
        TestScene { name, geometry, center, size, parts, in_world, shared: Vec::new() }
    }
}

/// The kinds of scenes, by name.
pub(crate) const KINDS: [&str; 8] =
    ["sphere", "soup", "terrain", "duplicated faces", "T-junctions", "slivers", "mixed", "instances"];

/// A scene of a kind around `center`, of some 1000 triangles.
pub(crate) fn scene(kind: &'static str, center: DVec3) -> TestScene {
    let mesh = match kind {
        "sphere" => meshes::sphere(1.0, 32, 0.05, 1),
        "soup" => meshes::soup(1000, 0.3, 2),
        "terrain" => meshes::terrain(22, 0.2, 3),
        "duplicated faces" => meshes::duplicated(meshes::terrain(12, 0.2, 4), 4, 5),
        "T-junctions" => meshes::t_junctions(40),
        "slivers" => meshes::slivers(1000, 6),
        "mixed" => return mixed(center),
        "instances" => return instances(center),
        _ => unreachable!("not a kind: {kind}"),
    };
    TestScene::of_meshes(kind, vec![meshes::moved(mesh, center)], center)
}

/// Balls, turned boxes and rectangles, many enough for a tree, with a ground ball and two meshes among them.
fn mixed(center: DVec3) -> TestScene {
    let mut random = Random::new(7);
    let mut solids = vec![Solid {
        object: 0,
        shape: Shape::Ball(Ball { center: center - DVec3::new(0.0, 0.0, 1e4 + 1.0), radius: 1e4 }),
    }];
    for object in 1..=60 {
        let place = center + random.in_cube();
        solids.push(Solid { object, shape: solid(object, place, &mut random) });
    }
    let mesh = |object, seed, by: f64| {
        let mesh = meshes::moved(meshes::sphere(0.4, 16, 0.1, seed), center + DVec3::splat(by));
        MeshPart { object, ..mesh }
    };
    TestScene::new("mixed", solids, vec![mesh(61, 8, 0.3), mesh(62, 9, -0.3)], center, 1.0)
}

/// A mesh of 100,000 triangles around `center` that stands with its lowest corner on a ball of radius 1e7.
pub(crate) fn on_a_large_ball(center: DVec3) -> TestScene {
    let mesh = meshes::moved(meshes::sphere(1.0, 318, 0.05, 1), center);
    assert!(mesh.triangles.len() >= 100_000);
    let lowest = mesh.positions.iter().min_by(|a, b| a.z.total_cmp(&b.z)).expect("a corner");
    let ball = Ball { center: *lowest - DVec3::new(0.0, 0.0, 1e7), radius: 1e7 };
    let ground = Solid { object: 0, shape: Shape::Ball(ball) };
    let mesh = MeshPart { object: 1, ..mesh };
    TestScene::new("on a large ball", vec![ground], vec![mesh], center, 1.0)
}

/// Meshes to be shown: of sizes of 3e-4 to 100, one of them far from the origin of its own coordinates. With each the scale
/// that makes it a tenth of the scene.
fn shared_meshes() -> [(MeshPart, f64); 4] {
    let sized = |mut mesh: MeshPart, size: f64| {
        mesh.positions.iter_mut().for_each(|p| *p *= size);
        (mesh, 0.1 / size)
    };
    [
        sized(meshes::sphere(1.0, 12, 0.2, 11), 1.0),
        (meshes::moved(meshes::soup(100, 0.5, 12), FAR), 0.1),
        sized(meshes::sphere(1.0, 12, 0.1, 14), 3e-4),
        sized(meshes::soup(60, 0.6, 15), 100.0),
    ]
}

/// Turned and mirrored instances of four meshes, 1e-3 to 1e3 times as large as those, among balls, boxes and rectangles and
/// a mesh that lies in the world. The last instance is the first once more.
fn instances(center: DVec3) -> TestScene {
    let mut random = Random::new(10);
    let meshes = shared_meshes();
    let spaces = meshes.iter().map(|(mesh, _)| MeshSpace::new(vec![mesh.clone()])).collect::<Vec<_>>();
    let mut parts = vec![MeshPart { object: 0, ..meshes::moved(meshes::terrain(8, 0.2, 13), center) }];
    let mut solids = Vec::new();
    for object in 1..=50 {
        let place = center + random.in_cube();
        if object % 5 == 0 {
            solids.push(Solid { object, shape: solid(object / 5, place, &mut random) });
            continue;
        }
        let mesh = object % 5 - 1;
        let (x, y) = axes(&mut random);
        let mirror = if random.unit() < 0.3 { -1.0 } else { 1.0 };
        let rotation = DMat3::from_cols(x, y, x.cross(y) * mirror);
        let (MeshPart { positions, triangles, .. }, scale) = &meshes[mesh as usize];
        let scale = scale * random.between(1.0, 3.0);
        let offset = if mesh == 1 { rotation * FAR * scale } else { DVec3::ZERO };
        let instance = Instance::new(mesh, &spaces[mesh as usize], rotation, scale, place - offset);
        let positions = positions.iter().map(|&p| instance.to_world(p)).collect();
        parts.push(MeshPart { object, positions, triangles: triangles.clone() });
        solids.push(Solid { object, shape: Shape::Instance(instance) });
    }
    solids.push(Solid { object: 51, ..solids[0] });
    let geometry = Geometry::with_instances(solids, parts[..1].to_vec(), spaces);
    let shared = meshes.map(|(mesh, _)| mesh).to_vec();
    TestScene { name: "instances", geometry, center, size: 1.0, parts, in_world: 1, shared }
}

/// Two unit vectors at a right angle.
fn axes(random: &mut Random) -> (DVec3, DVec3) {
    let x = random.direction();
    (x, x.cross(random.direction()).normalize())
}

fn solid(kind: u32, place: DVec3, random: &mut Random) -> Shape {
    let size = random.between(0.02, 0.2);
    let (x, y) = axes(random);
    match kind % 3 {
        0 => Shape::Ball(Ball { center: place, radius: size }),
        1 => Shape::Cuboid(Cuboid {
            center: place,
            half: DVec3::new(size, 0.5 * size, 0.7 * size),
            rotation: DMat3::from_cols(x, y, x.cross(y)),
        }),
        _ => Shape::Rectangle(Rectangle::new(place, x * size, y * (2.0 * size))),
    }
}
