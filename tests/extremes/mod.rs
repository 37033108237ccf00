//! Numerical stability at the extremes. `README.md` here lists every test with its trials and what others reach.

mod accumulation;
mod balls;
mod coincident;
mod degenerate;
mod floor;
mod gaps;
mod geometry;
mod ground;
mod guards;
mod lights;
mod nothing;
mod odd_rays;
mod oracle;
mod radiance;
mod refraction;
mod reintersection;
mod room;
mod scale;
mod slivers;
mod symmetry;
mod ties;
mod watertight;

use pathtracer::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use pathtracer::accel::embree::Embree;
use pathtracer::accel::{Accelerator, BuildOptions, Precision};
use pathtracer::geometry::{Geometry, Hit, PrimitiveId, Ray};
use pathtracer::integrator::{Counters, PathTracer};
use pathtracer::math::Rgb;
use pathtracer::render::{AccelKind, Rendered, Settings, Unwatched, render};
use pathtracer::sampling::{Independent, Sampler};
use pathtracer::scene::desc::SceneDesc;
use pathtracer::world::World;

/// An accelerator with its name.
struct Named<'g> {
    name: String,
    accelerator: Box<dyn Accelerator + 'g>,
}

impl Accelerator for Named<'_> {
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.accelerator.intersect(ray)
    }

    fn occluded(&self, ray: &Ray, t_max: f64, target: PrimitiveId) -> bool {
        self.accelerator.occluded(ray, t_max, target)
    }
}

/// Both accelerators at a precision; the native one alone without Embree.
fn accelerators(geometry: &Geometry, precision: Precision) -> Vec<Named<'_>> {
    let options = BuildOptions { precision, ..Default::default() };
    let named = |name: &str, accelerator| Named { name: format!("{name} {precision:?}"), accelerator };
    vec![
        named(
            "native",
            Box::new(Bvh::build(geometry, &options).expect("a tree")) as Box<dyn Accelerator + '_>,
        ),
        #[cfg(feature = "embree")]
        named("Embree", Box::new(Embree::build(geometry, &options).expect("a tree"))),
    ]
}

/// Both accelerators at the precisions that promise to be watertight.
fn watertight_accelerators(geometry: &Geometry) -> Vec<Named<'_>> {
    [Precision::Exact, Precision::Robust].into_iter().flat_map(|p| accelerators(geometry, p)).collect()
}

/// The accelerators that renders can choose.
fn kinds() -> Vec<AccelKind> {
    if cfg!(feature = "embree") {
        vec![AccelKind::Native, AccelKind::Embree]
    } else {
        vec![AccelKind::Native]
    }
}

/// Each of them at each precision.
fn kinds_and_precisions() -> impl Iterator<Item = (AccelKind, Precision)> {
    kinds().into_iter().flat_map(|accel| Precision::ALL.map(|precision| (accel, precision)))
}

/// Settings of a small picture on one thread.
fn small(width: u32, height: u32, samples: u64, bounces: u32) -> Settings {
    let precision = Precision::Exact;
    Settings { precision, threads: Some(1), ..Settings::new(width, height, samples, bounces) }
}

fn rendered(desc: &SceneDesc, settings: &Settings) -> Rendered {
    let world = World::compile(desc).expect("a valid scene");
    render(&world, &desc.camera, settings, &Unwatched).expect("a render")
}

/// The means of all pixels of a picture without dropped samples.
fn picture(desc: &SceneDesc, settings: &Settings) -> Vec<Rgb> {
    let rendered = rendered(desc, settings);
    assert_eq!(rendered.counters.dropped, 0, "samples that are not finite");
    rendered.film.means().collect()
}

/// relMSE of the pixels' components: the mean of (x - r)^2 / (r^2 + 0.01).
fn rel_mse(pixels: &[Rgb], reference: &[Rgb]) -> f64 {
    let error = |(x, r): (&Rgb, &Rgb)| {
        let square = (*x - *r) * (*x - *r) / (*r * *r + 0.01);
        square.element_sum() / 3.0
    };
    pixels.iter().zip(reference).map(error).sum::<f64>() / reference.len() as f64
}

/// Samples of a one-pixel picture with an accelerator, first channel.
fn traced(
    world: &World,
    desc: &SceneDesc,
    accelerator: &impl Accelerator,
    samples: u64,
    bounces: u32,
) -> Vec<f64> {
    let camera = world.camera(&desc.camera, 1, 1);
    let tracer = PathTracer::new(world, &camera, accelerator, bounces, true);
    let sampler = Independent::new(3);
    let mut counters = Counters::default();
    (0..samples).map(|index| tracer.sample(&sampler, 0, 0, index, &mut counters).x).collect()
}
