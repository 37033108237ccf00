//! Rays aimed where accelerators fail: at edges and corners, from inside and from afar.

use pathtracer::geometry::Ray;
use pathtracer::math::DVec3;

use super::random::Random;
use super::scenes::TestScene;

/// What a ray is aimed at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Aim {
    /// A point of the scene's box.
    Anywhere,
    /// A point of an edge.
    Edge,
    /// A corner.
    Vertex,
}

/// All of them.
pub(crate) const AIMS: [Aim; 3] = [Aim::Anywhere, Aim::Edge, Aim::Vertex];

/// Distances from which rays start, in sizes of the scene; 0 is inside.
pub(crate) const DISTANCES: [f64; 4] = [0.0, 1.0, 1e2, 1e4];

/// `count` rays, with all aims and distances in turn.
pub(crate) fn rays(scene: &TestScene, count: usize, seed: u64) -> Vec<Ray> {
    let mut random = Random::new(seed);
    (0..count)
        .map(|i| {
            let (aim, distance) = (AIMS[i % 3], DISTANCES[i / 3 % 4]);
            let target = target(scene, aim, &mut random);
            let origin = if distance == 0.0 {
                scene.center + random.in_cube() * (0.5 * scene.size)
            } else {
                scene.center + random.direction() * ((1.0 + distance) * scene.size)
            };
            Ray::new(origin, (target - origin).normalize())
        })
        .collect()
}

/// A point to aim at.
pub(crate) fn target(scene: &TestScene, aim: Aim, random: &mut Random) -> DVec3 {
    if aim == Aim::Anywhere || scene.parts.is_empty() {
        return scene.center + random.in_cube() * scene.size;
    }
    let part = &scene.parts[random.index(scene.parts.len())];
    let triangle = part.triangles[random.index(part.triangles.len())];
    let first = random.index(3);
    let a = part.positions[triangle[first] as usize];
    let b = part.positions[triangle[(first + 1) % 3] as usize];
    if aim == Aim::Vertex { a } else { a.lerp(b, random.unit()) }
}
