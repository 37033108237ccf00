//! Follows a render for the window: frames, progress, pauses, the end.

use super::work::Task;
use super::{BlockErrors, Frame, Look, Shared, Stage};
use crate::film::Film;
use crate::math::Rgb;
use crate::render::{FeaturePlanes, Prepared, Progress, Settings, SoFar, Watch};
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
    start: Instant,
    /// How long renders were held before this one.
    held: Duration,
    memory: Mutex<Memory>,
}

/// What is remembered from pass to pass.
struct Memory {
    told: Instant,
    shown: Option<Instant>,
    shown_samples: u64,
    look: Option<Arc<Look>>,
    /// The means after half as many samples.
    before: Option<(u64, Vec<Rgb>)>,
    errors: Option<Arc<Vec<f32>>>,
    blocks: Option<Arc<BlockErrors>>,
}

impl Memory {
    fn learn(&mut self, light: &[Rgb], errors: Vec<f32>, width: u32, samples: u64) {
        self.blocks = Some(Arc::new(BlockErrors::new(light, &errors, width, samples)));
        self.errors = Some(Arc::new(errors));
    }
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
        let (start, held) = (Instant::now(), shared.held());
        let memory = Memory {
            told: start,
            shown: None,
            shown_samples: 0,
            look,
            before: None,
            errors: None,
            blocks: None,
        };
        Follow { shared, task, prepared, settings, is_coarse, start, held, memory: Mutex::new(memory) }
    }

    fn memory(&self) -> MutexGuard<'_, Memory> {
        self.memory.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sees what there is beside the light, one sample a pixel.
    pub(super) fn look(&self) -> Option<Arc<Look>> {
        let task = self.task;
        let camera = &task.order.editable.camera;
        let mut look = Look::default();
        let mut take = |planes: &FeaturePlanes| look.add(planes);
        let is_whole = self.prepared.look(&task.world, camera, self.settings, self, &mut take);
        is_whole.unwrap_or(false).then(|| Arc::new(look))
    }

    /// Hands over a picture.
    pub(super) fn show(&self, light: Vec<Rgb>, samples: u64, film: &Film) {
        let (look, errors, blocks) = {
            let mut memory = self.memory();
            memory.shown = Some(Instant::now());
            memory.shown_samples = samples;
            if film.error_bar(0).is_some() {
                memory.learn(&light, error_bars(film), self.settings.width, samples);
            }
            (memory.look.clone(), memory.errors.clone(), memory.blocks.clone())
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
            blocks,
            counts,
            look,
            loaded: Arc::clone(&self.task.order.loaded),
            editable: Arc::clone(&self.task.order.editable),
            world: Arc::clone(&self.task.world),
        });
    }

    /// Whether a picture with so many samples was handed over last.
    pub(super) fn has_shown(&self, samples: u64) -> bool {
        self.memory().shown_samples == samples
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
            let errors = differences(light, before);
            memory.learn(light, errors, self.settings.width, samples);
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
        self.shared.wait_out_pause(self.task.job);
        let mut memory = self.memory();
        if self.is_coarse || memory.told.elapsed() < EVERY {
            return;
        }
        memory.told = Instant::now();
        drop(memory);
        let seconds = self.start.elapsed().saturating_sub(self.paused()).as_secs_f64();
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

    fn paused(&self) -> Duration {
        self.shared.held().saturating_sub(self.held)
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
