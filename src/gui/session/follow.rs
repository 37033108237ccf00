//! Follows a render for the window: frames, progress, pauses, the end.

use super::work::Task;
use super::{Frame, Look, Shared, Stage};
use crate::film::Film;
use crate::math::Rgb;
use crate::render::{Prepared, Progress, Settings, SoFar, Watch};
use rayon::prelude::*;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The shortest time between two frames, and between two looks at the progress.
const EVERY: Duration = Duration::from_millis(30);

/// Somebody who follows one stage of a task.
pub(super) struct Follow<'f> {
    pub(super) shared: &'f Shared,
    pub(super) task: &'f Task,
    pub(super) prepared: &'f Prepared<'f>,
    pub(super) settings: &'f Settings,
    /// Whether a larger picture comes after this one.
    pub(super) is_coarse: bool,
    memory: Mutex<Memory>,
}

/// What is remembered from pass to pass.
struct Memory {
    start: Instant,
    paused: Duration,
    told: Instant,
    shown: Option<Instant>,
    look: Option<Arc<Look>>,
    /// The means after half as many samples.
    before: Option<(u64, Vec<Rgb>)>,
    errors: Option<Arc<Vec<f32>>>,
}

impl<'f> Follow<'f> {
    pub(super) fn new(
        shared: &'f Shared,
        task: &'f Task,
        prepared: &'f Prepared<'f>,
        settings: &'f Settings,
        is_coarse: bool,
        look: Option<Arc<Look>>,
    ) -> Follow<'f> {
        let start = Instant::now();
        let memory = Memory {
            start,
            paused: Duration::ZERO,
            told: start,
            shown: None,
            look,
            before: None,
            errors: None,
        };
        Follow { shared, task, prepared, settings, is_coarse, memory: Mutex::new(memory) }
    }

    fn memory(&self) -> MutexGuard<'_, Memory> {
        self.memory.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sees what there is beside the light, one sample a pixel.
    pub(super) fn look(&self) -> Option<Arc<Look>> {
        let task = self.task;
        let camera = &task.order.editable.camera;
        let planes = self.prepared.look(&task.world, camera, self.settings, 1, self).ok()?;
        (!self.cancelled()).then(|| Arc::new(Look::new(&planes)))
    }

    /// Hands over a picture.
    pub(super) fn show(&self, light: Vec<Rgb>, samples: u64, film: &Film) {
        let (look, errors) = {
            let mut memory = self.memory();
            memory.shown = Some(Instant::now());
            if film.error_bar(0).is_some() {
                memory.errors = Some(Arc::new(error_bars(film)));
            }
            (memory.look.clone(), memory.errors.clone())
        };
        let counts = self.settings.noise.map(|_| {
            (0..light.len()).map(|pixel| u32::try_from(film.samples_of(pixel)).unwrap_or(u32::MAX)).collect()
        });
        self.shared.publish(Frame {
            job: self.task.job,
            is_coarse: self.is_coarse,
            light,
            settings: self.settings.clone(),
            samples,
            errors,
            counts,
            look,
            loaded: Arc::clone(&self.task.order.loaded),
            editable: Arc::clone(&self.task.order.editable),
            world: Arc::clone(&self.task.world),
        });
    }

    fn learn_look(&self) {
        if self.memory().look.is_none()
            && let Some(look) = self.look()
        {
            self.memory().look = Some(look);
        }
    }

    /// Compares the means with those of half as many samples.
    fn learn_errors(&self, light: &[Rgb], samples: u64) {
        if !samples.is_power_of_two() || self.is_coarse {
            return;
        }
        let mut memory = self.memory();
        if let Some((half, before)) = &memory.before
            && 2 * half == samples
        {
            memory.errors = Some(Arc::new(differences(light, before)));
        }
        memory.before = Some((samples, light.to_vec()));
    }
}

/// The standard errors of all pixels.
fn error_bars(film: &Film) -> Vec<f32> {
    let of = |pixel| film.error_bar(pixel).map_or(0.0, |bar| bar.standard_error as f32);
    (0..film.pixels()).into_par_iter().map(of).collect()
}

/// Standard errors from how far the mean of all samples is from that of the first half: half of the difference of two means
/// with twice the variance, so it has the variance of the mean itself.
fn differences(all: &[Rgb], half: &[Rgb]) -> Vec<f32> {
    let apart = |(a, b): (&Rgb, &Rgb)| ((*a - *b).element_sum() / 3.0).abs() as f32;
    all.iter().zip(half).map(apart).collect()
}

impl Watch for Follow<'_> {
    fn progress(&self, progress: &Progress) {
        let paused = self.shared.wait_out_pause(self.task.job);
        let mut memory = self.memory();
        // All threads wait at the same time.
        memory.paused = memory.paused.max(paused.min(memory.start.elapsed()));
        if self.is_coarse || memory.told.elapsed() < EVERY {
            return;
        }
        memory.told = Instant::now();
        let seconds = memory.start.elapsed().saturating_sub(memory.paused).as_secs_f64();
        drop(memory);
        self.shared.tell(self.task.job, |status| {
            status.samples = progress.samples;
            status.total = progress.total;
            status.rays = progress.rays;
            status.seconds = seconds;
            status.outlook = progress.outlook;
            if status.stage == Stage::Building {
                status.stage = Stage::Rendering;
            }
        });
    }

    fn cancelled(&self) -> bool {
        self.shared.is_over(self.task.job)
    }

    fn pass(&self, so_far: &SoFar<'_>) {
        if self.cancelled() {
            return;
        }
        let samples = so_far.samples();
        let is_due = self.memory().shown.is_none_or(|shown| shown.elapsed() >= EVERY);
        let is_doubled = samples.is_power_of_two() && !self.is_coarse;
        if !is_due && !is_doubled {
            return;
        }
        let mut light = Vec::new();
        so_far.means(&mut light);
        self.learn_errors(&light, samples);
        // Of a small picture what is seen is found at once; of a large one the light is not kept waiting.
        if self.is_coarse {
            self.learn_look();
        }
        if is_due {
            self.show(light, samples, so_far.film());
        }
        self.learn_look();
    }
}
