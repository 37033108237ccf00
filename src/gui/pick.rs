//! What is at a point of the picture: one ray, tried against every primitive, so that it needs no accelerator and does not
//! disturb a render.

use super::session::Frame;
use crate::accel::Accelerator;
use crate::accel::brute_force::BruteForce;
use crate::math::DVec3;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::thread;

/// What a click is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Select an object.
    #[default]
    Select,
    /// Make a point sharp.
    Focus,
    /// Look at a point.
    LookAt,
}

impl Tool {
    /// The name in the window.
    pub const fn name(self) -> &'static str {
        match self {
            Tool::Select => "Select",
            Tool::Focus => "Focus",
            Tool::LookAt => "Look at",
        }
    }
}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pick {
    /// What for.
    pub tool: Tool,
    /// The object and the point in the scene; `None` for the sky.
    pub found: Option<(usize, DVec3)>,
}

/// The object and the point that the centre of the lens sees at (x, y), in pixels of the frame from the top left corner.
pub fn seen(frame: &Frame, x: f64, y: f64) -> Option<(usize, DVec3)> {
    let world = &frame.world;
    let camera = world.camera(&frame.editable.camera, frame.settings.width, frame.settings.height);
    // The centre of the square of lens numbers is the centre of the lens.
    let ray = camera.ray(x, y, || [0.5, 0.5]);
    let hit = BruteForce::new(&world.geometry).intersect(&ray)?;
    Some((hit.object as usize, world.interaction(&ray, &hit).receiver.point.position + world.origin))
}

/// Looks on a thread of its own; `wake` is called when it is done.
pub fn start(
    frame: Arc<Frame>,
    [x, y]: [f64; 2],
    tool: Tool,
    wake: impl FnOnce() + Send + 'static,
) -> Receiver<Pick> {
    let (sender, receiver) = channel();
    thread::spawn(move || {
        // Nobody waits for a click that was followed by another one.
        let _ = sender.send(Pick { tool, found: seen(&frame, x, y) });
        wake();
    });
    receiver
}
