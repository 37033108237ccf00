//! The program's icon: `packaging/icon.yaml`, rendered into a square with round corners.

use pathtracer::picture::{quantize, srgb_encode};
use pathtracer::render::{Settings, Unwatched, render};
use pathtracer::world::World;
use std::io::BufWriter;
use std::path::Path;

/// Sides of the pictures that desktops look for, in pixels.
const SIDES: [u32; 2] = [48, 256];
/// Radius of the corners in sides.
const ROUNDING: f64 = 0.22;
/// Enough that no noise is seen.
const SAMPLES: u64 = 1024;

/// Renders the icon in all sizes.
pub(crate) fn write(root: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let desc = pathtracer::scene::load(&root.join("packaging/icon.yaml"))?.desc;
    let world = World::compile(&desc)?;
    for side in SIDES {
        let rendered = render(&world, &desc.camera, &Settings::new(side, side, SAMPLES, 16), &Unwatched)?;
        let pixels = rendered.film.means().zip(0..).flat_map(|(light, pixel)| {
            let [r, g, b] = light.to_array().map(|value| quantize(srgb_encode(value)));
            [r, g, b, quantize(inside(side, pixel % side, pixel / side))]
        });
        let pixels: Vec<u8> = pixels.collect();
        let path = root.join(format!("packaging/icons/{side}.png"));
        println!("{}: {side} x {side} pixels", path.display());
        let mut encoder = png::Encoder::new(BufWriter::new(std::fs::File::create(path)?), side, side);
        encoder.set_color(png::ColorType::Rgba);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.write_header()?.write_image_data(&pixels)?;
    }
    Ok(())
}

/// How much of a pixel lies in the square with round corners, 0 to 1.
fn inside(side: u32, x: u32, y: u32) -> f64 {
    let (half, radius) = (f64::from(side) / 2.0, ROUNDING * f64::from(side));
    // How far the pixel lies beyond the centres of the corners, on either axis.
    let beyond = [x, y].map(|at| ((f64::from(at) + 0.5 - half).abs() - (half - radius)).max(0.0));
    (radius - beyond[0].hypot(beyond[1]) + 0.5).clamp(0.0, 1.0)
}
