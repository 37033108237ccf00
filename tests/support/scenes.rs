//! Scenes for the comparison of accelerators.

use pathtracer::geometry::{Ball, Cuboid, Geometry, MeshPart, Rectangle, Shape, Solid};
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
    /// The meshes; corners and edges are targets.
    pub(crate) parts: Vec<MeshPart>,
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
        TestScene { name, geometry: Geometry::new(solids, &parts), center, size, parts }
    }
}

/// The kinds of scenes, by name.
pub(crate) const KINDS: [&str; 7] =
    ["sphere", "soup", "terrain", "duplicated faces", "T-junctions", "slivers", "mixed"];

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

fn solid(kind: u32, place: DVec3, random: &mut Random) -> Shape {
    let size = random.between(0.02, 0.2);
    let x = random.direction();
    let y = x.cross(random.direction()).normalize();
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
