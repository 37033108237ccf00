//! The thread that takes orders.

use super::follow::Follow;
use super::{Order, Purpose, Shared, Stage, Status};
use crate::accel::BvhQuality;
use crate::error::{Diagnostic, Error, Result};
use crate::geometry::Geometry;
use crate::output::{Provenance, Rescue, Target, Wanted};
use crate::picture::Destination;
use crate::render::{AccelKind, Ended, Origin, Prepared, Recipe, Rendered, Settings, View, in_pool};
use crate::scene::edit::{self, Editable};
use crate::scene::{self, Digest};
use crate::world::World;
use std::sync::Arc;

/// The time that the first picture may take, in seconds, on top of what comes before it.
const FIRST_PICTURE: f64 = 0.03;
/// The fewest pixels of a picture that comes first.
const FEWEST_PIXELS: f64 = 2000.0;
/// So many triangles are worth a tree for the first pictures alone.
const MANY_TRIANGLES: usize = 10_000;
/// Samples a second that are expected before any are taken.
const EXPECTED_RATE: f64 = 300_000.0;

/// An order, ready to be rendered.
pub(super) struct Task {
    pub(super) job: u64,
    pub(super) order: Order,
    pub(super) world: Arc<World>,
    /// Of the scene with its edits; only a final render needs it.
    digest: Option<Digest>,
    /// Warnings of the world, as it was when its shapes or materials last changed.
    guards: Vec<Diagnostic>,
    /// Whether its smaller pictures have been shown.
    is_seen: bool,
}

/// Takes orders until the end.
pub(super) fn serve(shared: &Shared) {
    let mut rate = EXPECTED_RATE;
    let mut next = next_task(shared, None);
    while let Some(task) = next {
        let geometry: Arc<Geometry> = Arc::clone(&task.world.geometry);
        next = serve_shapes(shared, &geometry, task, &mut rate);
    }
}

/// Takes orders over some shapes; the first over others.
fn serve_shapes(shared: &Shared, geometry: &Geometry, mut task: Task, rate: &mut f64) -> Option<Task> {
    if let Err(error) = hurry(shared, geometry, &mut task, rate) {
        return failed(shared, &task, error);
    }
    if !shared.is_newest(task.job) {
        // Nobody waits for its accelerator.
        return next_task(shared, Some(&task));
    }
    match Prepared::build(geometry, &task.order.settings) {
        Ok(prepared) => serve_with(shared, &prepared, task, rate),
        Err(error) => failed(shared, &task, error),
    }
}

/// The order can't be rendered; the next one.
fn failed(shared: &Shared, task: &Task, error: Error) -> Option<Task> {
    shared.tell(task.job, |status| status.stage = Stage::Failed(error.to_string()));
    next_task(shared, Some(task))
}

/// Shows the smaller pictures of a preview by a tree that is built soonest, where the accelerator that is asked for takes long.
fn hurry(shared: &Shared, geometry: &Geometry, task: &mut Task, rate: &mut f64) -> Result<()> {
    let is_preview = matches!(task.order.purpose, Purpose::Preview);
    if !is_preview || geometry.triangle_count() < MANY_TRIANGLES {
        return Ok(());
    }
    let settings =
        Settings { accel: AccelKind::Native, bvh: BvhQuality::Fast, ..task.order.settings.clone() };
    let prepared = Prepared::build(geometry, &settings)?;
    task.is_seen = run_coarse(shared, &prepared, task, &settings, rate)? != Ended::Cancelled;
    shared.tell(task.job, |status| status.stage = Stage::Building);
    Ok(())
}

/// Takes orders while the accelerator fits; the first that needs another one.
fn serve_with(shared: &Shared, prepared: &Prepared<'_>, mut task: Task, rate: &mut f64) -> Option<Task> {
    while prepared.fits(&task.world, &task.order.settings) {
        let stage = match run(shared, prepared, &task, rate) {
            Ok(ended) => Stage::Done(ended),
            Err(error) => Stage::Failed(error.to_string()),
        };
        shared.tell(task.job, |status| status.stage = stage);
        task = next_task(shared, Some(&task))?;
    }
    Some(task)
}

/// Waits for an order and compiles it; `None` at the end.
fn next_task(shared: &Shared, last: Option<&Task>) -> Option<Task> {
    loop {
        let (job, order) = shared.next()?;
        (shared.notify)();
        match compile(job, order, last) {
            Ok(task) => {
                shared.tell(job, |status| status.guards.clone_from(&task.guards));
                return Some(task);
            }
            Err(error) => shared.tell(job, |status| fail(status, error)),
        }
    }
}

/// The order can't be rendered.
fn fail(status: &mut Status, error: Error) {
    status.stage = Stage::Failed(error.to_string());
    if let Error::Scene(diagnostics) = error {
        status.guards = diagnostics;
    }
}

/// Compiles the scene of an order, with as much as possible of the last one's.
fn compile(job: u64, order: Order, last: Option<&Task>) -> Result<Task> {
    order.settings.check()?;
    let Order { loaded, editable, .. } = &order;
    let is_final = matches!(order.purpose, Purpose::Final(_));
    let last = last.filter(|last| Arc::ptr_eq(&last.order.loaded, loaded));
    if !is_final
        && let Some(last) = last
        && has_same_surfaces(&last.order.editable, editable)
    {
        // Not asked again while the camera moves: that is a look at every triangle.
        let (world, guards) = (Arc::clone(&last.world), last.guards.clone());
        return Ok(Task { job, order, world, digest: None, guards, is_seen: false });
    }
    let is_edited = **editable != loaded.editable;
    let (desc, digest) = if is_final && is_edited {
        // Exactly what the command line reads from the saved file.
        let text = edit::save(&loaded.text, &loaded.scene.desc, editable)?;
        let scene = in_pool(&order.settings, || scene::parse(&text, &loaded.path))?;
        (scene.desc, Some(scene.digest))
    } else {
        let mut desc = loaded.scene.desc.clone();
        editable.put(&mut desc);
        (desc, (!is_edited).then_some(loaded.scene.digest))
    };
    let (mut world, guards) = in_pool(&order.settings, || {
        let world = World::compile(&desc)?;
        let guards = world.guards(&desc, order.settings.width)?;
        Ok((world, guards))
    })?;
    if let Some(last) = last
        && has_same_shapes(&last.order.editable, editable)
    {
        world.geometry = Arc::clone(&last.world.geometry);
    }
    Ok(Task { job, order, world: Arc::new(world), digest, guards, is_seen: false })
}

/// Whether two states differ in their cameras at most.
fn has_same_surfaces(a: &Editable, b: &Editable) -> bool {
    a.environment == b.environment && a.rotation == b.rotation && a.surfaces == b.surfaces
}

/// Whether the shapes of a scene compile to the same: a mesh that emits light gets triangles of its own.
fn has_same_shapes(a: &Editable, b: &Editable) -> bool {
    let emits = |editable: &Editable| -> Vec<bool> {
        let surfaces = editable.surfaces.iter();
        surfaces.map(|surface| surface.as_ref().is_some_and(|surface| surface.material().emits())).collect()
    };
    emits(a) == emits(b)
}

/// Renders a task: first smaller pictures, if it is a preview.
fn run(shared: &Shared, prepared: &Prepared<'_>, task: &Task, rate: &mut f64) -> Result<Ended> {
    shared.tell(task.job, |status| status.stage = Stage::Rendering);
    let full = &task.order.settings;
    let target = match &task.order.purpose {
        Purpose::Final(wanted) => Some((wanted, target(shared, task, wanted)?)),
        Purpose::Preview => {
            if !task.is_seen && run_coarse(shared, prepared, task, full, rate)? == Ended::Cancelled {
                return Ok(Ended::Cancelled);
            }
            None
        }
    };
    let look = target.as_ref().and_then(|_| Follow::new(shared, task, prepared, full, false, None).look());
    let follow = Follow::new(shared, task, prepared, full, false, look);
    let rendered = prepared.render(&task.world, &task.order.editable.camera, full, &follow)?;
    learn(rate, &rendered);
    let samples = rendered.film.samples();
    if shared.is_newest(task.job) && samples > 0 {
        // A picture that was stopped is mostly on the screen already, and the next one must not wait.
        if rendered.ended != Ended::Cancelled || !follow.has_shown(samples) {
            follow.show(rendered.film.means().collect(), samples, &rendered.film);
        }
        conclude(shared, task, &rendered);
    }
    if let (Some((wanted, target)), Some(digest)) = (target, task.digest)
        && samples > 0
    {
        write(&target, wanted, task, digest, &rendered)?;
        shared.tell(task.job, |status| status.written = Some(target.picture().path().to_path_buf()));
    }
    Ok(rendered.ended)
}

/// Renders the smaller pictures of a preview.
fn run_coarse(
    shared: &Shared,
    prepared: &Prepared<'_>,
    task: &Task,
    full: &Settings,
    rate: &mut f64,
) -> Result<Ended> {
    for settings in coarser(full, *rate) {
        let follow = Follow::new(shared, task, prepared, &settings, true, None);
        let rendered = prepared.render(&task.world, &task.order.editable.camera, &settings, &follow)?;
        if rendered.ended == Ended::Cancelled {
            return Ok(Ended::Cancelled);
        }
        learn(rate, &rendered);
    }
    Ok(Ended::Complete)
}

/// The place of a final picture.
fn target(shared: &Shared, task: &Task, wanted: &Wanted) -> Result<Target> {
    if let Err(why) = Destination::new(&wanted.image) {
        shared.tell(task.job, |status| status.is_file_refused = true);
        return Err(why);
    }
    Target::new(wanted.clone())
}

/// Tells the last numbers of a render.
fn conclude(shared: &Shared, task: &Task, rendered: &Rendered) {
    shared.tell(task.job, |status| {
        status.samples = rendered.samples;
        status.rays = rendered.counters.rays;
        status.seconds = rendered.render_seconds;
        let error = rendered.error.as_ref().map(|error| error.relative.value);
        status.outlook.error = error.or(status.outlook.error);
        status.outlook.error_at_end = status.outlook.error;
        status.outlook.seconds_left = Some(0.0);
    });
}

/// Writes a final picture, as the command line does; if that fails, its film is kept elsewhere.
fn write(target: &Target, wanted: &Wanted, task: &Task, digest: Digest, rendered: &Rendered) -> Result<()> {
    let (scene, settings) = (&*task.order.loaded.path, &task.order.settings);
    let view = View::new(&task.world, &task.order.editable.camera, settings.width, settings.height);
    let provenance = Provenance {
        scene,
        digest,
        view: &view,
        settings,
        samples: rendered.film.samples(),
        is_clamped: rendered.counters.clamped > 0,
        exposure: wanted.exposure,
    };
    let Err(why) = target.write(&provenance, rendered) else { return Ok(()) };
    let recipe = Recipe::new(scene, digest, settings)?;
    let origin = Origin { recipe, view, brightest: rendered.brightest };
    let rescue = Rescue { image: &wanted.image, beside: Some(scene), options: Some(wanted.options()) };
    Err(rescue.keep(&origin, rendered, why))
}

/// Remembers how fast samples are taken.
fn learn(rate: &mut f64, rendered: &Rendered) {
    let samples = rendered.samples();
    if samples >= FEWEST_PIXELS && rendered.render_seconds > 0.0 {
        *rate = samples / rendered.render_seconds;
    }
}

/// The smaller pictures that come before the full one, one sample a pixel each: the first as large as its time allows, the
/// next with four times its sides.
fn coarser(full: &Settings, rate: f64) -> Vec<Settings> {
    let pixels = f64::from(full.width) * f64::from(full.height);
    let affordable = (rate * FIRST_PICTURE).max(FEWEST_PIXELS);
    let mut stages = Vec::new();
    let mut shrink = 1;
    while pixels / f64::from(shrink * shrink) > affordable {
        shrink *= 2;
    }
    while shrink > 1 {
        stages.push(Settings {
            width: full.width.div_ceil(shrink),
            height: full.height.div_ceil(shrink),
            samples: 1,
            noise: None,
            time: None,
            error_estimate: false,
            ..full.clone()
        });
        shrink /= if shrink >= 8 { 4 } else { shrink };
    }
    stages
}
