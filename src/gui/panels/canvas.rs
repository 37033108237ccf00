//! The picture, and the mouse on it.

use super::zoom::{Zoom, pixel_at};
use crate::gui::camera_control as control;
use crate::gui::display::{Display, Request, Shown, View};
use crate::gui::pick::Tool;
use crate::gui::session::Frame;
use crate::gui::studio::Studio;
use eframe::egui::{
    Align2, Color32, CursorIcon, FontId, Modifiers, Painter, PointerButton, Pos2, Rect, Response, Sense,
    Stroke, TextureHandle, TextureOptions, Ui, Vec2, pos2, vec2,
};
use std::sync::Arc;
use std::time::Duration;

/// How much a notch of the wheel moves the camera: by this share of the distance for 50 points.
const WHEEL: f64 = 0.1;

/// A picture on its way to the screen.
#[derive(Default)]
struct Layer {
    texture: Option<TextureHandle>,
    shown: Option<Arc<Shown>>,
}

/// The picture's place.
#[derive(Default)]
pub struct Canvas {
    /// How it is looked at.
    pub zoom: Zoom,
    /// Where there is place for it, in points.
    pub place: Option<Rect>,
    /// The pixel under the mouse.
    pub pixel: Option<[usize; 2]>,
    layer: Layer,
    stored: Layer,
    is_wiping: bool,
}

impl Layer {
    /// Brings the newest colours to the graphics driver.
    fn upload(&mut self, ui: &Ui, display: &Display, name: &str, options: TextureOptions) {
        let Some(shown) = display.shown() else { return };
        if self.shown.as_ref().is_some_and(|last| Arc::ptr_eq(last, &shown)) {
            return;
        }
        let image = Arc::clone(&shown.image);
        match &mut self.texture {
            Some(texture) => texture.set(image, options),
            None => self.texture = Some(ui.ctx().load_texture(name, image, options)),
        }
        self.shown = Some(shown);
    }

    fn paint(&self, painter: &Painter, rect: Rect, share: std::ops::Range<f32>) {
        if let Some(texture) = &self.texture {
            let (left, right) =
                (rect.left() + rect.width() * share.start, rect.left() + rect.width() * share.end);
            let part = Rect::from_min_max(pos2(left, rect.top()), pos2(right, rect.bottom()));
            let uv = Rect::from_min_max(pos2(share.start, 0.0), pos2(share.end, 1.0));
            painter.image(texture.id(), part, uv, Color32::WHITE);
        }
    }
}

impl Canvas {
    /// What is on the screen.
    pub fn shown(&self) -> Option<&Arc<Shown>> {
        self.layer.shown.as_ref()
    }

    pub(super) fn show(&mut self, ui: &mut Ui, studio: &mut Studio) {
        let (place, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        self.place = Some(place);
        let per_point = ui.ctx().pixels_per_point();
        let pixels = place.size() * per_point;
        studio.set_place([pixels.x.max(1.0) as u32, pixels.y.max(1.0) as u32]);
        if studio.is_settling() {
            ui.ctx().request_repaint_after(Duration::from_millis(220));
        }
        let Some(frame) = studio.session.frame() else {
            return hint(ui, place, studio);
        };
        self.request(ui, &frame, studio);
        let options = if self.zoom.scale() >= 2.0 && !frame.is_coarse {
            TextureOptions::NEAREST
        } else {
            TextureOptions::LINEAR
        };
        self.layer.upload(ui, &studio.display, "picture", options);
        let settings = studio.preview_settings();
        let size = match studio.is_final() || !frame.is_coarse {
            true => frame.size(),
            false => [settings.width as usize, settings.height as usize],
        };
        let rect = self.zoom.layout(place, size, per_point);
        let painter = ui.painter().with_clip_rect(place);
        let wipe = studio.wipe.filter(|_| studio.stored.is_some());
        self.layer.paint(&painter, rect, wipe.unwrap_or(0.0)..1.0);
        if let Some(share) = wipe {
            self.stored.upload(ui, &studio.stored_display, "stored", options);
            self.stored.paint(&painter, rect, 0.0..share);
            draw_wipe(&painter, rect, share);
        }
        self.point(&response, rect, &frame);
        self.drag(ui, &response, place, rect, studio);
        self.click(ui, &response, rect, &frame, studio);
        overlay(ui, &painter, place, studio, &frame);
    }

    /// Asks for the colours of what is to be seen.
    fn request(&self, ui: &Ui, frame: &Arc<Frame>, studio: &mut Studio) {
        let (view, exposure) = (studio.view, studio.kept.knobs.exposure);
        let most = ui.ctx().input(|input| input.max_texture_side);
        studio.display.request(Request { frame: Arc::clone(frame), view, exposure, most });
        if let Some(stored) = studio.stored.clone().filter(|_| studio.wipe.is_some()) {
            studio.stored_display.request(Request { frame: stored, view, exposure, most });
        }
    }

    /// Remembers the pixel under the mouse.
    fn point(&mut self, response: &Response, rect: Rect, frame: &Frame) {
        let at = response.hover_pos().and_then(|at| pixel_at(rect, frame.size(), at));
        self.pixel = at.map(|at| at.map(|place| place as usize));
    }

    /// Moves the camera, the zoomed picture or the wipe.
    fn drag(&mut self, ui: &Ui, response: &Response, place: Rect, rect: Rect, studio: &mut Studio) {
        let modifiers = ui.ctx().input(|input| input.modifiers);
        self.wheel(ui, response, place, studio, modifiers);
        if response.drag_started()
            && let (Some(share), Some(at)) =
                (studio.wipe, ui.ctx().input(|input| input.pointer.press_origin()))
        {
            self.is_wiping = (at.x - (rect.left() + share * rect.width())).abs() < 8.0;
        }
        if response.drag_stopped() {
            self.is_wiping = false;
        }
        let by = response.drag_delta();
        if by == Vec2::ZERO {
            return;
        }
        if self.is_wiping {
            let share = studio.wipe.unwrap_or(0.5) + by.x / rect.width();
            studio.wipe = Some(share.clamp(0.0, 1.0));
            return;
        }
        if studio.is_final() || modifiers.command {
            return self.zoom.shift(by);
        }
        let shares = [f64::from(by.x / rect.width()), f64::from(by.y / rect.height())];
        let aspect = f64::from(rect.height() / rect.width());
        let is_middle = response.dragged_by(PointerButton::Middle);
        let is_right = response.dragged_by(PointerButton::Secondary);
        studio.edit(|editable| {
            let camera = &mut editable.camera;
            match modifiers {
                _ if is_right => control::dolly(camera, libm::exp(2.0 * shares[1])),
                _ if is_middle || modifiers.shift => control::pan(camera, shares, aspect),
                _ if modifiers.alt => control::roll(camera, shares[0] * 180.0),
                _ => control::orbit(camera, shares),
            }
        });
        studio.form.clear_camera();
    }

    fn wheel(
        &mut self,
        ui: &Ui,
        response: &Response,
        place: Rect,
        studio: &mut Studio,
        modifiers: Modifiers,
    ) {
        let Some(at) = response.hover_pos() else { return };
        let (scroll, zoom) = ui.ctx().input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        if zoom != 1.0 {
            self.zoom.scale_about(place, at, zoom);
        } else if scroll != 0.0 && (studio.is_final() || modifiers.command) {
            self.zoom.scale_about(place, at, (scroll / 200.0).exp2());
        } else if scroll != 0.0 {
            let factor = libm::exp(-WHEEL * f64::from(scroll) / 50.0);
            studio.edit(|editable| control::dolly(&mut editable.camera, factor));
            studio.form.clear_camera();
        }
    }

    fn click(&self, ui: &Ui, response: &Response, rect: Rect, frame: &Arc<Frame>, studio: &mut Studio) {
        if !response.clicked() {
            return;
        }
        ui.ctx().memory_mut(|memory| {
            if let Some(focused) = memory.focused() {
                memory.surrender_focus(focused);
            }
        });
        let at = response.interact_pointer_pos().and_then(|at| pixel_at(rect, frame.size(), at));
        let Some(at) = at else { return };
        let with_command = ui.ctx().input(|input| input.modifiers.command);
        let tool = if with_command { Tool::Focus } else { studio.tool };
        studio.click(Arc::clone(frame), at, tool);
    }
}

/// What to do with an empty window.
fn hint(ui: &Ui, place: Rect, studio: &Studio) {
    let text = match (&studio.document.path, studio.document.is_reading()) {
        (_, true) => "reading the scene…",
        (Some(_), _) if studio.document.loaded.is_none() => "",
        (Some(_), _) => "rendering…",
        (None, _) => "Open a scene: File, Ctrl+O, or drop a file here",
    };
    let color = ui.visuals().text_color();
    ui.painter().text(place.center(), Align2::CENTER_CENTER, text, FontId::proportional(16.0), color);
}

fn draw_wipe(painter: &Painter, rect: Rect, share: f32) {
    let x = rect.left() + share * rect.width();
    painter.vline(x, rect.y_range(), Stroke::new(3.0, Color32::from_black_alpha(160)));
    painter.vline(x, rect.y_range(), Stroke::new(1.0, Color32::WHITE));
    for (text, side, align) in [("A", -8.0, Align2::RIGHT_TOP), ("now", 8.0, Align2::LEFT_TOP)] {
        label(painter, pos2(x + side, rect.top() + 8.0), align, text);
    }
}

/// Text on the picture, readable on any.
fn label(painter: &Painter, at: Pos2, align: Align2, text: &str) {
    let font = FontId::proportional(13.0);
    let galley = painter.layout_no_wrap(text.to_owned(), font, Color32::WHITE);
    let rect = align.anchor_size(at, galley.size());
    painter.rect_filled(rect.expand2(vec2(5.0, 2.0)), 3.0, Color32::from_black_alpha(170));
    painter.galley(rect.min, galley, Color32::WHITE);
}

/// What the mouse does, and what the colours of a view mean.
fn overlay(ui: &Ui, painter: &Painter, place: Rect, studio: &Studio, frame: &Frame) {
    let tool = match studio.tool {
        Tool::Select => None,
        Tool::Focus => Some("click: make that point sharp"),
        Tool::LookAt => Some("click: look at that point"),
    };
    if let Some(tool) = tool {
        ui.ctx().output_mut(|output| output.cursor_icon = CursorIcon::Crosshair);
        label(painter, place.center_top() + vec2(0.0, 8.0), Align2::CENTER_TOP, tool);
    }
    let legend = match studio.view {
        View::Error if frame.errors.is_none() => "error map: after two samples",
        View::Error => "relative error: dark 0.1 %, bright 100 %",
        View::Samples => "samples: dark 0, bright the most",
        View::Depth => "depth: bright is near",
        View::Albedo => "albedo",
        View::Normals => "normals: x, y, z as red, green, blue",
        View::Picture => return,
    };
    label(painter, place.left_bottom() + vec2(10.0, -10.0), Align2::LEFT_BOTTOM, legend);
}
