//! Scenes that grow, the same on every machine.

use crate::error::Result;
use crate::math::DVec3;
use crate::scene::desc::{Axes, MeshDesc, SceneDesc, ShapeDesc};
use crate::scene::parse;
use crate::study::meshes::Family;
use crate::study::random::Random;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

/// Half the side of the square over which lights are strewn, and their heights.
const HALF: f64 = 2.0;
const HEIGHTS: [f64; 2] = [1.0, 2.0];
/// Of the lights together, in units of radiance x area.
const FLUX: f64 = 30.0;

/// A scan of about so many triangles on a floor, under a grey sky and a lamp.
pub(super) fn scan(triangles: usize, seed: u64) -> Result<SceneDesc> {
    let text = "\
Camera: { Position: [-2.6, -1.7, 1.2], LookingAt: [0, 0, 0], Fov: 0.25, FocusDistance: 3 }
Environment: { SkyColor: [0.3, 0.3, 0.3], HorizonColor: [0.3, 0.3, 0.3], GroundColor: [0.3, 0.3, 0.3] }
Objects:
  - Object: { Type: Ball, Name: mesh, Position: [0, 0, 0], Radius: 1, Material: { Type: Diffuse, Color: [0.7, 0.6, 0.5] } }
  - Object: { Type: Rectangle, Position: [0, 0, -1.1], Width: 20, Height: 20, Rotation: [0, 90, 0], Material: { Type: Diffuse, Color: [0.5, 0.5, 0.5] } }
  - Object: { Type: Rectangle, Position: [0, 0, 4], Width: 1, Height: 1, Rotation: [0, -90, 0], Material: { Type: Diffuse, EmissionStrength: 20 } }
";
    let part = Family::Scan.make(triangles, seed);
    let positions = part.positions.iter().map(DVec3::to_array).collect();
    with_mesh(text, MeshDesc { positions, triangles: part.triangles, ..MeshDesc::default() })
}

/// A ball on a floor, seen from below the lights so that none is seen directly; `lights` are the objects that shine.
fn under(lights: &str) -> String {
    format!(
        "\
Camera: {{ Position: [-1.8, 0, 0.9], LookingAt: [0.6, 0, 0], Fov: 0.25, FocusDistance: 3 }}
Environment: {{ SkyColor: [0, 0, 0], HorizonColor: [0, 0, 0], GroundColor: [0, 0, 0] }}
Objects:
  - Object: {{ Type: Rectangle, Position: [0, 0, 0], Width: 4, Height: 4, Rotation: [0, 90, 0], Material: {{ Type: Diffuse, Color: [0.6, 0.6, 0.6] }} }}
  - Object: {{ Type: Ball, Position: [0.6, 0, 0.3], Radius: 0.3, Material: {{ Type: Diffuse, Color: [0.7, 0.5, 0.4] }} }}
{lights}"
    )
}

/// A mesh of `count` small triangles that shine, strewn over the floor; all together are as bright for every count.
pub(super) fn shining_triangles(count: usize, seed: u64) -> Result<SceneDesc> {
    /// Of the longest edge.
    const EDGE: f64 = 0.01;
    let mut random = Random::new(seed);
    let mut mesh = MeshDesc::default();
    let mut area = 0.0;
    for i in 0..count as u32 {
        let corner = place(&mut random);
        let (a, b) = (random.direction() * EDGE, random.direction() * EDGE);
        mesh.positions.extend([corner, corner + a, corner + b].map(|p| p.to_array()));
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
        area += 0.5 * a.cross(b).length();
    }
    let light = format!(
        "  - Object: {{ Type: Ball, Name: mesh, Position: [0, 0, 0], Radius: 1, Material: {{ Type: Diffuse, EmissionStrength: {} }} }}\n",
        // Both sides shine.
        FLUX / (2.0 * area)
    );
    with_mesh(&under(&light), mesh)
}

/// `count` small balls that shine, strewn over the floor; all together are as bright for every count.
pub(super) fn shining_balls(count: usize, seed: u64) -> Result<SceneDesc> {
    const RADIUS: f64 = 0.005;
    let mut random = Random::new(seed);
    let strength = FLUX / (count as f64 * 4.0 * std::f64::consts::PI * RADIUS * RADIUS);
    let mut lights = String::new();
    for _ in 0..count {
        let DVec3 { x, y, z } = place(&mut random);
        // Writing to a string can't fail.
        let _ = writeln!(
            lights,
            "  - Object: {{ Type: Ball, Position: [{x}, {y}, {z}], Radius: {RADIUS}, Material: {{ Type: Diffuse, EmissionStrength: {strength} }} }}"
        );
    }
    Ok(parse(&under(&lights), Path::new("scaling.yaml"))?.desc)
}

fn place(random: &mut Random) -> DVec3 {
    let across = [random.between(-HALF, HALF), random.between(-HALF, HALF)];
    DVec3::new(across[0], across[1], random.between(HEIGHTS[0], HEIGHTS[1]))
}

/// The scene of a text whose object named `mesh` becomes a mesh.
fn with_mesh(text: &str, mesh: MeshDesc) -> Result<SceneDesc> {
    let mut desc = parse(text, Path::new("scaling.yaml"))?.desc;
    let mesh = Arc::new(mesh);
    for object in desc.objects.iter_mut().filter(|object| object.name.as_deref() == Some("mesh")) {
        object.shape = ShapeDesc::TriangleMesh {
            file: "mesh.obj".into(),
            mesh: mesh.clone(),
            scale: 1.0,
            position: DVec3::ZERO,
            rotation: DVec3::ZERO,
            axes: Axes::ZUp,
            smooth: false,
        };
    }
    Ok(desc)
}
