//! The renders behind the window: a thread of its own takes orders, and the newest wins.
//!
//! An order gets a number. Whoever looks sees frames of the newest order only, once there are any: the number is compared
//! where a frame is handed over, under the lock under which orders are given.

mod follow;
mod frame;
mod work;

pub use frame::{BlockErrors, Frame, Look};

use super::document::Loaded;
use crate::error::Diagnostic;
use crate::output::Wanted;
use crate::render::{Ended, Outlook, Settings};
use crate::scene::edit::Editable;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// What is to be rendered.
#[derive(Clone, Debug)]
pub struct Order {
    /// The scene.
    pub loaded: Arc<Loaded>,
    /// What it says by now.
    pub editable: Arc<Editable>,
    /// The render.
    pub settings: Settings,
    /// What for.
    pub purpose: Purpose,
}

/// What a render is for.
#[derive(Clone, Debug)]
pub enum Purpose {
    /// To be looked at: smaller pictures come first.
    Preview,
    /// To be written.
    Final(Wanted),
}

/// What the thread does.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Stage {
    /// Waits for an order.
    #[default]
    Idle,
    /// Compiles the scene and builds the accelerator.
    Building,
    /// Traces rays.
    Rendering,
    /// Would trace rays, but for the pause.
    Paused,
    /// Has rendered.
    Done(Ended),
    /// Could not.
    Failed(String),
}

/// How the newest order goes on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// Its number.
    pub job: u64,
    /// Whether it is a final render.
    pub is_final: bool,
    /// What is done now.
    pub stage: Stage,
    /// Samples of all pixels, of the picture at its full size.
    pub samples: u64,
    /// Of [`Status::samples`], at most.
    pub total: u64,
    /// Rays traced.
    pub rays: u64,
    /// Seconds of sampling, pauses left out.
    pub seconds: f64,
    /// What is known about the error.
    pub outlook: Outlook,
    /// Whether it could not, since the picture can't go to its file.
    pub is_file_refused: bool,
    /// The file that the picture was written to.
    pub written: Option<PathBuf>,
    /// What there is to say of the scene's numbers: warnings, or why it is not rendered.
    pub guards: Vec<Diagnostic>,
}

impl Status {
    /// Whether rays are traced, or would be but for a pause.
    pub fn is_busy(&self) -> bool {
        matches!(self.stage, Stage::Building | Stage::Rendering | Stage::Paused)
    }
}

/// What the thread and the window share.
struct Shared {
    state: Mutex<State>,
    wake: Condvar,
    /// The number of the newest order, to be read without the lock.
    newest: AtomicU64,
    /// The number of an order that is to end early, with its picture kept.
    stopped: AtomicU64,
    paused: AtomicBool,
    notify: Box<dyn Fn() + Send + Sync>,
}

#[derive(Default)]
struct State {
    order: Option<Order>,
    frame: Option<Arc<Frame>>,
    status: Status,
    hold: Hold,
    quit: bool,
}

/// How long renders were held by pauses: while at least one of their threads waited.
#[derive(Default)]
struct Hold {
    /// Threads that wait now.
    waiting: usize,
    since: Option<Instant>,
    /// Of all renders together.
    total: Duration,
}

impl Hold {
    fn enter(&mut self) {
        if self.waiting == 0 {
            self.since = Some(Instant::now());
        }
        self.waiting += 1;
    }

    fn leave(&mut self) {
        self.waiting -= 1;
        if self.waiting == 0 {
            self.total += self.since.take().map_or(Duration::ZERO, |since| since.elapsed());
        }
    }

    fn total(&self) -> Duration {
        self.total + self.since.map_or(Duration::ZERO, |since| since.elapsed())
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for an order that was not taken yet; `None` at the end.
    fn next(&self) -> Option<(u64, Order)> {
        let mut state = self.lock();
        loop {
            if state.quit {
                return None;
            }
            if let Some(order) = state.order.take() {
                state.status.stage = Stage::Building;
                return Some((state.status.job, order));
            }
            state = self.wake.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Changes the status of an order, if it is the newest.
    fn tell(&self, job: u64, change: impl FnOnce(&mut Status)) {
        let mut state = self.lock();
        if state.status.job == job {
            change(&mut state.status);
            drop(state);
            self.wake.notify_all();
            (self.notify)();
        }
    }

    /// Hands over a frame, if its order is the newest.
    fn publish(&self, frame: Frame) {
        let mut state = self.lock();
        if state.status.job == frame.job {
            state.frame = Some(Arc::new(frame));
            drop(state);
            self.wake.notify_all();
            (self.notify)();
        }
    }

    fn is_newest(&self, job: u64) -> bool {
        self.newest.load(Ordering::Acquire) == job
    }

    /// Whether the order has to end.
    fn is_over(&self, job: u64) -> bool {
        !self.is_newest(job) || self.stopped.load(Ordering::Acquire) == job
    }

    /// Waits while there is a pause.
    fn wait_out_pause(&self, job: u64) {
        if !self.paused.load(Ordering::Acquire) {
            return;
        }
        let mut state = self.lock();
        state.hold.enter();
        while self.paused.load(Ordering::Acquire) && !self.is_over(job) {
            if state.status.job == job && state.status.stage == Stage::Rendering {
                state.status.stage = Stage::Paused;
                self.wake.notify_all();
                (self.notify)();
            }
            state = self.wake.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        if state.status.job == job && state.status.stage == Stage::Paused {
            state.status.stage = Stage::Rendering;
        }
        state.hold.leave();
    }

    /// How long all renders were held, together.
    fn held(&self) -> Duration {
        self.lock().hold.total()
    }
}

/// The thread that renders. Dropping it ends the thread.
pub struct Session {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Session {
    /// Starts the thread. `notify` is called from it, and from the threads that render, when there is something new.
    pub fn new(notify: impl Fn() + Send + Sync + 'static) -> Session {
        let shared = Arc::new(Shared {
            state: Mutex::default(),
            wake: Condvar::new(),
            newest: AtomicU64::new(0),
            stopped: AtomicU64::new(0),
            paused: AtomicBool::new(false),
            notify: Box::new(notify),
        });
        let worker = Arc::clone(&shared);
        let thread = thread::Builder::new().name("renders".into()).spawn(move || work::serve(&worker)).ok();
        Session { shared, thread }
    }

    /// Gives an order, which ends the one before. Returns its number.
    pub fn order(&self, order: Order) -> u64 {
        let mut state = self.shared.lock();
        let job = state.status.job + 1;
        let is_final = matches!(order.purpose, Purpose::Final(_));
        state.status = Status { job, is_final, stage: Stage::Building, ..Status::default() };
        state.order = Some(order);
        self.shared.newest.store(job, Ordering::Release);
        self.shared.paused.store(false, Ordering::Release);
        self.shared.wake.notify_all();
        job
    }

    /// Ends the render under way; its picture so far stays, and is written if it is a final one.
    pub fn stop(&self) {
        let state = self.shared.lock();
        self.shared.stopped.store(state.status.job, Ordering::Release);
        self.shared.paused.store(false, Ordering::Release);
        self.shared.wake.notify_all();
    }

    /// Holds the render under way, or lets it go on.
    pub fn pause(&self, is_paused: bool) {
        let state = self.shared.lock();
        self.shared.paused.store(is_paused && state.status.is_busy(), Ordering::Release);
        self.shared.wake.notify_all();
    }

    /// Whether renders are held.
    pub fn is_paused(&self) -> bool {
        self.shared.paused.load(Ordering::Acquire)
    }

    /// How the newest order goes on.
    pub fn status(&self) -> Status {
        self.shared.lock().status.clone()
    }

    /// The newest frame: of the newest order if there is one, else of the last that had one.
    pub fn frame(&self) -> Option<Arc<Frame>> {
        self.shared.lock().frame.clone()
    }

    /// Waits until the newest order has ended.
    pub fn wait(&self) -> Status {
        self.wait_for(u64::MAX)
    }

    /// Waits until the newest order has a frame of its full size with so many samples, or has ended.
    pub fn wait_for(&self, samples: u64) -> Status {
        self.wait_until(|state| {
            let job = state.status.job;
            let frame = state.frame.as_ref();
            frame.is_some_and(|frame| frame.job == job && !frame.is_coarse && frame.samples >= samples)
        })
    }

    /// Waits until the render is held by a pause, or has ended.
    pub fn wait_for_pause(&self) -> Status {
        self.wait_until(|state| state.status.stage == Stage::Paused)
    }

    /// Waits until something holds, or the newest order has ended.
    fn wait_until(&self, holds: impl Fn(&State) -> bool) -> Status {
        let mut state = self.shared.lock();
        while !holds(&state) && state.status.is_busy() {
            state = self.shared.wake.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.status.clone()
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        {
            let mut state = self.shared.lock();
            state.quit = true;
            self.shared.newest.store(u64::MAX, Ordering::Release);
            self.shared.paused.store(false, Ordering::Release);
            self.shared.wake.notify_all();
        }
        if let Some(thread) = self.thread.take() {
            // A panic of the thread has nothing left to break.
            let _ = thread.join();
        }
    }
}
