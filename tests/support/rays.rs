//! Rays aimed where accelerators fail: at edges, corners and outlines, from inside and from afar.

use pathtracer::geometry::{Ball, Ray, Shape};
use pathtracer::math::DVec3;

use super::random::Random;
use super::scenes::TestScene;

/// What a ray is aimed at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Aim {
    /// A point of the scene's box.
    Anywhere,
    /// A point of an edge, or of a ball's outline.
    Edge,
    /// A corner, or a point of a ball's outline.
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
            let origin = if distance == 0.0 {
                scene.center + random.in_cube() * (0.5 * scene.size)
            } else {
                scene.center + random.direction() * ((1.0 + distance) * scene.size)
            };
            Ray::new(origin, (target(scene, aim, origin, &mut random) - origin).normalize())
        })
        .collect()
}

/// A point to aim at from `origin`: of meshes and of bodies in turn where there are both. Instances are meshes here.
pub(crate) fn target(scene: &TestScene, aim: Aim, origin: DVec3, random: &mut Random) -> DVec3 {
    let solids = &scene.geometry.solids;
    let of_body = scene.parts.is_empty() || !solids.is_empty() && random.unit() < 0.5;
    if aim != Aim::Anywhere && of_body && !solids.is_empty() {
        let place = random.index(solids.len());
        if let Some(target) = of_solid(&solids[place].shape, aim, origin, random) {
            return target;
        }
    }
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

/// A corner, or a point of an edge or of the diagonal of a rectangle, or of the outline of a ball.
fn of_solid(shape: &Shape, aim: Aim, origin: DVec3, random: &mut Random) -> Option<DVec3> {
    let mut corner = random.in_cube().signum();
    let edge = aim == Aim::Edge;
    match shape {
        Shape::Ball(ball) => Some(outline(ball, origin, random)),
        Shape::Cuboid(cuboid) => {
            if edge {
                corner[random.index(3)] = random.between(-1.0, 1.0);
            }
            Some(cuboid.center + cuboid.rotation * (corner * cuboid.half))
        }
        Shape::Rectangle(rectangle) => {
            let (mut u, mut v) = (0.5 + 0.5 * corner.x, 0.5 + 0.5 * corner.y);
            if edge {
                let along = random.unit();
                match random.index(3) {
                    0 => u = along,
                    1 => v = along,
                    _ => (u, v) = (along, along),
                }
            }
            Some(rectangle.center + rectangle.offset_at(u, v))
        }
        Shape::Instance(_) => None,
    }
}

/// A point where a ray from `origin` touches a ball; from inside, any point of it.
fn outline(ball: &Ball, origin: DVec3, random: &mut Random) -> DVec3 {
    let to = ball.center - origin;
    let sin = ball.radius / to.length();
    if sin >= 1.0 {
        return ball.center + random.direction() * ball.radius;
    }
    let axis = to.normalize();
    let across = axis.cross(random.direction()).normalize();
    ball.center + (across * ((1.0 - sin) * (1.0 + sin)).sqrt() - axis * sin) * ball.radius
}
