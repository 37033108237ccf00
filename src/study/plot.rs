//! Plots of a bench: how the cost of a ray and of a build grow with the number of triangles.
//!
//! One panel a mesh, all on the same axes, both logarithmic. The font comes with the program: a plot needs none of the
//! system's.

mod axis;
pub mod chart;
mod log_axis;
mod mark;

use self::log_axis::LogAxis;
use self::mark::{Mark, Placed};
use super::bench::{Row, Rung};
use super::contender::Kind;
use super::rounds::Spread;
use crate::accel::Precision;
use crate::error::{Error, Result};
use crate::render::AccelKind;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::fmt::Display;
use std::sync::Once;

/// Pixels of a panel; one alone is twice as wide.
const PANEL: (u32, u32) = (430, 330);
const MOST_COLUMNS: usize = 4;
/// Pixels of the heading, of the title of a block of panels, and of the legend.
const HEADING: u32 = 76;
const TITLE: u32 = 44;
const LEGEND: u32 = 84;
const INK: RGBColor = RGBColor(38, 38, 44);
const FAINT: RGBColor = RGBColor(226, 226, 232);
const GREY: RGBColor = RGBColor(110, 110, 118);

/// What is plotted.
#[derive(Clone, Copy, Debug)]
pub struct Plot<'r> {
    /// The heading, and a smaller line below it.
    pub heading: [&'r str; 2],
    /// All rungs, those of a mesh ascending.
    pub rungs: &'r [Rung],
}

/// A block of panels: a cost of every row.
struct Block {
    title: &'static str,
    cost: fn(&Rung, &Row) -> Spread,
}

const BLOCKS: [Block; 2] = [
    Block {
        title: "Nanoseconds a ray: geometric mean over the kinds of rays, 1 thread; bars show all rounds",
        cost: ray_cost,
    },
    Block { title: "Nanoseconds a triangle to build, all threads; bars show all rounds", cost: build_cost },
];

fn ray_cost(_: &Rung, row: &Row) -> Spread {
    let Spread { median, min, max } = row.mean[0];
    Spread { median: 1e9 / median, min: 1e9 / max, max: 1e9 / min }
}

fn build_cost(rung: &Rung, row: &Row) -> Spread {
    row.build_seconds[1].scaled(1e9 / rung.triangles.max(1) as f64)
}

impl Plot<'_> {
    /// As an SVG file.
    ///
    /// # Errors
    /// Those of drawing, which a string never has.
    pub fn svg(&self) -> Result<String> {
        let mut text = String::new();
        let root = SVGBackend::with_string(&mut text, self.size()).into_drawing_area();
        self.draw(&root)?;
        drop(root);
        Ok(text)
    }

    /// The pixels of a picture, R G B row by row, with its width and height.
    ///
    /// # Errors
    /// Those of drawing, which a buffer of the right size never has.
    pub fn pixels(&self) -> Result<(Vec<u8>, u32, u32)> {
        let (width, height) = self.size();
        let mut pixels = vec![0; 3 * width as usize * height as usize];
        let root = BitMapBackend::with_buffer(&mut pixels, (width, height)).into_drawing_area();
        self.draw(&root)?;
        drop(root);
        Ok((pixels, width, height))
    }

    /// The meshes in the order of their first rungs.
    fn meshes(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for rung in self.rungs {
            if !names.contains(&rung.mesh.as_str()) {
                names.push(&rung.mesh);
            }
        }
        names
    }

    fn columns(&self) -> usize {
        self.meshes().len().clamp(1, MOST_COLUMNS)
    }

    fn panel_rows(&self) -> usize {
        self.meshes().len().div_ceil(self.columns())
    }

    fn size(&self) -> (u32, u32) {
        let block = TITLE + PANEL.1 * self.panel_rows() as u32;
        (PANEL.0 * self.columns().max(2) as u32 + 20, HEADING + block * BLOCKS.len() as u32 + LEGEND)
    }

    fn draw<DB: DrawingBackend>(&self, root: &DrawingArea<DB, Shift>) -> Result<()> {
        register_font();
        root.fill(&WHITE).map_err(failed)?;
        let [heading, below] = self.heading;
        write(root, heading, (20, 14), 26, INK)?;
        write(root, below, (20, 48), 16, GREY)?;
        let mut rest = root.margin(HEADING, 0, 0, 20);
        for block in &BLOCKS {
            let (upper, lower) = rest.split_vertically(TITLE + PANEL.1 * self.panel_rows() as u32);
            self.draw_block(&upper, block)?;
            rest = lower;
        }
        draw_legend(&rest, &self.kinds())?;
        root.present().map_err(failed)
    }

    fn kinds(&self) -> Vec<Kind> {
        self.rungs.first().map(|rung| rung.rows.iter().map(|row| row.kind).collect()).unwrap_or_default()
    }

    fn draw_block<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>, block: &Block) -> Result<()> {
        write(area, block.title, (20, 16), 19, INK)?;
        let x = LogAxis::around(self.rungs.iter().map(|rung| rung.triangles as f64));
        let y = LogAxis::around(self.rungs.iter().flat_map(|rung| {
            rung.rows.iter().flat_map(|row| {
                let cost = (block.cost)(rung, row);
                [cost.min, cost.max]
            })
        }));
        let panels = area.margin(TITLE, 0, 0, 0).split_evenly((self.panel_rows(), self.columns()));
        for (mesh, panel) in self.meshes().into_iter().zip(&panels) {
            let rungs: Vec<&Rung> = self.rungs.iter().filter(|rung| rung.mesh == mesh).collect();
            draw_panel(panel, mesh, &rungs, block, [x.clone(), y.clone()])?;
        }
        Ok(())
    }
}

fn draw_panel<DB: DrawingBackend>(
    panel: &DrawingArea<DB, Shift>,
    mesh: &str,
    rungs: &[&Rung],
    block: &Block,
    [x, y]: [LogAxis; 2],
) -> Result<()> {
    let mut chart = ChartBuilder::on(panel)
        .margin(8)
        .caption(mesh, font(18).color(&INK))
        .x_label_area_size(42)
        .y_label_area_size(58)
        .build_cartesian_2d(x, y)
        .map_err(failed)?;
    chart
        .configure_mesh()
        .x_desc("triangles")
        .label_style(font(14).color(&INK))
        .axis_desc_style(font(14).color(&GREY))
        .axis_style(GREY)
        .bold_line_style(FAINT)
        .light_line_style(TRANSPARENT)
        .draw()
        .map_err(failed)?;
    let rows = rungs.first().map_or(0, |rung| rung.rows.len());
    for i in 0..rows {
        let kind = rungs[0].rows[i].kind;
        let color = color_of(kind);
        let points: Vec<(f64, Spread)> =
            rungs.iter().map(|rung| (rung.triangles as f64, (block.cost)(rung, &rung.rows[i]))).collect();
        let line = points.iter().map(|&(x, cost)| (x, cost.median));
        chart.draw_series(LineSeries::new(line, color.stroke_width(2))).map_err(failed)?;
        // The range over the rounds, and a mark at the median.
        let ranges = points.iter().map(|&(x, cost)| PathElement::new([(x, cost.min), (x, cost.max)], color));
        chart.draw_series(ranges).map_err(failed)?;
        let marks = points.iter().map(|&(x, cost)| placed(kind, (x, cost.median)));
        chart.draw_series(marks).map_err(failed)?;
    }
    Ok(())
}

/// A row for each accelerator.
fn draw_legend<DB: DrawingBackend>(area: &DrawingArea<DB, Shift>, kinds: &[Kind]) -> Result<()> {
    const ROW: usize = 3;
    for (i, &kind) in kinds.iter().enumerate() {
        let (x, y) = (20 + 210 * (i % ROW) as i32, 22 + 30 * (i / ROW) as i32);
        let line = PathElement::new([(x, y), (x + 36, y)], color_of(kind).stroke_width(2));
        area.draw(&line).map_err(failed)?;
        area.draw(&placed(kind, (x + 18, y))).map_err(failed)?;
        let label = format!("{} {}", kind.accel_name(), kind.precision_name());
        write(area, &label, (x + 46, y - 9), 17, INK)?;
    }
    Ok(())
}

/// The mark of an accelerator: a disk for exact, a ring for robust, a triangle for fast.
fn placed<C>(kind: Kind, at: C) -> Placed<C> {
    let mark = match kind.precision {
        Precision::Exact => Mark::Disk,
        Precision::Robust => Mark::Ring,
        Precision::Fast => Mark::Triangle,
    };
    Placed { mark, color: color_of(kind), at }
}

/// Warm for Embree, cold for native; the faster the lighter.
pub(super) fn color_of(kind: Kind) -> RGBColor {
    match (kind.accel, kind.precision) {
        (AccelKind::Embree, Precision::Exact) => RGBColor(146, 43, 0),
        (AccelKind::Embree, Precision::Robust) => RGBColor(222, 93, 20),
        (AccelKind::Embree, Precision::Fast) => RGBColor(250, 167, 80),
        (AccelKind::Native, Precision::Exact) => RGBColor(10, 50, 120),
        (AccelKind::Native, Precision::Robust) => RGBColor(35, 120, 190),
        (AccelKind::Native, Precision::Fast) => RGBColor(95, 185, 215),
    }
}

const FAMILY: &str = "sans-serif";

fn font(size: i32) -> TextStyle<'static> {
    (FAMILY, size).into_text_style(&(0, 0))
}

fn write<DB: DrawingBackend>(
    area: &DrawingArea<DB, Shift>,
    text: &str,
    at: (i32, i32),
    size: i32,
    color: RGBColor,
) -> Result<()> {
    let style = font(size).color(&color).pos(Pos::new(HPos::Left, VPos::Top));
    area.draw(&Text::new(text, at, style)).map_err(failed)
}

fn register_font() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // A font that is no font would show as an error of the first text.
        let _ = plotters::style::register_font(FAMILY, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
    });
}

fn failed(error: impl Display) -> Error {
    Error::Internal(format!("the plot could not be drawn: {error}"))
}
