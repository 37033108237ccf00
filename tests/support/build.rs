//! Small scenes built in code, and the mean of what a camera sees in them.

use pathtracer::accel::brute_force::BruteForce;
use pathtracer::error::Location;
use pathtracer::integrator::{Counters, PathTracer};
use pathtracer::math::{DVec3, Rgb};
use pathtracer::sampling::{Independent, Sampler};
use pathtracer::scene::desc::{
    ApertureDesc, Axes, CameraDesc, EnvironmentDesc, MaterialDesc, MaterialKind, MeshDesc, ObjectDesc,
    SceneDesc, ShapeDesc, TexturesDesc,
};
use pathtracer::world::World;
use rayon::prelude::*;
use std::sync::Arc;

use super::stats::Moments;

/// A grey.
pub(crate) fn grey(value: f64) -> Rgb {
    Rgb::splat(value)
}

pub(crate) fn diffuse(color: Rgb) -> MaterialKind {
    MaterialKind::Diffuse { color, emission: Rgb::ZERO }
}

pub(crate) fn glowing(color: Rgb, emission: Rgb) -> MaterialKind {
    MaterialKind::Diffuse { color, emission }
}

pub(crate) fn ball(position: DVec3, radius: f64) -> ShapeDesc {
    ShapeDesc::Ball { position, radius }
}

pub(crate) fn cuboid(position: DVec3, size: DVec3, rotation: DVec3) -> ShapeDesc {
    ShapeDesc::Box { position, size, rotation }
}

/// A horizontal square; its front is above with a turn of +90 degrees about y, below with -90.
pub(crate) fn square(position: DVec3, side: f64) -> ShapeDesc {
    ShapeDesc::Rectangle { position, width: side, height: side, rotation: DVec3::new(0.0, 90.0, 0.0) }
}

/// A mesh with coordinates as they are.
pub(crate) fn mesh(positions: Vec<[f64; 3]>, triangles: Vec<[u32; 3]>) -> ShapeDesc {
    let mesh = Arc::new(MeshDesc { positions, triangles, ..MeshDesc::default() });
    ShapeDesc::TriangleMesh {
        file: "mesh.obj".into(),
        mesh,
        scale: 1.0,
        position: DVec3::ZERO,
        rotation: DVec3::ZERO,
        axes: Axes::ZUp,
        smooth: false,
    }
}

/// A mesh at another place, larger and turned; the copies of a mesh share its triangles.
pub(crate) fn placed(shape: ShapeDesc, at: DVec3, times: f64, turn: DVec3) -> ShapeDesc {
    match shape {
        ShapeDesc::TriangleMesh { file, mesh, axes, smooth, .. } => {
            ShapeDesc::TriangleMesh { file, mesh, scale: times, position: at, rotation: turn, axes, smooth }
        }
        other => other,
    }
}

/// A scene with a black sky and a narrow camera at `eye` that looks at `target`.
pub(crate) fn scene(eye: DVec3, target: DVec3, objects: Vec<(ShapeDesc, MaterialKind)>) -> SceneDesc {
    let location = Location { file: "scene.yaml".into(), line: 1, column: 1 };
    let object = |(shape, kind)| ObjectDesc {
        name: None,
        location: location.clone(),
        shape,
        material: MaterialDesc { name: None, kind, textures: TexturesDesc::default() },
        faces: Vec::new(),
    };
    SceneDesc {
        file: "scene.yaml".into(),
        camera: CameraDesc {
            position: eye,
            looking_at: target,
            fov: 1e-9,
            focus_distance: 1.0,
            aperture: ApertureDesc::DepthOfField(0.0),
            angle: 0.0,
        },
        environment_map: None,
        environment: sky(0.0),
        objects: objects.into_iter().map(object).collect(),
    }
}

/// A light above a white floor at z = 0, seen at the origin from the side.
pub(crate) fn lit_floor(light: ShapeDesc, radiance: f64) -> SceneDesc {
    let floor = square(DVec3::ZERO, 1e-3);
    let objects = vec![(floor, diffuse(grey(1.0))), (light, glowing(grey(0.0), grey(radiance)))];
    scene(DVec3::new(-1e-4, 0.0, 1e-4), DVec3::ZERO, objects)
}

/// Changes every position and every length.
pub(crate) fn edit_lengths(
    desc: &mut SceneDesc,
    point: impl Fn(DVec3) -> DVec3,
    length: impl Fn(f64) -> f64,
) {
    desc.camera.position = point(desc.camera.position);
    desc.camera.looking_at = point(desc.camera.looking_at);
    desc.camera.focus_distance = length(desc.camera.focus_distance);
    if let ApertureDesc::Radius(radius) = &mut desc.camera.aperture {
        *radius = length(*radius);
    }
    for object in &mut desc.objects {
        match &mut object.shape {
            ShapeDesc::Ball { position, radius } => {
                (*position, *radius) = (point(*position), length(*radius));
            }
            ShapeDesc::Box { position, size, .. } => {
                (*position, *size) = (point(*position), size.map(&length));
            }
            ShapeDesc::Rectangle { position, width, height, .. } => {
                (*position, *width, *height) = (point(*position), length(*width), length(*height));
            }
            ShapeDesc::TriangleMesh { position, scale, .. } => {
                (*position, *scale) = (point(*position), length(*scale));
            }
        }
    }
}

/// A constant grey sky.
pub(crate) fn sky(value: f64) -> EnvironmentDesc {
    EnvironmentDesc { sky: grey(value), horizon: grey(value), ground: grey(value), strength: 1.0 }
}

/// How a mean is measured.
pub(crate) struct Measure {
    pub(crate) samples: u64,
    pub(crate) bounces: u32,
    pub(crate) light_sampling: bool,
}

/// Every sample of a one-pixel picture, first channel.
pub(crate) fn samples(desc: &SceneDesc, measure: &Measure) -> Vec<f64> {
    let world = World::compile(desc).expect("a valid scene");
    let camera = world.camera(&desc.camera, 1, 1);
    let accelerator = BruteForce::new(&world.geometry);
    let tracer = PathTracer::new(&world, &camera, &accelerator, measure.bounces, measure.light_sampling);
    let sampler = Independent::new(1);
    let mut counters = Counters::default();
    (0..measure.samples).map(|index| tracer.sample(&sampler, 0, 0, index, &mut counters).x).collect()
}

/// Mean and spread of the samples of [`samples`], on all cores and without keeping them; the same whatever the cores do.
pub(crate) fn moments(desc: &SceneDesc, measure: &Measure) -> Moments {
    const CHUNK: u64 = 50_000;
    let world = World::compile(desc).expect("a valid scene");
    let camera = world.camera(&desc.camera, 1, 1);
    let accelerator = BruteForce::new(&world.geometry);
    let tracer = PathTracer::new(&world, &camera, &accelerator, measure.bounces, measure.light_sampling);
    let sampler = Independent::new(1);
    let part = |chunk: u64| {
        let mut counters = Counters::default();
        let indices = chunk * CHUNK..measure.samples.min((chunk + 1) * CHUNK);
        Moments::of(indices.map(|index| tracer.sample(&sampler, 0, 0, index, &mut counters).x))
    };
    let parts: Vec<Moments> = (0..measure.samples.div_ceil(CHUNK)).into_par_iter().map(part).collect();
    parts.into_iter().fold(Moments::default(), Moments::with)
}

/// Asserts that the mean of a one-pixel picture is `expected`: within four standard errors, which must be below
/// `width` times `expected`.
pub(crate) fn assert_mean(what: &str, desc: &SceneDesc, measure: &Measure, expected: f64, width: f64) {
    assert_mean_within(what, desc, measure, expected, width, 0.0);
}

/// As [`assert_mean`], where a kind of samples has the chance and the share `rare` of the mean. If fewer than 10 of them are
/// expected (so that all of them are missing with a probability above e^-10, which does not show in the spread of the
/// others) the mean may be off by that share.
///
/// Such are the samples of a material that meet a light of the solid angle s under a cosine c by chance, s c / pi: that is
/// also the greatest share that multiple importance sampling leaves to them. Or those that miss one which fills the sky.
pub(crate) fn assert_mean_of_light(
    what: &str,
    desc: &SceneDesc,
    measure: &Measure,
    expected: f64,
    width: f64,
    rare: f64,
) {
    let unseen = rare * (measure.samples as f64) < 10.0;
    assert_mean_within(what, desc, measure, expected, width, if unseen { rare } else { 0.0 });
}

fn assert_mean_within(
    what: &str,
    desc: &SceneDesc,
    measure: &Measure,
    expected: f64,
    width: f64,
    missing: f64,
) {
    let moments = moments(desc, measure);
    let (mean, error) = (moments.mean(), moments.standard_error());
    assert!(error <= width * expected, "{what}: standard error {error:e}, allowed {:e}", width * expected);
    // Where all samples are equal their sums are still rounded.
    let allowed = 4.0 * error + (missing + 1e-12) * expected;
    assert!((mean - expected).abs() <= allowed, "{what}: mean {mean}, expected {expected}, error {error:e}");
}
