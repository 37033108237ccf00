//! The result as one HTML page that needs nothing else: tables, charts, and pictures to compare with a wipe.

use super::Tradeoff;
use crate::error::{Error, Result};
use crate::output::{quantize, srgb_encode};
use crate::study::plot::chart::Sheet;
use crate::study::table::{Table, counted};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use std::fmt::Write;

const STYLE: &str = include_str!("page/style.css");
const SCRIPT: &str = include_str!("page/wipe.js");

/// Of more configurations, only those on the Pareto front and the default are shown as pictures.
const MOST_PICTURES: usize = 64;

const NOTES: &str = "relMSE is the mean of (x - r)² / (r² + 0.01) over pixels and channels; trimmed: without the worst 0.1 % of the \
    pixels. FLIP is the mean over the pixels, clipped to what a display shows, at 67 pixels a degree. Seconds are of sampling, without \
    load and build. Efficiency is 1 / (relMSE x seconds) beside that of the default. Intervals hold with 95 % confidence, by bootstrap \
    over the seeds. “front”: on the Pareto front (*), and in which share of the resamples.";

impl Tradeoff {
    /// The page.
    ///
    /// # Errors
    /// [`Error::Internal`] if a chart or picture can't be drawn.
    pub fn page(&self) -> Result<String> {
        let mut html = String::new();
        self.write_page(&mut html)?.map_err(|_| Error::Internal("the report could not be written".into()))?;
        Ok(html)
    }

    /// An error of a chart, else one of the text, which a string never has.
    fn write_page(&self, html: &mut String) -> Result<std::fmt::Result> {
        let charts =
            self.charts().into_iter().map(|chart| Sheet { heading: None, charts: vec![chart] }.svg());
        let charts = charts.collect::<Result<Vec<String>>>()?;
        let (pictures, start) = self.shown_pictures()?;
        Ok(self.write_parts(html, &charts, &pictures, start))
    }

    fn write_parts(
        &self,
        html: &mut String,
        charts: &[String],
        pictures: &str,
        start: usize,
    ) -> std::fmt::Result {
        let [width, height] = self.size;
        let title = escaped(&self.scene);
        writeln!(
            html,
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>Trade-off: {title}</title>\n\
             <style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n<h1>Speed for accuracy: {title}</h1>\n\
             <p class=\"grey\">{width} x {height} pixels, {}, errors {}; {}</p>\n<p class=\"grey\">Default: {}</p>",
            counted(self.seeds, "seed"),
            if self.has_reference { "against the reference" } else { "by variance across seeds and bias" },
            escaped(&self.machine.line()),
            escaped(&self.variants[0].name())
        )?;
        let command = self.recommended_command();
        let command =
            command.map(|command| format!("<code>{}</code>", escaped(&command))).unwrap_or_default();
        let line = escaped(&self.recommendation_line());
        writeln!(html, "<h2>Recommendation</h2>\n<div class=\"card answer\">{line}{command}</div>")?;
        writeln!(
            html,
            "<h2>Pictures</h2>\n<div class=\"card\">\n<div class=\"choose\"><select aria-label=\"left picture\"></select>\
             <select aria-label=\"right picture\"></select></div>\n\
             <div class=\"wipe\"><img alt=\"\"><img alt=\"\"><i></i></div>\n\
             <input id=\"place\" type=\"range\" min=\"0\" max=\"100\" step=\"0.1\" value=\"50\" aria-label=\"wipe\">\n</div>"
        )?;
        writeln!(html, "<h2>Charts</h2>")?;
        for chart in charts {
            writeln!(html, "<div class=\"card\">{chart}</div>")?;
        }
        let front: Vec<bool> = self.rows.iter().map(|row| row.on_front).collect();
        writeln!(html, "<h2>All settings</h2>\n<div class=\"card\">{}</div>", markup(&self.table(), &front))?;
        writeln!(html, "<p class=\"grey\">{NOTES}</p>")?;
        let more = [("Convergence", self.convergence_table()), ("Rays", self.rays_table())];
        for (title, table) in more.iter().filter_map(|(title, table)| Some((title, table.as_ref()?))) {
            writeln!(html, "<h2>{title}</h2>\n<div class=\"card\">{}</div>", markup(table, &[]))?;
        }
        let script = SCRIPT.replace("START", &start.to_string());
        writeln!(
            html,
            "</main>\n<script>\nconst pictures = [{pictures}];\n{script}</script>\n</body>\n</html>"
        )
    }

    /// Names and pictures as the items of a JavaScript array, the right one last, and which one is shown first.
    fn shown_pictures(&self) -> Result<(String, usize)> {
        let few = self.rows.len() <= MOST_PICTURES;
        let mut items = String::new();
        let mut count = 0;
        let mut start = 0;
        for (i, (row, pixels)) in self.rows.iter().zip(&self.pictures).enumerate() {
            if !few && !row.on_front && i != self.baseline {
                continue;
            }
            if i == self.baseline {
                start = count;
            }
            let samples = counted(row.configuration.samples, "sample");
            items += &self.item(&format!("{}, {samples}", self.label(row.configuration.variant)), pixels)?;
            count += 1;
        }
        let name = if self.has_reference { "the reference" } else { "the mean of all that are right" };
        items += &self.item(name, &self.truth)?;
        Ok((items, start))
    }

    fn item(&self, name: &str, pixels: &[f32]) -> Result<String> {
        let bytes: Vec<u8> = pixels.iter().map(|&value| quantize(srgb_encode(value.into()))).collect();
        let mut png = Vec::new();
        let [width, height] = self.size;
        PngEncoder::new(&mut png).write_image(&bytes, width, height, ExtendedColorType::Rgb8).map_err(
            |error| Error::Internal(format!("a picture of the report could not be encoded: {error}")),
        )?;
        // Names are made of the words of settings, which need no escape.
        Ok(format!("[\"{name}\", \"data:image/png;base64,{}\"],\n", base64(&png)))
    }
}

/// A table as HTML; rows with a true flag stand out.
fn markup(table: &Table, marked: &[bool]) -> String {
    let mut html = String::from("<table>\n");
    for (i, row) in table.rows().iter().enumerate() {
        let tag = if i == 0 { "th" } else { "td" };
        let is_marked = i > 0 && marked.get(i - 1).copied().unwrap_or(false);
        html += if is_marked { "<tr class=\"front\">" } else { "<tr>" };
        for cell in row {
            let _ = write!(html, "<{tag}>{}</{tag}>", escaped(cell));
        }
        html += "</tr>\n";
    }
    html + "</table>"
}

/// Text without what HTML would read as markup.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// RFC 4648, section 4.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |i: usize| u32::from(group.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            let digit = DIGITS[(bits >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= group.len() { char::from(digit) } else { '=' });
        }
    }
    text
}
