//! Nanoseconds a ray, printed and not asserted: `cargo test --release speed -- --ignored --nocapture` on an idle machine.
//! One thread; accelerators and precisions take turns, medians of all rounds.

#[cfg(feature = "embree")]
mod alone;
#[cfg(feature = "embree")]
mod bare;

use crate::support::meshes;
use crate::support::random::Random;
use pathtracer::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use pathtracer::accel::embree::Embree;
use pathtracer::accel::{Accelerator, BuildOptions, Precision};
use pathtracer::geometry::{Ball, Geometry, MeshPart, PrimitiveId, Ray, Shape, Solid};
use pathtracer::math::DVec3;
use std::hint::black_box;
use std::time::Instant;

const ROUNDS: usize = 7;
const RAYS: usize = 200_000;

/// An accelerator behind one type, and what it is called.
type Named<'g> = (String, Box<dyn Accelerator + 'g>);

/// A noisy sphere of about 100,000 triangles.
fn noisy_sphere() -> MeshPart {
    meshes::sphere(1.0, 316, 0.05, 1)
}

/// The sphere, maybe standing on a ball of radius 1e7.
fn geometry(on_a_ball: bool) -> Geometry {
    let ground = Solid {
        object: 0,
        shape: Shape::Ball(Ball { center: DVec3::new(0.0, 0.0, -1e7 - 1.1), radius: 1e7 }),
    };
    let mesh = MeshPart { object: 1, ..noisy_sphere() };
    Geometry::new(if on_a_ball { vec![ground] } else { Vec::new() }, &[mesh])
}

/// Chords of the sphere around the mesh.
fn chords() -> Vec<Ray> {
    let mut random = Random::new(3);
    let mut chord = || {
        let from = random.direction() * 1.2;
        Ray::new(from, (random.direction() * 1.2 - from).normalize())
    };
    (0..RAYS).map(|_| chord()).collect()
}

fn accelerators(geometry: &Geometry) -> Vec<Named<'_>> {
    let mut all: Vec<Named<'_>> = Vec::new();
    for (name, precision) in
        [("exact", Precision::Exact), ("robust", Precision::Robust), ("fast", Precision::Fast)]
    {
        let options = BuildOptions { precision, ..Default::default() };
        let native = Bvh::build(geometry, &options).expect("a tree");
        all.push((format!("native {name}"), Box::new(native)));
        #[cfg(feature = "embree")]
        {
            let embree = Embree::build(geometry, &options).expect("a scene");
            all.push((format!("embree {name}"), Box::new(embree)));
        }
    }
    all
}

/// Rays with the same origins whose directions have components of 0, -0, 1e-30 and 1e30, and whose numbers are not finite.
fn odd() -> [(&'static str, Vec<Ray>); 2] {
    let mut random = Random::new(4);
    let mut with = |components: &[f64]| {
        let mut pick = || components[random.index(components.len())];
        chords().iter().map(|ray| Ray::new(ray.origin, DVec3::new(pick(), pick(), pick()))).collect()
    };
    [
        ("odd", with(&[0.0, -0.0, 1e-30, -1e-30, 1.0, -1.0, 1e30, -1e30])),
        ("not finite", with(&[f64::NAN, f64::INFINITY, f64::NEG_INFINITY])),
    ]
}

/// Nanoseconds a ray for the closest and for any hit.
fn measure(accelerator: &dyn Accelerator, rays: &[Ray]) -> [f64; 2] {
    let per_ray = |start: Instant| start.elapsed().as_secs_f64() * 1e9 / rays.len() as f64;
    let start = Instant::now();
    rays.iter().for_each(|ray| {
        black_box(accelerator.intersect(ray));
    });
    let closest = per_ray(start);
    let start = Instant::now();
    rays.iter().for_each(|ray| {
        black_box(accelerator.occluded(ray, f64::INFINITY, PrimitiveId::NONE));
    });
    [closest, per_ray(start)]
}

fn median(times: &[[f64; 2]], which: usize) -> f64 {
    let mut values: Vec<f64> = times.iter().map(|time| time[which]).collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
#[ignore = "a measurement"]
fn nanoseconds_a_ray() {
    let rays = chords();
    for on_a_ball in [false, true] {
        let geometry = geometry(on_a_ball);
        let all = accelerators(&geometry);
        let mut times = vec![Vec::new(); all.len()];
        for _ in 0..ROUNDS {
            for ((_, accelerator), times) in all.iter().zip(&mut times) {
                times.push(measure(accelerator.as_ref(), &rays));
            }
        }
        println!("{} triangles, on a ball of radius 1e7: {on_a_ball}", geometry.spaces[0].triangles.len());
        for ((name, _), times) in all.iter().zip(&times) {
            println!("{name:14} closest {:6.0} ns  any {:6.0} ns", median(times, 0), median(times, 1));
        }
    }
}

/// The time of odd rays over that of ordinary ones, whose divisions by zero and denormal numbers might be slow.
#[test]
#[ignore = "a measurement"]
fn odd_rays_over_ordinary_ones() {
    let ordinary = chords();
    let geometry = geometry(false);
    for (what, rays) in odd() {
        for (name, accelerator) in accelerators(&geometry) {
            let mut ratios = Vec::new();
            for _ in 0..ROUNDS {
                let [odd, other] = [&rays, &ordinary].map(|rays| measure(accelerator.as_ref(), rays));
                ratios.push([odd[0] / other[0], odd[1] / other[1]]);
            }
            let [closest, any] = [0, 1].map(|which| median(&ratios, which));
            println!("{what:10} {name:14} closest {closest:.2}  any {any:.2}");
        }
    }
}
