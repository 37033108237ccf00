//! The marks that stand at the points of plots and charts, and in their legends.

use plotters::element::{Drawable, PointCollection};
use plotters::prelude::*;
use plotters_backend::{BackendCoord, DrawingErrorKind};

/// The shapes of marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Nothing.
    None,
    /// A filled circle.
    Disk,
    /// A circle.
    Ring,
    /// A triangle.
    Triangle,
    /// A square.
    Square,
    /// A square on its tip.
    Diamond,
}

impl Mark {
    /// Those that can be seen.
    pub const SHAPES: [Mark; 5] = [Mark::Disk, Mark::Ring, Mark::Triangle, Mark::Square, Mark::Diamond];
}

/// A mark at its place.
pub(super) struct Placed<C> {
    pub(super) mark: Mark,
    pub(super) color: RGBColor,
    pub(super) at: C,
}

impl<'m, C: 'm> PointCollection<'m, C> for &'m Placed<C> {
    type Point = &'m C;
    type IntoIter = std::iter::Once<&'m C>;

    fn point_iter(self) -> Self::IntoIter {
        std::iter::once(&self.at)
    }
}

impl<C, DB: DrawingBackend> Drawable<DB> for Placed<C> {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        mut points: I,
        backend: &mut DB,
        _: (u32, u32),
    ) -> std::result::Result<(), DrawingErrorKind<DB::ErrorType>> {
        let Some((x, y)) = points.next() else { return Ok(()) };
        let color = &self.color;
        match self.mark {
            Mark::None => Ok(()),
            Mark::Disk => backend.draw_circle((x, y), 4, color, true),
            Mark::Ring => {
                backend.draw_circle((x, y), 4, &WHITE, true)?;
                backend.draw_circle((x, y), 4, &color.stroke_width(2), false)
            }
            Mark::Triangle => backend.fill_polygon([(x, y - 6), (x + 5, y + 4), (x - 5, y + 4)], color),
            Mark::Square => backend.draw_rect((x - 4, y - 4), (x + 4, y + 4), color, true),
            Mark::Diamond => backend.fill_polygon([(x, y - 6), (x + 6, y), (x, y + 6), (x - 6, y)], color),
        }
    }
}
