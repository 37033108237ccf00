//! What is shown of a frame: a thread turns its numbers into colours, so that the window never waits for it.

use super::session::Frame;
use super::tone;
use eframe::egui::{Color32, ColorImage};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

/// The widest and highest image that is handed to the graphics driver, however much it takes.
const LARGEST_SIDE: usize = 8192;

/// What of a frame is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum View {
    /// The light.
    #[default]
    Picture,
    /// Reflectances.
    Albedo,
    /// Normals: x, y, z as red, green, blue.
    Normals,
    /// Distances: near is bright.
    Depth,
    /// The estimated relative error of each pixel.
    Error,
    /// Samples of each pixel.
    Samples,
}

impl View {
    /// In the order of the keys 1 to 6.
    pub const ALL: [View; 6] =
        [View::Picture, View::Albedo, View::Normals, View::Depth, View::Error, View::Samples];

    /// Whether the brightness of a colour stands for a value.
    pub const fn shows_values(self) -> bool {
        matches!(self, View::Picture | View::Albedo)
    }

    /// The name in the window.
    pub const fn name(self) -> &'static str {
        match self {
            View::Picture => "Picture",
            View::Albedo => "Albedo",
            View::Normals => "Normals",
            View::Depth => "Depth",
            View::Error => "Error map",
            View::Samples => "Samples map",
        }
    }
}

/// What is to be shown.
#[derive(Clone)]
pub struct Request {
    /// Of what.
    pub frame: Arc<Frame>,
    /// What of it.
    pub view: View,
    /// Brightness in stops.
    pub exposure: f64,
    /// The most pixels of a side of the image: what the graphics driver takes.
    pub most: usize,
}

impl Request {
    /// Whether the frame does not know yet what is to be shown.
    fn is_early(&self) -> bool {
        match self.view {
            View::Picture | View::Samples => false,
            View::Error => self.frame.errors.is_none(),
            View::Albedo | View::Normals | View::Depth => self.frame.look.is_none(),
        }
    }

    fn is_same(&self, other: &Request) -> bool {
        Arc::ptr_eq(&self.frame, &other.frame)
            && self.view == other.view
            && self.exposure.to_bits() == other.exposure.to_bits()
            && self.most == other.most
    }
}

/// What is shown.
pub struct Shown {
    /// What it was made from.
    pub request: Request,
    /// The colours, of every pixel or, if there are too many, of some.
    pub image: Arc<ColorImage>,
    /// How many values of red, green and blue have each byte.
    pub histogram: Box<[[u32; 256]; 3]>,
    /// The relative error of the picture, of [`View::Error`].
    pub error: Option<f64>,
}

#[derive(Default)]
struct State {
    wanted: Option<Request>,
    shown: Option<Arc<Shown>>,
    quit: bool,
}

struct Shared {
    state: Mutex<State>,
    wake: Condvar,
    notify: Box<dyn Fn() + Send + Sync>,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn serve(&self) {
        loop {
            let mut state = self.lock();
            let request = loop {
                if state.quit {
                    return;
                }
                match state.wanted.take() {
                    Some(request) => break request,
                    None => state = self.wake.wait(state).unwrap_or_else(PoisonError::into_inner),
                }
            };
            let is_early = request.is_early() && state.shown.is_some();
            drop(state);
            // The picture before is better than none.
            if !is_early {
                let shown = Arc::new(show(request));
                self.lock().shown = Some(shown);
                (self.notify)();
            }
        }
    }
}

/// The thread that makes colours. Dropping it ends the thread.
pub struct Display {
    shared: Arc<Shared>,
    last: Option<Request>,
    thread: Option<JoinHandle<()>>,
}

impl Display {
    /// Starts the thread. `notify` is called from it when there is something new.
    pub fn new(notify: impl Fn() + Send + Sync + 'static) -> Display {
        let shared =
            Arc::new(Shared { state: Mutex::default(), wake: Condvar::new(), notify: Box::new(notify) });
        let worker = Arc::clone(&shared);
        let thread = thread::Builder::new().name("colours".into()).spawn(move || worker.serve()).ok();
        Display { shared, last: None, thread }
    }

    /// Asks for a picture, unless it was asked for already. The newest request wins.
    pub fn request(&mut self, request: Request) {
        if self.last.as_ref().is_some_and(|last| last.is_same(&request)) {
            return;
        }
        self.last = Some(request.clone());
        self.shared.lock().wanted = Some(request);
        self.shared.wake.notify_all();
    }

    /// What was made last.
    pub fn shown(&self) -> Option<Arc<Shown>> {
        self.shared.lock().shown.clone()
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        self.shared.lock().quit = true;
        self.shared.wake.notify_all();
        if let Some(thread) = self.thread.take() {
            // A panic of the thread has nothing left to break.
            let _ = thread.join();
        }
    }
}

/// Makes the colours of a request.
pub fn show(request: Request) -> Shown {
    let frame = &*Arc::clone(&request.frame);
    let [width, height] = frame.size();
    let step = width.max(height).div_ceil(request.most.clamp(1, LARGEST_SIDE)).max(1);
    let size = [width.div_ceil(step), height.div_ceil(step)];
    let colors = colors(frame, request.view, request.exposure);
    let mut histogram = Box::new([[0; 256]; 3]);
    let mut pixels = Vec::with_capacity(size[0] * size[1]);
    for y in (0..height).step_by(step) {
        for x in (0..width).step_by(step) {
            let [r, g, b] = colors(y * width + x);
            pixels.push(Color32::from_rgb(r, g, b));
            for (channel, byte) in histogram.iter_mut().zip([r, g, b]) {
                channel[byte as usize] += 1;
            }
        }
    }
    let error = (request.view == View::Error).then(|| relative_error(frame)).flatten();
    let image = Arc::new(ColorImage::new(size, pixels));
    Shown { image, histogram, error, request }
}

/// The colour of a pixel.
type Colors<'f> = Box<dyn Fn(usize) -> [u8; 3] + 'f>;

fn colors(frame: &Frame, view: View, exposure: f64) -> Colors<'_> {
    match (view, &frame.look) {
        (View::Picture, _) => {
            let factor = libm::exp2(exposure);
            Box::new(move |pixel| frame.light[pixel].to_array().map(|value| tone::byte(value * factor)))
        }
        (View::Error, _) => Box::new(|pixel| match relative(frame, pixel) {
            Some(error) => ramp((libm::log10(error.max(1e-9)) + 3.0) / 3.0),
            None => NOTHING,
        }),
        (View::Samples, _) => {
            let most = frame.samples.max(1) as f64;
            Box::new(move |pixel| ramp(frame.count(pixel) as f64 / most))
        }
        (View::Albedo, Some(look)) => {
            Box::new(|pixel| triple(&look.albedo, pixel).map(|value| tone::byte(value.into())))
        }
        (View::Normals, Some(look)) => {
            Box::new(|pixel| triple(&look.normal, pixel).map(|value| (127.5 + 127.5 * value) as u8))
        }
        (View::Depth, Some(look)) => {
            let seen = || look.depth.iter().copied().filter(|&depth| depth < crate::render::FAR);
            let (near, far) = (seen().fold(f32::MAX, f32::min), seen().fold(0.0, f32::max));
            let scale = 1.0 / (far - near).max(f32::MIN_POSITIVE);
            Box::new(move |pixel| {
                let depth = look.depth.get(pixel).copied().unwrap_or(crate::render::FAR);
                let share = if depth < crate::render::FAR { 1.0 - (depth - near) * scale } else { -1.0 };
                [if share < 0.0 { 0 } else { (30.0 + 225.0 * share) as u8 }; 3]
            })
        }
        _ => Box::new(|_| NOTHING),
    }
}

/// What is not known yet.
const NOTHING: [u8; 3] = [64, 64, 64];

fn triple(values: &[f32], pixel: usize) -> [f32; 3] {
    let of = |i: usize| values.get(3 * pixel + i).copied().unwrap_or(0.0);
    [of(0), of(1), of(2)]
}

/// The relative error of a pixel: the root of variance / (mean^2 + 0.01), as [`crate::film::PictureError`] weighs it.
fn relative(frame: &Frame, pixel: usize) -> Option<f64> {
    let error = f64::from(frame.error(pixel)?);
    let mean = frame.light.get(pixel)?.element_sum() / 3.0;
    Some(error / (mean * mean + 0.01).sqrt())
}

/// The root of the mean of the squares of [`relative`].
fn relative_error(frame: &Frame) -> Option<f64> {
    let pixels = frame.light.len();
    let squares: Option<f64> =
        (0..pixels).map(|pixel| relative(frame, pixel).map(|error| error * error)).sum();
    Some((squares? / pixels.max(1) as f64).sqrt())
}

/// Colours from dark blue over green to yellow, ever brighter, so that they can be told apart without seeing colours.
pub fn ramp(share: f64) -> [u8; 3] {
    const STOPS: [[f64; 3]; 5] = [
        [20.0, 12.0, 70.0],
        [50.0, 70.0, 140.0],
        [40.0, 140.0, 130.0],
        [120.0, 200.0, 80.0],
        [250.0, 230.0, 50.0],
    ];
    let place = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let index = (place as usize).min(STOPS.len() - 2);
    let (low, high, part) = (STOPS[index], STOPS[index + 1], place - index as f64);
    std::array::from_fn(|i| (low[i] + (high[i] - low[i]) * part) as u8)
}
