//! Charts of points with error bars, below each other on one sheet, as SVG and as pixels.

use super::axis::Axis;
pub use super::axis::Scale;
pub use super::mark::Mark;
use super::mark::Placed;
use super::{FAINT, GREY, INK, failed, font, register_font, write};
use crate::error::Result;
use plotters::coord::Shift;
use plotters::coord::ranged1d::Ranged;
use plotters::prelude::*;

/// Pixels of a chart, of the part right of it that its legend takes, and of the heading of a sheet.
const CHART: (u32, u32) = (1000, 460);
const LEGEND: u32 = 250;
const HEADING: u32 = 76;

/// Pixels of the dashes and gaps of guides, in their order.
const DASHES: [(u32, u32); 3] = [(9, 5), (3, 4), (16, 4)];

/// Several charts.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// A large line and a small one below it, if any.
    pub heading: Option<[String; 2]>,
    /// The charts from above.
    pub charts: Vec<Chart>,
}

/// One chart.
#[derive(Clone, Debug)]
pub struct Chart {
    /// What it shows.
    pub title: String,
    /// What is along each axis, x and y.
    pub labels: [String; 2],
    /// How values lie along each axis.
    pub scales: [Scale; 2],
    /// What is drawn, the first lowest.
    pub series: Vec<Series>,
    /// Lines to compare slopes with.
    pub guides: Vec<Guide>,
}

/// Points that belong together.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// R G B.
    pub color: [u8; 3],
    /// What stands at every point.
    pub mark: Mark,
    /// Pixels of the line through the points; 0 for none.
    pub line: u32,
    /// In the order of the line.
    pub points: Vec<Point>,
}

/// A point with its intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Where it is.
    pub at: [f64; 2],
    /// From where to where its bars go, along x and along y.
    pub bars: [[f64; 2]; 2],
}

impl Point {
    /// A point without bars.
    pub fn bare(x: f64, y: f64) -> Point {
        Point { at: [x, y], bars: [[x, x], [y, y]] }
    }
}

/// A power law through a point, on logarithmic axes.
#[derive(Clone, Debug)]
pub struct Guide {
    /// Its name in the legend.
    pub name: String,
    /// The power.
    pub power: f64,
    /// A point of it.
    pub through: [f64; 2],
}

impl Sheet {
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

    fn heading_height(&self) -> u32 {
        if self.heading.is_some() { HEADING } else { 0 }
    }

    fn size(&self) -> (u32, u32) {
        (CHART.0, self.heading_height() + CHART.1 * self.charts.len().max(1) as u32)
    }

    fn draw<DB: DrawingBackend>(&self, root: &DrawingArea<DB, Shift>) -> Result<()> {
        register_font();
        root.fill(&WHITE).map_err(failed)?;
        if let Some([heading, below]) = &self.heading {
            write(root, heading, (20, 14), 26, INK)?;
            write(root, below, (20, 48), 16, GREY)?;
        }
        let mut rest = root.margin(self.heading_height(), 0, 0, 0);
        for chart in &self.charts {
            let (upper, lower) = rest.split_vertically(CHART.1);
            chart.draw(&upper)?;
            rest = lower;
        }
        root.present().map_err(failed)
    }
}

type Plane = plotters::coord::cartesian::Cartesian2d<Axis, Axis>;

impl Chart {
    /// The axis of a dimension, around all points with their bars.
    fn axis(&self, dimension: usize) -> Axis {
        let points = self.series.iter().flat_map(|series| &series.points);
        let values = points.flat_map(move |point| {
            let [low, high] = point.bars[dimension];
            [point.at[dimension], low, high]
        });
        Axis::around(self.scales[dimension], values)
    }

    fn draw<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Result<()> {
        write(area, &self.title, (20, 10), 19, INK)?;
        let (left, legend) = area.margin(34, 0, 0, 0).split_horizontally(CHART.0 - LEGEND);
        let mut chart = ChartBuilder::on(&left)
            .margin(12)
            .x_label_area_size(46)
            .y_label_area_size(70)
            .build_cartesian_2d(self.axis(0), self.axis(1))
            .map_err(failed)?;
        chart
            .configure_mesh()
            .x_desc(&self.labels[0])
            .y_desc(&self.labels[1])
            .label_style(font(14).color(&INK))
            .axis_desc_style(font(15).color(&GREY))
            .axis_style(GREY)
            .bold_line_style(FAINT)
            .light_line_style(TRANSPARENT)
            .draw()
            .map_err(failed)?;
        for (i, guide) in self.guides.iter().enumerate() {
            self.draw_guide(&mut chart, guide, DASHES[i % DASHES.len()])?;
        }
        for series in &self.series {
            self.draw_series(&mut chart, series)?;
        }
        self.draw_legend(&legend)
    }

    fn draw_series<DB: DrawingBackend>(
        &self,
        chart: &mut ChartContext<'_, DB, Plane>,
        series: &Series,
    ) -> Result<()> {
        let color = rgb(series.color);
        let (x, y) = (self.axis(0), self.axis(1));
        // Points that are not on the axes, such as an error of 0 on a logarithmic one, are left out.
        let on_axes = |point: &&Point| x.contains(point.at[0]) && y.contains(point.at[1]);
        let points: Vec<&Point> = series.points.iter().filter(on_axes).collect();
        if series.line > 0 {
            let line = points.iter().map(|point| (point.at[0], point.at[1]));
            chart.draw_series(LineSeries::new(line, color.stroke_width(series.line))).map_err(failed)?;
        }
        let held = |axis: &Axis, value: f64| value.clamp(axis.range().start, axis.range().end);
        let bars = points.iter().flat_map(|point| {
            let [[left, right], [low, high]] = point.bars;
            let [x0, y0] = point.at;
            [
                PathElement::new([(held(&x, left), y0), (held(&x, right), y0)], color),
                PathElement::new([(x0, held(&y, low)), (x0, held(&y, high))], color),
            ]
        });
        chart.draw_series(bars).map_err(failed)?;
        let marks =
            points.iter().map(|point| Placed { mark: series.mark, color, at: (point.at[0], point.at[1]) });
        chart.draw_series(marks).map_err(failed)?;
        Ok(())
    }

    /// The part of a guide that is inside of the axes, dashed.
    fn draw_guide<DB: DrawingBackend>(
        &self,
        chart: &mut ChartContext<'_, DB, Plane>,
        guide: &Guide,
        (dash, gap): (u32, u32),
    ) -> Result<()> {
        const STEPS: usize = 400;
        let (x, y) = (self.axis(0), self.axis(1));
        let (first, last) = (x.range().start.ln(), x.range().end.ln());
        let at = |i: usize| {
            let x = (first + (last - first) * i as f64 / STEPS as f64).exp();
            (x, guide.through[1] * (x / guide.through[0]).powf(guide.power))
        };
        let inside: Vec<(f64, f64)> = (0..=STEPS).map(at).filter(|point| y.contains(point.1)).collect();
        let line = DashedLineSeries::new(inside, dash, gap, GREY.stroke_width(1));
        chart.draw_series(line).map_err(failed)?;
        Ok(())
    }

    fn draw_legend<DB: DrawingBackend>(&self, area: &DrawingArea<DB, Shift>) -> Result<()> {
        const LINE: i32 = 25;
        let mut y = 26;
        for series in self.series.iter().filter(|series| !series.name.is_empty()) {
            let color = rgb(series.color);
            if series.line > 0 {
                let line = PathElement::new([(6, y), (38, y)], color.stroke_width(series.line));
                area.draw(&line).map_err(failed)?;
            }
            area.draw(&Placed { mark: series.mark, color, at: (22, y) }).map_err(failed)?;
            write(area, &series.name, (48, y - 9), 16, INK)?;
            y += LINE;
        }
        for (i, guide) in self.guides.iter().enumerate() {
            let (dash, gap) = DASHES[i % DASHES.len()];
            for x in (6..38 - dash as i32).step_by((dash + gap) as usize) {
                let dash = PathElement::new([(x, y), (x + dash as i32, y)], GREY);
                area.draw(&dash).map_err(failed)?;
            }
            write(area, &guide.name, (48, y - 9), 16, GREY)?;
            y += LINE;
        }
        Ok(())
    }
}

fn rgb([r, g, b]: [u8; 3]) -> RGBColor {
    RGBColor(r, g, b)
}
