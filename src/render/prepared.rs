//! What renders of the same shapes share: the accelerator, built once.

use super::chunks::take_samples;
use super::{AccelKind, Ended, FeaturePlanes, Rendered, Settings, State, Watch, features, in_pool};
use crate::accel::bvh::Bvh;
#[cfg(feature = "embree")]
use crate::accel::embree::Embree;
use crate::accel::{Accelerator, BuildOptions};
use crate::error::Result;
use crate::geometry::Geometry;
use crate::integrator::{Counters, FeatureTracer, PathTracer};
use crate::sampling::{Independent, Sampler, SamplerKind, Sobol};
use crate::scene::desc::CameraDesc;
use crate::world::World;
use std::time::Instant;

/// An accelerator over the shapes of a world, for renders with any camera, size and number of samples, and of all worlds that
/// share the shapes.
pub struct Prepared<'g> {
    accelerator: Built<'g>,
    geometry: &'g Geometry,
    /// Those that it was built with.
    settings: Settings,
    build_seconds: f64,
}

enum Built<'g> {
    #[cfg(feature = "embree")]
    Embree(Embree<'g>),
    Native(Bvh<'g>),
}

impl<'g> Prepared<'g> {
    /// Builds what `settings` ask for.
    ///
    /// # Errors
    /// Settings that can't be; an accelerator that can't be built, such as for want of memory.
    pub fn build(geometry: &'g Geometry, settings: &Settings) -> Result<Prepared<'g>> {
        settings.check()?;
        in_pool(settings, || Prepared::build_here(geometry, settings))
    }

    /// [`Prepared::build`] in the pool that this thread is in.
    pub(super) fn build_here(geometry: &'g Geometry, settings: &Settings) -> Result<Prepared<'g>> {
        let start = Instant::now();
        let Settings { precision, isa, bvh: quality, .. } = *settings;
        let options = BuildOptions { precision, isa, quality, ..BuildOptions::default() };
        let accelerator = match settings.accel {
            #[cfg(feature = "embree")]
            AccelKind::Embree => Built::Embree(Embree::build(geometry, &options)?),
            #[cfg(not(feature = "embree"))]
            AccelKind::Embree => return Err(AccelKind::Embree.missing()),
            AccelKind::Native => Built::Native(Bvh::build(geometry, &options)?),
        };
        let build_seconds = start.elapsed().as_secs_f64();
        Ok(Prepared { accelerator, geometry, settings: settings.clone(), build_seconds })
    }

    /// Whether a render of `world` with `settings` would build the same.
    pub fn fits(&self, world: &World, settings: &Settings) -> bool {
        let with = |settings: &Settings| (settings.accel, settings.precision, settings.isa, settings.bvh);
        std::ptr::eq(self.geometry, &*world.geometry) && with(settings) == with(&self.settings)
    }

    /// As [`render`](super::render()). The world's shapes must be those of the accelerator: see [`Prepared::fits`].
    ///
    /// # Errors
    /// Settings that can't be; threads that can't be started; a bug met on the way.
    pub fn render(
        &self,
        world: &World,
        camera: &CameraDesc,
        settings: &Settings,
        watch: &dyn Watch,
    ) -> Result<Rendered> {
        settings.check()?;
        in_pool(settings, || self.render_here(world, camera, settings, watch, None))
    }

    /// [`Prepared::render`] in the pool that this thread is in, from where a checkpoint was.
    pub(super) fn render_here(
        &self,
        world: &World,
        camera: &CameraDesc,
        settings: &Settings,
        watch: &dyn Watch,
        state: Option<State>,
    ) -> Result<Rendered> {
        let run = Run { world, camera, settings, watch };
        let rendered = match &self.accelerator {
            #[cfg(feature = "embree")]
            Built::Embree(accelerator) => run.with_accel(accelerator, state),
            Built::Native(accelerator) => run.with_accel(accelerator, state),
        }?;
        Ok(Rendered { build_seconds: self.build_seconds, ..rendered })
    }

    /// Sees the first sample of every pixel without its light, some rows at once from the top, each of which `take` gets.
    /// Whether it got all of them: not if it is cancelled.
    ///
    /// # Errors
    /// As [`Prepared::render`].
    pub fn look(
        &self,
        world: &World,
        camera: &CameraDesc,
        settings: &Settings,
        watch: &dyn Watch,
        take: &mut (dyn FnMut(&FeaturePlanes) + Send),
    ) -> Result<bool> {
        settings.check()?;
        let run = Run { world, camera, settings, watch };
        in_pool(settings, || match &self.accelerator {
            #[cfg(feature = "embree")]
            Built::Embree(accelerator) => Ok(run.look(accelerator, take)),
            Built::Native(accelerator) => Ok(run.look(accelerator, take)),
        })
    }
}

/// A render on its way to its types.
struct Run<'r> {
    world: &'r World,
    camera: &'r CameraDesc,
    settings: &'r Settings,
    watch: &'r dyn Watch,
}

impl Run<'_> {
    fn with_accel<A: Accelerator>(&self, accel: &A, state: Option<State>) -> Result<Rendered> {
        let seed = self.settings.seed;
        match self.settings.sampler {
            SamplerKind::Sobol => self.with_sampler(accel, Sobol::new(seed), state),
            SamplerKind::Independent => self.with_sampler(accel, Independent::new(seed), state),
        }
    }

    fn with_sampler<A: Accelerator, S: Sampler>(
        &self,
        accel: &A,
        sampler: S,
        state: Option<State>,
    ) -> Result<Rendered> {
        let Settings { width, height, bounces, light_sampling, .. } = *self.settings;
        let camera = self.world.camera(self.camera, width, height);
        let tracer = PathTracer::new(self.world, &camera, accel, bounces, light_sampling);
        let sample = |x, y, index, counters: &mut Counters| tracer.sample(&sampler, x, y, index, counters);
        let rendered = take_samples(self.settings, self.watch, sample, state)?;
        let rendered = Rendered { brightest: self.world.brightest(), ..rendered };
        // Of the parts with the same pixels the first has the features, of all samples.
        let (range, taken) = (self.settings.chunk_range(), rendered.film.samples());
        if !self.settings.features || range.start > 0 {
            return Ok(rendered);
        }
        let tracer = FeatureTracer { world: self.world, camera: &camera, accelerator: accel };
        let start = Instant::now();
        let samples = |pixel| match &self.settings.chunks {
            Some(_) => self.settings.samples,
            // Where blocks stop, each by itself: a part has the samples that the whole picture has there.
            None if self.settings.noise.is_some() => rendered.film.samples_of(pixel),
            None => taken,
        };
        let features = features::collect(self.settings, self.watch, samples, |x, y, index| {
            tracer.sample(&sampler, x, y, index)
        })?;
        let ended = if self.watch.cancelled() { Ended::Cancelled } else { rendered.ended };
        let render_seconds = rendered.render_seconds + start.elapsed().as_secs_f64();
        Ok(Rendered { features: Some(features), ended, render_seconds, ..rendered })
    }

    fn look<A: Accelerator>(&self, accelerator: &A, take: &mut (dyn FnMut(&FeaturePlanes) + Send)) -> bool {
        let camera = self.world.camera(self.camera, self.settings.width, self.settings.height);
        let tracer = FeatureTracer { world: self.world, camera: &camera, accelerator };
        let sampler = Sobol::new(self.settings.seed);
        let see = |x, y, index| tracer.sample(&sampler, x, y, index);
        features::look(self.settings, self.watch, see, take)
    }
}
