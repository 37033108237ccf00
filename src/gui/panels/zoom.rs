//! Where the picture lies in its place, and which pixel is under the mouse.

use eframe::egui::{Pos2, Rect, Vec2};

/// The largest and the smallest size of a pixel, in pixels of the screen.
const RANGE: [f32; 2] = [1.0 / 64.0, 128.0];

/// How the picture is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Zoom {
    /// Screen pixels a picture pixel, and where the picture's centre lies relative to the place's, in points; `None` shows the
    /// whole picture.
    at: Option<(f32, Vec2)>,
    /// What shows the whole picture.
    whole: f32,
}

impl Zoom {
    /// Shows the whole picture.
    pub fn fit(&mut self) {
        self.at = None;
    }

    /// Screen pixels a picture pixel.
    pub fn scale(&self) -> f32 {
        self.at.map_or(self.whole, |(scale, _)| scale)
    }

    /// The rectangle of a picture of so many pixels in a place.
    pub fn layout(&mut self, place: Rect, size: [usize; 2], pixels_per_point: f32) -> Rect {
        let pixels = Vec2::new(size[0].max(1) as f32, size[1].max(1) as f32);
        let room = place.size() * pixels_per_point / pixels;
        self.whole = room.x.min(room.y).max(f32::MIN_POSITIVE);
        let (scale, offset) = self.at.unwrap_or((self.whole, Vec2::ZERO));
        // On whole pixels of the screen, so that pixels of the picture do not smear.
        let extent = pixels * scale / pixels_per_point;
        let corner = place.center() + offset - extent * 0.5;
        let snapped = ((corner.to_vec2() * pixels_per_point).round() / pixels_per_point).to_pos2();
        Rect::from_min_size(snapped, extent)
    }

    /// Zooms, so that what is at `fixed` stays there.
    pub fn scale_about(&mut self, place: Rect, fixed: Pos2, factor: f32) {
        let (scale, offset) = self.at.unwrap_or((self.whole, Vec2::ZERO));
        let wanted = (scale * factor).clamp(RANGE[0], RANGE[1]);
        let from = fixed - place.center();
        self.at = Some((wanted, from + (offset - from) * (wanted / scale)));
    }

    /// Zooms about the centre, to a power of two so that pixels stay square.
    pub fn scale_about_centre(&mut self, factor: f32) {
        let (scale, offset) = self.at.unwrap_or((self.whole, Vec2::ZERO));
        let wanted = (scale * factor).log2().round().exp2().clamp(RANGE[0], RANGE[1]);
        self.at = Some((wanted, offset * (wanted / scale)));
    }

    /// Moves the picture, by points.
    pub fn shift(&mut self, by: Vec2) {
        let (scale, offset) = self.at.unwrap_or((self.whole, Vec2::ZERO));
        self.at = Some((scale, offset + by));
    }
}

/// The place in a picture of so many pixels, from its top left corner, in pixels; `None` outside.
pub fn pixel_at(rect: Rect, size: [usize; 2], at: Pos2) -> Option<[f64; 2]> {
    let share = (at - rect.min) / rect.size();
    let is_inside = (0.0..1.0).contains(&share.x) && (0.0..1.0).contains(&share.y);
    is_inside.then(|| [f64::from(share.x) * size[0] as f64, f64::from(share.y) * size[1] as f64])
}
