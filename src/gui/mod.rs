//! The window: a preview that renders while the scene is changed, and final renders. It calls the same
//! [`render`](crate::render::render()) as the command line.
//!
//! ```text
//! document (the file) -> studio (the state, the commands) -> session (renders) -> display (colours) -> app, panels (widgets)
//! ```
//!
//! Nothing here waits for a render: files are read, renders run and colours are made on threads of their own, and the newest
//! request wins.

mod app;
pub mod camera_control;
mod coming;
pub mod display;
pub mod document;
pub mod examples;
pub mod forecast;
pub mod form;
pub mod history;
pub mod panels;
pub mod pick;
pub mod saving;
pub mod session;
pub mod settings;
pub mod studio;
pub mod tone;

pub use app::open;
