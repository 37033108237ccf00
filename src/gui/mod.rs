//! The window: a preview that renders while the scene is changed, and final renders. It calls the same
//! [`render`](crate::render::render()) as the command line.
//!
//! ```text
//! document (the file) -> studio (the state, the commands) -> session (renders) -> display (colours) -> app, panels (widgets)
//! ```
//!
//! While it is open no frame waits for a render: files are read, renders run and colours are made on threads of their own, and
//! the newest request wins. Only closing waits, for the render to stop and for a picture that is being written.

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
